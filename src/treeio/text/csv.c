/* Reads and writes the CSV of nodes: a line that names the columns, then one line per node. Also
 * writes the CSV of segments, which table.c reads. `node_columns` lists the columns with a fixed
 * meaning; all others are columns of values of the tree. */
#include "treeio/comments.h"
#include "treeio/cursor.h"
#include "treeio/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum NodeColumn { ID, PARENT, X, Y, Z, RADIUS, TYPE, SHARE, LINK, NODE_COLUMNS } NodeColumn;

static const char *const node_columns[NODE_COLUMNS] = {
    [ID] = "id",     [PARENT] = "parent",    [X] = "x_mm",
    [Y] = "y_mm",    [Z] = "z_mm",           [RADIUS] = "radius_mm",
    [TYPE] = "type", [SHARE] = "flow_share", [LINK] = "same_as"};

enum { LAST_NEEDED = RADIUS };

const char *const csv_segment_titles[CSV_SEGMENT_TITLES + 1] = {
    "id",    "parent", "x0_mm",     "y0_mm",     "z0_mm",  "x1_mm",
    "y1_mm", "z1_mm",  "radius_mm", "length_mm", "same_as"};

/* A column of the file. */
typedef struct CsvColumn {
    const char *title; /* borrowed from the text */
    size_t meaning;    /* a NodeColumn, or NODE_COLUMNS + the index of the builder's column */
} CsvColumn;

typedef struct CsvReader {
    TreeBuilder *builder;
    ARRAY(CsvColumn) columns;
    bool has[NODE_COLUMNS];
    char **field;  /* of one row; owned */
    double *value; /* per column of the builder: its value in a row; owned */
} CsvReader;

static Status read_title(CsvReader *reader, char *title, Err *err)
{
    size_t meaning = 0, number;
    while (meaning < NODE_COLUMNS && strcmp(title, node_columns[meaning]) != 0)
        meaning++;
    if (meaning == NODE_COLUMNS) {
        const char *unit = csv_unit(title);
        TRY(builder_column(reader->builder, title, unit, &number, err));
        meaning += number;
    } else if (reader->has[meaning]) {
        return err_set(err, STATUS_INPUT, "two columns are called '%s'", title);
    } else {
        reader->has[meaning] = true;
    }
    return ARRAY_PUSH(&reader->columns, "columns", err, (CsvColumn){title, meaning});
}

static Status read_titles(CsvReader *reader, char *line, Err *err)
{
    for (char *at = line, *title; at;) {
        TRY(csv_field(&at, ',', &title, err));
        TRY(read_title(reader, title, err));
    }
    for (int column = 0; column <= LAST_NEEDED; column++)
        if (!reader->has[column])
            return err_set(err, STATUS_INPUT,
                           "no column is called %s; a CSV of nodes needs id, parent, x_mm, y_mm, "
                           "z_mm and radius_mm",
                           node_columns[column]);
    TRY(mem_calloc(&reader->field, reader->columns.n, sizeof *reader->field, "fields", err));
    return mem_calloc(&reader->value, reader->builder->n_columns, sizeof *reader->value,
                      "values of a row", err);
}

/* A row of the file. */
typedef struct CsvRow {
    BuilderNode node;
    double share;
    int64_t link; /* TREE_NO_LINK: none */
} CsvRow;

/* Reads an id. An empty or negative parent or link means that there is none. */
static Status read_id(NodeColumn column, const char *text, int64_t *id, Err *err)
{
    bool may_lack = column != ID;
    int32_t number = TREE_NO_PARENT;
    if (*text || !may_lack)
        TRY(field_integer(node_columns[column], text, may_lack ? TREE_NO_PARENT : 1, TREE_MAX_ID,
                          &number, err));
    *id = number;
    return STATUS_OK;
}

static Status read_node_field(NodeColumn column, const char *text, CsvRow *row, Err *err)
{
    BuilderNode *node = &row->node;
    double *const number[NODE_COLUMNS] = {[X] = &node->position.x,
                                          [Y] = &node->position.y,
                                          [Z] = &node->position.z,
                                          [RADIUS] = &node->radius_mm,
                                          [SHARE] = &row->share};
    bool not_negative = column == RADIUS || column == SHARE;
    if (column == ID || column == PARENT || column == LINK)
        return read_id(column, text,
                       column == ID       ? &node->id
                       : column == PARENT ? &node->parent
                                          : &row->link,
                       err);
    if (column == TYPE)
        return field_integer("type", text, INT32_MIN, INT32_MAX, &node->type, err);
    if (column == SHARE && !*text)
        return STATUS_OK;
    return field_number(node_columns[column], text, not_negative ? 0 : -HUGE_VAL, number[column],
                        err);
}

static Status read_row(CsvReader *reader, size_t line, char *text, Err *err)
{
    TreeBuilder *builder = reader->builder;
    CsvRow row = {.node = {.type = TREE_VESSEL_TYPE, .record = line}, .link = TREE_NO_LINK};
    TRY(csv_row(text, ',', reader->field, reader->columns.n, err));
    for (size_t k = 0; k < reader->columns.n; k++) {
        const CsvColumn *column = &reader->columns.items[k];
        if (column->meaning < NODE_COLUMNS)
            TRY(read_node_field((NodeColumn)column->meaning, reader->field[k], &row, err));
        else
            TRY(field_value(column->title, reader->field[k],
                            &reader->value[column->meaning - NODE_COLUMNS], err));
    }
    TRY(builder_node(builder, &row.node, err));
    for (size_t k = 0; k < builder->n_columns; k++)
        TRY(builder_value(builder, k, reader->value[k], err));
    if (row.link != TREE_NO_LINK)
        TRY(builder_link(builder, row.node.id, row.link, line, err));
    return row.share > 0 ? builder_share(builder, row.node.id, row.share, line, err) : STATUS_OK;
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    CsvReader *reader = context;
    if (*line == '#')
        return comment_read(&reader->builder->meta, line + 1, err);
    if (!line[strspn(line, TEXT_BLANKS)])
        return STATUS_OK;
    return reader->columns.n > 0 ? read_row(reader, number, line, err)
                                 : read_titles(reader, line, err);
}

Status csv_read(TreeBuilder *builder, char *bytes, size_t size, Err *err)
{
    CsvReader reader = {.builder = builder};
    Status status = lines_read(builder->name, bytes, size, read_line, &reader, err);
    ARRAY_RELEASE(&reader.columns);
    free(reader.field);
    free(reader.value);
    return status;
}

/* Returns true if the first line that is not a comment names a parent and coordinates in mm. */
bool csv_detect(const char *start)
{
    start = text_first_row(start);
    size_t length = strcspn(start, "\n");
    const char *parent = memmem(start, length, node_columns[PARENT], strlen(node_columns[PARENT]));
    return parent && memchr(start, ',', length) &&
           memmem(start, length, node_columns[X], strlen(node_columns[X]));
}

bool csv_segments_detect(const char *start)
{
    static const char titles[] = "id,parent,x0_mm,";
    return strncmp(text_first_row(start), titles, strlen(titles)) == 0;
}

static void put_quoted(const char *chars, Text *text)
{
    for (const char *quote; (quote = strchr(chars, '"')); chars = quote + 1) {
        text_append(text, chars, (size_t)(quote - chars));
        text_puts(text, "\"\"");
    }
    text_puts(text, chars);
}

static bool is_among(const char *name, const char *const *names, size_t n)
{
    while (n > 0 && strcmp(names[n - 1], name) != 0)
        n--;
    return n > 0;
}

/* Appends the title of a column of values. A name that has a fixed meaning in the file gets the
 * prefix "value of". */
static void put_title(const TreeColumn *column, Text *text)
{
    bool is_taken = is_among(column->name, node_columns, NODE_COLUMNS) ||
                    is_among(column->name, csv_segment_titles, CSV_SEGMENT_TITLES);
    text_puts(text, is_taken ? ",\"value of " : ",\"");
    put_quoted(column->name, text);
    if (*column->unit) {
        text_puts(text, " [");
        put_quoted(column->unit, text);
        text_puts(text, "]");
    }
    text_puts(text, "\"");
}

/* Appends the first `n` titles, and the title of links if the tree has them. */
static void put_titles(const Tree *tree, const char *const *titles, size_t n, Text *text)
{
    for (size_t k = 0; k < n; k++) {
        text_puts(text, k ? "," : "");
        text_puts(text, titles[k]);
    }
    text_puts(text, tree->link ? ",same_as" : "");
    for (size_t k = 0; k < tree->n_columns; k++)
        put_title(&tree->column[k], text);
    text_puts(text, "\n");
}

/* Appends a comma and the number; nothing follows the comma if the number is NAN. */
static void put_number(double value, Text *text)
{
    char number[NUMBER_TEXT_SIZE + 1] = ",";
    if (!isnan(value))
        number_text(value, number + 1);
    text_append(text, number, strlen(number));
}

static void put_position(Vec3 position, Text *text)
{
    put_number(position.x, text);
    put_number(position.y, text);
    put_number(position.z, text);
}

/* In a tree with links, appends the field same_as: the id of the node that the link names. */
static void put_link(const Tree *tree, size_t i, Text *text)
{
    if (tree_has_link(tree, i))
        text_printf(text, ",%d", tree->id[tree->link[i]]);
    else
        text_puts(text, tree->link ? "," : "");
}

/* Appends the values of the tree's columns, and ends the row. */
static void put_values(const Tree *tree, size_t i, Text *text)
{
    put_link(tree, i, text);
    for (size_t k = 0; k < tree->n_columns; k++)
        put_number(tree->column[k].value[i], text);
    text_puts(text, "\n");
}

Status csv_write(const Tree *tree, Text *text, Err *err)
{
    (void)err;
    comments_put(&tree->meta, NULL, text);
    put_titles(tree, node_columns, tree->flow_share ? LINK : SHARE, text);
    for (size_t i = 0; i < tree->n; i++) {
        text_printf(text, "%d,%d", tree->id[i],
                    tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : -1);
        put_position(tree->position[i], text);
        put_number(tree->radius_mm[i], text);
        text_printf(text, ",%d", tree->type[i]);
        if (tree->flow_share)
            put_number(tree->flow_share[i], text);
        put_values(tree, i, text);
    }
    return STATUS_OK;
}

Status csv_segments_write(const Tree *tree, Text *text, Err *err)
{
    (void)err;
    comments_put(&tree->meta, NULL, text);
    put_titles(tree, csv_segment_titles, CSV_SEGMENT_TITLES - 1, text);
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        text_printf(text, "%d,%d", tree->id[i], tree->id[tree->parent[i]]);
        put_position(tree->position[tree->parent[i]], text);
        put_position(tree->position[i], text);
        put_number(tree->radius_mm[i], text);
        put_number(tree_segment_length(tree, i), text);
        put_values(tree, i, text);
    }
    return STATUS_OK;
}
