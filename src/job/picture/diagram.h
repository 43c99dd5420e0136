/* The operation `diagram`: draws a tree unrolled flat, as a page or as pixels. */
#ifndef CORCAST_JOB_PICTURE_DIAGRAM_H
#define CORCAST_JOB_PICTURE_DIAGRAM_H

#include "diagram/diagram.h"
#include "job/picture/coloring.h"
#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"

extern const Command command_diagram;

/* A diagram, and what it borrows from. All arrays are owned. */
typedef struct MadeDiagram {
    bool is_page;
    FigurePage page; /* true to size; only if is_page */
    Frame pixels;    /* the colour plane; only if not is_page */
    Press press;     /* how a file holds the pixels; only if not is_page */
    PictureTree of;
    Appearance appearance;
    Diagram layout;
    DiagramStyle style;
    FigureBars bars;
    float (*color)[3]; /* per node: linear RGB */
} MadeDiagram;

/* Draws the tree that is the first operand: a page if the option output is an .svg or missing, else
 * pixels.
 *
 * options  parsed->options.
 * made     stays where it is, because it refers to itself. The caller releases it with
 *          madediagram_release even after an error.
 * Errors   STATUS_USAGE for options without effect; as picture_read_tree, coloring_appearance and
 *          diagram_lay_out. */
MUST_CHECK Status diagram_make(void *options, Parsed *parsed, MadeDiagram *made, Err *err);
void madediagram_release(MadeDiagram *made);

/* Writes the diagram to the file of the option output. Errors: as frames_write and
 * frames_write_page. */
MUST_CHECK Status diagram_write(const void *options, const Parsed *parsed, const MadeDiagram *made,
                                Err *err);

#endif
