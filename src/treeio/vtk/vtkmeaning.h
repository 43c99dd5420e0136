/* Finds the meaning of the named arrays of a file: which arrays hold radii, inlets and, in files
 * that corcast wrote, the ids and links of a tree. vtk_to_graph [vtkdata.h] calls these functions:
 *
 *     TRY(vtk_find_meaning(&meaning, data, graph, err));
 *     if (meaning.id)
 *         return vtk_to_tree(&meaning, data, graph, err);   // corcast wrote the file
 *     TRY(vtk_note_assumptions(&meaning, data, graph, err));
 *     for each array:  if (!vtk_has_meaning(&meaning, array)) make it a column; */
#ifndef CORCAST_TREEIO_VTK_VTKMEANING_H
#define CORCAST_TREEIO_VTK_VTKMEANING_H

#include "treeio/vtk/vtkdata.h"

/* The arrays with a meaning. An array of points has one number per point, and an array of cells has
 * one number per cell. All are borrowed from the data. */
typedef struct VtkMeaning {
    const VtkArray *radius; /* radii or diameters, in the file's unit; NULL: the file has no radii,
                             * and graph->options->radius_mm is set */
    GraphElement radius_element; /* the elements that `radius` describes: points or cells */
    double radius_factor;  /* factor from a value of the array to a radius: 0.5 if the array holds
                            * diameters, else 1 */
    const VtkArray *inlet; /* array of points that marks inlets; NULL: the file has none */
    double inlet_value;    /* value of `inlet` at inlets */
    /* Only in files that corcast wrote; NULL in other files: */
    const VtkArray *id;                /* array of points: the id of the node */
    const VtkArray *type, *flow_share; /* arrays of points; NULL: the tree has no types or shares */
    const VtkArray *cell_radius; /* array of cells: the radius of the segment that the cell shows.
                                  * It may differ from the radius of the point at which the segment
                                  * ends, if a link joins several segments there [tree.h]. NULL:
                                  * every segment has the radius of its point */
    const VtkArray *link[2]; /* link[GRAPH_POINTS] and link[GRAPH_LINES]: the arrays link_id of the
                              * points and of the cells. A node with a link has no point of its own:
                              * its id is the value of the point at which its segment ends, or of
                              * the cell that is its segment. Below 1: no link. NULL: the file has
                              * no such array */
} VtkMeaning;

/* Finds the meaning of the arrays. Uses graph->options->radius_array if it is set. Errors:
 * STATUS_INPUT, with the file's name, if there is no array of radii and the options state no
 * radius. */
MUST_CHECK Status vtk_find_meaning(VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                                   Err *err);
/* Adds sentences to *graph->reading that state which arrays were taken for radii and inlets, and
 * how many cells were left out. Errors: STATUS_MEMORY. */
MUST_CHECK Status vtk_note_assumptions(const VtkMeaning *meaning, const VtkData *data,
                                       const Graph *graph, Err *err);
/* Returns true if an array has a meaning, and so does not become a column. In files of other
 * programs this includes arrays whose names equal the name of `radius` except for case, blanks,
 * punctuation and a unit in brackets: they hold the same quantity. */
bool vtk_has_meaning(const VtkMeaning *meaning, const VtkArray *array);

/* Returns the array of the metadata that corcast wrote [vtkwrite.c], or NULL. */
const VtkArray *vtk_find_metadata(const VtkData *data);

/* Returns the position of point `i`, in the file's unit. */
static inline Vec3 vtk_position(const VtkData *data, size_t i)
{
    return (Vec3){data->point[3 * i], data->point[3 * i + 1], data->point[3 * i + 2]};
}

/* Adds the nodes, columns and metadata of the tree to the builder graph->tree. Requires
 * meaning->id.
 *
 * Errors   STATUS_INPUT, with the file's name and the record, if two cells end at the same node;
 *          those of builder_node, builder_column and meta_parse; STATUS_MEMORY. */
MUST_CHECK Status vtk_to_tree(const VtkMeaning *meaning, const VtkData *data, Graph *graph,
                              Err *err);

#endif
