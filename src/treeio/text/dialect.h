/* Reads text formats of networks that have one element per row, by tables of sections and fields.
 *
 * A format states its sections, the fields of their rows, and at most three functions: which
 * section a line belongs to, what a row means beyond its fields, and what is missing at the end. */
#ifndef CORCAST_TREEIO_DIALECT_H
#define CORCAST_TREEIO_DIALECT_H

#include "tree/tree.h"
#include "treeio/names.h"

/* The meaning of a field. A row adds a point if it has FIELD_POINT, and a segment if it has
 * FIELD_TO or FIELD_END. */
typedef enum FieldRole {
    FIELD_POINT,    /* name of the row's point */
    FIELD_OF_POINT, /* name of an earlier point, to which the row's columns belong */
    FIELD_SEGMENT,  /* name of the row's segment */
    FIELD_POSITION, /* x of the point; the next two fields are y and z */
    FIELD_START,    /* x of the segment's proximal end, a point without a name; then y, z */
    FIELD_END,      /* the same for the distal end */
    FIELD_FROM,     /* name of the segment's proximal point, which may come later */
    FIELD_TO,       /* name of the segment's distal point */
    FIELD_RADIUS,   /* of the row's point or segment */
    FIELD_DIAMETER, /* the same */
    FIELD_AREA,     /* of the cross-section: the same */
    FIELD_NUMBER,   /* a column, which exists in every tree of the format */
    FIELD_VALUE     /* a column, which exists if a row has it; NA is no value */
} FieldRole;

typedef struct DialectField {
    size_t section, at; /* index of the section; index of the field in a row */
    FieldRole role;
    const char *name, *unit; /* what the field is called; its column's unit */
    bool not_negative;       /* a number below 0 is refused */
} DialectField;

/* A row. All texts are borrowed from the file. */
typedef struct DialectRow {
    char **field;
    size_t count, line;
    size_t element; /* index of the point or segment that the row's columns belong to */
    bool has_point, has_segment;
    GraphPoint point, start, end; /* the row's point; the segment's own ends */
    char *from, *to;              /* names of the segment's ends; NULL: they are its own */
    GraphLine segment;
} DialectRow;

typedef struct DialectReader DialectReader;
typedef Status ReadDialectRow(DialectReader *reader, DialectRow *row, Err *err);

typedef struct DialectSection {
    const char *title;             /* matches without regard to case */
    const char *row;               /* what a row is called in errors, "a vessel" */
    size_t min_fields, max_fields; /* of a row; max_fields of 0: any number */
    GraphElement of;               /* what the rows add, and what their columns belong to */
    ReadDialectRow *read; /* called when the fields were read, before the row's elements are
                           * added; NULL: the fields are all */
} DialectSection;

typedef struct Dialect {
    const DialectSection *section;
    size_t n_sections;
    const DialectField *field;
    size_t n_fields;
    const char *none; /* text of a number that is missing; NULL: none may be */
    Status (*comment)(Graph *graph, const char *comment, Err *err); /* NULL: no comments */
    /* Sets reader->section for a row, or returns false in *is_row for a line that is no row. */
    Status (*choose)(DialectReader *reader, DialectRow *row, bool *is_row, Err *err);
} Dialect;

/* A segment, which is added when all points are there. */
typedef struct DialectSegment {
    char *from, *to; /* names of its points; NULL: `line` has their indices */
    GraphLine line;
} DialectSegment;

struct DialectReader {
    const Dialect *dialect;
    Graph *graph;
    void *own;      /* of the format */
    size_t section; /* begins with n_sections: none */
    size_t skip;    /* number of lines to pass over */
    Names points, segments;
    ARRAY(DialectSegment) kept; /* all segments, in the order of the file */
    ARRAY(char *) fields;
    size_t *column; /* per field of the table: its column + 1; 0: none yet */
};

/* Reads all lines of a text. The caller releases the reader, also after an error.
 *
 * reader   begin with dialect, graph, own, the names of points and segments, and skip.
 * Errors   STATUS_INPUT, with file and line; STATUS_MEMORY. */
MUST_CHECK Status dialect_read(DialectReader *reader, char *text, size_t size, Err *err);
/* Adds the segments to the graph, and sets the points of each in reader->kept. Errors:
 * STATUS_INPUT, with file and line, for a name that no point has; STATUS_MEMORY. */
MUST_CHECK Status dialect_add_segments(DialectReader *reader, Err *err);
void dialect_release(DialectReader *reader);

/* Appends the titles of sections and the names of fields, one per line. */
void dialect_put_keywords(const Dialect *dialect, Text *text);
/* Returns the section of this title, or n_sections. */
size_t dialect_find_section(const Dialect *dialect, const char *title);

/* Reads three fields as a position. Errors: STATUS_INPUT, without file and line. */
MUST_CHECK Status field_position(char *const field[3], Vec3 *position, Err *err);

#endif
