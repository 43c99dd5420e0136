/* Draws a tree as a flat diagram, in which all segments have their true lengths and diameters: the
 * operation `diagram`. */
#ifndef CORCAST_JOB_PICTURE_DIAGRAM_H
#define CORCAST_JOB_PICTURE_DIAGRAM_H

#include "options/options.h"

extern const Command command_diagram;

/* Draws the tree that is the first operand, and writes the diagram to the file of --output: a page
 * if the output is an .svg, .pdf or .eps file, else an image.
 *
 * options   parsed->options.
 * Errors    STATUS_USAGE for an output of unknown format, and for bits that the format cannot
 *           store; STATUS_MEMORY; the errors of coloring_read_look, picture_read_tree,
 *           coloring_appearance, diagram_lay_out, press_open, diagram_draw, figure_check,
 *           frames_write and frames_write_page. */
MUST_CHECK Status diagram_run(void *options, Parsed *parsed, Err *err);

#endif
