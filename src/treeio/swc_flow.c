/* Flow shares travel as header lines, which every SWC reader skips. They may stand before the rows
 * they speak of, so they are kept as read and given to the tree when it is whole. */
#include "treeio/comments.h"
#include "treeio/swc.h"

#include <stdlib.h>
#include <string.h>

static const char key[] = "flow_share";
static const char blanks[] = " \t\v\f";

typedef struct FlowShareLine {
    int32_t id;
    double share;
    size_t number; /* of the line */
} FlowShareLine;

bool swc_is_flow_share(const char *line)
{
    return comment_value(line, key) != NULL;
}

/* Copies the next word at *at, and moves past it; false when there is none or it is too long. */
static bool next_word(const char **at, char *word, size_t size)
{
    *at += strspn(*at, blanks);
    size_t length = strcspn(*at, blanks);
    if (length == 0 || length >= size)
        return false;
    memcpy(word, *at, length);
    word[length] = '\0';
    *at += length;
    return true;
}

static bool parse(const char *text, FlowShareLine *out)
{
    char id[32], share[400];
    long long number;
    if (!next_word(&text, id, sizeof id) || !next_word(&text, share, sizeof share) ||
        text[strspn(text, blanks)] || !integer_parse(id, 1, TREE_MAX_ID, &number))
        return false;
    out->id = (int32_t)number;
    return number_parse(share, &out->share) && isfinite(out->share) && out->share > 0;
}

Status swc_flow_share_parse(FlowShareLines *lines, const char *line, size_t number, Err *err)
{
    FlowShareLine read = {.number = number};
    const char *text = comment_value(line, key);
    if (!parse(text, &read))
        return err_set(err, STATUS_INPUT,
                       "%s:%zu: flow_share is '%.40s'; it must be the id of a node and a number "
                       "above 0",
                       lines->name, number, text);
    TRY(mem_reserve(&lines->line, &lines->capacity, lines->n + 1, sizeof read, "flow shares", err));
    lines->line[lines->n++] = read;
    return STATUS_OK;
}

/* Index + 1 of the node of every id, 0 where there is none, in *table (owned). */
static Status index_ids(const Tree *tree, int32_t **table, Err *err)
{
    TRY(mem_calloc(table, TREE_MAX_ID + (size_t)1, sizeof **table, "table entries for ids", err));
    for (size_t i = 0; i < tree->n; i++)
        (*table)[tree->id[i]] = (int32_t)i + 1;
    return STATUS_OK;
}

/* A share is above 0, so a node that has one is a node that was named. */
static Status assign(const FlowShareLines *lines, const int32_t *table, Tree *tree, Err *err)
{
    for (size_t k = 0; k < lines->n; k++) {
        const FlowShareLine *line = &lines->line[k];
        int32_t entry = table[line->id];
        if (!entry)
            return err_set(err, STATUS_INPUT,
                           "%s:%zu: flow_share names the node %d, which is no row's id",
                           lines->name, line->number, line->id);
        double *share = &tree->flow_share[entry - 1];
        if (*share > 0)
            return err_set(err, STATUS_INPUT,
                           "%s:%zu: an earlier line says the flow share of node %d, too",
                           lines->name, line->number, line->id);
        *share = line->share;
    }
    return STATUS_OK;
}

/* The key terminal_flow must go with the lines. */
static Status check_rule(const FlowShareLines *lines, const TreeMeta *meta, Err *err)
{
    bool territory = meta_number(meta, META_TERMINAL_FLOW) == TERMINAL_FLOW_TERRITORY;
    if (!meta->known[META_TERMINAL_FLOW] || territory == (lines->n > 0))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   territory ? "%s: terminal_flow is territory, but there are no flow_share lines"
                             : "%s: terminal_flow is equal, but there are flow_share lines",
                   lines->name);
}

Status swc_flow_shares_apply(const FlowShareLines *lines, Tree *tree, Err *err)
{
    TRY(check_rule(lines, &tree->meta, err));
    if (lines->n == 0)
        return STATUS_OK;
    int32_t *table = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(tree_add_flow_shares(tree, err));
    TRY_GOTO(index_ids(tree, &table, err));
    TRY_GOTO(assign(lines, table, tree, err));
done:
    free(table);
    return status;
}

void swc_flow_shares_release(FlowShareLines *lines)
{
    free(lines->line);
    *lines = (FlowShareLines){0};
}

void swc_flow_shares_write(const Tree *tree, FILE *stream)
{
    for (size_t i = 0; tree->flow_share && i < tree->n; i++) {
        char number[NUMBER_TEXT_SIZE];
        if (tree->flow_share[i] > 0)
            fprintf(stream, "# %s: %d %s\n", key, tree->id[i],
                    number_text(tree->flow_share[i], number));
    }
}
