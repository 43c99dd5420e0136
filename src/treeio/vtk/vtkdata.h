/* The content of a file that has points, polylines, and named arrays of numbers for both.
 *
 * The readers of legacy VTK, VTK's XML, Amira and NamedNetwork (GXL, GraphML) fill a VtkData, in
 * any order, with vtk_add_line, vtk_add_cells, vtk_add_array and vtk_set_number. vtk_to_graph then
 * finds the meaning of the arrays [vtkmeaning.h] and fills a Graph [tree/graph.h]. The caller ends
 * with vtk_release, also after an error.
 *
 * All numbers of a file are read as doubles, indices too: indices up to 2^53 are exact. */
#ifndef CORCAST_TREEIO_VTK_VTKDATA_H
#define CORCAST_TREEIO_VTK_VTKDATA_H

#include "tree/tree.h"

/* Name of the array of text that holds the metadata of a tree that corcast wrote, one comment per
 * line. */
#define VTK_METADATA "corcast"

/* ---- types of arrays ---- */

typedef enum VtkType {
    VTK_TEXT, /* lines of text; all other types are numbers */
    VTK_INT8,
    VTK_UINT8,
    VTK_INT16,
    VTK_UINT16,
    VTK_INT32,
    VTK_UINT32,
    VTK_INT64,
    VTK_UINT64,
    VTK_FLOAT,
    VTK_DOUBLE,
    VTK_TYPES
} VtkType;

/* The formats, each with its own names of types. The reader of MetaIO uses only the names of
 * types. */
typedef enum VtkNaming {
    NAMING_LEGACY,
    NAMING_XML,
    NAMING_AMIRA,
    NAMING_METAIO,
    NAMINGS
} VtkNaming;

/* Returns the type whose name in a format is the first `length` characters of `name`, in upper or
 * lower case; VTK_TYPES, without an error, if the format has no such type. */
VtkType vtk_type_called(VtkNaming naming, const char *name, size_t length);
/* Finds the type with this name in a format.
 *
 * numbers_only  the name of an array that must hold numbers, for errors; NULL: text is accepted.
 * Errors        STATUS_INPUT, without the file's name, for an unknown type, and for text if
 *               `numbers_only` is not NULL. */
MUST_CHECK Status vtk_find_type(VtkNaming naming, const char *name, const char *numbers_only,
                                VtkType *type, Err *err);
/* Returns the first name of a type in a format. */
const char *vtk_type_name(VtkNaming naming, VtkType type);
/* Returns the number of bytes of one value; 1 for VTK_TEXT, whose values are characters. */
size_t vtk_type_size(VtkType type);

/* Converts n values of a type to numbers, on all processors. `bytes` needs no alignment. */
void vtk_numbers(VtkType type, bool is_big_endian, const char *bytes, size_t n, double *out);
/* Converts n numbers to values of a type. */
void vtk_bytes(VtkType type, bool is_big_endian, const double *numbers, size_t n, char *bytes);

/* ---- arrays ---- */

/* A named array of numbers, or of lines of text. All pointers are owned. */
typedef struct VtkArray {
    char *name;
    size_t n, components; /* number of elements, and of numbers per element */
    double *value;        /* n * components numbers; NULL: the array is text */
    size_t capacity;      /* allocated length of `value`, in numbers */
    char *text;           /* lines, each zero-terminated; NULL: the array has no text */
    size_t text_size;     /* bytes of `text` */
} VtkArray;

/* The arrays of all points, of all cells, or of the file. Zeroed, there are none. */
typedef struct VtkArrays {
    VtkArray *array; /* owned */
    size_t n, capacity;
    size_t next;    /* index of the array that vtk_set_number tries first */
    double n_added; /* count of the numbers that vtk_set_number and vtk_fill_up have added; a
                     * double, because check_unpacked takes a double */
} VtkArrays;

/* Frees what the array owns, and zeroes it. */
void vtk_release_array(VtkArray *array);

/* Moves an array to *arrays, and zeroes *array. *array is released after an error. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status vtk_add_array(VtkArrays *arrays, VtkArray *array, Err *err);
/* Returns the first array of this name, or NULL. */
VtkArray *vtk_find_array(const VtkArrays *arrays, const char *name);

/* Sets the value of one element in the array of this name. Adds the array if there is none. Lower
 * elements without a value get NAN.
 *
 * file_size  size of the file in bytes, which limits how many numbers the arrays may hold
 *            [max_unpacked_bytes].
 * Errors     STATUS_INPUT, without file and line, if there would be more than BUILDER_MAX_COLUMNS
 *            arrays; those of check_unpacked; STATUS_MEMORY.
 * Cost       O(arrays); O(1) if the calls for each element name the arrays in the same order. */
MUST_CHECK Status vtk_set_number(VtkArrays *arrays, const char *name, size_t element, double value,
                                 size_t file_size, Err *err);
/* Fills all arrays with NAN up to `n` elements. Errors: those of check_unpacked; STATUS_MEMORY. */
MUST_CHECK Status vtk_fill_up(VtkArrays *arrays, size_t n, size_t file_size, Err *err);

/* ---- data ---- */

/* Index of the arrays of the file, after GRAPH_POINTS and GRAPH_LINES. */
enum { VTK_OF_FILE = 2, VTK_ELEMENTS };

/* Begin with {0}; release with vtk_release. All arrays are owned. */
typedef struct VtkData {
    double *point; /* per point: x, y, z */
    size_t n_points, points_capacity;
    double *corner; /* indices of the points of all polylines, one polyline after the other */
    size_t n_corners, corners_capacity;
    size_t *end;  /* per polyline: 1 + position of its last point in `corner` */
    size_t *cell; /* per polyline: its index among all cells of the file */
    size_t n_lines, ends_capacity, cells_capacity; /* n_lines: number of polylines */
    size_t n_cells;                 /* number of cells of any kind; arrays of cells have an element
                                     * for each */
    size_t not_lines;               /* number of cells that are neither lines nor points */
    bool is_directed;               /* blood flows along the lines */
    VtkArrays arrays[VTK_ELEMENTS]; /* of points, of cells, of the file */
} VtkData;

void vtk_release(VtkData *data);

/* Adds a polyline through `n` points. `cell` is its index among all cells. corner[k] + first_point
 * is the index of its point k; the indices are checked later, by vtk_to_graph. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status vtk_add_line(VtkData *data, size_t cell, const double *corner, size_t n,
                               size_t first_point, Err *err);

/* Removes three arrays of points, and stores their numbers in data->point as x, y and z.
 *
 * axes     names of the arrays; axes[2] may be NULL: z is 0.
 * name     the file's name, for errors.
 * Errors   STATUS_INPUT, with the file's name, for a point without a position; STATUS_MEMORY. */
MUST_CHECK Status vtk_detach_positions(VtkData *data, const char *const axes[3], const char *name,
                                       Err *err);

/* ---- cells ---- */

enum { VTK_CELL_KINDS = 5 };

/* A kind of cells, such as lines or polygons. */
typedef struct VtkCellKind {
    const char *legacy, *xml; /* its names in legacy files and in XML */
    int type;                 /* VTK's type code of the cells; 0: the cells are not lines, or
                               * has_types is set */
    bool has_types;           /* each cell has its own type code [VtkCells.type] */
} VtkCellKind;

/* All kinds, in the order in which VTK's XML numbers the cells: an array of cells has the values of
 * all cells of kind 0, then those of kind 1, and so on. */
extern const VtkCellKind vtk_cell_kinds[VTK_CELL_KINDS];

/* The cells of one kind in a file. All arrays are owned. */
typedef struct VtkCells {
    double *corner;      /* point indices of all cells, one cell after the other */
    double *end;         /* per cell: 1 + position of its last point in `corner` */
    double *type;        /* per cell: VTK's type code; NULL: the type of the kind */
    size_t n, n_corners; /* number of cells, and length of `corner` */
} VtkCells;

void vtk_release_cells(VtkCells *cells);
/* Adds those cells of a kind that are lines to the data, and counts all cells in n_cells and
 * not_lines. `first_point` is as in vtk_add_line. Errors: STATUS_INPUT, without the file's name, if
 * cells->end does not rise or exceeds n_corners; STATUS_MEMORY. */
MUST_CHECK Status vtk_add_cells(VtkData *data, const VtkCells *cells, const VtkCellKind *kind,
                                size_t first_point, Err *err);

/* ---- meaning ---- */

/* Appends the name that a column of a tree has in VTK files, "NAME [UNIT]". If vtk_is_own(NAME), an
 * underscore follows NAME, so that the reader does not take the array for one of corcast's own. */
void vtk_put_column_name(const TreeColumn *column, Text *text);
/* Returns true if corcast writes an array of this name itself, such as "radius". Ignores
 * underscores at the end. */
bool vtk_is_own(const char *name);

/* Adds the points and lines to a graph. The names of arrays decide which arrays hold radii and
 * inlets [vtkmeaning.h]; other arrays become columns. Adds sentences about the assumptions to
 * *graph->reading. If corcast wrote the file, fills graph->tree instead, and leaves the graph
 * empty.
 *
 * Errors   STATUS_INPUT, with the file's name, if a line refers to a point that does not exist, an
 *          array has not one value per element, or there is no array of radii; STATUS_MEMORY. */
MUST_CHECK Status vtk_to_graph(const VtkData *data, Graph *graph, Err *err);

#endif
