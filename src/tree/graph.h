/* Makes a tree of points and lines without order: the builder of formats that hold a network.
 *
 * A reader hands over what the file says, in the file's unit: points, lines between them, values of
 * both. graph_build scales, makes one of the points that lie at one place, removes what is not
 * needed, cuts or refuses loops, chooses the root of each component, directs all lines away from
 * it, and hands nodes to a TreeBuilder. What it found and did stands in a TreeReading.
 *
 * A node of the tree is a point, and its segment the line that leads to it from the root: the
 * segment has the line's radius, or else its distal point's; and the values of both. */
#ifndef CORCAST_TREE_GRAPH_H
#define CORCAST_TREE_GRAPH_H

#include "tree/builder.h"
#include "tree/reading.h"

/* A point as a file has it. */
typedef struct GraphPoint {
    Vec3 position; /* in the file's unit; of voxels where it has them */
    double radius; /* likewise; NAN: none */
    bool is_inlet; /* the file says that blood enters here */
    bool has_type;
    int32_t type;      /* SWC's; else TREE_VESSEL_TYPE */
    double flow_share; /* as Tree has it; 0: none is said */
    int64_t id;        /* that the node is to have; 0: its number, from 1 on */
    size_t record;     /* where in the file, for sentences */
} GraphPoint;

/* A line between two points, given before or after; a polyline is several. */
typedef struct GraphLine {
    size_t a, b;      /* numbers of points, from 0 on */
    double radius;    /* NAN: none */
    bool is_directed; /* blood flows from a to b */
    bool is_part; /* of a polyline of several lines, so that values of lines are the polyline's */
    size_t record;
} GraphLine;

typedef enum GraphElement { GRAPH_POINTS, GRAPH_LINES } GraphElement;

/* Begin with {.name, .point_record, .line_record, .options, .reading, .tree} (all borrowed, the
 * last five may be NULL); release with graph_release. What a reader may set is said. */
typedef struct Graph {
    const char *name;         /* of the file */
    const char *point_record; /* what the records of points are called, "point"; NULL: lines */
    const char *line_record;  /* likewise "cell" */
    const ReadOptions *options;
    TreeReading *reading;
    TreeBuilder *tree;   /* a reader that finds a tree in its file, with ids and parents, in mm, may
                          * hand its nodes and meta over here, and leave the graph empty */
    TreeMeta meta;       /* of the tree, for the reader to fill */
    LengthUnit unit;     /* that is custom in the format, for the reader to set; mm */
    bool unit_is_stated; /* the file itself says the unit; for the reader to set */
    bool is_named; /* lines name their points, so that points at one place may be different ones
                    * where they would close a loop; for the reader to set */
    bool is_tree;  /* the file was made of a tree, and each line is directed and leads from a
                    * parent to its child, and each point has its own id but for those that are
                    * joined: nothing is merged or removed; for the reader to set */
    GraphPoint *point;
    size_t n_points, points_capacity;
    GraphLine *line;
    size_t n_lines, lines_capacity;
    struct GraphColumn *column;
    size_t n_columns, columns_capacity;
    struct GraphJoin *join;
    size_t n_joins, joins_capacity;
} Graph;

void graph_release(Graph *graph);

/* Puts file and record in front of the sentence of a STATUS_INPUT, as builder_blame; names the
 * records of points or of lines. */
Status graph_blame(const Graph *graph, GraphElement of, size_t record, Status status, Err *err);

/* Adds a point or a line, in O(1) amortised, numbered from 0 on in the order given. STATUS_INPUT,
 * without file and record, for a position that is not finite, a radius that is infinite or below 0,
 * an id beyond 0 .. TREE_MAX_ID. */
MUST_CHECK Status graph_point(Graph *graph, const GraphPoint *point, Err *err);
MUST_CHECK Status graph_line(Graph *graph, const GraphLine *line, Err *err);

/* Says that two points, given before or after, are one, wherever they lie. */
MUST_CHECK Status graph_join(Graph *graph, size_t a, size_t b, Err *err);

/* Adds a column of values of points or of lines (name and unit copied), numbered in *column from 0
 * on. STATUS_INPUT when the name is empty or that of another of the same elements, or there are too
 * many. Where points and lines have a column of one name, that of the points is called "NAME of
 * points" in the tree. */
MUST_CHECK Status graph_column(Graph *graph, GraphElement of, const char *name, const char *unit,
                               size_t *column, Err *err);
/* Sets the column's value of element number `at`, given before. What is not set is NAN. O(1)
 * amortised in any order. */
MUST_CHECK Status graph_value(Graph *graph, size_t column, size_t at, double value, Err *err);

/* Hands the tree over to `builder`, which takes name and meta, and fills graph->reading, if any.
 * O(n log n). STATUS_INPUT when there is no line, a line names a point that there is not, a line
 * and its distal point have no radius, or there are loops and options->break_loops is not set.
 * Afterwards the graph can only be released. */
MUST_CHECK Status graph_build(Graph *graph, TreeBuilder *builder, Err *err);

/* How many nodes of a tree lie where earlier ones do, so that graph_build, to which only points and
 * lines are handed, makes one of them and those. O(n). STATUS_MEMORY. */
MUST_CHECK Status graph_count_merged(const Tree *tree, size_t *n, Err *err);

#endif
