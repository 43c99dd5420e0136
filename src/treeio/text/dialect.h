/* Reads text formats that have one point or segment per row. Private to the submodule treeio/text.
 *
 * A format is described by a Dialect: a table of its sections, a table of the fields of their rows,
 * and up to three functions. A row is a line that was split into fields. A field is a word of a
 * row; a column is an array of the tree that fields fill. `choose` finds the section of a row,
 * `comment` reads a comment, and DialectSection.read completes a row where the tables do not
 * suffice. dialect_read reads all lines and adds the points to the graph. dialect_add_segments then
 * adds the segments, because a segment may refer to a point that comes later in the file.
 *
 *     DialectReader reader = {.dialect = &vmv, .graph = graph, .points = {.what = "vertex"}};
 *     status = dialect_read(&reader, text, size, err);
 *     if (status == STATUS_OK)
 *         status = dialect_add_segments(&reader, err);
 *     dialect_release(&reader); */
#ifndef CORCAST_TREEIO_TEXT_DIALECT_H
#define CORCAST_TREEIO_TEXT_DIALECT_H

#include "tree/tree.h"
#include "treeio/names.h"

/* The meaning of a field. A row with a FIELD_POINT adds a point. A row with a FIELD_TO or FIELD_END
 * adds a segment. */
typedef enum FieldRole {
    FIELD_POINT,    /* name of the row's point */
    FIELD_OF_POINT, /* name of an earlier point, to which the row's columns belong */
    FIELD_SEGMENT,  /* name of the row's segment */
    FIELD_POSITION, /* x of the point; the next two fields are y and z */
    FIELD_START,    /* x of the segment's proximal end, a point without a name; then y, z */
    FIELD_END,      /* x of the segment's distal end, a point without a name; then y, z */
    FIELD_FROM,     /* name of the segment's proximal point, which may come later in the file */
    FIELD_TO,       /* name of the segment's distal point, which may come later in the file */
    FIELD_RADIUS,   /* radius of the row's point or segment */
    FIELD_DIAMETER, /* diameter of the row's point or segment */
    FIELD_AREA,     /* cross-sectional area of the row's point or segment */
    FIELD_NUMBER,   /* a value for a column that every tree of the format has */
    FIELD_VALUE     /* a value of an optional column, which is made at the first row that has a
                     * value; the text NA stands for no value */
} FieldRole;

/* A field of the rows of a section. */
typedef struct DialectField {
    size_t section; /* index in Dialect.section */
    size_t at;      /* index of the field in a row, from 0 */
    FieldRole role;
    const char *name, *unit; /* name of the field, for errors and columns; unit of the column */
    bool not_negative;       /* numbers below 0 are refused */
} DialectField;

/* A row. All strings are borrowed from the text of the file. */
typedef struct DialectRow {
    char **field; /* `count` fields */
    size_t count;
    size_t line;    /* line in the file, from 1 */
    size_t element; /* index of the point or segment that the row's columns belong to */
    bool has_point, has_segment;
    GraphPoint point;
    GraphPoint start, end; /* ends of the segment that are points without names */
    char *from, *to;       /* names of the segment's ends; NULL: `start` and `end` are the ends */
    GraphLine segment;
} DialectRow;

typedef struct DialectReader DialectReader;
/* Completes a row whose fields have been read: changes *row, or adds points to reader->graph.
 * Errors: STATUS_INPUT, without file and line; STATUS_MEMORY. */
typedef Status ReadDialectRow(DialectReader *reader, DialectRow *row, Err *err);

/* A section of the format. */
typedef struct DialectSection {
    const char *title;             /* compared without regard to case */
    const char *row;               /* the word for a row in errors: "a vessel" */
    size_t min_fields, max_fields; /* number of fields in a row; max_fields of 0: any number */
    GraphElement of;      /* the element that a row adds, and to which its columns belong */
    ReadDialectRow *read; /* called after the fields were read, and before the row's point or
                           * segment is added; NULL: the tables suffice */
} DialectSection;

/* The description of a format. The tables are borrowed. */
typedef struct Dialect {
    const DialectSection *section;
    size_t n_sections;
    const DialectField *field;
    size_t n_fields;
    const char *none; /* text in place of a missing number of any other role; NULL: numbers must not
                       * be missing */
    /* Reads the text after the '#' of a comment. NULL: the format has no comments. */
    Status (*comment)(Graph *graph, const char *comment, Err *err);
    /* Sets reader->section to the section of a line, which was split into the fields of *row. Sets
     * *is_row to false if the line is not a row, for example if it is a title. */
    Status (*choose)(DialectReader *reader, DialectRow *row, bool *is_row, Err *err);
} Dialect;

/* A segment that will be added after all points. */
typedef struct DialectSegment {
    char *from, *to; /* names of the end points; NULL: `line` already has their indices */
    GraphLine line;
} DialectSegment;

struct DialectReader {
    const Dialect *dialect;
    Graph *graph;
    void *own;      /* data of the format, for its functions */
    size_t section; /* index of the current section; n_sections: none yet */
    size_t skip;    /* number of lines to skip at the beginning of the text */
    Names points, segments;
    ARRAY(DialectSegment)
    pending; /* all segments, in the order of the file; dialect_add_segments sets the indices of
              * their points */
    ARRAY(char *) fields;
    size_t *column; /* per field of Dialect.field: 1 + the index of its column; 0: none yet */
};

/* Reads all lines of a text, and adds the points to the graph.
 *
 * reader   the caller sets dialect, graph, own and skip, and the words for points and segments in
 *          errors (points.what, segments.what). It zeroes the rest, and releases the reader with
 *          dialect_release, even after an error.
 * text     `size` characters and a zero. It is split in place, and must outlive the reader.
 * Errors   STATUS_INPUT, with file and line; STATUS_MEMORY. */
MUST_CHECK Status dialect_read(DialectReader *reader, char *text, size_t size, Err *err);
/* Adds the segments to the graph, and sets the indices of their points in reader->pending. Errors:
 * STATUS_INPUT, with file and line, for a name that no point has; STATUS_MEMORY. */
MUST_CHECK Status dialect_add_segments(DialectReader *reader, Err *err);
void dialect_release(DialectReader *reader);

/* Returns the index of the section called `title`, or n_sections if there is none. */
size_t dialect_find_section(const Dialect *dialect, const char *title);

#endif
