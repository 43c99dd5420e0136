/* The formats of the table in treeio.c: what each does, and what their texts share.
 *
 * A new format is a file of a sub-room and a row of that table. Its extension identifies it; where
 * several share one, and on standard input, its TreeDetect does. One whose file is a tree, with ids
 * and parents, has a TreeRead, which hands nodes to a TreeBuilder [tree/builder.h]; one whose file
 * is a network of points and lines has a GraphRead, which hands these to a Graph [tree/graph.h] as
 * the file has them: treeio.c has it made a tree. Neither scales: options of the user are applied
 * to what is handed over, but for those that only the reader can apply (radius_array, columns,
 * ...), which it finds in graph->options and its row lists in `takes`. XML is parsed by
 * treeio/xml.h; what is assumed is told to reading_note. A text is cut into lines by lines_read. */
#ifndef CORCAST_TREEIO_FORMATS_H
#define CORCAST_TREEIO_FORMATS_H

#include "tree/tree.h"

/* Whether a file that begins with these bytes, zero-terminated, is of the format. */
typedef bool TreeDetect(const char *start);
/* Hands the file's bytes (zero-terminated; may be changed) to the builder. A text has LF at the
 * ends of its lines. STATUS_INPUT with file and record. */
typedef Status TreeRead(TreeBuilder *builder, char *bytes, size_t size, Err *err);
/* Likewise to a graph, in the file's own unit. */
typedef Status GraphRead(Graph *graph, char *bytes, size_t size, Err *err);
/* Appends the file of a tree that tree_check accepts. The text may flow into a stream; the caller
 * checks it at the end. Errors: STATUS_INPUT, without the file's name, for a tree that the format
 * cannot hold; STATUS_MEMORY. */
typedef Status TreeWrite(const Tree *tree, Text *text, Err *err);

/* Returns true if a column of the tree is written, although the format writes no others. */
typedef bool TreeKeeps(const TreeColumn *column);
/* Appends the keywords of a format, one per line, from the tables of its reader. */
typedef void TreeKeywords(Text *text);

TreeKeeps swc_keeps, oned_keeps;
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

/* Numbers that a compressed or sparse file of `size` bytes may unpack to, and points, lines or
 * cells that it may hold. Data of vessels take at least a byte per point and compress less than 64
 * times; files that claim more are refused before memory is allocated, even if their claim is true.
 */
static inline double most_unpacked_bytes(size_t size)
{
    return 64e6 + 64 * (double)size;
}
static inline double most_elements(size_t size)
{
    return 1e6 + (double)size;
}
/* STATUS_INPUT, without the file, for more elements than that. */
MUST_CHECK Status check_elements(const char *what, double count, size_t size, Err *err);
/* STATUS_INPUT, without the file, for more bytes of numbers than that. */
MUST_CHECK Status check_unpacked(double bytes, size_t size, Err *err);

/* Of a text that may begin with comments and empty lines, the first line behind them, at its first
 * character that is no blank. */
const char *text_first_row(const char *start);

/* Refuses a line of fields that holds a number with a decimal comma, as "10,5" between blanks or
 * semicolons: a comma separates fields. STATUS_INPUT, without file and line. */
MUST_CHECK Status fields_check_commas(const char *line, Err *err);
/* Returns the end of a sentence about a text that is no number: it names the decimal comma where
 * the text has one, and is "" elsewhere. */
const char *decimal_comma_hint(const char *text);

/* Numbers in a file: a finite one, at least `minimum`, and a whole one. STATUS_INPUT, without file
 * and record, calling it `what`. */
MUST_CHECK Status field_number(const char *what, const char *text, double minimum, double *out,
                               Err *err);
/* A radius or a diameter; a bad one becomes NAN where the options repair radii [reading_radius]. */
MUST_CHECK Status field_radius(const ReadOptions *options, const char *what, const char *text,
                               double *out, Err *err);
MUST_CHECK Status field_whole(const char *what, const char *text, int32_t minimum, int32_t maximum,
                              int32_t *out, Err *err);
/* A finite number; NAN where the field is empty, NA or NaN. */
MUST_CHECK Status field_value(const char *what, const char *text, double *out, Err *err);

/* Reads a quantity ("flow") of a folder of svOneDSolver into columns of the tree, as
 * tree_read_values. */
MUST_CHECK Status steps_read(Tree *tree, const char *folder, const char *quantity, Err *err);

/* Takes the next field of a line of CSV off *at, in place, which becomes NULL behind the last;
 * blanks around it go, and where `separator` is one, several are like one. A quoted one ends with a
 * quote that no other follows. STATUS_INPUT, without file and line, when none does. */
MUST_CHECK Status csv_field(char **at, char separator, char **field, Err *err);
/* Cuts a row of CSV into its `n` fields, in place. Errors: STATUS_INPUT, without file and line, for
 * any other number of fields, and as csv_field. */
MUST_CHECK Status csv_row(char *line, char separator, char **field, size_t n, Err *err);
/* Parts "name [unit]" in place; the unit is "" where there is none. */
const char *csv_unit(char *title);

/* The titles that a CSV of segments begins with, "id" first; NULL ends them. */
enum { CSV_SEGMENT_TITLES = 10 };
extern const char *const csv_segment_titles[CSV_SEGMENT_TITLES + 1];

#endif
