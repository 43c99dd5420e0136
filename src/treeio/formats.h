/* The functions of the formats in the table of treeio.c, and what their texts share.
 *
 * A new format is a file of a submodule and a row of that table. The extension identifies it. If
 * several formats share an extension, and on standard input, a TreeDetect decides. A file that is a
 * tree, with ids and parents, has a TreeRead, which hands nodes to a TreeBuilder [tree/builder.h].
 * A file that is a network of points and lines has a GraphRead, which hands them to a Graph
 * [tree/graph.h]; treeio.c then makes a tree of it. Neither scales lengths. treeio.c applies the
 * user's options, except those that only the reader can apply (radius_array, columns, ...): the
 * reader finds them in graph->options, and its row lists them in `takes`. Assumptions go to
 * reading_note. treeio/xml.h parses XML, treeio/cursor.h cuts texts into lines and words,
 * treeio/text/dialect.h reads rows by tables of sections and fields. */
#ifndef CORCAST_TREEIO_FORMATS_H
#define CORCAST_TREEIO_FORMATS_H

#include "tree/tree.h"

/* Returns true if a file that begins with these bytes (zero-terminated) has the format. */
typedef bool TreeDetect(const char *start);
/* Hands a file to the builder. `bytes` is zero-terminated and may be changed; lines of a text end
 * with LF. Errors: STATUS_INPUT, with file and record; STATUS_MEMORY. */
typedef Status TreeRead(TreeBuilder *builder, char *bytes, size_t size, Err *err);
/* As TreeRead, to a graph, in the file's own unit. */
typedef Status GraphRead(Graph *graph, char *bytes, size_t size, Err *err);
/* Appends the file of a tree that tree_check accepts. The text may flow into a stream; the caller
 * checks it at the end. Errors: STATUS_INPUT, without the file's name, for a tree that the format
 * cannot hold; STATUS_MEMORY. */
typedef Status TreeWrite(const Tree *tree, Text *text, Err *err);
/* Returns true if a column of the tree is written, although the format writes no others. */
typedef bool TreeStores(const TreeColumn *column);
/* Appends the keywords of a format, one per line, from the tables of its reader. */
typedef void TreeKeywords(Text *text);

TreeStores swc_stores, oned_stores;
TreeKeywords csv_keywords, table_keywords, vtk_keywords, vtp_keywords, graphml_keywords,
    oned_keywords, vmv_keywords, vita_keywords, metaio_keywords, amira_keywords;
TreeDetect amira_detect, csv_detect, opencco_detect, metaio_detect, vtk_detect, vtp_detect,
    gxl_detect, graphml_detect, amiraxml_detect, pvd_detect, csv_segments_detect, oned_detect,
    vmv_detect, vita_detect;
TreeRead swc_read, csv_read, pvd_read;
GraphRead oned_read, vita_read, secomb_read, opencco_read, vmv_read, metaio_read, vtk_read,
    vtp_read, gxl_read, graphml_read, amiraxml_read, table_read, amira_read;
TreeWrite swc_write, csv_write, csv_segments_write, oned_write, vmv_write, vtk_write, vtp_write,
    gxl_write, graphml_write;

/* ---- limits ---- */

/* Limits of what a compressed or sparse file of `size` bytes may claim: bytes of unpacked numbers,
 * and points, lines or cells. Data of vessels take at least a byte per point and compress less than
 * 64 times. A file that claims more is refused before memory is allocated, even if the claim is
 * true. */
static inline double max_unpacked_bytes(size_t size)
{
    return 64e6 + 64 * (double)size;
}
static inline double max_elements(size_t size)
{
    return 1e6 + (double)size;
}
/* Checks a number of elements against max_elements. Errors: STATUS_INPUT, without the file's name.
 */
MUST_CHECK Status check_elements(const char *what, double count, size_t size, Err *err);
/* Checks bytes of numbers against max_unpacked_bytes. Errors: STATUS_INPUT, without the file's
 * name. */
MUST_CHECK Status check_unpacked(double bytes, size_t size, Err *err);

/* ---- fields ---- */

/* Returns the first character that is not blank after comments and empty lines. */
const char *text_first_row(const char *start);

/* Refuses a line that holds a number with a decimal comma, as "10,5" between blanks or semicolons:
 * a comma separates fields. Errors: STATUS_INPUT, without file and line. */
MUST_CHECK Status fields_check_commas(const char *line, Err *err);
/* Returns the end of a sentence that refuses a text: it names the decimal comma if the text has
 * one, and is "" otherwise. */
const char *decimal_comma_hint(const char *text);

/* Each of these reads one field, which errors call `what`. Errors: STATUS_INPUT, without file and
 * record.
 *
 * field_number reads a finite number of at least `minimum`; field_integer an integer in a range;
 * field_value a finite number, or NAN for an empty field, NA or NaN; field_radius a radius or a
 * diameter, or NAN for a bad one if the options repair radii [reading_radius]. */
MUST_CHECK Status field_number(const char *what, const char *text, double minimum, double *out,
                               Err *err);
MUST_CHECK Status field_integer(const char *what, const char *text, int32_t minimum,
                                int32_t maximum, int32_t *out, Err *err);
MUST_CHECK Status field_value(const char *what, const char *text, double *out, Err *err);
MUST_CHECK Status field_radius(const ReadOptions *options, const char *what, const char *text,
                               double *out, Err *err);

/* ---- CSV ---- */

/* Cuts the next field off a line of CSV, in place.
 *
 * at         the rest of the line; becomes NULL after the last field.
 * separator  if it is a blank, several blanks separate like one.
 * field      receives the field without blanks around it. A quoted field ends at a quote that no
 * other quote follows. Errors     STATUS_INPUT, without file and line, if a quote is not closed. */
MUST_CHECK Status csv_field(char **at, char separator, char **field, Err *err);
/* Cuts a row of CSV into its `n` fields, in place. Errors: as csv_field; STATUS_INPUT, without file
 * and line, for any other number of fields. */
MUST_CHECK Status csv_row(char *line, char separator, char **field, size_t n, Err *err);
/* Cuts "name [unit]" in two, in place. Returns the unit, or "" if there is none. */
const char *csv_unit(char *title);

/* The titles that a CSV of segments begins with, "id" first; NULL ends them. */
enum { CSV_SEGMENT_TITLES = 10 };
extern const char *const csv_segment_titles[CSV_SEGMENT_TITLES + 1];

/* ---- folders ---- */

/* Reads a quantity ("flow") of a folder of svOneDSolver into columns of the tree. Errors: as
 * tree_read_values. */
MUST_CHECK Status steps_read(Tree *tree, const char *folder, const char *quantity, Err *err);

#endif
