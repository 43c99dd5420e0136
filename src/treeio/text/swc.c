/* Reads and writes SWC. Flow shares are comments "flow_share: ID SHARE", and pairs of terminals are
 * comments "terminal_pair: ID ID", because every reader of SWC skips comments.
 *
 * Parsing numbers takes most of the time, so all processors read a large file. The text is divided
 * into blocks of whole lines. A thread parses the plain rows of a block (seven numbers and nothing
 * else) up to the first line that is not a plain row, without changing the text. Then, in the order
 * of the file, these rows are added to the builder, and the rest of the block is read line by line.
 * Only the reader of single lines reports errors. A wave has only a few blocks per thread, so that
 * its rows stay in the processor's cache. Rows are written in the same way, one page per thread.
 *
 * Accepted dialects: commas or semicolons may separate fields. A line may name the columns, with or
 * without '#'. Ids may start at 0, which the first row shows. A root may have the parent 0. Further
 * columns, as in Vaa3D's ESWC, become columns of the tree. */
#include "treeio/comments.h"
#include "treeio/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The fields of SWC, and the maximum number of fields of a row with further columns. */
enum { N_FIELDS = 7, MAX_FIELDS = 100 };

#define BETWEEN_FIELDS TEXT_BLANKS ",;"

static const char share_key[] = "flow_share";

/* The state of reading. */
typedef struct SwcReader {
    TreeBuilder *builder;
    size_t n_fields;    /* number of fields of each row; 0: no row has been read */
    int32_t lowest_id;  /* 0 or 1 */
    const char *titles; /* the last line that names columns (borrowed from the text), or NULL */
    char *rest;         /* the text that is not read yet; NULL: none is left */
    size_t line;        /* number of the first line of `rest` */
} SwcReader;

/* Converts an id of the file to an id of the tree, whose ids start at 1. A number below the file's
 * lowest id, as the parent 0 in a file whose ids start at 1, means that there is no node. */
static int64_t id_of(const SwcReader *reader, int32_t number)
{
    return number < reader->lowest_id ? TREE_NO_PARENT : (int64_t)number + 1 - reader->lowest_id;
}

/* Reads the id of a node or of a parent, an integer of at least `minimum`. */
static Status read_id(const SwcReader *reader, const char *what, const char *text, int32_t minimum,
                      int64_t *id, Err *err)
{
    int32_t number = 0;
    TRY(field_integer(what, text, minimum, TREE_MAX_ID - 1 + reader->lowest_id, &number, err));
    *id = id_of(reader, number);
    return STATUS_OK;
}

/* Reads a row that was cut into fields. */
static Status read_row(const SwcReader *reader, size_t line, char *const *field, Err *err)
{
    const double any = -HUGE_VAL;
    TreeBuilder *builder = reader->builder;
    BuilderNode node = {.record = line};
    TRY(read_id(reader, "id", field[0], reader->lowest_id, &node.id, err));
    TRY(field_integer("type", field[1], INT32_MIN, INT32_MAX, &node.type, err));
    TRY(field_number("x coordinate", field[2], any, &node.position.x, err));
    TRY(field_number("y coordinate", field[3], any, &node.position.y, err));
    TRY(field_number("z coordinate", field[4], any, &node.position.z, err));
    TRY(field_radius(builder->options, "radius", field[5], &node.radius_mm, err));
    TRY(read_id(reader, "parent", field[6], TREE_NO_PARENT, &node.parent, err));
    TRY(builder_node(builder, &node, err));
    for (size_t k = 0; k + N_FIELDS < reader->n_fields; k++) {
        double value;
        TRY(field_value("value", field[N_FIELDS + k], &value, err));
        TRY(builder_value(builder, k, value, err));
    }
    return STATUS_OK;
}

static bool is_whole(double value, double minimum, double maximum)
{
    return value >= minimum && value <= maximum && value == (double)(int64_t)value;
}

static Status read_pair(TreeBuilder *builder, size_t line, const char *value, Err *err)
{
    double id[2];
    if (!numbers_parse(value, 2, id) || !is_whole(id[0], 1, TREE_MAX_ID) ||
        !is_whole(id[1], 1, TREE_MAX_ID))
        return err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be the ids of two nodes",
                       tree_pairs_name, value);
    return builder_pair(builder, (int64_t)id[0], (int64_t)id[1], line, err);
}

static Status read_share(TreeBuilder *builder, size_t line, const char *value, Err *err)
{
    double number[2]; /* id and share */
    if (!numbers_parse(value, 2, number) || !is_whole(number[0], 1, TREE_MAX_ID) ||
        !isfinite(number[1]) || number[1] <= 0)
        return err_set(err, STATUS_INPUT,
                       "flow_share is '%.40s'; it must be the id of a node and a number above 0",
                       value);
    return builder_share(builder, (int64_t)number[0], number[1], line, err);
}

/* Returns true if a line names the columns: its third to fifth words are x, y and z. */
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

/* Reads a comment, from after its '#'. */
static Status read_comment(SwcReader *reader, size_t line, const char *comment, Err *err)
{
    const char *share = comment_value(comment, share_key);
    if (share)
        return read_share(reader->builder, line, share, err);
    const char *pair = comment_value(comment, tree_pairs_name);
    if (pair)
        return read_pair(reader->builder, line, pair, err);
    if (names_columns(comment))
        reader->titles = comment;
    return comment_read(&reader->builder->meta, comment, err);
}

/* Cuts a line into fields. `field` receives the first MAX_FIELDS of them. Returns the count of all
 * fields. */
static size_t cut_fields(char *line, char **field)
{
    size_t count = 0;
    for (char *word; (word = text_field(&line)); count++)
        if (count < MAX_FIELDS)
            field[count] = word;
    return count;
}

/* Adds the columns after the seventh. Their names come from the last line that names as many
 * columns as the rows have. Without such a line, they are "column 8" and so on. */
static Status add_columns(const SwcReader *reader, Err *err)
{
    char *copy = NULL, *title[MAX_FIELDS], number[32];
    TRY(mem_strdup(&copy, reader->titles ? reader->titles : "", err));
    bool named = cut_fields(copy + strspn(copy, "#"), title) == reader->n_fields;
    Status status = STATUS_OK;
    for (size_t i = N_FIELDS, column; status == STATUS_OK && i < reader->n_fields; i++) {
        snprintf(number, sizeof number, "column %zu", i + 1);
        status = builder_column(reader->builder, named ? title[i] : number, "", &column, err);
    }
    free(copy);
    return status;
}

static Status begin_rows(SwcReader *reader, const char *id, size_t count, Err *err)
{
    double first;
    reader->lowest_id = !(number_parse(id, &first) && first == 0);
    reader->n_fields = count;
    return add_columns(reader, err);
}

static Status refuse_count(const SwcReader *reader, size_t count, Err *err)
{
    if (count > MAX_FIELDS)
        return err_set(err, STATUS_INPUT, "the row has %zu fields; it must have at most %d", count,
                       MAX_FIELDS);
    if (reader->n_fields > N_FIELDS)
        return err_set(err, STATUS_INPUT, "the row has %zu field%s; earlier rows have %zu", count,
                       count == 1 ? "" : "s", reader->n_fields);
    return err_set(err, STATUS_INPUT,
                   "the row has %zu field%s; it must have %d: id type x y z radius parent", count,
                   count == 1 ? "" : "s", N_FIELDS);
}

/* Reads a line of any kind: comment, titles or row. */
static Status read_line(SwcReader *reader, char *line, Err *err)
{
    char *field[MAX_FIELDS];
    line += strspn(line, TEXT_BLANKS);
    if (*line == '#')
        return read_comment(reader, reader->line, line + 1, err);
    if (reader->n_fields == 0 && names_columns(line)) {
        reader->titles = line;
        return STATUS_OK;
    }
    char *comment = strchr(line, '#');
    if (comment)
        *comment = '\0';
    TRY(fields_check_commas(line, err));
    size_t count = cut_fields(line, field);
    if (count == 0)
        return STATUS_OK;
    bool fits = reader->n_fields == 0 ? count >= N_FIELDS : count == reader->n_fields;
    if (!fits || count > MAX_FIELDS)
        return refuse_count(reader, count, err);
    if (reader->n_fields == 0)
        TRY(begin_rows(reader, field[0], count, err));
    return read_row(reader, reader->line, field, err);
}

/* Reads the lines that begin before `end`. */
static Status read_lines(SwcReader *reader, const char *end, Err *err)
{
    for (; reader->rest && reader->rest < end; reader->line++) {
        char *line = text_line(&reader->rest);
        TRY(builder_blame(reader->builder, reader->line, read_line(reader, line, err), err));
    }
    return STATUS_OK;
}

/* ---- plain rows ------------------------------------------------------------------------------ */

/* A block has 256 kB, some 5,000 rows, which take far longer to parse than a thread takes to start
 * on them. A row has at least 14 bytes: seven digits and seven ends. A wave has 8 blocks per
 * thread. More blocks balance the threads better; fewer keep the rows of a wave in the cache. None
 * of the numbers changes the result. */
enum { BLOCK = 1 << 18, SHORTEST_ROW = 14, BLOCKS_PER_THREAD = 8 };

/* Whole lines of the text. */
typedef struct SwcBlock {
    char *rest, *end;  /* the part that is not parsed yet */
    BuilderNode *node; /* receives the rows of the block; borrowed from the wave */
    size_t n;          /* number of rows parsed */
} SwcBlock;

/* Blocks that are parsed at the same time. */
typedef struct SwcWave {
    const SwcReader *reader;
    SwcBlock *block;   /* owned */
    BuilderNode *node; /* rows of all blocks; owned */
    size_t n;          /* maximum number of blocks */
} SwcWave;

/* Parses a plain row at *rest, and moves *rest past it. Returns false, and moves nothing, for any
 * line that read_row would not accept or that has more than seven numbers. */
static bool take_row(const SwcReader *reader, char **rest, BuilderNode *node)
{
    const char *at = *rest;
    double field[N_FIELDS];
    for (size_t k = 0; k < N_FIELDS; k++) {
        while (text_separates_fields(*at))
            at++;
        if (!number_take(&at, &field[k]) || (!text_separates_fields(*at) && k + 1 < N_FIELDS))
            return false;
    }
    while (text_separates_fields(*at))
        at++;
    if ((*at && *at != '\n') || !is_whole(field[1], INT32_MIN, INT32_MAX) || !(field[5] >= 0) ||
        !is_whole(field[0], reader->lowest_id, TREE_MAX_ID - 1 + reader->lowest_id) ||
        !is_whole(field[6], TREE_NO_PARENT, TREE_MAX_ID - 1 + reader->lowest_id))
        return false;
    *node = (BuilderNode){.id = id_of(reader, (int32_t)field[0]),
                          .parent = id_of(reader, (int32_t)field[6]),
                          .type = (int32_t)field[1],
                          .position = {field[2], field[3], field[4]},
                          .radius_mm = field[5]};
    *rest += at - *rest + (*at == '\n');
    return true;
}

static void take_rows(size_t index, int worker, void *context)
{
    const SwcWave *wave = context;
    SwcBlock *block = &wave->block[index];
    (void)worker;
    while (block->rest < block->end && take_row(wave->reader, &block->rest, &block->node[block->n]))
        block->n++;
}

/* Returns the block that begins at `from`. A line that is longer than BLOCK is a block of its own.
 */
static SwcBlock cut_block(char *from, char *end)
{
    char *last = end - from > BLOCK ? memrchr(from, '\n', BLOCK) : end - 1;
    last = last ? last : memchr(from, '\n', (size_t)(end - from));
    return (SwcBlock){.rest = from, .end = last ? last + 1 : end};
}

/* Adds the parsed rows of a block to the builder, and reads the rest of the block by lines. */
static Status finish_block(SwcReader *reader, const SwcBlock *block, Err *err)
{
    for (size_t i = 0; i < block->n; i++, reader->line++) {
        block->node[i].record = reader->line;
        TRY(builder_blame(reader->builder, reader->line,
                          builder_node(reader->builder, &block->node[i], err), err));
    }
    reader->rest = block->rest;
    return read_lines(reader, block->end, err);
}

static Status read_wave(SwcReader *reader, SwcWave *wave, size_t rows_per_block, char *end,
                        Err *err)
{
    size_t n = 0;
    for (char *from = reader->rest; n < wave->n && from < end; from = wave->block[n++].end) {
        wave->block[n] = cut_block(from, end);
        wave->block[n].node = wave->node + n * rows_per_block;
    }
    threads_for(n, 0, take_rows, wave);
    for (size_t i = 0; i < n; i++)
        TRY(finish_block(reader, &wave->block[i], err));
    return STATUS_OK;
}

/* Reads the rest of a text whose rows have seven fields. */
static Status read_plain_rows(SwcReader *reader, char *end, Err *err)
{
    size_t size = (size_t)(end - reader->rest), blocks = size / BLOCK + 1;
    size_t most = (size_t)threads_available() * BLOCKS_PER_THREAD;
    size_t rows = (size < BLOCK ? size : BLOCK) / SHORTEST_ROW + 1;
    SwcWave wave = {.reader = reader, .n = blocks < most ? blocks : most};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&wave.block, wave.n, sizeof *wave.block, "blocks of lines", err));
    TRY_GOTO(mem_calloc(&wave.node, wave.n * rows, sizeof *wave.node, "rows", err));
    while (reader->rest && reader->rest < end)
        TRY_GOTO(read_wave(reader, &wave, rows, end, err));
done:
    free(wave.block);
    free(wave.node);
    return status;
}

Status swc_read(TreeBuilder *builder, char *bytes, size_t size, Err *err)
{
    SwcReader reader = {.builder = builder, .lowest_id = 1, .rest = bytes, .line = 1};
    char *end = bytes + size;
    while (reader.rest && reader.rest < end && reader.n_fields != N_FIELDS)
        TRY(read_lines(&reader, reader.rest + 1, err));
    if (reader.rest && reader.rest < end)
        TRY(read_plain_rows(&reader, end, err));
    if (reader.lowest_id == 1)
        return STATUS_OK;
    if (builder->shares.n > 0 || builder->pairs.n > 0)
        return err_set(err, STATUS_INPUT,
                       "%s: the ids start at 0, but a %s refers to nodes by ids from 1 on",
                       builder->name, builder->shares.n > 0 ? share_key : tree_pairs_name);
    return reading_note(builder->reading, err, "ids start at 0 in the file; 1 was added to each");
}

/* ---- writing --------------------------------------------------------------------------------- */

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

/* Appends a row. printf would take as long as the conversion of all four numbers. */
static char *put_row(const Tree *tree, size_t i, char *to)
{
    to = put_whole(to, tree->id[i]);
    to = put_whole(to, tree->type[i]);
    to = put_number(to, tree->position[i].x);
    to = put_number(to, tree->position[i].y);
    to = put_number(to, tree->position[i].z);
    to = put_number(to, tree->radius_mm[i]);
    to = put_whole(to, tree_is_segment(tree, i) ? tree->id[tree->parent[i]] : -1);
    to[-1] = '\n';
    return to;
}

/* A page has up to 1024 rows, or about 60 kB of text: enough work to be worth a thread, and little
 * memory. The output does not depend on the number. */
enum { ROWS = 1024, LONGEST_ROW = 8 * NUMBER_TEXT_SIZE };

/* Pages of rows that are written at the same time. */
typedef struct SwcPages {
    const Tree *tree;
    size_t first;   /* row of the first page */
    size_t *length; /* per page: length of its text; owned */
    char *text;     /* the texts of all pages, ROWS * LONGEST_ROW characters apart; owned */
} SwcPages;

static void fill_page(size_t index, int worker, void *context)
{
    const SwcPages *pages = context;
    size_t first = pages->first + index * ROWS, left = pages->tree->n - first;
    char *text = pages->text + index * ROWS * LONGEST_ROW, *to = text;
    (void)worker;
    for (size_t i = first; i < first + (left < ROWS ? left : ROWS); i++)
        to = put_row(pages->tree, i, to);
    pages->length[index] = (size_t)(to - text);
}

/* Appends all rows, a page per thread at a time. */
static Status write_rows(const Tree *tree, Text *text, Err *err)
{
    size_t n = (tree->n + ROWS - 1) / ROWS, most = (size_t)threads_available() * BLOCKS_PER_THREAD;
    SwcPages pages = {.tree = tree};
    Status status = STATUS_OK;
    most = n < most ? n : most;
    TRY_GOTO(mem_calloc(&pages.length, most, sizeof *pages.length, "pages", err));
    TRY_GOTO(mem_calloc(&pages.text, most * ROWS, LONGEST_ROW, "rows", err));
    for (; n > 0; n -= most, pages.first += most * ROWS) {
        most = n < most ? n : most;
        threads_for(most, 0, fill_page, &pages);
        for (size_t i = 0; i < most; i++)
            text_append(text, pages.text + i * ROWS * LONGEST_ROW, pages.length[i]);
    }
done:
    free(pages.length);
    free(pages.text);
    return status;
}

bool swc_stores(const TreeColumn *column)
{
    return strcmp(column->name, tree_pairs_name) == 0;
}

Status swc_write(const Tree *tree, Text *text, Err *err)
{
    TreePair *pair;
    size_t pairs;
    /* Remarks that begin with these words would be read as shares or pairs. */
    static const char *const meaningful[] = {share_key, tree_pairs_name, NULL};
    comments_put(&tree->meta, meaningful, text);
    TRY(tree_pairs(tree, &pair, &pairs, err));
    for (size_t k = 0; k < pairs; k++)
        text_printf(text, "# %s: %d %d\n", tree_pairs_name, tree->id[pair[k].node[0]],
                    tree->id[pair[k].node[1]]);
    free(pair);
    for (size_t i = 0; tree->flow_share && i < tree->n; i++)
        if (tree->flow_share[i] > 0) {
            text_printf(text, "# %s: %d ", share_key, tree->id[i]);
            text_number(text, tree->flow_share[i]);
            text_puts(text, "\n");
        }
    return write_rows(tree, text, err);
}
