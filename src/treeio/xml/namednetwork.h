/* A network whose points have names and whose lines name their ends, both with any numbers under
 * names: what GXL and GraphML hold. */
#ifndef CORCAST_TREEIO_NAMEDNETWORK_H
#define CORCAST_TREEIO_NAMEDNETWORK_H

#include "treeio/names.h"
#include "treeio/vtk/attributes.h"
#include "treeio/vtk/vtkdata.h"

/* Begin with {.names = {.what = "node"}} and the size of the file in both Attributes; release with
 * namednetwork_release. */
typedef struct NamedNetwork {
    Names names;
    Slabs texts;
    Attributes of_points, of_lines; /* of the point and the line begun last */
    struct NamedLine *line;
    size_t n_lines, lines_capacity;
    VtkData data;
} NamedNetwork;

void namednetwork_release(NamedNetwork *network);

/* Begins a point, or a line between two points that are given before or after. Names are copied.
 * STATUS_INPUT, without file and line, when another point has the name. */
MUST_CHECK Status namednetwork_point(NamedNetwork *network, const char *name, size_t record,
                                     Err *err);
MUST_CHECK Status namednetwork_line(NamedNetwork *network, const char *from, const char *to,
                                    size_t record, Err *err);

/* What is known of a tree that the program wrote, a comment a line [treeio/comments.h]: the nodes
 * have its ids, and the edges' radii are the nodes'. */
MUST_CHECK Status namednetwork_known(NamedNetwork *network, const char *comments, Err *err);

/* Appends what is known so, with the signs that XML does not take as entities. */
void namednetwork_put_known(const TreeMeta *meta, Text *text);

/* Hands all over to the graph [vtk_to_graph], of which nothing is left here. `axes` names the
 * numbers of points that are x, y and z; without the third, z is 0. STATUS_INPUT, with the file's
 * name and the line where there is one, when a line names no point, a point has no position, or
 * there is no radius. */
MUST_CHECK Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3],
                                        Graph *graph, Err *err);

#endif
