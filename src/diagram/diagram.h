/* The door of the room diagram: a tree unrolled flat, lengths and diameters true.
 *
 * Every main branch is a horizontal row of bars, a bar for each segment, as long and as wide as the
 * segment; what lies across is the length of the path from the root. Thin links lead from a branch
 * to those that leave it. Nothing crosses: the branches of a branch lie above and below it, and
 * what overlaps a branch that leaves later lies farther out. In such diagrams people find low wall
 * shear stress far more often than in pictures of three dimensions [Borkin et al., IEEE Trans. Vis.
 * Comput. Graph. 17 (2011) 2479-2488]. */
#ifndef CORCAST_DIAGRAM_DIAGRAM_H
#define CORCAST_DIAGRAM_DIAGRAM_H

#include "base/base.h"
#include "image/image.h"
#include "tree/tree.h"
#include <stddef.h>
#include <stdint.h>

/* A segment, or the link to the first segment of a branch, as a rectangle: mm, x to the right from
 * the roots, y down from the top. */
typedef struct DiagramBar {
    double x[2], y[2]; /* ascending */
    int32_t node;      /* of the tree: the segment; of a link that to which it leads */
} DiagramBar;

typedef struct Diagram {
    DiagramBar *bar; /* owned; links first, then segments in the order of the tree */
    size_t n, n_links;
    double width_mm, height_mm; /* of all bars */
} Diagram;

/* The free space between two rows, if it is not given, is the median diameter of the terminals, or
 * more, so that the diagram is about DIAGRAM_ASPECT times as high as wide. */
#define DIAGRAM_ASPECT 0.75

/* Lays out a tree or forest in *diagram (owned; diagram_release), roots on the left. `gap_mm` is
 * the space between rows, or 0 for the one said above. Segments without length have no bar.
 * O(n log n). STATUS_INPUT when no segment has length. */
MUST_CHECK Status diagram_lay_out(const Tree *tree, double gap_mm, Diagram *diagram, Err *err);
void diagram_release(Diagram *diagram);

/* What a diagram looks like. */
typedef struct DiagramPaint {
    const float (*color)[3]; /* linear RGB of each segment, by its node; borrowed */
    float background[3];     /* linear RGB */
    double margin;           /* free part on each side, in [0, 0.45] */
} DiagramPaint;

/* Draws it as large as it fits, in the middle, into *color (owned): linear RGB of `width` x
 * `height` pixels, each the mean of what it covers, so that bars thinner than a pixel show as
 * faintly as they cover it. */
MUST_CHECK Status diagram_draw(const Diagram *diagram, const DiagramPaint *paint, int width,
                               int height, Plane *color, Err *err);

/* What an SVG says beside the bars; all is borrowed. */
typedef struct DiagramSvg {
    const char *templates;   /* the folder of templates */
    const char *description; /* what it shows, and */
    const char *generator;   /* program and version, and */
    const char *command;     /* the command that makes it: one line each */
    const char *name, *unit; /* of the values; name NULL: there are none */
    const double *values;    /* of each segment, by its node; NAN where there is none */
} DiagramSvg;

/* Appends it as SVG in millimetres, true to size, a `rect` for each bar whose id is "s" and the
 * segment's SWC id, "l" and that of the segment it leads to for a link, with the segment's value as
 * its title. STATUS_INPUT when a template is missing or does not fit. */
MUST_CHECK Status diagram_put_svg(const Diagram *diagram, const Tree *tree,
                                  const DiagramPaint *paint, const DiagramSvg *svg, Text *out,
                                  Err *err);

#endif
