/* The public header of the module diagram: draws a tree unrolled into the plane, with true lengths
 * and diameters.
 *
 * Each branch is a horizontal row of bars. A bar is a segment, as long and as wide as the segment.
 * The horizontal position of a bar is the path length from the root. Thin links lead from a branch
 * to the branches that leave it. No bars or links cross: daughter branches are above and below
 * their parent. If a branch would overlap another that leaves the parent farther along, the first
 * one is placed farther out. A network with loops is unrolled along its parents. Where a branch
 * closes a loop, it ends at a cross bar: its end is the same point as a node elsewhere. In such
 * diagrams people find low wall shear stress far more often than in 3D pictures [Borkin et al.,
 * IEEE Trans. Vis. Comput. Graph. 17 (2011) 2479-2488].
 *
 *     TRY(diagram_lay_out(&tree, 0, &diagram, err));
 *     const FigureBars bars = diagram_bars(&style);
 *     TRY(diagram_draw(&style, &bars, (int[]){width, height}, (int[]){0, 0}, &color, err));
 *     diagram_release(&diagram); */
#ifndef CORCAST_DIAGRAM_DIAGRAM_H
#define CORCAST_DIAGRAM_DIAGRAM_H

#include "base/base.h"
#include "figure/figure.h"
#include "image/image.h"
#include "tree/tree.h"
#include <stddef.h>

/* The layout of a tree, in mm: x to the right from the roots, y down from the top. A bar is the
 * segment that ends at node FigureBar.index, the link to that segment, or the cross bar at its end.
 */
typedef struct Diagram {
    /* Owned: links first, then cross bars, then segments in the order of the tree. */
    FigureBar *bar;
    size_t n, n_links, n_crosses;
    double width_mm, height_mm; /* of all bars */
} Diagram;

/* Minimum height of a diagram as a fraction of its width, if the default space between rows is
 * used. Reason of the value not recorded. */
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

/* The colors of a diagram, and the values in its labels. All pointers are borrowed. */
typedef struct DiagramStyle {
    const Diagram *diagram;
    const Tree *tree;
    const float (*color)[3]; /* per node: linear RGB of its segment */
    float background[3];     /* linear RGB */
    double margin;           /* free space on each side, as a fraction of the page, in [0, 0.45] */
    const char *name, *unit; /* name and unit of `values`; name NULL: there are no values */
    const double *values;    /* per node: value of its segment; NAN where there is none */
} DiagramStyle;

/* Returns the bars of a diagram. Their ids are "s" and the SWC id of the segment, "l" and the SWC
 * id of the segment that a link leads to, or "c" and the SWC id of a segment that ends at a cross
 * bar. Borrows `style`. */
FigureBars diagram_bars(const DiagramStyle *style);

/* Makes a page of the bars and margins, true to size. Release *page with figure_release. The page
 * borrows `bars`. If memory runs out, figure_check reports it. */
void diagram_make_page(const DiagramStyle *style, const FigureBars *bars, FigurePage *page);

/* Draws the bars as large as the margins allow, centred, into a new plane of linear RGB, size[0] x
 * size[1] pixels. Leaves room[0] columns at the right and room[1] rows at the bottom empty.
 * Release *color with plane_release. Errors: STATUS_MEMORY; STATUS_INPUT for sides that plane_init
 * refuses. */
MUST_CHECK Status diagram_draw(const DiagramStyle *style, const FigureBars *bars, const int size[2],
                               const int room[2], Plane *color, Err *err);

#endif
