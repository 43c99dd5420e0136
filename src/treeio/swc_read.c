/* The file is cut in place into lines and fields; a row keeps its line number. Then parents are
 * found in a direct table of ids, and rows placed: from each row not yet placed, the walk towards
 * the root collects the ancestors that are not placed either, and they go before it. A file with
 * parents first keeps its order, every row is walked over twice at most, and a walk that meets
 * itself is a cycle. */
#include "treeio/comments.h"
#include "treeio/swc.h"

#include <stdlib.h>
#include <string.h>

enum { N_FIELDS = 7, ROOT_PARENT_ID = -1, SHOWN = 40 /* characters of a bad value */ };

static const char blanks[] = " \t\v\f";

/* As many rows as there are ids, of the longest numbers, have 3 GB. */
static const FileForm swc_file = {.name = "an SWC file", .most_bytes = 4e9, .is_text = true};

typedef struct Row {
    int32_t id, type, parent_id;
    int32_t parent; /* row index, or TREE_NO_PARENT; found when all rows are read */
    Vec3 position;
    double radius_mm;
    size_t line;
} Row;

typedef struct Reader {
    const char *name; /* of the file */
    size_t line;      /* counted from 1 */
    Row *rows;
    size_t n, capacity;
    TreeMeta meta;
    FlowShareLines flow_shares;
} Reader;

static Status read_whole(const Reader *reader, const char *what, const char *text, int32_t minimum,
                         int32_t maximum, int32_t *out, Err *err)
{
    double value;
    if (!number_parse(text, &value) || !(value >= minimum && value <= maximum) ||
        value != floor(value))
        return err_set(err, STATUS_INPUT,
                       "%s:%zu: the %s is '%.*s'; it must be a whole number from %d to %d",
                       reader->name, reader->line, what, SHOWN, text, minimum, maximum);
    *out = (int32_t)value;
    return STATUS_OK;
}

static Status read_number(const Reader *reader, const char *what, const char *text, double minimum,
                          double *out, Err *err)
{
    double value;
    if (!number_parse(text, &value) || !isfinite(value) || value < minimum)
        return err_set(err, STATUS_INPUT, "%s:%zu: the %s is '%.*s'; it must be a finite number%s",
                       reader->name, reader->line, what, SHOWN, text,
                       minimum == 0 ? " that is not negative" : "");
    *out = value;
    return STATUS_OK;
}

static Status read_row(Reader *reader, char *const field[N_FIELDS], Err *err)
{
    const double any = -HUGE_VAL;
    Row row = {.line = reader->line};
    TRY(read_whole(reader, "id", field[0], 1, TREE_MAX_ID, &row.id, err));
    TRY(read_whole(reader, "type", field[1], INT32_MIN, INT32_MAX, &row.type, err));
    TRY(read_number(reader, "x coordinate", field[2], any, &row.position.x, err));
    TRY(read_number(reader, "y coordinate", field[3], any, &row.position.y, err));
    TRY(read_number(reader, "z coordinate", field[4], any, &row.position.z, err));
    TRY(read_number(reader, "radius", field[5], 0, &row.radius_mm, err));
    TRY(read_whole(reader, "parent", field[6], ROOT_PARENT_ID, TREE_MAX_ID, &row.parent_id, err));
    TRY(mem_reserve(&reader->rows, &reader->capacity, reader->n + 1, sizeof row, "rows", err));
    reader->rows[reader->n++] = row;
    return STATUS_OK;
}

/* `comment` is what follows '#'. */
static Status read_comment(Reader *reader, const char *comment, Err *err)
{
    if (swc_is_flow_share(comment))
        return swc_flow_share_parse(&reader->flow_shares, comment, reader->line, err);
    Status status = comment_read(&reader->meta, comment, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s:%zu: ", reader->name, reader->line);
    return status;
}

static Status read_line(Reader *reader, char *line, Err *err)
{
    line += strspn(line, blanks);
    if (*line == '#')
        return read_comment(reader, line + 1, err);
    line[strcspn(line, "#")] = '\0';
    char *field[N_FIELDS];
    size_t count = 0;
    while (*line) {
        char *end = line + strcspn(line, blanks);
        char *next = end + strspn(end, blanks);
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
                       "%s:%zu: the row has %zu field%s; it must have %d: id type x y z radius "
                       "parent",
                       reader->name, reader->line, count, count == 1 ? "" : "s", N_FIELDS);
    return read_row(reader, field, err);
}

static Status read_lines(Reader *reader, char *bytes, Err *err)
{
    if (*bytes == '\0')
        return err_set(err, STATUS_INPUT, "%s: the file is empty; an SWC file has at least one row",
                       reader->name);
    for (char *at = bytes, *next; at; at = next) {
        reader->line++;
        next = strchr(at, '\n');
        if (next)
            *next++ = '\0';
        TRY(read_line(reader, at, err));
    }
    if (reader->n == 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the file has no rows; an SWC file has at least one, id type x y z "
                       "radius parent",
                       reader->name);
    return STATUS_OK;
}

/* Fills the zeroed table, at index id, with the row's index + 1. */
static Status index_ids(const Reader *reader, int32_t *row_after_id, Err *err)
{
    for (size_t i = 0; i < reader->n; i++) {
        const Row *row = &reader->rows[i];
        int32_t *entry = &row_after_id[row->id];
        if (*entry)
            return err_set(err, STATUS_INPUT,
                           "%s:%zu: the id %d is already that of line %zu; every row needs its own",
                           reader->name, row->line, row->id, reader->rows[*entry - 1].line);
        *entry = (int32_t)i + 1;
    }
    return STATUS_OK;
}

static Status find_parents(Reader *reader, Err *err)
{
    int32_t last_id = 0;
    for (size_t i = 0; i < reader->n; i++)
        if (reader->rows[i].id > last_id)
            last_id = reader->rows[i].id;
    int32_t *table = NULL;
    TRY(mem_calloc(&table, (size_t)last_id + 1, sizeof *table, "table entries for ids", err));
    Status status = STATUS_OK;
    TRY_GOTO(index_ids(reader, table, err));
    for (size_t i = 0; i < reader->n; i++) {
        Row *row = &reader->rows[i];
        if (row->parent_id == ROOT_PARENT_ID)
            row->parent = TREE_NO_PARENT;
        else if (row->parent_id <= last_id && table[row->parent_id])
            row->parent = table[row->parent_id] - 1;
        else
            TRY_GOTO(err_set(err, STATUS_INPUT,
                             "%s:%zu: the parent is %d, which is no row's id; it must be the id of "
                             "a row, or -1 for a root",
                             reader->name, row->line, row->parent_id));
    }
done:
    free(table);
    return status;
}

enum { UNPLACED = -1, WALKED = -2 };

/* Places row `start` and its unplaced ancestors, the topmost at *placed. */
static Status place_with_ancestors(const Reader *reader, int32_t start, int32_t *place,
                                   int32_t *placed, Err *err)
{
    const Row *rows = reader->rows;
    int32_t length = 0, at = start;
    for (; at != TREE_NO_PARENT && place[at] == UNPLACED; at = rows[at].parent) {
        place[at] = WALKED;
        length++;
    }
    if (at != TREE_NO_PARENT && place[at] == WALKED)
        return err_set(err, STATUS_INPUT,
                       "%s:%zu: node %d is its own %s; parents must lead to a root, whose parent "
                       "is -1",
                       reader->name, rows[at].line, rows[at].id,
                       rows[at].parent == at ? "parent" : "ancestor");
    at = start;
    for (int32_t below = length; below > 0; at = rows[at].parent)
        place[at] = *placed + --below;
    *placed += length;
    return STATUS_OK;
}

static void fill_tree(const Reader *reader, const int32_t *place, Tree *tree)
{
    for (size_t i = 0; i < reader->n; i++) {
        const Row *row = &reader->rows[i];
        int32_t at = place[i];
        tree->id[at] = row->id;
        tree->type[at] = row->type;
        tree->parent[at] = row->parent == TREE_NO_PARENT ? TREE_NO_PARENT : place[row->parent];
        tree->position[at] = row->position;
        tree->radius_mm[at] = row->radius_mm;
    }
}

/* Moves the header from the reader. */
static Status build_tree(Reader *reader, Tree *out, Err *err)
{
    TRY(find_parents(reader, err));
    int32_t *place = NULL; /* of each row in the tree */
    TRY(mem_calloc(&place, reader->n, sizeof *place, "row places", err));
    for (size_t i = 0; i < reader->n; i++)
        place[i] = UNPLACED;
    Status status = STATUS_OK;
    int32_t placed = 0;
    Tree tree = {0};
    for (size_t i = 0; i < reader->n; i++)
        TRY_GOTO(place_with_ancestors(reader, (int32_t)i, place, &placed, err));
    TRY_GOTO(tree_init(&tree, reader->n, err));
    fill_tree(reader, place, &tree);
    tree.meta = reader->meta;
    reader->meta = (TreeMeta){0};
    TRY_GOTO(swc_flow_shares_apply(&reader->flow_shares, &tree, err));
    *out = tree;
done:
    if (status != STATUS_OK)
        tree_release(&tree);
    free(place);
    return status;
}

Status swc_read(Tree *tree, const char *path, Err *err)
{
    char *bytes = NULL;
    size_t size = 0;
    TRY(file_read(path, &swc_file, &bytes, &size, err));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    Reader reader = {.name = name, .flow_shares.name = name};
    Status status = STATUS_OK;
    TRY_GOTO(read_lines(&reader, bytes, err));
    TRY_GOTO(build_tree(&reader, tree, err));
done:
    meta_release(&reader.meta);
    swc_flow_shares_release(&reader.flow_shares);
    free(reader.rows);
    free(bytes);
    return status;
}
