/* The operation `convert`: trees and images from one file format to another. */
#ifndef CORCAST_JOB_PICTURE_CONVERT_H
#define CORCAST_JOB_PICTURE_CONVERT_H

#include "options/options.h"

extern const Command command_convert;

/* Reads the first operand, a tree or an image, and writes it to the second. The extension of the
 * second operand selects the format.
 *
 * options  parsed->options.
 * Errors   STATUS_USAGE for an unknown extension, for a tree that is to become an image or the
 *          other way round, and for options without effect; the errors of convert_tree_make,
 *          convert_tree_write, picture_read, plane_read, picture_write and plane_write. */
MUST_CHECK Status convert_run(void *options, Parsed *parsed, Err *err);

#endif
