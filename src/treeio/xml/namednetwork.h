/* A network whose points have names, and whose lines list the names of their points. Points and
 * lines have any named numbers. GXL, GraphML and Amira's workbooks hold such networks.
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
    size_t end, record; /* end of its names in `ends`; line of the file */
} NamedLine;

/* Begin with namednetwork_of; release with namednetwork_release. */
typedef struct NamedNetwork {
    size_t file_size; /* in bytes */
    Names names;      /* of points */
    const char *last; /* name of the last point; borrowed from `texts` */
    Slabs texts;      /* hold all names */
    ARRAY(NamedLine) lines;
    ARRAY(char *) ends; /* names of the points of all lines */
    VtkData data;
} NamedNetwork;

/* Returns an empty network. `what` is what points are called in errors. */
NamedNetwork namednetwork_of(const char *what, size_t file_size);
void namednetwork_release(NamedNetwork *network);

/* Begins a point or a line. `record` is its line in the file. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_begin(NamedNetwork *network, GraphElement of, size_t record,
                                     Err *err);
/* Names the point that was begun last. The name is copied. Errors: STATUS_INPUT, without file and
 * line, if another point has the name; STATUS_MEMORY. */
MUST_CHECK Status namednetwork_name(NamedNetwork *network, const char *name, size_t record,
                                    Err *err);
/* Continues the line that was begun last to the point of this name, which may come later. The name
 * is copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_add_end(NamedNetwork *network, const char *name, Err *err);
/* Begins a line from one point to another. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_edge(NamedNetwork *network, const char *from, const char *to,
                                    size_t record, Err *err);
/* Sets a number of the point or the line that was begun last. Errors: as vtk_set_number. */
MUST_CHECK Status namednetwork_set(NamedNetwork *network, GraphElement of, const char *name,
                                   double value, Err *err);

/* Sets the metadata of a tree that corcast wrote, one comment per line [treeio/comments.h]. Nodes
 * then have its ids, and nodes have the radii of edges. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_set_metadata(NamedNetwork *network, const char *comments, Err *err);
/* Appends the metadata for namednetwork_set_metadata, with entities where XML needs them. */
void namednetwork_put_metadata(const TreeMeta *meta, Text *text);

/* Hands the network over to the graph [vtk_to_graph].
 *
 * axes     names of the numbers of points that are x, y and z; NULL as the third: z is 0.
 * Errors   STATUS_INPUT, with the file's name, and the line if there is one, if a line refers to no
 *          point or has fewer than two, a point has no position, or there is no radius;
 *          STATUS_MEMORY. */
MUST_CHECK Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3],
                                        Graph *graph, Err *err);

#endif
