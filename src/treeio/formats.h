/* The formats of the table in treeio.c: what each does, and what their texts share. */
#ifndef CORCAST_TREEIO_FORMATS_H
#define CORCAST_TREEIO_FORMATS_H

#include "tree/tree.h"
#include <stdio.h>

/* Whether a file that begins with these bytes, zero-terminated, is of the format. */
typedef bool TreeDetect(const char *start);
/* Hands the file's bytes (zero-terminated; may be changed) to the builder. A text has LF at the
 * ends of its lines. STATUS_INPUT with file and record. */
typedef Status TreeRead(TreeBuilder *builder, char *bytes, size_t size, Err *err);
/* Writes a tree that tree_check accepts; errors of the stream are the caller's matter. */
typedef Status TreeWrite(const Tree *tree, FILE *stream, Err *err);

TreeDetect csv_detect;
TreeRead swc_read, csv_read;
TreeWrite swc_write, csv_write;

/* Takes in one line (zero-terminated, without its end; may be changed), the file's `number`th.
 * STATUS_INPUT without file and line. */
typedef Status ReadLine(void *reader, size_t number, char *line, Err *err);
/* Hands all lines of a text to `read`, and says of which it was that it refuses. */
MUST_CHECK Status lines_read(const TreeBuilder *builder, char *text, ReadLine *read, void *reader,
                             Err *err);

/* Cuts a line in place into its fields [text_field]; returns how many there are, of which the first
 * `most` go to `field`. */
size_t fields_cut(char *line, char **field, size_t most);

/* Numbers in a file: a finite one, at least `minimum`, and a whole one. STATUS_INPUT, without file
 * and record, calling it `what`. */
MUST_CHECK Status field_number(const char *what, const char *text, double minimum, double *out,
                               Err *err);
MUST_CHECK Status field_whole(const char *what, const char *text, int32_t minimum, int32_t maximum,
                              int32_t *out, Err *err);
/* A finite number; NAN where the field is empty, NA or NaN. */
MUST_CHECK Status field_value(const char *what, const char *text, double *out, Err *err);

#endif
