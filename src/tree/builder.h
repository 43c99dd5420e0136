/* Builds a tree from nodes that a file lists in any order.
 *
 * A reader calls builder_node and the other functions for the records of its file, then
 * builder_build. builder_build resolves the ids and puts each parent before its children. If the
 * records do not form a tree, the error names the record. For files of lines without a direction
 * use graph.h. */
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

/* Maximum number of columns of a file. Without it, a small file could name so many columns that
 * their values fill the memory. Reason for 10000 not recorded. */
enum { BUILDER_MAX_COLUMNS = 10000 };

/* A node as the file states it, before ids are resolved. */
typedef struct BuilderNode {
    int64_t id;     /* unique */
    int64_t parent; /* the id of another node, which may come later in the file; TREE_NO_PARENT: a
                     * root */
    int32_t type;
    Vec3 position;    /* mm */
    double radius_mm; /* of the segment that ends here */
    size_t record;    /* line or number of the record in the file, for errors */
} BuilderNode;

/* A tree while it is read. Begin with {.name = ..., .record = ..., .reading = ...}; release with
 * builder_release. */
typedef struct TreeBuilder {
    const char *name;   /* name of the file, for errors; borrowed */
    const char *record; /* the word for a record in errors: "point"; NULL: a line; borrowed */
    const ReadOptions *options; /* rules for radii [reading_radius]; borrowed; may be NULL */
    TreeReading *reading;       /* receives the assumptions of the reader; borrowed; may be NULL */
    TreeMeta meta;              /* metadata of the tree, which the reader sets */
    /* Per node, in the order of the file. All arrays are owned. */
    int32_t *id, *type, *parent; /* `parent` is an id */
    Vec3 *position;
    double *radius_mm;
    size_t *row_record; /* the node's record */
    size_t n, capacity; /* number of nodes */
    /* What builder_column, builder_share, builder_pair and builder_link added: */
    struct BuilderColumn *column;
    size_t n_columns, columns_capacity;
    ARRAY(struct BuilderShare) shares;
    ARRAY(struct BuilderPair) pairs, links;
} TreeBuilder;

void builder_release(TreeBuilder *builder);

/* Puts "FILE:RECORD: " in front of the error if `status` is STATUS_INPUT. Returns `status`. Call it
 * for errors of the reader and of the functions below, except for errors of builder_build, which
 * state file and record already. */
Status builder_blame(const TreeBuilder *builder, size_t record, Status status, Err *err);

/* Adds a node. O(1) on average.
 *
 * Errors   STATUS_INPUT if the id, or a parent other than TREE_NO_PARENT, is not in [1,
 *          TREE_MAX_ID], the position is not finite, or reading_radius refuses the radius.
 *          STATUS_MEMORY. */
MUST_CHECK Status builder_node(TreeBuilder *builder, const BuilderNode *node, Err *err);

/* Adds a column with one value for each node. Copies the name and the unit.
 *
 * column   receives the index of the column.
 * Errors   STATUS_INPUT if the name is empty or already in use, or there are BUILDER_MAX_COLUMNS
 *          columns. STATUS_MEMORY.
 * Cost     O(columns), because the name is compared with all others. */
MUST_CHECK Status builder_column(TreeBuilder *builder, const char *name, const char *unit,
                                 size_t *column, Err *err);
/* Sets the value of a column for the node that was added last. Requires a node, and an index that
 * builder_column has set. A value that is not set, or is not finite, is stored as NAN. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status builder_value(TreeBuilder *builder, size_t column, double value, Err *err);

/* Sets the flow share of a node. The node may be added later.
 *
 * record   record of the file that states the share, for errors of builder_build.
 * Errors   STATUS_INPUT if the share is not a finite number above 0, or the id is not in [1,
 *          TREE_MAX_ID]. STATUS_MEMORY. */
MUST_CHECK Status builder_share(TreeBuilder *builder, int64_t id, double share, size_t record,
                                Err *err);

/* Adds a pair of nodes [pairs.h]. The nodes may be added later. Pairs are numbered in the order of
 * the calls.
 *
 * record   record of the file that states the pair, for errors of builder_build.
 * Errors   STATUS_INPUT if an id is not in [1, TREE_MAX_ID]. STATUS_MEMORY. */
MUST_CHECK Status builder_pair(TreeBuilder *builder, int64_t id, int64_t other, size_t record,
                               Err *err);

/* States that the node `id` is the same point as the node `other` [Tree.link]. builder_build gives
 * it the position of `other`. The nodes may be added later.
 *
 * record   record of the file that states the link, for errors of builder_build.
 * Errors   STATUS_INPUT if an id is not in [1, TREE_MAX_ID]. STATUS_MEMORY. */
MUST_CHECK Status builder_link(TreeBuilder *builder, int64_t id, int64_t other, size_t record,
                               Err *err);

/* Builds the tree, and moves the metadata to it. Nodes keep the order of the file, except that an
 * ancestor that comes later in the file moves to just before its first descendant.
 *
 * tree     receives the tree, which tree_check accepts; release it with tree_release.
 * Errors   STATUS_INPUT in these cases:
 *           - the file has no node, an id occurs twice, a parent does not exist, or nodes form a
 *             cycle;
 *           - a share, a pair or a link refers to a node that does not exist, or occurs twice;
 *           - tree_check_links refuses a link;
 * - the metadata key terminal_flow [meta.h] requires shares and there are none, or it forbids
 *   shares and there are some. STATUS_MEMORY.
 * Cost     O(n log n) for n nodes. */
MUST_CHECK Status builder_build(TreeBuilder *builder, Tree *tree, Err *err);

#endif
