/* The public header of the module diagram: draws a tree unrolled into the plane, with true lengths
 * and diameters.
 *
 * Each branch is a horizontal row of bars. A bar is a rectangle for one segment, with the segment's
 * length and diameter. The horizontal position of a bar is the path length from the root. Thin
 * links connect a branch to its daughter branches, which are above and below it. No bars or links
 * cross: if a branch would overlap a sister that leaves the parent nearer to the parent's end, the
 * branch is placed farther from the parent's row than the sister.
 *
 * A network with loops is unrolled along the parents of its nodes. A branch that closes a loop ends
 * at a cross bar, which marks that its end is also a node elsewhere in the diagram. In diagrams of
 * this kind people find low wall shear stress far more often than in 3D pictures [Borkin et al.,
 * IEEE Trans. Vis. Comput. Graph. 17 (2011) 2479-2488].
 *     TRY(diagram_lay_out(&tree, 0, &diagram, err)); // then set style.diagram and the others
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

/* The layout of a tree, in mm: x to the right from the roots, y down from the top. FigureBar.index
 * is a segment, as the index of the node at which the segment ends: the segment of a bar, the
 * segment to which a link leads, the segment that ends at a cross bar. */
typedef struct Diagram {
    /* Links first, then cross bars, then segments in the order of the tree. Owned. */
    FigureBar *bar;
    size_t n, n_links, n_crosses;
    double width_mm, height_mm; /* size of the diagram */
} Diagram;

/* Minimum height of a diagram as a fraction of its width, if the default space between rows is
 * used. Reason of the value not recorded. */
#define DIAGRAM_ASPECT 0.75

/* Lays out a tree or forest, with its roots on the left. Segments without length have no bar.
 *
 * gap_mm   vertical space between rows. 0: the median diameter of the terminals, or more if the
 *          height of the diagram would otherwise be less than DIAGRAM_ASPECT times its width.
 * diagram  receives the layout; release it with diagram_release.
 * Errors   STATUS_INPUT if no segment has a length, STATUS_MEMORY.
 * Cost     O(n log n). */
MUST_CHECK Status diagram_lay_out(const Tree *tree, double gap_mm, Diagram *diagram, Err *err);
/* Frees the bars and zeroes *diagram. */
void diagram_release(Diagram *diagram);

/* The colors of a diagram, and the values in its labels. All pointers are borrowed. */
typedef struct DiagramStyle {
    const Diagram *diagram;
    const Tree *tree;
    const float (*color)[3]; /* per node: linear RGB of its segment */
    float background[3];     /* linear RGB */
    double margin;           /* free space on each side, as a fraction of the page, in [0, 0.45] */
    const char *name, *unit; /* name and unit of `values`; name is NULL if there are no values */
    const double *values;    /* per node: value of its segment; NAN where there is none */
} DiagramStyle;

/* Returns the bars of a diagram for figure_add_bars. Their ids in an SVG are a letter and an SWC
 * id: "s" and the id of the segment; "l" and the id of the segment to which the link leads; "c" and
 * the id of the segment that ends at the cross bar. Borrows `style`. */
FigureBars diagram_bars(const DiagramStyle *style);

/* Makes a page with the bars at true size, and margins around them. Release *page with
 * figure_release. The page borrows `bars`. If memory runs out, figure_check reports it. */
void diagram_make_page(const DiagramStyle *style, const FigureBars *bars, FigurePage *page);

/* Draws the bars, as large as the margins allow and centred, into a new plane of linear RGB.
 *
 * size      width and height of the plane in pixels.
 * reserved  number of columns at the right and of rows at the bottom that stay free.
 * color     receives the plane; release it with plane_release.
 * Errors    STATUS_MEMORY; STATUS_INPUT for a width or height that plane_init refuses. */
MUST_CHECK Status diagram_draw(const DiagramStyle *style, const FigureBars *bars, const int size[2],
                               const int reserved[2], Plane *color, Err *err);

#endif
