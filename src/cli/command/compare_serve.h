/* The service of `corcast compare --serve`. Private to the commands. */
#ifndef CORCAST_CLI_COMMAND_COMPARE_SERVE_H
#define CORCAST_CLI_COMMAND_COMPARE_SERVE_H

#include "options/options.h"

/* Reads questions from standard input, a JSON object per line, and writes an answer per line to
 * standard output, in the same order, until the input ends. docs/REFERENCES.md describes both. A
 * question that fails has an answer with an error. Errors: STATUS_IO if writing fails;
 * STATUS_MEMORY. */
MUST_CHECK Status compare_serve(Err *err);

#endif
