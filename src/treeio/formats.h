/* The functions that implement the file formats, and the helpers that text formats share. Private
 * to the module treeio.
 *
 * To add a format, write a source file in a submodule and add a row to the table in treeio.c. The
 * row names the functions of the format:
 *
 *     TreeDetect   recognizes a file by its first bytes: needed if several formats share the
 *                  extension, and for standard input.
 *     TreeRead     reads a file of nodes with ids and parents into a TreeBuilder [tree/builder.h].
 *     GraphRead    reads a file of points and lines into a Graph [tree/graph.h]; treeio.c then
 *                  makes a tree of the graph. A format has a TreeRead or a GraphRead, not both.
 *     TreeWrite    writes a tree; NULL if the format is only read.
 *     TreeStores   in a format that cannot store all columns (LOSES_COLUMNS in treeio.c): returns
 *                  true for the columns that it can store; NULL if it can store none.
 *
 * Readers do not scale lengths: treeio.c converts units and applies the user's options. A GraphRead
 * applies a few options itself, such as radius_array and columns: it reads them from
 * graph->options, and the format's row in treeio.c names them in the member `takes`. Readers record
 * every assumption with reading_note.
 *
 * Helpers: treeio/xml.h parses XML; treeio/cursor.h cuts text into lines and words;
 * treeio/text/dialect.h reads rows by tables of sections and fields. An error "without file and
 * line" has a sentence to which the caller adds file and line. */
#ifndef CORCAST_TREEIO_FORMATS_H
#define CORCAST_TREEIO_FORMATS_H

#include "tree/tree.h"

/* Returns true if a file whose bytes are `start`, up to the first zero, has the format. */
typedef bool TreeDetect(const char *start);
/* Reads a file into the builder.
 *
 * bytes   the file, with a zero after its `size` bytes. The reader may change the bytes. In text
 *         formats all line ends were converted to LF.
 * Errors  STATUS_INPUT, with file and line; STATUS_MEMORY. */
typedef Status TreeRead(TreeBuilder *builder, char *bytes, size_t size, Err *err);
/* Reads a file into the graph, in the file's own unit of length. Otherwise like TreeRead. */
typedef Status GraphRead(Graph *graph, char *bytes, size_t size, Err *err);
/* Appends the file of `tree`, which tree_check has accepted. `text` may have a stream
 * [base/text.h], whose errors the caller checks at the end. Errors: STATUS_INPUT, without the
 * file's name, for a tree that the format cannot hold; STATUS_MEMORY. */
typedef Status TreeWrite(const Tree *tree, Text *text, Err *err);
/* Returns true if the format can store `column`. */
typedef bool TreeStores(const TreeColumn *column);

TreeStores swc_stores, oned_stores;
TreeDetect amira_detect, csv_detect, opencco_detect, metaio_detect, vtk_detect, vtp_detect,
    gxl_detect, graphml_detect, amiraxml_detect, pvd_detect, csv_segments_detect, oned_detect,
    vmv_detect, vita_detect;
TreeRead swc_read, csv_read, pvd_read;
GraphRead oned_read, vita_read, secomb_read, opencco_read, vmv_read, metaio_read, vtk_read,
    vtp_read, gxl_read, graphml_read, amiraxml_read, table_read, amira_read;
TreeWrite swc_write, csv_write, csv_segments_write, oned_write, vmv_write, vtk_write, vtp_write,
    gxl_write, graphml_write;

/* ---- limits ---- */

/* Upper limits of the sizes that the header of a file of `size` bytes may announce: the bytes of
 * its numbers after decompression, and the number of its points, lines or cells. A file that
 * announces more is refused before memory is allocated. A small malicious file therefore cannot
 * allocate much memory. Real vessel data takes at least one byte per point, and compresses less
 * than 64 times. The constant terms, 64 MB and a million, accept every small file. */
static inline double max_unpacked_bytes(size_t size)
{
    return 64e6 + 64 * (double)size;
}
static inline double max_elements(size_t size)
{
    return 1e6 + (double)size;
}
/* Checks a number of elements, which errors call `what` ("points"), against max_elements. Errors:
 * STATUS_INPUT, without the file's name. */
MUST_CHECK Status check_elements(const char *what, double count, size_t size, Err *err);
/* Checks the size of numbers after decompression, in bytes, against max_unpacked_bytes. Errors:
 * STATUS_INPUT, without the file's name. */
MUST_CHECK Status check_unpacked(double bytes, size_t size, Err *err);

/* ---- fields ---- */

/* Returns the first character that is not a blank or line end, and not in a '#' comment; the final
 * zero if there is none. */
const char *text_first_row(const char *start);

/* Checks that a line has no number with a decimal comma, such as "10,5" between blanks or
 * semicolons. A comma would be taken for a separator of fields. Errors: STATUS_INPUT, without file
 * and line. */
MUST_CHECK Status fields_check_commas(const char *line, Err *err);
/* Returns the end of an error message about `text`: advice to use a decimal point if `text` is a
 * number with a decimal comma, and "" otherwise. */
const char *decimal_comma_hint(const char *text);

/* The next four functions convert the text of one field. `what` names the field in errors.
 *
 *     field_number    accepts a finite number of at least `minimum`.
 *     field_integer   accepts an integer in [minimum, maximum].
 *     field_value     accepts a finite number; an empty field, NA and NaN give NAN.
 *     field_radius    accepts a radius or diameter that is finite and at least 0. With
 *                     options->repair_radii, a negative or infinite number and NaN give NAN.
 *                     `options` may be NULL.
 *
 * Errors: STATUS_INPUT, without file and line, for any other text. */
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
 * at         in and out: the rest of the line; NULL after the last field.
 * separator  the character between fields. If it is a blank, several blanks count as one.
 * field      receives the field, without blanks around it, borrowed from the line. In a field in
 *            "double quotes", "" stands for one quote character.
 * Errors     STATUS_INPUT, without file and line, if a quoted field has no closing quote, or is not
 *            followed by a separator. */
MUST_CHECK Status csv_field(char **at, char separator, char **field, Err *err);
/* Cuts a row of CSV into its `n` fields, in place. Errors: those of csv_field; STATUS_INPUT,
 * without file and line, if the row does not have exactly `n` fields. */
MUST_CHECK Status csv_row(char *line, char separator, char **field, size_t n, Err *err);
/* Cuts "name [unit]" into name and unit, in place. Returns the unit, or "" if there is none. */
const char *csv_unit(char *title);

/* The titles of the first columns of a CSV of segments, beginning with "id", and a final NULL. Only
 * files of networks with loops have the last column, "same_as". */
enum { CSV_SEGMENT_TITLES = 11 };
extern const char *const csv_segment_titles[CSV_SEGMENT_TITLES + 1];

/* ---- folders ---- */

/* Reads a quantity ("flow") from a result folder of svOneDSolver into columns of the tree, one
 * column per time step. Errors: those of tree_read_values. */
MUST_CHECK Status steps_read(Tree *tree, const char *folder, const char *quantity, Err *err);

#endif
