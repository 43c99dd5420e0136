/* Reads the tubes of MetaIO scenes (.tre) as MetaIO's metaTube.cxx and ITK's converter of tubes do.
 *
 * Each object has a header of lines "Key = value", which ends with "Points =" or "Points". The
 * points follow, one row of text each, or as binary numbers. PointDim names the numbers of a point.
 * Without PointDim, a row of text holds x, y, z (if NDims is 3), the radius, and numbers that are
 * ignored. Positions and radii are in voxels of size ElementSpacing. TransformMatrix,
 * CenterOfRotation and Offset transform the positions.
 *
 * Older versions of MetaIO reserve more bytes for binary points than they fill, so the bytes
 * between the last point and the next object are skipped. Blood flows from a parent tube to its
 * children: one end of a child is connected to the parent's point that the child names, or to the
 * parent's nearest point if it names none. */
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/names.h"
#include "treeio/vtk/vtkdata.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Maximum number of numbers of a point. A tube of MetaIO has some tens; the arrays for a row are on
 * the stack. */
enum { MAX_COLUMNS = 200 };

/* The header of an object. */
typedef struct TubeHeader {
    bool is_tube, is_root, is_binary, is_big_endian;
    double artery;                                /* 1 or 0; NAN: not stated */
    int32_t dimensions, id, parent, parent_point; /* -1: none */
    char *id_text, *parent_text;                  /* borrowed */
    int32_t points;
    double spacing[3], matrix[9], center[3], offset[3];
    VtkType type; /* type of binary numbers */
    bool has_point_dim;
    size_t n_columns;
    int32_t meaning[MAX_COLUMNS]; /* per number of a point: a Meaning, or the graph's column */
} TubeHeader;

/* The numbers of a point that are not columns. */
typedef enum Meaning { MEANS_X = -4, MEANS_Y, MEANS_Z, MEANS_RADIUS } Meaning;

/* An object that has been read. Its points have consecutive numbers in the graph. */
typedef struct TubeObject {
    int32_t id, parent_point;
    char *parent;        /* ID of the parent; NULL: none */
    size_t first, count; /* first point; number of points */
    size_t line;
    bool is_moved; /* a matrix or an offset transforms the object */
} TubeObject;

/* The first columns of the graph. The columns of PointDim follow. */
enum { TUBE, ARTERY, OWN_COLUMNS };

typedef struct TubeReader {
    Graph *graph;
    Cursor cursor;
    TubeHeader header;
    ARRAY(TubeObject) objects;
    const char *column[MAX_COLUMNS]; /* names of PointDim that are columns (borrowed) */
    size_t n_columns;
    Names ids;      /* of objects */
    size_t assumed; /* count of tubes without PointDim */
} TubeReader;

static const TubeHeader no_header = {.artery = (double)NAN,
                                     .dimensions = 3,
                                     .id = -1,
                                     .parent = -1,
                                     .parent_point = -1,
                                     .points = -1,
                                     .type = VTK_FLOAT,
                                     .spacing = {1, 1, 1},
                                     .matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

/* ---- headers ---- */

static bool is_true(const char *value)
{
    return *value == 'T' || *value == 't' || *value == '1';
}

static Status read_numbers(const char *key, const char *value, size_t count, double *out, Err *err)
{
    return numbers_parse(value, count, out)
               ? STATUS_OK
               : err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be %zu numbers", key, value,
                         count);
}

/* Reads a matrix with as many rows and columns as there are dimensions. */
static Status read_matrix(TubeHeader *header, const char *value, Err *err)
{
    size_t n = (size_t)header->dimensions;
    double number[9];
    TRY(read_numbers("TransformMatrix", value, n * n, number, err));
    for (size_t i = 0; i < n; i++)
        memcpy(&header->matrix[3 * i], &number[n * i], n * sizeof *number);
    return STATUS_OK;
}

static Status read_type(TubeHeader *header, const char *value, Err *err)
{
    header->type = vtk_type_called(NAMING_METAIO, value, strlen(value));
    return header->type < VTK_TYPES
               ? STATUS_OK
               : err_set(err, STATUS_INPUT,
                         "ElementType is '%.40s'; it must be MET_FLOAT or MET_DOUBLE", value);
}

static int32_t meaning_of(const char *name)
{
    static const char *const radii[] = {"r", "rad", "radius", "s"};
    if (!name[1] && strchr("xXyYzZ", *name))
        return MEANS_X + (*name | 32) - 'x';
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++)
        if (strcasecmp(name, radii[i]) == 0)
            return MEANS_RADIUS;
    return 0;
}

/* Finds or adds the column for a name of PointDim. */
static Status find_column(TubeReader *reader, const char *name, int32_t *column, Err *err)
{
    size_t k = 0, number;
    while (k < reader->n_columns && strcmp(reader->column[k], name) != 0)
        k++;
    if (k == MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "PointDim has more than %d names, the maximum",
                       MAX_COLUMNS);
    if (k == reader->n_columns) {
        TRY(graph_column(reader->graph, GRAPH_POINTS, name, "", &number, err));
        reader->column[reader->n_columns++] = name;
    }
    *column = OWN_COLUMNS + (int32_t)k;
    return STATUS_OK;
}

static Status read_point_dim(TubeReader *reader, char *value, Err *err)
{
    TubeHeader *header = &reader->header;
    header->n_columns = 0;
    header->has_point_dim = true;
    for (char *name; (name = text_field(&value)); header->n_columns++) {
        if (header->n_columns == MAX_COLUMNS)
            return err_set(err, STATUS_INPUT, "PointDim has more than %d names, the maximum",
                           MAX_COLUMNS);
        int32_t *meaning = &header->meaning[header->n_columns];
        *meaning = meaning_of(name);
        if (*meaning == 0)
            TRY(find_column(reader, name, meaning, err));
    }
    return STATUS_OK;
}

/* The form of a key's value. */
typedef enum KeyKind {
    KEY_BOOLEAN,
    KEY_INTEGER,
    KEY_VECTOR,
    KEY_MATRIX,
    KEY_TYPE,
    KEY_COLUMNS
} KeyKind;

static const struct {
    const char *name;
    KeyKind kind;
    size_t member; /* offset of the member of TubeHeader; unused by the last three kinds */
} keys[] = {
    {"ID", KEY_INTEGER, offsetof(TubeHeader, id)},
    {"ParentID", KEY_INTEGER, offsetof(TubeHeader, parent)},
    {"ParentPoint", KEY_INTEGER, offsetof(TubeHeader, parent_point)},
    {"NPoints", KEY_INTEGER, offsetof(TubeHeader, points)},
    {"Root", KEY_BOOLEAN, offsetof(TubeHeader, is_root)},
    {"BinaryData", KEY_BOOLEAN, offsetof(TubeHeader, is_binary)},
    {"BinaryDataByteOrderMSB", KEY_BOOLEAN, offsetof(TubeHeader, is_big_endian)},
    {"ElementByteOrderMSB", KEY_BOOLEAN, offsetof(TubeHeader, is_big_endian)},
    {"ElementSpacing", KEY_VECTOR, offsetof(TubeHeader, spacing)},
    {"CenterOfRotation", KEY_VECTOR, offsetof(TubeHeader, center)},
    {"Offset", KEY_VECTOR, offsetof(TubeHeader, offset)},
    {"Position", KEY_VECTOR, offsetof(TubeHeader, offset)},
    {"TransformMatrix", KEY_MATRIX, 0},
    {"Orientation", KEY_MATRIX, 0},
    {"ElementType", KEY_TYPE, 0},
    {"PointDim", KEY_COLUMNS, 0},
};

/* Stores the value of key `k` of the table in the header. */
static Status read_value(TubeReader *reader, size_t k, char *value, Err *err)
{
    TubeHeader *header = &reader->header;
    void *member = (char *)header + keys[k].member;
    switch (keys[k].kind) {
    case KEY_BOOLEAN:
        *(bool *)member = is_true(value);
        return STATUS_OK;
    case KEY_INTEGER:
        return field_integer(keys[k].name, value, -1, INT32_MAX, member, err);
    case KEY_VECTOR:
        return read_numbers(keys[k].name, value, (size_t)header->dimensions, member, err);
    case KEY_MATRIX:
        return read_matrix(header, value, err);
    case KEY_TYPE:
        return read_type(header, value, err);
    case KEY_COLUMNS:
        return read_point_dim(reader, value, err);
    }
    return STATUS_OK;
}

static bool is_moved(const TubeHeader *header)
{
    return memcmp(header->matrix, no_header.matrix, sizeof header->matrix) != 0 ||
           memcmp(header->offset, no_header.offset, sizeof header->offset) != 0;
}

/* Adds the object whose header has been read. */
static Status add_object(TubeReader *reader, Err *err)
{
    const TubeHeader *header = &reader->header;
    const size_t line = reader->cursor.line;
    if (header->id >= 0)
        TRY(names_add(&reader->ids, header->id_text, reader->objects.n, line, err));
    return ARRAY_PUSH(&reader->objects, "objects", err,
                      (TubeObject){.id = header->id,
                                   .parent = header->parent < 0 ? NULL : header->parent_text,
                                   .parent_point = header->parent_point,
                                   .first = reader->graph->n_points,
                                   .line = line,
                                   .is_moved = is_moved(header)});
}

/* Begins a new object. An object other than a tube has no points, so it is added now. */
static Status begin_object(TubeReader *reader, const char *type, Err *err)
{
    if (!reader->header.is_tube && reader->header.id >= 0)
        TRY(add_object(reader, err));
    reader->header = no_header;
    reader->header.is_tube = strcasecmp(type, "Tube") == 0;
    return STATUS_OK;
}

/* Handles a line "Key = value". Unknown keys are ignored. */
static Status read_key(TubeReader *reader, const char *key, char *value, Err *err)
{
    TubeHeader *header = &reader->header;
    if (strcasecmp(key, "ObjectType") == 0)
        return begin_object(reader, value, err);
    if (strcasecmp(key, "NDims") == 0)
        return field_integer(key, value, 2, 3, &header->dimensions, err);
    if (strcasecmp(key, "Artery") == 0)
        header->artery = is_true(value);
    if (strcasecmp(key, "ID") == 0)
        header->id_text = value;
    if (strcasecmp(key, "ParentID") == 0)
        header->parent_text = value;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (strcasecmp(key, keys[k].name) == 0)
            return read_value(reader, k, value, err);
    return STATUS_OK;
}

/* ---- points ---- */

/* Converts a position from voxels to the space of the scene. */
static Vec3 scene_position(const TubeHeader *header, const double voxel[3])
{
    double out[3];
    for (size_t row = 0; row < 3; row++) {
        out[row] = header->center[row] + header->offset[row];
        for (size_t k = 0; k < 3; k++)
            out[row] +=
                header->matrix[3 * row + k] * (voxel[k] * header->spacing[k] - header->center[k]);
    }
    return vec3(out[0], out[1], out[2]);
}

/* Adds a point of the current tube with its numbers. A radius is multiplied by the first spacing,
 * as MetaIO does. */
static Status add_point(TubeReader *reader, const double *number, Err *err)
{
    const TubeHeader *header = &reader->header;
    Graph *graph = reader->graph;
    size_t at = graph->n_points;
    double voxel[3] = {0, 0, 0};
    GraphPoint point = {.radius = (double)NAN, .record = reader->cursor.line};
    for (size_t k = 0; k < header->n_columns; k++) {
        if (header->meaning[k] == MEANS_RADIUS)
            point.radius = number[k] * header->spacing[0];
        else if (header->meaning[k] < 0)
            voxel[header->meaning[k] - MEANS_X] = number[k];
    }
    point.position = scene_position(header, voxel);
    point.is_inlet = header->is_root && at == reader->objects.items[reader->objects.n - 1].first;
    TRY(graph_point(graph, &point, err));
    for (size_t k = 0; k < header->n_columns; k++)
        if (header->meaning[k] >= 0)
            TRY(graph_value(graph, (size_t)header->meaning[k], at, number[k], err));
    TRY(graph_value(graph, TUBE, at, header->id, err));
    if (!isnan(header->artery))
        TRY(graph_value(graph, ARTERY, at, header->artery, err));
    return STATUS_OK;
}

static Status read_row(TubeReader *reader, Err *err)
{
    double number[MAX_COLUMNS];
    size_t n = reader->header.n_columns;
    char *line = cursor_line(&reader->cursor);
    if (!line)
        return err_set(err, STATUS_INPUT, "the file ends within the points of a tube");
    size_t found = 0;
    TRY(fields_check_commas(line, err));
    for (const char *at = line; found < n && number_take(&at, &number[found]); found++)
        at += strspn(at, TEXT_BLANKS);
    if (reader->header.has_point_dim ? !numbers_parse(line, n, number) : found < n)
        return err_set(err, STATUS_INPUT,
                       "the point is '%.40s'; it must be %zu numbers, as PointDim states", line, n);
    return add_point(reader, number, err);
}

/* Reads the binary points of a tube, and moves to the next object. */
static Status read_binary(TubeReader *reader, Err *err)
{
    const TubeHeader *header = &reader->header;
    Cursor *cursor = &reader->cursor;
    double number[MAX_COLUMNS];
    size_t n = header->n_columns, size = n * vtk_type_size(header->type);
    if ((size_t)header->points > cursor_left(cursor) / size)
        return err_set(err, STATUS_INPUT,
                       "the file ends within the points of a tube, which take %.0f bytes",
                       (double)header->points * (double)size);
    for (int32_t i = 0; i < header->points; i++, cursor->at += size) {
        vtk_numbers(header->type, header->is_big_endian, cursor->at, n, number);
        TRY(add_point(reader, number, err));
    }
    const char *next = memmem(cursor->at, cursor_left(cursor), "ObjectType", 10);
    cursor->at = next ? cursor->at + (next - cursor->at) : cursor->end;
    return STATUS_OK;
}

static bool has(const TubeHeader *header, Meaning meaning)
{
    for (size_t k = 0; k < header->n_columns; k++)
        if (header->meaning[k] == (int32_t)meaning)
            return true;
    return false;
}

static Status check_header(const TubeHeader *header, bool gives_radius, Err *err)
{
    if (header->points < 0)
        return err_set(err, STATUS_INPUT, "the tube has no NPoints");
    if (!has(header, MEANS_X) || !has(header, MEANS_Y) ||
        (header->dimensions == 3 && !has(header, MEANS_Z)) ||
        (!has(header, MEANS_RADIUS) && !gives_radius))
        return err_set(err, STATUS_INPUT, "PointDim must name x, y%s and a radius",
                       header->dimensions == 3 ? ", z" : "");
    return STATUS_OK;
}

/* Assumes the order in which MetaIO writes the numbers of a point. Numbers after the radius, such
 * as colors, have no name. Binary points are refused, because only PointDim states their size. */
static Status assume_point_dim(TubeReader *reader, Err *err)
{
    static const int32_t order[] = {MEANS_X, MEANS_Y, MEANS_Z, MEANS_RADIUS};
    TubeHeader *header = &reader->header;
    if (header->is_binary)
        return err_set(
            err, STATUS_INPUT,
            "the tube has binary points, but no PointDim, which must name their numbers");
    for (size_t k = 0; k < 4; k++)
        if (k != 2 || header->dimensions == 3)
            header->meaning[header->n_columns++] = order[k];
    if (reader->assumed++ > 0)
        return STATUS_OK;
    return reading_note(
        reader->graph->reading, err,
        "a tube has no PointDim; assumed that each row begins with x, y, z and radius");
}

/* Reads the points of a tube, and connects them by lines. */
static Status read_tube(TubeReader *reader, Err *err)
{
    TubeHeader *header = &reader->header;
    Graph *graph = reader->graph;
    if (!header->has_point_dim)
        TRY(assume_point_dim(reader, err));
    TRY(check_header(header, graph->options && graph->options->radius_mm > 0, err));
    TRY(add_object(reader, err));
    TubeObject *object = &reader->objects.items[reader->objects.n - 1];
    if (header->is_binary)
        TRY(read_binary(reader, err));
    for (int32_t i = 0; !header->is_binary && i < header->points; i++)
        TRY(read_row(reader, err));
    object->count = (size_t)header->points;
    for (size_t i = object->first + 1; i < object->first + object->count; i++)
        TRY(graph_line(
            graph, &(GraphLine){.a = i - 1, .b = i, .radius = (double)NAN, .record = object->line},
            err));
    reader->header = no_header;
    return STATUS_OK;
}

static Status read_line(TubeReader *reader, char *line, Err *err)
{
    char *equals = strchr(line, '=');
    if (equals)
        *equals = '\0';
    const char *key = text_trim(line);
    if (!equals && strcasecmp(key, "Points") != 0)
        return STATUS_OK;
    if (strcasecmp(key, "Points") == 0)
        return reader->header.is_tube ? read_tube(reader, err) : STATUS_OK;
    return read_key(reader, key, text_trim(equals + 1), err);
}

/* ---- children ---- */

/* Returns the point of an object that is nearest to a position. */
static size_t nearest(const Graph *graph, const TubeObject *object, Vec3 to)
{
    size_t best = object->first;
    for (size_t i = object->first; i < object->first + object->count; i++)
        if (vec3_distance(graph->point[i].position, to) <
            vec3_distance(graph->point[best].position, to))
            best = i;
    return best;
}

/* A line that leads from a point of the parent to an end of the tube. */
typedef struct TubeLink {
    size_t from, to;
    double distance;
} TubeLink;

/* Returns the line to an end of the tube from the parent's point that the tube names or, if it
 * names none, from the parent's nearest point. */
static TubeLink link_to(const Graph *graph, const TubeObject *tube, const TubeObject *parent,
                        size_t end)
{
    Vec3 at = graph->point[end].position;
    size_t from = tube->parent_point < 0 ? nearest(graph, parent, at)
                                         : parent->first + (size_t)tube->parent_point;
    return (TubeLink){from, end, vec3_distance(graph->point[from].position, at)};
}

/* Connects a tube to its parent by the shorter of the lines to its two ends. */
static Status connect_to_parent(const TubeReader *reader, const TubeObject *tube, Err *err)
{
    Graph *graph = reader->graph;
    size_t number;
    if (!tube->parent || tube->count == 0)
        return STATUS_OK;
    TRY(names_find(&reader->ids, tube->parent, &number, err));
    const TubeObject *parent = &reader->objects.items[number];
    if (parent->is_moved)
        return err_set(err, STATUS_INPUT,
                       "object %d transforms the objects in it, which is not supported",
                       parent->id);
    if (parent->count == 0 || parent == tube)
        return STATUS_OK;
    if (tube->parent_point >= 0 && (size_t)tube->parent_point >= parent->count)
        return err_set(err, STATUS_INPUT,
                       "ParentPoint is %d; tube %d has %zu points, counted from 0",
                       tube->parent_point, parent->id, parent->count);
    TubeLink first = link_to(graph, tube, parent, tube->first);
    TubeLink last = link_to(graph, tube, parent, tube->first + tube->count - 1);
    TubeLink link = last.distance < first.distance ? last : first;
    return graph_line(graph,
                      &(GraphLine){.a = link.from,
                                   .b = link.to,
                                   .radius = graph->point[link.to].radius,
                                   .is_directed = true,
                                   .record = tube->line},
                      err);
}

/* Reads all objects, and connects tubes to their parents. */
static Status read_all(TubeReader *reader, Err *err)
{
    Graph *graph = reader->graph;
    size_t column;
    TRY(graph_column(graph, GRAPH_POINTS, "tube", "", &column, err));
    TRY(graph_column(graph, GRAPH_POINTS, "artery", "", &column, err));
    for (char *line; (line = cursor_line(&reader->cursor));)
        TRY(cursor_locate_error(&reader->cursor, read_line(reader, line, err), err));
    if (reader->objects.n == 0)
        return err_set(err, STATUS_INPUT, "%s: the file has no tube", graph->name);
    for (size_t i = 0; i < reader->objects.n; i++)
        TRY(graph_blame(graph, GRAPH_LINES, reader->objects.items[i].line,
                        connect_to_parent(reader, &reader->objects.items[i], err), err));
    return STATUS_OK;
}

Status metaio_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    TubeReader reader = {.graph = graph,
                         .cursor = cursor_of(graph->name, NULL, bytes, size),
                         .header = no_header,
                         .ids = {.what = "object with the ID"}};
    Status status = read_all(&reader, err);
    ARRAY_RELEASE(&reader.objects);
    names_release(&reader.ids);
    return status;
}

bool metaio_detect(const char *start)
{
    return strncasecmp(text_first_row(start), "ObjectType", strlen("ObjectType")) == 0;
}
