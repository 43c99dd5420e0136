/* The public header of the module tree: an arterial tree as flat arrays.
 *
 * Node i, unless it is a root, is the distal end of segment i: the straight tube from its parent's
 * position to its own position, with the radius radius_mm[i] along its whole length. A root is an
 * inlet; its radius is that of the thickest segment that leaves it. A tree with several roots is a
 * forest. Parents come before their children: a loop with increasing i visits nodes from the roots
 * to the terminals, a loop with decreasing i from the terminals to the roots.
 *
 * A network with loops is a tree with links. A link states that a node without children is the same
 * point as another node, so that the segment of the first node ends there. Parents then give a
 * spanning forest of the network, and each link closes a loop or joins two trees. The `place` of a
 * node is the node that its link names, or else the node itself: segments meet at places. */
#ifndef CORCAST_TREE_TREE_H
#define CORCAST_TREE_TREE_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/branches.h"   // IWYU pragma: export
#include "tree/builder.h"    // IWYU pragma: export
#include "tree/centreline.h" // IWYU pragma: export
#include "tree/graph.h"      // IWYU pragma: export
#include "tree/idindex.h"    // IWYU pragma: export
#include "tree/meta.h"       // IWYU pragma: export
#include "tree/outlets.h"    // IWYU pragma: export
#include "tree/pairs.h"      // IWYU pragma: export
#include "tree/reading.h"    // IWYU pragma: export
#include "tree/series.h"     // IWYU pragma: export
#include "tree/viscosity.h"  // IWYU pragma: export
#include <stdbool.h>
#include <stdint.h>

enum { TREE_NO_PARENT = -1, TREE_NO_LINK = -1, TREE_MAX_ID = 100000000 };

/* The SWC type code of grown trees, and of nodes whose file states none. SWC has no code for
 * arteries; files of arterial trees use 3. */
enum { TREE_VESSEL_TYPE = 3 };

/* A named array of values of the segments, from a file or computed. */
typedef struct TreeColumn {
    char *name;    /* not empty; unique in the tree; owned */
    char *unit;    /* "" for pure numbers; owned */
    double *value; /* per node: the value of its segment; NAN: none; owned */
} TreeColumn;

struct Tree {
    size_t n;          /* number of nodes; at least 1 */
    int32_t *id;       /* SWC id, in [1, TREE_MAX_ID] */
    int32_t *type;     /* SWC type code */
    int32_t *parent;   /* index of the parent, below the own index; TREE_NO_PARENT at a root */
    Vec3 *position;    /* mm */
    double *radius_mm; /* >= 0 */
    /* Per node: index of the node that is the same point, before or after it; TREE_NO_LINK: none.
     * A node with a link is neither a root nor a parent, and its position equals that of the node
     * that the link names. That node has no link, and another segment begins or ends there. NULL:
     * no node has a link. */
    int32_t *link;
    /* Per node: the flow that leaves the tree there, >= 0, in a unit common to all nodes. NULL: the
     * flow is the same at all terminals, and 0 at other nodes. A node with a link has 0. */
    double *flow_share;
    TreeColumn *column; /* owned */
    size_t n_columns;
    TreeMeta meta;
};

/* Makes a tree of n >= 1 zeroed nodes without parents; release it with tree_release. Errors:
 * STATUS_INFEASIBLE if n exceeds TREE_MAX_ID; STATUS_MEMORY. */
MUST_CHECK Status tree_init(Tree *tree, size_t n, Err *err);
/* Frees the arrays, columns and meta, and zeroes *tree. A zeroed tree is allowed. */
void tree_release(Tree *tree);

/* Returns true if node i is not a root. */
static inline bool tree_is_segment(const Tree *tree, size_t i)
{
    return tree->parent[i] != TREE_NO_PARENT;
}

/* Returns true if node i has a link. */
static inline bool tree_has_link(const Tree *tree, size_t i)
{
    return tree->link && tree->link[i] != TREE_NO_LINK;
}

/* Returns the place of node i: the node that its link names, or i. */
static inline size_t tree_linked_node(const Tree *tree, size_t i)
{
    return tree_has_link(tree, i) ? (size_t)tree->link[i] : i;
}

/* Returns the number of nodes with a link. Cost: O(n). */
size_t tree_link_count(const Tree *tree);

/* Adds links to a tree without them; all are TREE_NO_LINK, and the caller sets them. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status tree_add_links(Tree *tree, Err *err);

/* Numbers the connected components of the network from 0, in the order of their first nodes. A link
 * connects its two nodes.
 *
 * component  receives, per node, the number of its component: a new array, which the caller frees.
 * n          receives the number of components. The number of independent loops is the number of
 *            links + *n - the number of roots.
 * Errors     STATUS_MEMORY.
 * Cost       O(n) without links. */
MUST_CHECK Status tree_components(const Tree *tree, uint32_t **component, size_t *n, Err *err);

/* Finds the number of independent loops: segments - places + components. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_loop_count(const Tree *tree, size_t *loops, Err *err);

/* Returns the length of segment i, mm; 0 for a root. */
static inline double tree_segment_length(const Tree *tree, size_t i)
{
    if (!tree_is_segment(tree, i))
        return 0;
    return vec3_distance(tree->position[tree->parent[i]], tree->position[i]);
}

/* Returns true if a node has another type than TREE_VESSEL_TYPE. Cost: O(n). */
bool tree_has_types(const Tree *tree);

/* Returns the largest id. Cost: O(n). */
int32_t tree_max_id(const Tree *tree);

/* Returns the largest radius of roots and of segments that leave a root, mm. Cost: O(n). */
double tree_root_radius(const Tree *tree);

/* Counts the segments that meet at each node in a new array of n entries, which the caller frees.
 * The node's own segment is not counted: the entry is the number of children and of links to the
 * node. A node with a link counts 1. A node that is not a root is a terminal if the entry is 0; a
 * node is a bifurcation if the entry is 2 or more. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_child_counts(const Tree *tree, int32_t **count, Err *err);

/* Adds flow shares to a tree without them; all are 0, and the caller sets them. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status tree_add_flow_shares(Tree *tree, Err *err);

/* Adds a column of NAN, which the caller fills through *value; the tree owns the array. Name and
 * unit are copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_add_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* Does the same as tree_add_column, but replaces the values and the unit if the tree has a column
 * of this name. */
MUST_CHECK Status tree_set_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* Finds the column of this name; NULL if there is none. */
const TreeColumn *tree_column(const Tree *tree, const char *name);

/* Copies the flow shares to a new array of n entries, which the caller frees. For a tree without
 * flow shares they are 1 at terminals and 0 at other nodes. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_flow_shares(const Tree *tree, double **share, Err *err);

/* Checks the invariants of the type: parents come before children, positions and radii are finite,
 * radii and flow shares are not negative, ids are unique and in range, links are as Tree.link
 * states. Errors: STATUS_INPUT, naming the id of the first node that violates them; STATUS_MEMORY.
 */
MUST_CHECK Status tree_check(const Tree *tree, Err *err);

/* Checks the invariants of links alone [Tree.link]. Errors: as tree_check. */
MUST_CHECK Status tree_check_links(const Tree *tree, Err *err);

/* Makes a copy of the tree without the segments thinner than `radius_mm` and without their
 * subtrees; release *out with tree_release. Roots always stay. Ids, order, columns and meta are
 * kept. The flow shares of a removed subtree go to the node that it was attached to, so that the
 * remaining segments keep their flow. A link to a removed node is removed. Errors: STATUS_MEMORY.
 */
MUST_CHECK Status tree_prune_copy(const Tree *tree, double radius_mm, Tree *out, Err *err);

/* Makes a copy of the part of the tree near its roots; release *out with tree_release. The path
 * length from the root is at most `part` > 0 times the longest path in the tree; segments that
 * reach farther are shortened, with their radius unchanged. Ids, order, columns and flow shares are
 * treated as in tree_prune_copy. If `part` is 1 or more, the copy is complete. Errors:
 * STATUS_MEMORY.
 */
MUST_CHECK Status tree_proximal_part(const Tree *tree, double part, Tree *out, Err *err);

/* Sets the ids to 1 to n, in the order of the arrays. */
void tree_renumber(Tree *tree);

/* Adds the content of the tree, except the texts in its meta, to `hash`. */
void tree_hash(const Tree *tree, Hash *hash);

/* Returns the bounding box of all segments, drawn as tubes with hemispherical ends. */
Box tree_bounds(const Tree *tree);

#endif
