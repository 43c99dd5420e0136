#include "treeio/comments.h"
#include "treeio/swc.h"

#include <string.h>

/* Appends the decimal digits of the number, and then a blank. */
static char *put_whole(char *to, int64_t value)
{
    char digits[16];
    int count = 0;
    if (value < 0) {
        *to++ = '-';
        value = -value;
    }
    do
        digits[count++] = (char)('0' + value % 10);
    while ((value /= 10) > 0);
    while (count > 0)
        *to++ = digits[--count];
    *to++ = ' ';
    return to;
}

static char *put_number(char *to, double value)
{
    number_text(value, to);
    to += strlen(to);
    *to++ = ' ';
    return to;
}

/* By hand: fprintf would take as long as all four numbers. */
static void write_row(const Tree *tree, size_t i, FILE *stream)
{
    char row[8 * NUMBER_TEXT_SIZE], *to = row;
    to = put_whole(to, tree->id[i]);
    to = put_whole(to, tree->type[i]);
    to = put_number(to, tree->position[i].x);
    to = put_number(to, tree->position[i].y);
    to = put_number(to, tree->position[i].z);
    to = put_number(to, tree->radius_mm[i]);
    to = put_whole(to, tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : -1);
    to[-1] = '\n';
    fwrite(row, 1, (size_t)(to - row), stream);
}

Status swc_write(const Tree *tree, const char *path, Err *err)
{
    OutFile file;
    TRY(outfile_open(&file, path, err));
    Status status = comments_write(&tree->meta, file.stream, err);
    if (status != STATUS_OK) {
        outfile_discard(&file);
        return status;
    }
    swc_flow_shares_write(tree, file.stream);
    for (size_t i = 0; i < tree->n; i++)
        write_row(tree, i, file.stream);
    return outfile_commit(&file, err);
}
