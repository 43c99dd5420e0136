/* Makes a tree of nodes that a file names in any order.
 *
 * A reader hands over what the file says, record by record, and need not resolve anything: ids are
 * found, parents put before their children, and all that no tree can be is refused with a sentence
 * that names the record. A graph without directions has to be directed first. */
#ifndef CORCAST_TREE_BUILDER_H
#define CORCAST_TREE_BUILDER_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/meta.h"
#include <stddef.h>
#include <stdint.h>

typedef struct Tree Tree;
typedef struct ReadOptions ReadOptions;
typedef struct TreeReading TreeReading;

enum { BUILDER_MAX_COLUMNS = 10000 };

/* A node as a file has it. */
typedef struct BuilderNode {
    int64_t id;     /* different in every node */
    int64_t parent; /* the id of a node given before or after it; TREE_NO_PARENT: a root */
    int32_t type;
    Vec3 position;    /* mm */
    double radius_mm; /* of the segment that ends here */
    size_t record;    /* where in the file, for sentences */
} BuilderNode;

/* Begin with {.name = ..., .record = ..., .reading = ...}; release with builder_release. */
typedef struct TreeBuilder {
    const char *name;   /* of the file (borrowed) */
    const char *record; /* what its records are called, "point" (borrowed); NULL: they are lines */
    const ReadOptions *options;  /* how radii are checked (borrowed); may be NULL */
    TreeReading *reading;        /* where the reader says what it assumes (borrowed); may be NULL */
    TreeMeta meta;               /* of the tree, for the reader to fill */
    int32_t *id, *type, *parent; /* of each row; a parent by its id */
    Vec3 *position;
    double *radius_mm;
    size_t *row_record;
    size_t n, capacity; /* rows */
    struct BuilderColumn *column;
    size_t n_columns, columns_capacity;
    struct BuilderShare *share;
    size_t n_shares, shares_capacity;
    struct BuilderPair *pair;
    size_t n_pairs, pairs_capacity;
} TreeBuilder;

void builder_release(TreeBuilder *builder);

/* Puts "FILE:RECORD: " in front of the sentence of a STATUS_INPUT, and returns `status`: for what
 * is wrong with a record, whether the reader finds it or one of the functions below but
 * builder_build, which names the record itself. */
Status builder_blame(const TreeBuilder *builder, size_t record, Status status, Err *err);

/* Adds a node, in O(1) amortised. STATUS_INPUT for an id or a parent beyond 1 .. TREE_MAX_ID, a
 * position that is not finite, and a radius that reading_radius refuses. */
MUST_CHECK Status builder_node(TreeBuilder *builder, const BuilderNode *node, Err *err);

/* Adds a column of values of nodes (name and unit copied), numbered in *column from 0 on.
 * STATUS_INPUT when the name is empty or that of another, or there are too many: each name is held
 * against all others. */
MUST_CHECK Status builder_column(TreeBuilder *builder, const char *name, const char *unit,
                                 size_t *column, Err *err);
/* Sets the column's value of the node added last. What is not set, or not finite, is NAN. */
MUST_CHECK Status builder_value(TreeBuilder *builder, size_t column, double value, Err *err);

/* Says the flow share, above 0, of a node given before or after. */
MUST_CHECK Status builder_share(TreeBuilder *builder, int64_t id, double share, size_t record,
                                Err *err);

/* Says a pair of nodes [pairs.h] given before or after; pairs are numbered as they are said. */
MUST_CHECK Status builder_pair(TreeBuilder *builder, int64_t id, int64_t other, size_t record,
                               Err *err);

/* Makes the tree in *tree (owned; tree_release), which tree_check accepts: parents first and
 * otherwise in the order given, an ancestor that is given later just before its first descendant.
 * The meta moves to it. O(nodes log nodes). STATUS_INPUT when there is no node, an id is given
 * twice, a parent is no node's id, nodes are their own ancestors, a share or a pair is
 * said of what is no node, or twice, or a share against the key terminal_flow. */
MUST_CHECK Status builder_build(TreeBuilder *builder, Tree *tree, Err *err);

#endif
