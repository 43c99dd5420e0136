/* SWC: lines are cut in place into fields. Flow shares travel as comments "flow_share: ID SHARE",
 * which every reader of SWC skips.
 *
 * The dialects: fields may be parted by commas or semicolons, a line may name the columns, with '#'
 * or without, ids may start at 0, a root may have the parent 0, and more columns may follow, as in
 * Vaa3D's ESWC, which become the tree's. Whether ids start at 0 is told by the first row, before
 * any id has been handed on. */
#include "treeio/comments.h"
#include "treeio/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { N_FIELDS = 7, MAX_FIELDS = 100 };

#define BETWEEN_FIELDS TEXT_BLANKS ",;"

static const char share_key[] = "flow_share";

/* What is read so far. */
typedef struct Reader {
    TreeBuilder *builder;
    size_t n_fields;    /* in every row; 0: there has been none */
    int32_t lowest_id;  /* 0 or 1 */
    const char *titles; /* the last line that names columns (borrowed from the text), or NULL */
} Reader;

static Status read_id(const Reader *reader, const char *text, int64_t *id, Err *err)
{
    int32_t number = 0;
    TRY(field_whole("id", text, reader->lowest_id, TREE_MAX_ID - 1 + reader->lowest_id, &number,
                    err));
    *id = (int64_t)number + 1 - reader->lowest_id;
    return STATUS_OK;
}

/* Where ids start at 1, the parent 0 is none. */
static Status read_parent(const Reader *reader, const char *text, int64_t *parent, Err *err)
{
    int32_t number = 0;
    TRY(field_whole("parent", text, TREE_NO_PARENT, TREE_MAX_ID, &number, err));
    if (number < reader->lowest_id)
        *parent = TREE_NO_PARENT;
    else
        *parent = (int64_t)number + 1 - reader->lowest_id;
    return STATUS_OK;
}

static Status read_row(const Reader *reader, size_t line, char *const *field, Err *err)
{
    const double any = -HUGE_VAL;
    TreeBuilder *builder = reader->builder;
    BuilderNode node = {.record = line};
    TRY(read_id(reader, field[0], &node.id, err));
    TRY(field_whole("type", field[1], INT32_MIN, INT32_MAX, &node.type, err));
    TRY(field_number("x coordinate", field[2], any, &node.position.x, err));
    TRY(field_number("y coordinate", field[3], any, &node.position.y, err));
    TRY(field_number("z coordinate", field[4], any, &node.position.z, err));
    TRY(field_number("radius", field[5], 0, &node.radius_mm, err));
    TRY(read_parent(reader, field[6], &node.parent, err));
    TRY(builder_node(builder, &node, err));
    for (size_t k = 0; k + N_FIELDS < reader->n_fields; k++) {
        double value;
        TRY(field_value("value", field[N_FIELDS + k], &value, err));
        TRY(builder_value(builder, k, value, err));
    }
    return STATUS_OK;
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

/* Whether a line names columns: "id type x y z radius parent", with any words for the others. */
static bool names_columns(const char *line)
{
    static const char *const axes[] = {"x", "y", "z"};
    line += strspn(line, "#" BETWEEN_FIELDS);
    for (size_t i = 0; i < 5; i++) {
        size_t length = strcspn(line, BETWEEN_FIELDS);
        if (i >= 2 && (length != 1 || strncasecmp(line, axes[i - 2], 1) != 0))
            return false;
        line += length;
        line += strspn(line, BETWEEN_FIELDS);
    }
    return true;
}

/* `comment` is what follows '#'. */
static Status read_comment(Reader *reader, size_t line, const char *comment, Err *err)
{
    const char *share = comment_value(comment, share_key);
    if (share)
        return read_share(reader->builder, line, share, err);
    if (names_columns(comment))
        reader->titles = comment;
    return comment_read(&reader->builder->meta, comment, err);
}

/* The columns behind the seventh have the names that a line gives to as many columns as there are,
 * or else "column 8" and so on. */
static Status add_columns(const Reader *reader, Err *err)
{
    char *copy = NULL, *title[MAX_FIELDS], number[32];
    TRY(mem_strdup(&copy, reader->titles ? reader->titles : "", err));
    bool named = fields_cut(copy + strspn(copy, "#"), title, MAX_FIELDS) == reader->n_fields;
    Status status = STATUS_OK;
    for (size_t i = N_FIELDS, column; status == STATUS_OK && i < reader->n_fields; i++) {
        snprintf(number, sizeof number, "column %zu", i + 1);
        status = builder_column(reader->builder, named ? title[i] : number, "", &column, err);
    }
    free(copy);
    return status;
}

static Status begin_rows(Reader *reader, const char *id, size_t count, Err *err)
{
    double first;
    reader->lowest_id = !(number_parse(id, &first) && first == 0);
    reader->n_fields = count;
    return add_columns(reader, err);
}

static Status refuse_count(const Reader *reader, size_t count, Err *err)
{
    if (count > MAX_FIELDS)
        return err_set(err, STATUS_INPUT, "the row has %zu fields; it may have at most %d", count,
                       MAX_FIELDS);
    if (reader->n_fields > N_FIELDS)
        return err_set(err, STATUS_INPUT, "the row has %zu field%s; the rows before it have %zu",
                       count, count == 1 ? "" : "s", reader->n_fields);
    return err_set(err, STATUS_INPUT,
                   "the row has %zu field%s; it must have %d: id type x y z radius parent", count,
                   count == 1 ? "" : "s", N_FIELDS);
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    Reader *reader = context;
    char *field[MAX_FIELDS];
    line += strspn(line, TEXT_BLANKS);
    if (*line == '#')
        return read_comment(reader, number, line + 1, err);
    if (reader->n_fields == 0 && names_columns(line)) {
        reader->titles = line;
        return STATUS_OK;
    }
    char *comment = strchr(line, '#');
    if (comment)
        *comment = '\0';
    size_t count = fields_cut(line, field, MAX_FIELDS);
    if (count == 0)
        return STATUS_OK;
    bool fits = reader->n_fields == 0 ? count >= N_FIELDS : count == reader->n_fields;
    if (!fits || count > MAX_FIELDS)
        return refuse_count(reader, count, err);
    if (reader->n_fields == 0)
        TRY(begin_rows(reader, field[0], count, err));
    return read_row(reader, number, field, err);
}

Status swc_read(TreeBuilder *builder, char *bytes, size_t size, Err *err)
{
    (void)size;
    Reader reader = {.builder = builder, .lowest_id = 1};
    TRY(lines_read(builder->name, bytes, read_line, &reader, err));
    if (reader.lowest_id == 1)
        return STATUS_OK;
    if (builder->n_shares > 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the ids start at 0, but a flow_share names nodes by ids from 1 on",
                       builder->name);
    return reading_note(builder->reading, err,
                        "ids start at 0 in the file, and are one higher here");
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
