/* Builds a tree from a network: points, and lines that connect them, in any order.
 *
 * Readers of network formats (VTK, GraphML, Amira, tables, ...) use this module. A reader adds the
 * points, lines and values of its file, in the file's own unit. graph_build then makes a tree:
 *
 *  1. It scales all lengths to mm, and merges points that are joined [graph_join], have the same
 *     position, or are closer than ReadOptions.merge_tolerance_mm.
 *  2. It removes points without a line, lines from a point to itself, and repeated lines, which
 *     have the same points, radii and values as another line. A tree cannot hold them.
 *  3. It cuts each loop at its thinnest line if ReadOptions.break_loops is set.
 *  4. It chooses a root in each component, and directs all lines away from the root. A line that
 *     closes a loop gets a node with a link [Tree.link].
 *  5. It adds the nodes to a TreeBuilder. The TreeReading counts what was found and changed.
 *
 *     Graph graph = {.name = "vessels.vtp", .options = options, .reading = &reading};
 *     TRY_GOTO(graph_point(&graph, &point, err));     (for each point)
 *     TRY_GOTO(graph_line(&graph, &line, err));       (for each line)
 *     TRY_GOTO(graph_build(&graph, &builder, err));   (then builder_build, graph_release)
 *
 * A point becomes a node. The line that connects the node to its parent becomes the node's segment.
 * The segment's radius is the line's radius or, if the line has none, the radius of its distal
 * point. The segment has the values of the line and of its distal point.
 *
 * Points, lines and columns are numbered from 0, in the order in which they are added. Lines, joins
 * and values refer to points and lines by these numbers. */
#ifndef CORCAST_TREE_GRAPH_H
#define CORCAST_TREE_GRAPH_H

#include "tree/builder.h"
#include "tree/reading.h"

/* A point of the file. */
typedef struct GraphPoint {
    Vec3 position;     /* in the file's unit, or in voxels if the file's coordinates are voxels */
    double radius;     /* in the file's unit, or in voxels; NAN: none */
    bool is_inlet;     /* the file states that blood enters here */
    bool has_type;     /* the file states `type` */
    int32_t type;      /* SWC type code; a point without one gets TREE_VESSEL_TYPE */
    double flow_share; /* as Tree.flow_share; 0: the file states none */
    int64_t id;        /* id of the node; 0: the point's number + 1 */
    size_t record;     /* line or number of the record in the file, for errors */
} GraphPoint;

/* A line between two points. A polyline is several lines. The points may be added later. */
typedef struct GraphLine {
    size_t a, b;      /* numbers of the two points */
    double radius;    /* in the file's unit; NAN: none */
    bool is_directed; /* blood flows from a to b */
    bool is_part;     /* the line is one of several lines of a polyline. A column of lines has one
                       * value for each polyline, which all of its lines get */
    size_t record;    /* line or number of the record in the file, for errors */
} GraphLine;

/* The two kinds of elements that a column can describe. */
typedef enum GraphElement { GRAPH_POINTS, GRAPH_LINES } GraphElement;

/* A network while it is read. Begin with {.name = ...} and the other borrowed members that are
 * needed; release with graph_release. */
typedef struct Graph {
    /* Set at the beginning. All are borrowed; all except `name` may be NULL. */
    const char *name;         /* name of the file, for errors */
    const char *point_record; /* what errors call the record of a point, "point"; NULL: "line", a
                               * line of text */
    const char *line_record;  /* what errors call the record of a line, "cell"; NULL: "line", a line
                               * of text */
    const ReadOptions *options;
    TreeReading *reading; /* receives the counts of what was found and changed */
    TreeBuilder *tree;    /* where a reader whose file holds a tree (ids, parents, lengths in mm)
                           * adds the nodes and metadata. It leaves the graph empty then */
    /* Set by the reader: */
    TreeMeta meta;       /* metadata of the tree; owned */
    LengthUnit unit;     /* the unit that the file states, or the format's usual one; default mm */
    bool unit_is_stated; /* the file itself states the unit */
    bool is_named;       /* lines refer to points by name. Two points at one position are then
                          * merged only if this closes no loop */
    bool is_tree;        /* The file was written from a tree: each line is directed and leads from
                          * parent to child, and each point has its own id, except points that are
                          * joined. Nothing is merged or removed, and there are no loops */
    /* Filled by the functions below. All arrays are owned. */
    GraphPoint *point;
    size_t n_points, points_capacity;
    GraphLine *line;
    size_t n_lines, lines_capacity;
    struct GraphColumn *column;
    size_t n_columns, columns_capacity;
    struct GraphJoin *join;
    size_t n_joins, joins_capacity;
} Graph;

/* Frees what the graph owns, and zeroes it. */
void graph_release(Graph *graph);

/* Puts "FILE:RECORD: " in front of the error if `status` is STATUS_INPUT, as builder_blame does.
 * The word for the record is graph->point_record or graph->line_record, depending on `of`. Returns
 * `status`. */
Status graph_blame(const Graph *graph, GraphElement of, size_t record, Status status, Err *err);

/* Adds a point. O(1) on average.
 *
 * Errors   STATUS_INPUT if the position is not finite, the id is not in [0, TREE_MAX_ID],
 *          reading_radius refuses the radius, or there are 2^31 - 1 points. The sentence names
 *          neither file nor record; graph_blame adds them. STATUS_MEMORY. */
MUST_CHECK Status graph_point(Graph *graph, const GraphPoint *point, Err *err);
/* Adds a line. O(1) on average. Does not check the numbers of its points; graph_build does.
 *
 * Errors   STATUS_INPUT if reading_radius refuses the radius, or there are 2^31 - 1 lines. The
 *          sentence names neither file nor record. STATUS_MEMORY. */
MUST_CHECK Status graph_line(Graph *graph, const GraphLine *line, Err *err);

/* Declares that the points with the numbers a and b are one point, at any distance. The points may
 * be added later. Errors: STATUS_MEMORY. */
MUST_CHECK Status graph_join(Graph *graph, size_t a, size_t b, Err *err);

/* Adds a column: a named value for each point, or for each line. Name and unit are copied. If both
 * points and lines have a column of this name, the tree's column with the values of the points is
 * called "NAME of points".
 *
 * column   receives the number of the column.
 * Errors   STATUS_INPUT if the name is empty, another column of the same elements has it, or there
 *          are BUILDER_MAX_COLUMNS columns. STATUS_MEMORY. */
MUST_CHECK Status graph_column(Graph *graph, GraphElement of, const char *name, const char *unit,
                               size_t *column, Err *err);
/* Sets the value of a column for the point or line with the number `at`, which must
 * have been added. Values that are never set are NAN. O(1) on average, in any order.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status graph_value(Graph *graph, size_t column, size_t at, double value, Err *err);

/* Makes a tree of the network: adds its nodes, columns and metadata to `builder`, and fills
 * graph->reading. Afterwards the graph can only be released, also after an error.
 *
 * The root of a component is chosen among its points by these rules, in this order: a stated inlet;
 * a point that directed lines leave and none enters; an end of a single line; any point. Among
 * several points by the same rule, the thickest is the root.
 *
 * builder  must have its name set, and no nodes. The caller then calls builder_build.
 * Errors   STATUS_INPUT if there is no line, or all lines have length 0; if a line or a join refers
 *          to a point that does not exist; if neither a line nor its distal point has a radius, and
 *          the options supply none; if the lines of an is_tree graph form a loop.
 *          STATUS_INFEASIBLE if there are more than TREE_MAX_ID nodes. STATUS_MEMORY.
 * Cost     O(n log n) for n points and lines. */
MUST_CHECK Status graph_build(Graph *graph, TreeBuilder *builder, Err *err);

/* Counts the nodes of a tree that have the position of an earlier node, without being linked to it.
 * If the tree is written as a network and read again, graph_build merges each of these nodes with
 * the earlier node.
 *
 * n        receives the count.
 * Errors   STATUS_MEMORY.
 * Cost     O(n). */
MUST_CHECK Status graph_count_merged(const Tree *tree, size_t *n, Err *err);

#endif
