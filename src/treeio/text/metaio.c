/* Tubes of MetaIO scenes (.tre), as MetaIO's metaTube.cxx and ITK's converter of tubes read them: a
 * header "Key = value" for each object, which ends with "Points =" or "Points", and then the
 * points, a row of text each or packed numbers. PointDim says what the numbers of a point are;
 * without it they are x, y, z (if NDims is 3), the radius, and numbers that are left out. Positions
 * and radii are in voxels of ElementSpacing; TransformMatrix, CenterOfRotation and Offset move
 * them.
 *
 * Older versions of MetaIO reserve more room for packed points than they fill: what lies between
 * the last point and the next object is skipped. Children lead away from their parents, so that a
 * tube hangs with one end on its parent's point, or on the nearest one where none is said. */
#include "treeio/formats.h"
#include "treeio/names.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_COLUMNS = 200 };

typedef enum ElementType { ELEMENT_FLOAT, ELEMENT_DOUBLE, ELEMENT_TYPES } ElementType;

static const char *const element_types[] = {
    [ELEMENT_FLOAT] = "MET_FLOAT", [ELEMENT_DOUBLE] = "MET_DOUBLE"};
static const size_t element_sizes[] = {[ELEMENT_FLOAT] = 4, [ELEMENT_DOUBLE] = 8};

/* What its header says of an object. */
typedef struct Header {
    bool is_tube, is_root, is_binary, is_big_endian;
    double artery;                                /* 1 or 0; NAN: not said */
    int32_t dimensions, id, parent, parent_point; /* -1: none */
    char *id_text, *parent_text;                  /* borrowed */
    int32_t points;
    double spacing[3], matrix[9], center[3], offset[3];
    ElementType type;
    bool has_point_dim;
    size_t n_columns;
    int32_t meaning[MAX_COLUMNS]; /* of each number of a point: a Meaning, or a column */
} Header;

/* Numbers of a point that are no columns. */
typedef enum Meaning { MEANS_X = -4, MEANS_Y, MEANS_Z, MEANS_RADIUS } Meaning;

/* An object that has been read; points, of a tube, as the graph numbers them. */
typedef struct Object {
    int32_t id, parent_point;
    char *parent; /* its ID; NULL: it has none */
    size_t first, count;
    size_t line;
    bool is_moved; /* by a matrix or an offset */
} Object;

/* The first columns of the graph; behind them come those of PointDim. */
enum { TUBE, ARTERY, OWN_COLUMNS };

typedef struct Reader {
    Graph *graph;
    char *at, *end;
    size_t line; /* number of the one read last */
    Header header;
    Object *object;
    size_t n_objects, capacity;
    const char *column[MAX_COLUMNS]; /* names of PointDim that are columns (borrowed) */
    size_t n_columns;
    Names ids;      /* of objects */
    size_t assumed; /* tubes without PointDim */
} Reader;

static const Header no_header = {.artery = (double)NAN,
                                 .dimensions = 3,
                                 .id = -1,
                                 .parent = -1,
                                 .parent_point = -1,
                                 .points = -1,
                                 .spacing = {1, 1, 1},
                                 .matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

/* The next line, cut off in place without its end; NULL behind the last. */
static char *next_line(Reader *reader)
{
    if (reader->at == reader->end)
        return NULL;
    char *line = reader->at, *stop = memchr(line, '\n', (size_t)(reader->end - line));
    reader->line++;
    reader->at = stop ? stop + 1 : reader->end;
    if (!stop)
        stop = reader->end;
    *stop = '\0';
    if (stop > line && stop[-1] == '\r')
        stop[-1] = '\0';
    return line;
}

/* ---- headers ---- */

static bool is_true(const char *value)
{
    return *value == 'T' || *value == 't' || *value == '1';
}

static Status read_numbers(const char *key, const char *value, size_t count, double *out, Err *err)
{
    double number[9];
    if (!numbers_parse(value, count, number))
        return err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be %zu numbers", key, value,
                       count);
    memcpy(out, number, count * sizeof *out);
    return STATUS_OK;
}

/* A matrix of as many rows and columns as there are dimensions. */
static Status read_matrix(Header *header, const char *value, Err *err)
{
    size_t n = (size_t)header->dimensions;
    double number[9];
    TRY(read_numbers("TransformMatrix", value, n * n, number, err));
    for (size_t i = 0; i < n; i++)
        memcpy(&header->matrix[3 * i], &number[n * i], n * sizeof *number);
    return STATUS_OK;
}

static Status read_type(Header *header, const char *value, Err *err)
{
    for (int type = 0; type < ELEMENT_TYPES; type++) {
        if (strcasecmp(value, element_types[type]) == 0) {
            header->type = (ElementType)type;
            return STATUS_OK;
        }
    }
    return err_set(err, STATUS_INPUT, "ElementType is '%.40s'; it must be MET_FLOAT or MET_DOUBLE",
                   value);
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

/* The column of a name of PointDim, in *column. */
static Status find_column(Reader *reader, const char *name, int32_t *column, Err *err)
{
    size_t k = 0, number;
    while (k < reader->n_columns && strcmp(reader->column[k], name) != 0)
        k++;
    if (k == MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "PointDim names more than %d numbers", MAX_COLUMNS);
    if (k == reader->n_columns) {
        TRY(graph_column(reader->graph, GRAPH_POINTS, name, "", &number, err));
        reader->column[reader->n_columns++] = name;
    }
    *column = OWN_COLUMNS + (int32_t)k;
    return STATUS_OK;
}

static Status read_point_dim(Reader *reader, char *value, Err *err)
{
    Header *header = &reader->header;
    header->n_columns = 0;
    header->has_point_dim = true;
    for (char *name; (name = text_field(&value)); header->n_columns++) {
        if (header->n_columns == MAX_COLUMNS)
            return err_set(err, STATUS_INPUT, "PointDim names more than %d numbers", MAX_COLUMNS);
        int32_t *meaning = &header->meaning[header->n_columns];
        *meaning = meaning_of(name);
        if (*meaning == 0)
            TRY(find_column(reader, name, meaning, err));
    }
    return STATUS_OK;
}

/* What the value of a key is, and where it goes. */
typedef enum KeyKind {
    KEY_TRUTH,
    KEY_WHOLE,
    KEY_VECTOR,
    KEY_MATRIX,
    KEY_TYPE,
    KEY_COLUMNS
} KeyKind;

static const struct {
    const char *name;
    KeyKind kind;
    size_t member; /* of the header, where the kind has one */
} keys[] = {
    {"ID", KEY_WHOLE, offsetof(Header, id)},
    {"ParentID", KEY_WHOLE, offsetof(Header, parent)},
    {"ParentPoint", KEY_WHOLE, offsetof(Header, parent_point)},
    {"NPoints", KEY_WHOLE, offsetof(Header, points)},
    {"Root", KEY_TRUTH, offsetof(Header, is_root)},
    {"BinaryData", KEY_TRUTH, offsetof(Header, is_binary)},
    {"BinaryDataByteOrderMSB", KEY_TRUTH, offsetof(Header, is_big_endian)},
    {"ElementByteOrderMSB", KEY_TRUTH, offsetof(Header, is_big_endian)},
    {"ElementSpacing", KEY_VECTOR, offsetof(Header, spacing)},
    {"CenterOfRotation", KEY_VECTOR, offsetof(Header, center)},
    {"Offset", KEY_VECTOR, offsetof(Header, offset)},
    {"Position", KEY_VECTOR, offsetof(Header, offset)},
    {"TransformMatrix", KEY_MATRIX, 0},
    {"Orientation", KEY_MATRIX, 0},
    {"ElementType", KEY_TYPE, 0},
    {"PointDim", KEY_COLUMNS, 0},
};

static Status read_value(Reader *reader, size_t k, char *value, Err *err)
{
    Header *header = &reader->header;
    void *member = (char *)header + keys[k].member;
    switch (keys[k].kind) {
    case KEY_TRUTH:
        *(bool *)member = is_true(value);
        return STATUS_OK;
    case KEY_WHOLE:
        return field_whole(keys[k].name, value, -1, INT32_MAX, member, err);
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

static bool is_moved(const Header *header)
{
    return memcmp(header->matrix, no_header.matrix, sizeof header->matrix) != 0 ||
           memcmp(header->offset, no_header.offset, sizeof header->offset) != 0;
}

/* Keeps the object whose header has been read. */
static Status add_object(Reader *reader, Err *err)
{
    const Header *header = &reader->header;
    TRY(mem_reserve(&reader->object, &reader->capacity, reader->n_objects + 1,
                    sizeof *reader->object, "objects", err));
    reader->object[reader->n_objects] =
        (Object){.id = header->id,
                 .parent = header->parent < 0 ? NULL : header->parent_text,
                 .parent_point = header->parent_point,
                 .first = reader->graph->n_points,
                 .line = reader->line,
                 .is_moved = is_moved(header)};
    if (header->id >= 0)
        TRY(names_add(&reader->ids, header->id_text, reader->n_objects, reader->line, err));
    reader->n_objects++;
    return STATUS_OK;
}

/* A new object begins; one without points has ended with its header. */
static Status begin_object(Reader *reader, const char *type, Err *err)
{
    if (!reader->header.is_tube && reader->header.id >= 0)
        TRY(add_object(reader, err));
    reader->header = no_header;
    reader->header.is_tube = strcasecmp(type, "Tube") == 0;
    return STATUS_OK;
}

static Status read_key(Reader *reader, const char *key, char *value, Err *err)
{
    Header *header = &reader->header;
    if (strcasecmp(key, "ObjectType") == 0)
        return begin_object(reader, value, err);
    if (strcasecmp(key, "NDims") == 0)
        return field_whole(key, value, 2, 3, &header->dimensions, err);
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

/* From voxels to where the object is. */
static Vec3 place(const Header *header, const double voxel[3])
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

static Status add_point(Reader *reader, const double *number, Err *err)
{
    const Header *header = &reader->header;
    Graph *graph = reader->graph;
    size_t at = graph->n_points;
    double voxel[3] = {0, 0, 0};
    GraphPoint point = {.radius = (double)NAN, .record = reader->line};
    for (size_t k = 0; k < header->n_columns; k++) {
        if (header->meaning[k] == MEANS_RADIUS)
            point.radius = number[k] * header->spacing[0];
        else if (header->meaning[k] < 0)
            voxel[header->meaning[k] - MEANS_X] = number[k];
    }
    point.position = place(header, voxel);
    point.is_inlet = header->is_root && at == reader->object[reader->n_objects - 1].first;
    TRY(graph_point(graph, &point, err));
    for (size_t k = 0; k < header->n_columns; k++)
        if (header->meaning[k] >= 0)
            TRY(graph_value(graph, (size_t)header->meaning[k], at, number[k], err));
    TRY(graph_value(graph, TUBE, at, header->id, err));
    if (!isnan(header->artery))
        TRY(graph_value(graph, ARTERY, at, header->artery, err));
    return STATUS_OK;
}

static Status read_row(Reader *reader, Err *err)
{
    double number[MAX_COLUMNS];
    size_t n = reader->header.n_columns;
    char *line = next_line(reader);
    if (!line)
        return err_set(err, STATUS_INPUT, "the file ends within the points of a tube");
    size_t found = 0;
    TRY(fields_check_commas(line, err));
    for (const char *at = line; found < n && number_take(&at, &number[found]); found++)
        at += strspn(at, TEXT_BLANKS);
    if (reader->header.has_point_dim ? !numbers_parse(line, n, number) : found < n)
        return err_set(err, STATUS_INPUT, "the point '%.40s' is not the %zu numbers of PointDim",
                       line, n);
    return add_point(reader, number, err);
}

static double unpack(const char *bytes, size_t size, bool is_big_endian)
{
    unsigned char native[8];
    for (size_t i = 0; i < size; i++)
        native[i] = (unsigned char)bytes[is_big_endian ? size - 1 - i : i];
    float single;
    double number;
    if (size == sizeof single) {
        memcpy(&single, native, sizeof single);
        return (double)single;
    }
    memcpy(&number, native, sizeof number);
    return number;
}

static Status read_packed(Reader *reader, Err *err)
{
    const Header *header = &reader->header;
    double number[MAX_COLUMNS];
    size_t size = element_sizes[header->type], n = header->n_columns;
    if ((size_t)header->points > (size_t)(reader->end - reader->at) / (n * size))
        return err_set(err, STATUS_INPUT,
                       "the file ends within the points of a tube, which are to take %.0f bytes",
                       (double)header->points * (double)(n * size));
    for (int32_t i = 0; i < header->points; i++) {
        for (size_t k = 0; k < n; k++, reader->at += size)
            number[k] = unpack(reader->at, size, header->is_big_endian);
        TRY(add_point(reader, number, err));
    }
    const char *next = memmem(reader->at, (size_t)(reader->end - reader->at), "ObjectType", 10);
    reader->at = next ? reader->at + (next - reader->at) : reader->end;
    return STATUS_OK;
}

static bool has(const Header *header, Meaning meaning)
{
    for (size_t k = 0; k < header->n_columns; k++)
        if (header->meaning[k] == (int32_t)meaning)
            return true;
    return false;
}

static Status check_header(const Header *header, bool gives_radius, Err *err)
{
    if (header->points < 0)
        return err_set(err, STATUS_INPUT, "the tube does not say NPoints");
    if (!has(header, MEANS_X) || !has(header, MEANS_Y) ||
        (header->dimensions == 3 && !has(header, MEANS_Z)) ||
        (!has(header, MEANS_RADIUS) && !gives_radius))
        return err_set(err, STATUS_INPUT, "PointDim must name x, y%s and a radius",
                       header->dimensions == 3 ? ", z" : "");
    return STATUS_OK;
}

/* Without PointDim, the numbers of a point are in the order in which MetaIO writes them. What
 * follows the radius, as a colour, has no name. Packed points have a size that only PointDim
 * states. */
static Status assume_point_dim(Reader *reader, Err *err)
{
    static const int32_t order[] = {MEANS_X, MEANS_Y, MEANS_Z, MEANS_RADIUS};
    Header *header = &reader->header;
    if (header->is_binary)
        return err_set(err, STATUS_INPUT, "packed points need PointDim, which names their numbers");
    for (size_t k = 0; k < 4; k++)
        if (k != 2 || header->dimensions == 3)
            header->meaning[header->n_columns++] = order[k];
    if (reader->assumed++ > 0)
        return STATUS_OK;
    return reading_note(reader->graph->reading, err,
                        "a tube without PointDim has x, y, z and the radius first in each row");
}

static Status read_tube(Reader *reader, Err *err)
{
    Header *header = &reader->header;
    Graph *graph = reader->graph;
    if (!header->has_point_dim)
        TRY(assume_point_dim(reader, err));
    TRY(check_header(header, graph->options && graph->options->radius_mm > 0, err));
    TRY(add_object(reader, err));
    Object *object = &reader->object[reader->n_objects - 1];
    if (header->is_binary)
        TRY(read_packed(reader, err));
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

static Status read_line(Reader *reader, char *line, Err *err)
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

static size_t nearest(const Graph *graph, const Object *object, Vec3 to)
{
    size_t best = object->first;
    for (size_t i = object->first; i < object->first + object->count; i++)
        if (vec3_distance(graph->point[i].position, to) <
            vec3_distance(graph->point[best].position, to))
            best = i;
    return best;
}

/* A line that leads from a point of the parent to an end of the tube. */
typedef struct Link {
    size_t from, to;
    double distance;
} Link;

/* From the point that the tube names, or else the nearest one, to the end. */
static Link link_to(const Graph *graph, const Object *tube, const Object *parent, size_t end)
{
    Vec3 at = graph->point[end].position;
    size_t from = tube->parent_point < 0 ? nearest(graph, parent, at)
                                         : parent->first + (size_t)tube->parent_point;
    return (Link){from, end, vec3_distance(graph->point[from].position, at)};
}

static Status hang(const Reader *reader, const Object *tube, Err *err)
{
    Graph *graph = reader->graph;
    size_t number;
    if (!tube->parent || tube->count == 0)
        return STATUS_OK;
    TRY(names_find(&reader->ids, tube->parent, &number, err));
    const Object *parent = &reader->object[number];
    if (parent->is_moved)
        return err_set(err, STATUS_INPUT,
                       "the object %d moves those that it holds, which is not read", parent->id);
    if (parent->count == 0 || parent == tube)
        return STATUS_OK;
    if (tube->parent_point >= 0 && (size_t)tube->parent_point >= parent->count)
        return err_set(err, STATUS_INPUT, "ParentPoint is %d; tube %d has %zu points",
                       tube->parent_point, parent->id, parent->count);
    Link first = link_to(graph, tube, parent, tube->first);
    Link last = link_to(graph, tube, parent, tube->first + tube->count - 1);
    Link link = last.distance < first.distance ? last : first;
    return graph_line(graph,
                      &(GraphLine){.a = link.from,
                                   .b = link.to,
                                   .radius = graph->point[link.to].radius,
                                   .is_directed = true,
                                   .record = tube->line},
                      err);
}

static Status read_all(Reader *reader, Err *err)
{
    Graph *graph = reader->graph;
    size_t column;
    TRY(graph_column(graph, GRAPH_POINTS, "tube", "", &column, err));
    TRY(graph_column(graph, GRAPH_POINTS, "artery", "", &column, err));
    for (char *line; (line = next_line(reader));)
        TRY(graph_blame(graph, GRAPH_LINES, reader->line, read_line(reader, line, err), err));
    if (reader->n_objects == 0)
        return err_set(err, STATUS_INPUT, "%s: there is no tube in the file", graph->name);
    for (size_t i = 0; i < reader->n_objects; i++)
        TRY(graph_blame(graph, GRAPH_LINES, reader->object[i].line,
                        hang(reader, &reader->object[i], err), err));
    return STATUS_OK;
}

Status metaio_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    Reader reader = {.graph = graph,
                     .at = bytes,
                     .end = bytes + size,
                     .header = no_header,
                     .ids = {.what = "object of the ID"}};
    Status status = read_all(&reader, err);
    free(reader.object);
    names_release(&reader.ids);
    return status;
}

bool metaio_detect(const char *start)
{
    return strncasecmp(text_first_row(start), "ObjectType", strlen("ObjectType")) == 0;
}
