/* The server of `corcast compare --serve`: compares pairs of images that another program requests.
 * Private to the commands. */
#ifndef CORCAST_CLI_COMMAND_COMPARE_SERVE_H
#define CORCAST_CLI_COMMAND_COMPARE_SERVE_H

#include "options/options.h"

/* Reads requests from standard input, one JSON object per line. Writes one response per line to
 * standard output, in the same order, until the input ends. docs/REFERENCES.md describes both. A
 * request that fails has a response with an error. Errors: STATUS_IO if writing fails;
 * STATUS_MEMORY. */
MUST_CHECK Status compare_serve(Err *err);

#endif
