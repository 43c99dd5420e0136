/* Smooth vessels: each segment of a tree is divided into short straight pieces along a cubic curve
 * from its start to its end [docs/METHODS.md section 9]. stage_smooth divides the tree, and
 * stage_geometry [stage.h] then builds the geometry of the pieces.
 *
 *     TRY(stage_smooth(&tree, model, &smooth, err));
 *     params.smooth = &smooth;
 *     TRY(stage_geometry(&tree, &params, &geometry, NULL, err));
 *     smoothtree_release(&smooth); */
#ifndef CORCAST_STAGE_SMOOTH_H
#define CORCAST_STAGE_SMOOTH_H

#include "base/base.h"
#include "scene/scene.h"
#include "tree/tree.h"

/* Maximum number of pieces of a segment, and of a tree. A tree of more than
 * SMOOTH_TREE_PIECES segments has one piece per segment. Reason of the values not recorded. */
enum { SMOOTH_SEGMENT_PIECES = 256, SMOOTH_TREE_PIECES = 4000000 };

/* Numbers of segments and pieces, and the deviation of the pieces from the tree. */
typedef struct SmoothReport {
    size_t segments;       /* number of segments that are drawn */
    size_t pieces;         /* number of pieces that replace these segments */
    double distance_mm;    /* maximum distance between a piece and its segment; at most a quarter of
                            * the segment's length */
    double distance_radii; /* maximum of: distance between a piece and its segment / radius of the
                            * segment */
    double radius_change;  /* maximum of |radius of a piece / radius of its segment - 1| */
    double tolerance;      /* maximum distance that was allowed between a piece and its curve, in
                            * radii of the segment: 0.01, doubled until the tree has at most
                            * SMOOTH_TREE_PIECES pieces. A segment of SMOOTH_SEGMENT_PIECES pieces
                            * may exceed it */
} SmoothReport;

/* A tree whose segments are the pieces. A segment that is not drawn has one piece, equal to the
 * segment. The last piece of a segment ends at the segment's node. All arrays are owned. */
typedef struct SmoothTree {
    Tree tree;         /* the pieces, in the order of their segments. A piece has the id and the
                        * type of its segment, so ids repeat. `tree` has no extra columns of
                        * values and no metadata */
    uint32_t *segment; /* per node of `tree`: the node of the original tree at which the segment of
                        * the piece ends, which is the index of this segment; at a root, the
                        * original root */
    int32_t *twin;     /* per node of `tree`: the coincident piece that is drawn in place of the
                        * piece, as Coincidence.twin [coincidence.h] */
    int32_t *junction; /* per node of `tree`: the node that represents all connected nodes at this
                        * position, as Coincidence.junction */
    SmoothReport report;
} SmoothTree;

/* Divides the segments of a tree into pieces along smooth curves.
 *
 * The curves pass through all nodes. Of the segments that leave a node, the thickest continues the
 * direction of the segment that enters. The other leaving segments start in a direction that is
 * two thirds their own and one third that of the entering segment. Radii change linearly from node
 * to node.
 *
 * tree    may have coincident nodes, loops and several roots.
 * model   the model that will be drawn. The models that blend segments or put joints between them
 *         get longer pieces where three or more segments meet, so that the joints have space.
 *         Meshes get longer pieces at free ends, which are cut off flat.
 * out     borrows nothing; release it with smoothtree_release.
 * Errors  STATUS_MEMORY.
 * Cost    O(number of pieces); the result does not depend on threads. */
MUST_CHECK Status stage_smooth(const Tree *tree, SceneModel model, SmoothTree *out, Err *err);
/* Makes the smooth tree of a part of a tree. `whole` is the smooth tree of the whole tree.
 * tree_proximal_part cuts its pieces at the path length `part` > 0 times the longest path from a
 * root. The curves of the part are therefore equal to those of the whole. Release *out with
 * smoothtree_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status smoothtree_part(const SmoothTree *whole, double part, SmoothTree *out, Err *err);
/* Frees the arrays and zeroes *smooth. */
void smoothtree_release(SmoothTree *smooth);

#endif
