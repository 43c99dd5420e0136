/* The operation `convert`: converts trees and images between file formats. */
#ifndef CORCAST_JOB_PICTURE_CONVERT_H
#define CORCAST_JOB_PICTURE_CONVERT_H

#include "options/options.h"

extern const Command command_convert;

/* Reads the first operand, a tree or an image, and writes it to the second operand, whose extension
 * selects the format.
 *
 * options  parsed->options.
 * Errors   STATUS_USAGE for an unknown extension, if one file is a tree and the other an image, and
 *          for options without effect; STATUS_INPUT if the input cannot be used; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status convert_run(void *options, Parsed *parsed, Err *err);

#endif
