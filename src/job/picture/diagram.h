/* The operation `diagram`: draws a tree as a flat diagram, in which all segments have their true
 * lengths and diameters. */
#ifndef CORCAST_JOB_PICTURE_DIAGRAM_H
#define CORCAST_JOB_PICTURE_DIAGRAM_H

#include "options/options.h"

extern const Command command_diagram;

/* Draws the tree that is the first operand, and writes the diagram to the file of --output. An
 * .svg, .pdf or .eps file contains vector graphics; other files are images.
 *
 * options  parsed->options.
 * Errors   STATUS_USAGE for an output of unknown format, for a number of bits that the format
 *          cannot store, and for an unknown look, field or color map; STATUS_INPUT if the tree or
 *          another file cannot be used, or if no segment has a length; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status diagram_run(void *options, Parsed *parsed, Err *err);

#endif
