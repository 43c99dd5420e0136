/* What VTK's files hold of lines, whether legacy or XML, and the network that it is. */
#ifndef CORCAST_TREEIO_VTKDATA_H
#define CORCAST_TREEIO_VTKDATA_H

#include "tree/tree.h"

/* The text that holds what is known of a tree that the program wrote, a comment a line. */
#define VTK_KNOWN "corcast"

/* A type of numbers, as both kinds of files call it. */
typedef struct VtkType {
    const char *legacy, *xml; /* NULL: that kind does not know it */
    size_t size;              /* of a value, bytes */
    bool is_float, is_signed;
} VtkType;

/* NULL when there is none of the name, capitals or not. */
const VtkType *vtk_type_of_legacy(const char *name, size_t length);
const VtkType *vtk_type_of_xml(const char *name);
/* Converts n values from bytes that lie anywhere. */
void vtk_numbers(const VtkType *type, bool is_big_endian, const char *bytes, size_t n, double *out);

/* The other way round. */
void vtk_bytes(const VtkType *type, bool is_big_endian, const double *numbers, size_t n,
               char *bytes);

/* An array of `n` tuples of `components` numbers, or of lines of text. */
typedef struct VtkArray {
    char *name; /* owned */
    size_t n, components;
    double *value; /* owned; NULL: it is of text */
    char *text;    /* owned; of text, each line zero-terminated; NULL: none */
    size_t text_size;
} VtkArray;

typedef struct VtkArrays {
    VtkArray *array; /* owned */
    size_t n, capacity;
} VtkArrays;

/* Begin with {0}; release with vtk_release. */
typedef struct VtkData {
    double *point; /* x, y, z of each; owned */
    size_t n_points, points_capacity;
    double *corner; /* points of all polylines, one behind the other; owned */
    size_t n_corners, corners_capacity;
    size_t *end;  /* of each polyline in `corner`; owned */
    size_t *cell; /* number of each polyline among all cells; owned */
    size_t n_lines, ends_capacity, cells_capacity;
    size_t n_cells;   /* of any kind */
    size_t not_lines; /* cells that are neither lines nor points */
    bool is_directed; /* blood flows along the lines */
    VtkArrays of_points, of_cells, of_file;
} VtkData;

void vtk_release(VtkData *data);
void vtk_release_array(VtkArray *array);

/* Adds an array to those of *arrays, which owns it then, also on failure. */
MUST_CHECK Status vtk_add_array(VtkArrays *arrays, VtkArray *array, Err *err);
/* Adds a polyline, cell number `cell`, through `n` points, counted from number `first_point` on. */
MUST_CHECK Status vtk_add_line(VtkData *data, size_t cell, const double *corner, size_t n,
                               size_t first_point, Err *err);

/* Types of cells that are read, or passed over in silence. */
enum {
    VTK_VERTEX = 1,
    VTK_POLY_VERTEX = 2,
    VTK_LINE = 3,
    VTK_POLY_LINE = 4,
    VTK_QUADRATIC_EDGE = 21
};

/* Cells as files have them. */
typedef struct VtkCells {
    double *corner; /* the points of all, one behind the other; owned */
    double *end;    /* of each cell in `corner`; owned */
    double *type;   /* of each cell; owned; NULL: all are of `of` */
    size_t n, n_corners;
    int of;
} VtkCells;

void vtk_release_cells(VtkCells *cells);
/* Adds the lines among the cells, whose points are counted from number `first_point` on.
 * STATUS_INPUT, without the file, when ends do not rise to at most n_corners. */
MUST_CHECK Status vtk_add_cells(VtkData *data, const VtkCells *cells, size_t first_point, Err *err);

/* The name without what tells writings of one name apart: capitals, blanks, signs and a unit in
 * brackets; in `out`, cut to its size. */
void vtk_plain_name(const char *name, char *out, size_t size);

/* Whether the program has an array of its own of this name, underscores at its end left out: in its
 * files a column so called has an underscore more. */
bool vtk_is_own(const char *name);
/* Appends what a column of the tree is called in its files, "NAME [UNIT]". */
void vtk_put_column_name(const TreeColumn *column, Text *text);

/* Hands all over to the graph: radius, inlets and direction by the names of arrays, other arrays as
 * columns. `graph->reading` is told what was assumed. STATUS_INPUT, with the file's name, when a
 * line names a point that there is not, or there is no array of radii. */
MUST_CHECK Status vtk_to_graph(const VtkData *data, Graph *graph, Err *err);

#endif
