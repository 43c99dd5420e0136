/* Finds what the named arrays of a file mean: radii, inlets and, in files that corcast wrote, the
 * ids and links of a tree.
 *
 *     TRY(vtk_find_meaning(&meaning, data, graph, err));
 *     if (meaning.id)
 *         return vtk_to_tree(&meaning, data, graph, err);   // corcast wrote the file
 *     TRY(vtk_note_meaning(&meaning, data, graph, err));    // then each array without a meaning
 *                                                           // [vtk_is_used] becomes a column */
#ifndef CORCAST_TREEIO_VTK_VTKMEANING_H
#define CORCAST_TREEIO_VTK_VTKMEANING_H

#include "treeio/vtk/vtkdata.h"

/* The arrays with a meaning. All are borrowed from the data and have one number per element. */
typedef struct VtkMeaning {
    const VtkArray *radius; /* NULL: the file has none, and options->radius_mm is set */
    GraphElement of;        /* the elements that have the radius */
    double factor;          /* from the array to the radius: 0.5 for diameters */
    const VtkArray *inlet;  /* of points; NULL: none */
    double inlet_value;     /* value of the array at inlets */
    /* Of files that corcast wrote, which are trees: */
    const VtkArray *id;           /* of points; NULL: another program wrote the file */
    const VtkArray *type, *share; /* of points; NULL: the file has none */
    const VtkArray *cell_radius;  /* of cells, for lines with a link_id; NULL: the file has none */
    const VtkArray *link[2];      /* per GraphElement: ids of nodes with links; NULL: none */
} VtkMeaning;

/* Finds the meaning of the arrays. Errors: STATUS_INPUT, with the file's name, if there is no array
 * of radii and the options give no radius. */
MUST_CHECK Status vtk_find_meaning(VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                                   Err *err);
/* Records in graph->reading what was assumed. Errors: STATUS_MEMORY. */
MUST_CHECK Status vtk_note_meaning(const VtkMeaning *meaning, const VtkData *data,
                                   const Graph *graph, Err *err);
/* Returns true if an array is not a column. In files of other programs, an array whose name differs
 * from that of the radius only in spelling is no column, either. */
bool vtk_is_used(const VtkMeaning *meaning, const VtkArray *array);

/* Returns the array of the metadata that corcast wrote [vtkwrite.c], or NULL. */
const VtkArray *vtk_find_metadata(const VtkData *data);

/* Returns the position of point `i`. */
static inline Vec3 vtk_position(const VtkData *data, size_t i)
{
    return (Vec3){data->point[3 * i], data->point[3 * i + 1], data->point[3 * i + 2]};
}

/* Hands a tree that corcast wrote over to graph->tree. Errors: STATUS_INPUT, with file and record,
 * if two lines lead to one node, and as builder_node, builder_column and meta_parse; STATUS_MEMORY.
 */
MUST_CHECK Status vtk_to_tree(const VtkMeaning *meaning, const VtkData *data, Graph *graph,
                              Err *err);

#endif
