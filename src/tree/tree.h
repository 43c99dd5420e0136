/* The public header of the module tree: an arterial tree as flat arrays. Readers make trees
 * [treeio/treeio.h], and so does growth [grow/grow.h]; tree_release frees a tree.
 *
 * Every node except a root is the distal end of a segment with the same index: the straight tube
 * from the position of the node's parent to the position of the node. radius_mm[i] is the radius of
 * segment i along its whole length. A root is an inlet; its radius is that of the thickest segment
 * that leaves it. A tree with several roots is a forest. Parents come before their children: a loop
 * with increasing i visits nodes from the roots to the terminals, a loop with decreasing i from the
 * terminals to the roots.
 *
 * A network with loops is a tree with links. A link states that a node without children is the same
 * point as another node. The segment of the first node then ends at the other node. The parents
 * form a spanning forest of the network, and each link closes a loop or joins two trees. */
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

enum {
    TREE_NO_PARENT = -1,    /* in Tree.parent: the node is a root */
    TREE_NO_LINK = -1,      /* in Tree.link: the node has no link */
    TREE_MAX_ID = 100000000 /* largest id, and maximum number of nodes. Reason not recorded */
};

/* The SWC type code of grown trees, and of nodes whose file states none. SWC has no code for
 * arteries; files of arterial trees use 3. */
enum { TREE_VESSEL_TYPE = 3 };

/* A named array of values of the segments, from a file or computed. */
typedef struct TreeColumn {
    char *name;    /* not empty; unique in the tree; owned */
    char *unit;    /* "" for pure numbers; owned */
    double *value; /* per node: the value of its segment; NAN: none; owned */
} TreeColumn;

/* A tree. Arrays have one entry per node, and are owned. */
struct Tree {
    size_t n;          /* number of nodes; at least 1 */
    int32_t *id;       /* SWC id, in [1, TREE_MAX_ID]; unique */
    int32_t *type;     /* SWC type code */
    int32_t *parent;   /* index of the parent, less than the node's own index; TREE_NO_PARENT at a
                        * root */
    Vec3 *position;    /* mm */
    double *radius_mm; /* >= 0 */
    /* Index (lower or higher) of the node that is the same point; TREE_NO_LINK: none. A node with a
     * link is neither a root nor a parent. The node that the link names has the same position, has
     * no link itself, and another segment begins or ends there. NULL: no node has a link. */
    int32_t *link;
    /* The flow that leaves the tree at the node, >= 0, in a unit common to all nodes; 0 at a node
     * with a link. NULL: the flow is the same at all terminals, and 0 at other nodes. */
    double *flow_share;
    TreeColumn *column; /* n_columns columns; owned */
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

/* Returns the node at which segment i ends: the node that the link of node i names, or i. */
static inline size_t tree_linked_node(const Tree *tree, size_t i)
{
    return tree_has_link(tree, i) ? (size_t)tree->link[i] : i;
}

/* Returns the number of nodes with a link. Cost: O(n). */
size_t tree_link_count(const Tree *tree);

/* Allocates tree->link, which must be NULL, and sets all entries to TREE_NO_LINK; the caller then
 * sets links. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_add_links(Tree *tree, Err *err);

/* Numbers the connected components of the network from 0, in the order of their first nodes. A link
 * connects its two nodes.
 *
 * component  receives, per node, the number of its component: a new array, which the caller frees.
 * n          receives the number of components.
 * Errors     STATUS_MEMORY.
 * Cost       O(n) without links; O(n log n) with links. */
MUST_CHECK Status tree_components(const Tree *tree, uint32_t **component, size_t *n, Err *err);

/* Sets *loops to the number of independent loops: links + components - roots. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status tree_loop_count(const Tree *tree, size_t *loops, Err *err);

/* Returns the length of segment i, mm; 0 for a root. */
static inline double tree_segment_length(const Tree *tree, size_t i)
{
    if (!tree_is_segment(tree, i))
        return 0;
    return vec3_distance(tree->position[tree->parent[i]], tree->position[i]);
}

/* Returns true if any node has a type other than TREE_VESSEL_TYPE. Cost: O(n). */
bool tree_has_types(const Tree *tree);

/* Returns the largest id. Cost: O(n). */
int32_t tree_max_id(const Tree *tree);

/* Returns the largest radius of roots and of segments that leave a root, mm. Cost: O(n). */
double tree_root_radius(const Tree *tree);

/* Counts the segments that meet at each node, except the segment of the node itself.
 *
 * count    receives a new array of n entries, which the caller frees: per node, the number of its
 *          children plus the number of links to it. The entry of a node with a link is 1, so that
 *          it does not look like a terminal. A node that is not a root is a terminal if its entry
 *          is 0. A node is a bifurcation if its entry is 2 or more.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status tree_child_counts(const Tree *tree, int32_t **count, Err *err);

/* Allocates tree->flow_share, which must be NULL, and sets all entries to 0; the caller then sets
 * shares. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_add_flow_shares(Tree *tree, Err *err);

/* Adds a column whose values are NAN. The name must be new; name and unit are copied.
 *
 * value    receives the array of values, which the caller fills; the tree owns the array.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status tree_add_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* Does the same as tree_add_column, but if the tree has a column of this name, replaces its unit
 * and sets its values to NAN. */
MUST_CHECK Status tree_set_column(Tree *tree, const char *name, const char *unit, double **value,
                                  Err *err);
/* Finds the column of this name; NULL if there is none. */
const TreeColumn *tree_column(const Tree *tree, const char *name);

/* Copies the flow shares to a new array of n entries, which the caller frees. For a tree without
 * flow shares they are 1 at terminals and 0 at other nodes. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_flow_shares(const Tree *tree, double **share, Err *err);

/* Checks the invariants of the type: parents come before children, positions and radii are finite,
 * radii and flow shares are not negative, ids are unique and in range, and links are as Tree.link
 * requires. Errors: STATUS_INPUT, naming the id of the first node that violates an invariant;
 * STATUS_MEMORY. */
MUST_CHECK Status tree_check(const Tree *tree, Err *err);

/* Checks only the invariants of links [Tree.link]. Errors: those of tree_check. */
MUST_CHECK Status tree_check_links(const Tree *tree, Err *err);

/* Makes a copy of the tree without the segments thinner than `radius_mm` and without their
 * subtrees. Roots are always kept, and so are ids, order, columns and meta. The flow shares of a
 * removed subtree are added to the node where it was attached, so that the remaining segments keep
 * their flow. A link to a removed node is removed.
 *
 * out      receives the copy; release it with tree_release.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status tree_prune_copy(const Tree *tree, double radius_mm, Tree *out, Err *err);

/* Makes a copy of the part of the tree near its roots: up to the path length `part` > 0 times the
 * longest path from a root. Segments that reach farther are shortened; their radius does not
 * change. Ids, order, columns, flow shares and links are treated as in tree_prune_copy. If `part`
 * is 1 or more, the copy is complete.
 *
 * out      receives the copy; release it with tree_release.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status tree_proximal_part(const Tree *tree, double part, Tree *out, Err *err);

/* Sets the ids to 1 to n, in the order of the arrays. */
void tree_renumber(Tree *tree);

/* Adds the content of the tree to `hash`, except the texts in its meta. */
void tree_hash(const Tree *tree, Hash *hash);

/* Returns the bounding box, mm, of all segments as tubes with hemispherical ends. */
Box tree_bounds(const Tree *tree);

#endif
