/* SWC: lines are cut in place into fields. Flow shares travel as comments "flow_share: ID SHARE",
 * which every reader of SWC skips. */
#include "treeio/comments.h"
#include "treeio/formats.h"

#include <math.h>
#include <string.h>

enum { N_FIELDS = 7 };

static const char share_key[] = "flow_share";

static Status read_row(TreeBuilder *builder, size_t line, char *const field[N_FIELDS], Err *err)
{
    const double any = -HUGE_VAL;
    int32_t id = 0, parent = 0;
    BuilderNode node = {.record = line};
    TRY(field_whole("id", field[0], 1, TREE_MAX_ID, &id, err));
    TRY(field_whole("type", field[1], INT32_MIN, INT32_MAX, &node.type, err));
    TRY(field_number("x coordinate", field[2], any, &node.position.x, err));
    TRY(field_number("y coordinate", field[3], any, &node.position.y, err));
    TRY(field_number("z coordinate", field[4], any, &node.position.z, err));
    TRY(field_number("radius", field[5], 0, &node.radius_mm, err));
    TRY(field_whole("parent", field[6], TREE_NO_PARENT, TREE_MAX_ID, &parent, err));
    node.id = id;
    node.parent = parent;
    return builder_node(builder, &node, err);
}

/* Copies the next word at *at, and moves past it; false when there is none or it is too long. */
static bool next_word(const char **at, char *word, size_t size)
{
    *at += strspn(*at, TEXT_BLANKS);
    size_t length = strcspn(*at, TEXT_BLANKS);
    if (length == 0 || length >= size)
        return false;
    memcpy(word, *at, length);
    word[length] = '\0';
    *at += length;
    return true;
}

static Status read_share(TreeBuilder *builder, size_t line, const char *value, Err *err)
{
    const char *at = value;
    char id[32], share[400];
    long long number = 0;
    double part = 0;
    bool read = next_word(&at, id, sizeof id) && next_word(&at, share, sizeof share) &&
                !at[strspn(at, TEXT_BLANKS)] && integer_parse(id, 1, TREE_MAX_ID, &number) &&
                number_parse(share, &part) && isfinite(part) && part > 0;
    if (!read)
        return err_set(err, STATUS_INPUT,
                       "flow_share is '%.40s'; it must be the id of a node and a number above 0",
                       value);
    return builder_share(builder, number, part, line, err);
}

/* `comment` is what follows '#'. */
static Status read_comment(TreeBuilder *builder, size_t line, const char *comment, Err *err)
{
    const char *share = comment_value(comment, share_key);
    if (share)
        return read_share(builder, line, share, err);
    return comment_read(&builder->meta, comment, err);
}

static Status read_line(void *reader, size_t number, char *line, Err *err)
{
    TreeBuilder *builder = reader;
    line += strspn(line, TEXT_BLANKS);
    if (*line == '#')
        return read_comment(builder, number, line + 1, err);
    line[strcspn(line, "#")] = '\0';
    char *field[N_FIELDS];
    size_t count = 0;
    while (*line) {
        char *end = line + strcspn(line, TEXT_BLANKS);
        char *next = end + strspn(end, TEXT_BLANKS);
        if (count < N_FIELDS)
            field[count] = line;
        *end = '\0';
        line = next;
        count++;
    }
    if (count == 0)
        return STATUS_OK;
    if (count != N_FIELDS)
        return err_set(err, STATUS_INPUT,
                       "the row has %zu field%s; it must have %d: id type x y z radius parent",
                       count, count == 1 ? "" : "s", N_FIELDS);
    return read_row(builder, number, field, err);
}

Status swc_read(TreeBuilder *builder, char *bytes, size_t size, Err *err)
{
    (void)size;
    return lines_read(builder, bytes, read_line, builder, err);
}

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

Status swc_write(const Tree *tree, FILE *stream, Err *err)
{
    char share[NUMBER_TEXT_SIZE];
    TRY(comments_write(&tree->meta, stream, err));
    for (size_t i = 0; tree->flow_share && i < tree->n; i++)
        if (tree->flow_share[i] > 0)
            fprintf(stream, "# %s: %d %s\n", share_key, tree->id[i],
                    number_text(tree->flow_share[i], share));
    for (size_t i = 0; i < tree->n; i++)
        write_row(tree, i, stream);
    return STATUS_OK;
}
