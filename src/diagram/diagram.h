/* The public header of the module diagram: a tree unrolled flat, with true lengths and diameters.
 *
 * Every main branch is a horizontal row of bars, one for each segment, as long and as wide as the
 * segment. The horizontal position is the length of the path from the root. Thin links lead from a
 * branch to the branches that leave it. Nothing crosses: daughter branches are above and below
 * their parent, and a branch that would overlap one that leaves farther along the parent is placed
 * farther out. In such diagrams people find low wall shear stress far more often than in pictures
 * of three dimensions [Borkin et al., IEEE Trans. Vis. Comput. Graph. 17 (2011) 2479-2488]. */
#ifndef CORCAST_DIAGRAM_DIAGRAM_H
#define CORCAST_DIAGRAM_DIAGRAM_H

#include "base/base.h"
#include "figure/figure.h"
#include "image/image.h"
#include "tree/tree.h"
#include <stddef.h>

/* The layout of a tree: mm, x to the right from the roots, y down from the top. A bar stands for
 * the segment that ends at node FigureBar.index, or for the link to that segment. */
typedef struct Diagram {
    FigureBar *bar; /* owned; links first, then segments in the order of the tree */
    size_t n, n_links;
    double width_mm, height_mm; /* of all bars */
} Diagram;

/* Height over width that the default space between rows aims at. */
#define DIAGRAM_ASPECT 0.75

/* Lays out a tree or forest, roots on the left. Segments without length have no bar.
 *
 * gap_mm   space between rows. 0: the median diameter of the terminals, or more if the diagram
 *          would else be lower than DIAGRAM_ASPECT times its width
 * diagram  is owned; release it with diagram_release.
 * Errors   STATUS_INPUT if no segment has a length, STATUS_MEMORY.
 * Cost     O(n log n). */
MUST_CHECK Status diagram_lay_out(const Tree *tree, double gap_mm, Diagram *diagram, Err *err);
void diagram_release(Diagram *diagram);

/* What a diagram looks like, and the values in its labels. All pointers are borrowed. */
typedef struct DiagramStyle {
    const Diagram *diagram;
    const Tree *tree;
    const float (*color)[3]; /* per node: linear RGB of its segment */
    float background[3];     /* linear RGB */
    double margin;           /* free part on each side, in [0, 0.45] */
    const char *name, *unit; /* of the values; name NULL: there are none */
    const double *values;    /* per node: value of its segment; NAN where there is none */
} DiagramStyle;

/* Returns the bars of a diagram. Their ids are "s" and the SWC id of the segment, or "l" and the
 * SWC id of the segment that a link leads to. Borrows `style`. */
FigureBars diagram_bars(const DiagramStyle *style);

/* Makes *page of the bars with their margins, true to size. Release it with figure_release. The
 * page borrows `bars`. Memory that runs out shows in figure_check. */
void diagram_make_page(const DiagramStyle *style, const FigureBars *bars, FigurePage *page);

/* Draws the bars as large as they fit, centred, into *color (owned): linear RGB of `width` x
 * `height` pixels. Errors: STATUS_MEMORY. */
MUST_CHECK Status diagram_draw(const DiagramStyle *style, const FigureBars *bars, int width,
                               int height, Plane *color, Err *err);

#endif
