/* What the arrays of a file are for. */
#ifndef CORCAST_TREEIO_VTKMEANING_H
#define CORCAST_TREEIO_VTKMEANING_H

#include "treeio/vtk/vtkdata.h"

/* All borrowed from the data; of one number for each point or cell. */
typedef struct VtkMeaning {
    const VtkArray *radius; /* NULL: the file has none, and options->radius_mm is set */
    GraphElement of;        /* that have the radius */
    double factor;          /* 0.5 of diameters */
    const VtkArray *inlet;  /* of points; NULL: there is none */
    double inlet_value;     /* where the inlets are */
    const VtkArray *id; /* of points, in files of the program's own, which are trees; else NULL */
    const VtkArray *type, *share; /* likewise; NULL: the file has none */
} VtkMeaning;

/* STATUS_INPUT, with the file's name, when there is no array of radii and options give none. */
MUST_CHECK Status vtk_find_meaning(VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                                   Err *err);
/* Tells graph->reading what was assumed. */
MUST_CHECK Status vtk_tell_meaning(const VtkMeaning *meaning, const VtkData *data,
                                   const Graph *graph, Err *err);
/* Whether an array is something else than a column; of other programs' files also another of the
 * radius's name, as that of points beside that of cells. */
bool vtk_is_used(const VtkMeaning *meaning, const VtkArray *array);

/* What the program itself has written of a tree [vtkwrite.c]: lines of text; NULL: nothing. */
const VtkArray *vtk_find_known(const VtkData *data);

/* Point number `i`. */
static inline Vec3 vtk_position(const VtkData *data, size_t i)
{
    return (Vec3){data->point[3 * i], data->point[3 * i + 1], data->point[3 * i + 2]};
}

/* Hands a file that is a tree, as meaning->id says, to graph->tree. STATUS_INPUT, with file and
 * record, when two lines lead to one node, and as builder_node, builder_column and meta_parse. */
MUST_CHECK Status vtk_to_tree(const VtkMeaning *meaning, const VtkData *data, Graph *graph,
                              Err *err);

#endif
