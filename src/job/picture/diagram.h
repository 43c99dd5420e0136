/* Draws a tree as a flat diagram, in which all segments have their true lengths and diameters: the
 * operation `diagram`. The result is a page (SVG) or an image. */
#ifndef CORCAST_JOB_PICTURE_DIAGRAM_H
#define CORCAST_JOB_PICTURE_DIAGRAM_H

#include "diagram/diagram.h"
#include "job/picture/coloring.h"
#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"
#include "job/picture/sheet.h"

/* The command line of the operation. */
extern const Command command_diagram;

/* A diagram, and the data that it is drawn from. All arrays are owned. */
typedef struct MadeDiagram {
    bool is_page;    /* true: the result is `page`; false: the result is `pixels` */
    FigurePage page; /* vector graphics in true size; zeroed if not is_page */
    Frame pixels;    /* pixels.color is the image; zeroed if is_page */
    Press press;     /* how the image is stored in its file; zeroed if is_page */
    PictureTree of;  /* the tree */
    Appearance appearance;
    Diagram layout;
    DiagramStyle style; /* borrows from the other members */
    FigureBars bars;
    float (*color)[3]; /* per node: linear RGB */
    Sheet sheet; /* templates and fonts, and the page that lies over `pixels`; only opened for a
                    legend */
} MadeDiagram;

/* Draws the tree that is the first operand. The result is a page if the option `output` is an .svg,
 * .pdf or .eps file or not specified, else an image.
 *
 * options   parsed->options.
 * made      must not be moved or copied, because it points to itself. The caller releases it with
 *           madediagram_release even after an error.
 * Errors    STATUS_USAGE for an output of unknown format, and for bits that the format cannot
 *           store; STATUS_MEMORY; the errors of coloring_read_look, picture_read_tree,
 *           coloring_appearance, diagram_lay_out, press_open, diagram_draw and figure_check. */
MUST_CHECK Status diagram_make(void *options, Parsed *parsed, MadeDiagram *made, Err *err);
void madediagram_release(MadeDiagram *made);

/* Writes the diagram to the file of the option `output`, which must be specified.
 *
 * Errors   the errors of frames_write and frames_write_page. */
MUST_CHECK Status diagram_write(const void *options, const Parsed *parsed, MadeDiagram *made,
                                Err *err);

/* Makes the diagram and writes it. Errors: those of diagram_make and diagram_write. */
MUST_CHECK Status diagram_run(void *options, Parsed *parsed, Err *err);

#endif
