/* A network whose points have names, and whose polylines list the names of their points. Points and
 * polylines may have named numbers, such as "radius". GXL, GraphML and Amira's workbooks hold such
 * networks. A reader adds points and polylines in the order of the file, then calls
 * namednetwork_to_graph. `record` is a line of the file, for errors.
 *
 *     NamedNetwork network = namednetwork_new("node", size);
 *     namednetwork_begin(&network, GRAPH_POINTS, record, err);         (for each point)
 *     namednetwork_name(&network, "n1", record, err);
 *     namednetwork_set(&network, GRAPH_POINTS, "radius", 1.2, err);    (for each of its numbers)
 *     namednetwork_edge(&network, "n1", "n2", record, err);            (for each polyline)
 *     namednetwork_to_graph(&network, axes, graph, err);               (then namednetwork_release)
 */
#ifndef CORCAST_TREEIO_XML_NAMEDNETWORK_H
#define CORCAST_TREEIO_XML_NAMEDNETWORK_H

#include "treeio/names.h"
#include "treeio/vtk/vtkdata.h"

/* A polyline of the network. */
typedef struct NamedLine {
    size_t names_end; /* 1 + position of its last name in NamedNetwork.point_names */
    size_t record;    /* line of the file, for errors */
} NamedLine;

/* Begin with namednetwork_new; release with namednetwork_release. */
typedef struct NamedNetwork {
    size_t file_size; /* in bytes; limits how many numbers may be added [vtk_set_number] */
    Names names;      /* names of points */
    const char *last; /* name of the point that was begun last; borrowed from `texts` */
    Slabs texts;      /* memory of all names */
    ARRAY(NamedLine) lines;
    ARRAY(char *)
    point_names;  /* names of the points of all polylines, one polyline after another */
    VtkData data; /* the numbers of points and polylines */
} NamedNetwork;

/* Returns an empty network. `what` is the word for a point in errors: "node". It is borrowed. */
NamedNetwork namednetwork_new(const char *what, size_t file_size);
void namednetwork_release(NamedNetwork *network);

/* Begins a point, or a polyline (GRAPH_LINES) that namednetwork_add_end extends. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status namednetwork_begin(NamedNetwork *network, GraphElement element, size_t record,
                                     Err *err);
/* Names the point that was begun last. The name is copied. Errors: STATUS_INPUT, without file and
 * line, if another point has the name; STATUS_MEMORY. */
MUST_CHECK Status namednetwork_name(NamedNetwork *network, const char *name, size_t record,
                                    Err *err);
/* Adds the point of this name to the end of the polyline that was begun last. The point may come
 * later in the file. The name is copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_add_end(NamedNetwork *network, const char *name, Err *err);
/* Begins a polyline and adds its two points. Errors: STATUS_MEMORY. */
MUST_CHECK Status namednetwork_edge(NamedNetwork *network, const char *from, const char *to,
                                    size_t record, Err *err);
/* Sets the number called `name` of the point or the polyline that was begun last. Errors: those of
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
 * Errors   STATUS_INPUT, with the file's name and, for a polyline, its record, if a polyline names
 *          an unknown point or has fewer than two points, a point has no position, or no number is
 *          a radius; STATUS_MEMORY. */
MUST_CHECK Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3],
                                        Graph *graph, Err *err);

#endif
