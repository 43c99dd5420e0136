/* A network whose points have names, and whose lines list the names of their points. Points and
 * lines may have named numbers, such as "radius". GXL, GraphML and Amira's workbooks hold such
 * networks. A reader adds points and lines in the order of the file, then calls
 * namednetwork_to_graph.
 *
 *     NamedNetwork network = namednetwork_of("node", size);
 *     namednetwork_begin(&network, GRAPH_POINTS, line, err);           (for each point)
 *     namednetwork_name(&network, "n1", line, err);
 *     namednetwork_set(&network, GRAPH_POINTS, "radius", 1.2, err);    (for each of its numbers)
 *     namednetwork_edge(&network, "n1", "n2", line, err);              (for each line)
 *     namednetwork_to_graph(&network, axes, graph, err);               (then namednetwork_release)
 */
#ifndef CORCAST_TREEIO_XML_NAMEDNETWORK_H
#define CORCAST_TREEIO_XML_NAMEDNETWORK_H

#include "treeio/names.h"
#include "treeio/vtk/vtkdata.h"

/* A line of the network. */
typedef struct NamedLine {
    size_t end;    /* 1 + position of its last name in NamedNetwork.ends */
    size_t record; /* line of the file, for errors */
} NamedLine;

/* Begin with namednetwork_of; release with namednetwork_release. */
typedef struct NamedNetwork {
    size_t file_size; /* in bytes */
    Names names;      /* names of points */
    const char *last; /* name of the point that was begun last; borrowed from `texts` */
    Slabs texts;      /* memory of all names */
    ARRAY(NamedLine) lines;
    ARRAY(char *) ends; /* names of the points of all lines, line after line */
    VtkData data;       /* the numbers of points and lines */
} NamedNetwork;

/* Returns an empty network. `what` is the word for a point in errors: "node". It is borrowed. */
NamedNetwork namednetwork_of(const char *what, size_t file_size);
void namednetwork_release(NamedNetwork *network);

/* Begins a point or a line. `record` is its line in the file, for errors. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_begin(NamedNetwork *network, GraphElement of, size_t record,
                                     Err *err);
/* Names the point that was begun last. The name is copied. Errors: STATUS_INPUT, without file and
 * line, if another point has the name; STATUS_MEMORY. */
MUST_CHECK Status namednetwork_name(NamedNetwork *network, const char *name, size_t record,
                                    Err *err);
/* Adds the point of this name to the end of the line that was begun last. The point may come later
 * in the file. The name is copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_add_end(NamedNetwork *network, const char *name, Err *err);
/* Begins a line from one point to another. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_edge(NamedNetwork *network, const char *from, const char *to,
                                    size_t record, Err *err);
/* Sets the number called `name` of the point or the line that was begun last. Errors: those of
 * vtk_set_number. */
MUST_CHECK Status namednetwork_set(NamedNetwork *network, GraphElement of, const char *name,
                                   double value, Err *err);

/* Sets the metadata of a tree that corcast wrote. `comments` has one comment per line
 * [treeio/comments.h]. namednetwork_to_graph then restores the ids and radii of the tree. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status namednetwork_set_metadata(NamedNetwork *network, const char *comments, Err *err);
/* Appends the text that namednetwork_set_metadata reads, escaped for XML. */
void namednetwork_put_metadata(const TreeMeta *meta, Text *text);

/* Fills the graph from the network, as vtk_to_graph does.
 *
 * axes     names of the numbers of points that are x, y and z; axes[2] may be NULL: z is 0.
 * Errors   STATUS_INPUT, with the file's name and, for a line, its line in the file, if a line
 *          names an unknown point or has fewer than two points, a point has no position, or no
 *          number is a radius; STATUS_MEMORY. */
MUST_CHECK Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3],
                                        Graph *graph, Err *err);

#endif
