/* SWC files; treeio.h says what is read and written. */
#ifndef CORCAST_TREEIO_SWC_H
#define CORCAST_TREEIO_SWC_H

#include "tree/tree.h"

MUST_CHECK Status swc_read(Tree *tree, const char *path, Err *err);
MUST_CHECK Status swc_write(const Tree *tree, const char *path, Err *err);

/* The known header keys are numbered 0 .. SWC_N_KEYS - 1. */
enum { SWC_N_KEYS = 8, SWC_NO_KEY = -1 };

/* The key of a header line "key: value", or SWC_NO_KEY. */
int swc_key_of_line(const char *line);

/* Sets the field of `key` from the value of `line`. STATUS_INPUT, without file and line, when the
 * value is not allowed or differs from one set before. */
MUST_CHECK Status swc_key_parse(TreeHeader *header, int key, const char *line, Err *err);

bool swc_key_known(const TreeHeader *header, int key);

/* Writes "# key: value" and a line end. */
void swc_key_write(const TreeHeader *header, int key, FILE *stream);

#endif
