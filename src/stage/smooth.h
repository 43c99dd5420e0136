/* Smooth vessels: each segment of a tree is divided into short straight pieces along a cubic curve
 * from its start to its end [docs/METHODS.md section 9].
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

/* Maximum number of pieces of a segment, and of a tree whose segments have more than one piece. */
enum { SMOOTH_SEGMENT_PIECES = 256, SMOOTH_TREE_PIECES = 4000000 };

/* How far the pieces are from the tree. */
typedef struct SmoothReport {
    size_t segments;       /* segments that are drawn */
    size_t pieces;         /* pieces that replace these segments */
    double distance_mm;    /* maximum distance of a point of a piece from the piece's segment; it is
                            * at most a quarter of the segment's length */
    double distance_radii; /* maximum of the same distance / the segment's radius */
    double radius_change;  /* maximum of |radius of a piece / radius of its segment - 1| */
    double tolerance;      /* maximum distance of a piece from its curve / the segment's radius, if
                            * the number of pieces allows it */
} SmoothReport;

/* A tree of pieces. A segment that is not drawn has one piece, which is the segment itself. The
 * last piece of a segment ends at the segment's node. All arrays are owned. */
typedef struct SmoothTree {
    Tree tree;         /* the pieces, in the order of their segments, without columns and meta. A
                        * piece has the id and the type of its segment, so ids repeat */
    uint32_t *segment; /* per node of `tree`: the index of the segment or the root */
    int32_t *twin;     /* per node of `tree`: as in Coincidence */
    int32_t *junction; /* per node of `tree`: as in Coincidence */
    SmoothReport report;
} SmoothTree;

/* Divides the segments of a tree into pieces along smooth curves. The curves pass through all
 * nodes. The direction is continuous from a segment to the thickest segment that it leads to.
 * Other segments leave a third towards the direction of the segment that leads to them. Radii
 * change evenly from node to node.
 *
 * tree    may have coincident nodes, loops and several roots.
 * model   models with joints get longer pieces where three or more segments meet, so that the
 *         joints have space. Meshes get longer pieces at free ends, which are cut off flat.
 * out     borrows nothing; release it with smoothtree_release.
 * Errors  STATUS_MEMORY.
 * Cost    O(number of pieces); the result does not depend on threads. */
MUST_CHECK Status stage_smooth(const Tree *tree, SceneModel model, SmoothTree *out, Err *err);
/* Makes the smooth tree of a part of a tree, cut from the smooth tree `whole` of the whole tree as
 * by tree_proximal_part, so that the curves of the part are those of the whole. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status smoothtree_part(const SmoothTree *whole, double part, SmoothTree *out, Err *err);
/* Frees the arrays and zeroes *smooth. */
void smoothtree_release(SmoothTree *smooth);
/* Returns true if the piece that ends at `node` is drawn. stage_vessels lists these pieces in the
 * order of their nodes. */
bool smoothtree_draws(const SmoothTree *smooth, size_t node);

#endif
