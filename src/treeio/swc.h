/* SWC files; treeio.h says what is read and written. */
#ifndef CORCAST_TREEIO_SWC_H
#define CORCAST_TREEIO_SWC_H

#include "tree/tree.h"

MUST_CHECK Status swc_read(Tree *tree, const char *path, Err *err);
MUST_CHECK Status swc_write(const Tree *tree, const char *path, Err *err);

/* Header lines "flow_share: ID SHARE" that have been read; `name` is the file's. */
typedef struct FlowShareLines {
    const char *name;
    struct FlowShareLine *line; /* owned; swc_flow_shares_release */
    size_t n, capacity;
} FlowShareLines;

bool swc_is_flow_share(const char *line);

/* Appends what the line, the file's `number`th, says. STATUS_INPUT when that is not an id and a
 * share. */
MUST_CHECK Status swc_flow_share_parse(FlowShareLines *lines, const char *line, size_t number,
                                       Err *err);

/* Gives the tree the flow shares of the lines, if there are any; what no line names gets 0.
 * STATUS_INPUT when a line names no node or one that has its share, and when the header key
 * terminal_flow says otherwise. */
MUST_CHECK Status swc_flow_shares_apply(const FlowShareLines *lines, Tree *tree, Err *err);

void swc_flow_shares_release(FlowShareLines *lines);

/* Writes the line of every node whose share is above 0. */
void swc_flow_shares_write(const Tree *tree, FILE *stream);

#endif
