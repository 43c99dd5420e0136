/* The door of the room tree: an arterial tree as flat arrays.
 *
 * Node i other than a root is the distal end of segment i, the straight tube from its parent's
 * position to its own, of radius radius_mm[i] throughout. A root is an inlet point, and its radius
 * that of the thickest segment that leaves it. Several roots make a forest. Parents come before
 * children, so a forward loop is a sweep from the roots and a backward loop one from the
 * terminals. */
#ifndef CORCAST_TREE_TREE_H
#define CORCAST_TREE_TREE_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/builder.h"   // IWYU pragma: export
#include "tree/graph.h"     // IWYU pragma: export
#include "tree/idindex.h"   // IWYU pragma: export
#include "tree/meta.h"      // IWYU pragma: export
#include "tree/outlets.h"   // IWYU pragma: export
#include "tree/pairs.h"     // IWYU pragma: export
#include "tree/reading.h"   // IWYU pragma: export
#include "tree/series.h"    // IWYU pragma: export
#include "tree/viscosity.h" // IWYU pragma: export
#include <stdbool.h>
#include <stdint.h>

enum { TREE_NO_PARENT = -1, TREE_MAX_ID = 100000000 };

/* The SWC type code of nodes whose file has none, and of grown trees: SWC has no code for arteries,
 * and 3 is what files of arterial trees use. */
enum { TREE_VESSEL_TYPE = 3 };

/* Values of all segments under a name, as a file brought them. */
typedef struct TreeColumn {
    char *name;    /* owned; not empty, different from the others' */
    char *unit;    /* owned; "" for pure numbers */
    double *value; /* owned; one a node, that of its segment; NAN where there is none */
} TreeColumn;

struct Tree {
    size_t n;          /* nodes; at least 1 */
    int32_t *id;       /* SWC id, in [1, TREE_MAX_ID] */
    int32_t *type;     /* SWC type code */
    int32_t *parent;   /* index of the parent, below the own index; TREE_NO_PARENT at a root */
    Vec3 *position;    /* mm */
    double *radius_mm; /* >= 0 */
    /* The part of the flow that leaves the tree at each node, >= 0, relative to the others; NULL:
     * the same at every terminal and none elsewhere. */
    double *flow_share;
    TreeColumn *column; /* owned */
    size_t n_columns;
    TreeMeta meta;
};

/* Room for n >= 1 zeroed nodes, parents TREE_NO_PARENT, in *tree (owned; tree_release).
 * STATUS_INFEASIBLE when there are more nodes than ids. */
MUST_CHECK Status tree_init(Tree *tree, size_t n, Err *err);
/* Frees the arrays, columns and meta, and zeroes *tree; a zeroed tree may be released. */
void tree_release(Tree *tree);

static inline bool tree_is_segment(const Tree *tree, size_t i)
{
    return tree->parent[i] != TREE_NO_PARENT;
}

/* Length of segment i, mm; 0 at a root. */
static inline double tree_segment_length(const Tree *tree, size_t i)
{
    if (!tree_is_segment(tree, i))
        return 0;
    return vec3_distance(tree->position[tree->parent[i]], tree->position[i]);
}

/* The largest id. O(n). */
int32_t tree_last_id(const Tree *tree);

/* The largest radius of the roots and of the segments that leave them, mm. O(n). */
double tree_root_radius(const Tree *tree);

/* The number of children of every node, in *count (owned, n entries). A leaf that is not a root is
 * a terminal; a node with two children or more is a bifurcation. */
MUST_CHECK Status tree_child_counts(const Tree *tree, int32_t **count, Err *err);

/* Gives the tree, which has none, flow shares of 0 for the caller to fill. */
MUST_CHECK Status tree_add_flow_shares(Tree *tree, Err *err);

/* Adds a column (name and unit copied) of NAN, for the caller to fill; *value is borrowed. */
MUST_CHECK Status tree_add_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* The column of this name, for the caller to fill: the one there is, its unit now this one and its
 * values NAN, or else a new one. */
MUST_CHECK Status tree_set_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* NULL when there is none of this name. */
const TreeColumn *tree_column(const Tree *tree, const char *name);

/* The flow share of every node in *share (owned, n entries): tree->flow_share, or without it 1 at
 * terminals and 0 elsewhere. */
MUST_CHECK Status tree_flow_shares(const Tree *tree, double **share, Err *err);

/* Checks what the type promises: parents before children, finite positions and radii, radii and
 * flow shares not negative, ids in range and different. STATUS_INPUT naming the id of the node at
 * fault. */
MUST_CHECK Status tree_check(const Tree *tree, Err *err);

/* A new tree in *out (owned) without the segments thinner than `radius_mm` and without what hangs
 * on them; ids, order, columns and what is known are kept. A root always stays. What is left
 * carries the flow that it carried before: the flow shares of what is cut off go to the node it
 * hung on. */
MUST_CHECK Status tree_pruned(const Tree *tree, double radius_mm, Tree *out, Err *err);

/* A new tree in *out (owned): what of the tree lies within `part`, above 0, of the longest way
 * along the vessels from a root; segments that reach farther end there, with the radius they have.
 * Ids, order, columns and flow as tree_pruned has them; from 1 on, the tree itself. */
MUST_CHECK Status tree_grown(const Tree *tree, double part, Tree *out, Err *err);

/* Gives the nodes the ids 1 to n in array order. */
void tree_renumber(Tree *tree);

/* Adds all of the tree, but the texts that are known of it, to what `hash` stands for. */
void tree_hash(const Tree *tree, Hash *hash);

/* The box of all nodes and of all segments with their radii, a segment rounded at its ends. */
Box tree_bounds(const Tree *tree);

#endif
