/* Decks of SimVascular's svOneDSolver: a card a line, its fields as that program's reader takes
 * them (cvOneDOptionsLegacySerializer.cxx). Nodes that lie apart are one where a JOINT card says
 * that the segments that they end are joined. A segment tapers from one area to the other; in a
 * tree it has the radius of the distal one, as nodes of other formats have, and both areas are
 * columns.
 *
 * All cards are collected before any name in them is looked up, since they may come in any
 * order. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/names.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Fields of a SEGMENT card. */
typedef enum SegmentField {
    SEGMENT_NAME = 1,
    SEGMENT_ID,
    SEGMENT_LENGTH,
    SEGMENT_ELEMENTS,
    SEGMENT_IN_NODE,
    SEGMENT_OUT_NODE,
    SEGMENT_IN_AREA,
    SEGMENT_OUT_AREA,
    SEGMENT_FIELDS /* those that are read */
} SegmentField;

enum { MAX_FIELDS = 1000 /* of a card */ };

typedef struct Segment {
    char *in_node, *out_node; /* borrowed from the text, as all words here */
    size_t in, out;           /* points, once all nodes are there */
    size_t line;
    double length, elements, in_area, out_area;
} Segment;

/* The segments that a JOINTINLET or JOINTOUTLET card names. */
typedef struct SegmentList {
    size_t first, count; /* in Deck.word */
} SegmentList;

/* Those of one of the two cards, by their names. */
typedef struct Lists {
    bool enters; /* blood enters the joint through these segments */
    Names names;
    SegmentList *list;
    size_t capacity;
} Lists;

typedef struct Joint {
    char *inlet, *outlet;
    size_t line;
} Joint;

typedef struct Deck {
    Graph *graph;
    Names nodes, segments;
    Lists inlets, outlets;
    Segment *segment;
    size_t segments_capacity;
    Joint *joint;
    size_t n_joints, joints_capacity;
    char **word;
    size_t n_words, words_capacity;
    bool in_table;
} Deck;

static void release(Deck *deck)
{
    names_release(&deck->nodes);
    names_release(&deck->segments);
    names_release(&deck->inlets.names);
    names_release(&deck->outlets.names);
    free(deck->inlets.list);
    free(deck->outlets.list);
    free(deck->segment);
    free(deck->joint);
    free(deck->word);
}

/* A card and its fields, field[0] being its name. */
typedef struct Card {
    char **field;
    size_t count, line;
} Card;

typedef Status ReadCard(Deck *deck, const Card *card, Err *err);

static Status read_node(Deck *deck, const Card *card, Err *err)
{
    GraphPoint point = {.radius = (double)NAN, .record = card->line};
    double *const coordinate[] = {&point.position.x, &point.position.y, &point.position.z};
    for (size_t i = 0; i < 3; i++)
        TRY(field_number("coordinate", card->field[2 + i], -HUGE_VAL, coordinate[i], err));
    TRY(names_add(&deck->nodes, card->field[1], deck->graph->n_points, card->line, err));
    return graph_point(deck->graph, &point, err);
}

static Status read_segment(Deck *deck, const Card *card, Err *err)
{
    char **field = card->field;
    Segment segment = {
        .in_node = field[SEGMENT_IN_NODE], .out_node = field[SEGMENT_OUT_NODE], .line = card->line};
    TRY(field_number("length", field[SEGMENT_LENGTH], 0, &segment.length, err));
    TRY(field_number("number of elements", field[SEGMENT_ELEMENTS], 0, &segment.elements, err));
    TRY(field_number("inlet area", field[SEGMENT_IN_AREA], 0, &segment.in_area, err));
    TRY(field_number("outlet area", field[SEGMENT_OUT_AREA], 0, &segment.out_area, err));
    TRY(names_add(&deck->segments, field[SEGMENT_ID], deck->segments.n, card->line, err));
    TRY(mem_reserve(&deck->segment, &deck->segments_capacity, deck->segments.n,
                    sizeof *deck->segment, "segments", err));
    deck->segment[deck->segments.n - 1] = segment;
    return STATUS_OK;
}

static Status read_joint(Deck *deck, const Card *card, Err *err)
{
    TRY(mem_reserve(&deck->joint, &deck->joints_capacity, deck->n_joints + 1, sizeof *deck->joint,
                    "joints", err));
    deck->joint[deck->n_joints++] = (Joint){card->field[3], card->field[4], card->line};
    return STATUS_OK;
}

static Status read_list(Deck *deck, Lists *lists, const Card *card, Err *err)
{
    int32_t count = 0;
    size_t n = lists->names.n;
    TRY(field_whole("number of segments", card->field[2], 1, MAX_FIELDS - 3, &count, err));
    if ((size_t)count != card->count - 3)
        return err_set(err, STATUS_INPUT, "the card says %d segments and names %zu", count,
                       card->count - 3);
    TRY(names_add(&lists->names, card->field[1], n, card->line, err));
    TRY(mem_reserve(&lists->list, &lists->capacity, n + 1, sizeof *lists->list, "lists of segments",
                    err));
    TRY(mem_reserve(&deck->word, &deck->words_capacity, deck->n_words + (size_t)count,
                    sizeof *deck->word, "segments of joints", err));
    lists->list[n] = (SegmentList){deck->n_words, (size_t)count};
    memcpy(deck->word + deck->n_words, card->field + 3, (size_t)count * sizeof *deck->word);
    deck->n_words += (size_t)count;
    return STATUS_OK;
}

static Status read_inlet(Deck *deck, const Card *card, Err *err)
{
    return read_list(deck, &deck->inlets, card, err);
}

static Status read_outlet(Deck *deck, const Card *card, Err *err)
{
    return read_list(deck, &deck->outlets, card, err);
}

static Status begin_table(Deck *deck, const Card *card, Err *err)
{
    (void)card;
    (void)err;
    deck->in_table = true;
    return STATUS_OK;
}

static const struct {
    const char *name;
    size_t fewest, most; /* fields, its name among them */
    ReadCard *read;      /* NULL: it says nothing about the tree */
} cards[] = {
    {"NODE", 5, 5, read_node},
    {"JOINT", 5, 5, read_joint},
    {"JOINTINLET", 4, MAX_FIELDS, read_inlet},
    {"JOINTOUTLET", 4, MAX_FIELDS, read_outlet},
    {"SEGMENT", SEGMENT_FIELDS, 17, read_segment},
    {"DATATABLE", 2, MAX_FIELDS, begin_table},
    {"MODEL", 1, MAX_FIELDS, NULL},
    {"SOLVEROPTIONS", 1, MAX_FIELDS, NULL},
    {"MATERIAL", 1, MAX_FIELDS, NULL},
    {"OUTPUT", 1, MAX_FIELDS, NULL},
    {"COUPLING", 1, MAX_FIELDS, NULL},
};

enum { N_CARDS = sizeof cards / sizeof *cards };

/* The first word is the name of a card. */
bool oned_detect(const char *start)
{
    start = text_first_row(start);
    size_t i = 0, length = strcspn(start, TEXT_BLANKS "\r\n");
    while (i < N_CARDS &&
           (strlen(cards[i].name) != length || strncasecmp(cards[i].name, start, length) != 0))
        i++;
    return i < N_CARDS;
}

/* SimVascular heads its decks with "UNITS IN CGS", corcast with "Units: cm, g, s". */
static Status read_comment(Graph *graph, const char *comment, Err *err)
{
    if (strcasestr(comment, "units in cgs") || strcasestr(comment, "units: cm, g, s"))
        graph->unit_said = true;
    return comment_read_key(&graph->meta, comment, err);
}

static Status read_line(void *reader, size_t number, char *line, Err *err)
{
    Deck *deck = reader;
    char *field[MAX_FIELDS];
    line += strspn(line, TEXT_BLANKS);
    if (*line == '#')
        return read_comment(deck->graph, line + 1, err);
    TRY(fields_check_commas(line, err));
    Card card = {field, fields_cut(line, field, MAX_FIELDS), number};
    if (card.count == 0)
        return STATUS_OK;
    if (deck->in_table) {
        deck->in_table = strcasecmp(field[0], "ENDDATATABLE") != 0;
        return STATUS_OK;
    }
    size_t i = 0;
    while (i < N_CARDS && strcasecmp(cards[i].name, field[0]) != 0)
        i++;
    if (i == N_CARDS)
        return err_set(err, STATUS_INPUT, "'%.40s' is no card of a deck of svOneDSolver", field[0]);
    if (card.count < cards[i].fewest || card.count > cards[i].most)
        return err_set(err, STATUS_INPUT,
                       "the %s card has %zu fields behind its name; it has %s%zu", cards[i].name,
                       card.count - 1, cards[i].fewest == cards[i].most ? "" : "at least ",
                       cards[i].fewest - 1);
    return cards[i].read ? cards[i].read(deck, &card, err) : STATUS_OK;
}

/* ---- what the cards mean ---- */

typedef enum DeckColumn { LENGTH, IN_AREA, OUT_AREA, ELEMENTS, DECK_COLUMNS } DeckColumn;

static const struct {
    const char *name, *unit;
} deck_columns[DECK_COLUMNS] = {[LENGTH] = {"length", "cm"},
                                [IN_AREA] = {"inlet area", "cm2"},
                                [OUT_AREA] = {"outlet area", "cm2"},
                                [ELEMENTS] = {"elements", ""}};

static Status add_segment(Deck *deck, size_t i, Err *err)
{
    Graph *graph = deck->graph;
    Segment *segment = &deck->segment[i];
    TRY(names_find(&deck->nodes, segment->in_node, &segment->in, err));
    TRY(names_find(&deck->nodes, segment->out_node, &segment->out, err));
    const GraphLine line = {.a = segment->in,
                            .b = segment->out,
                            .radius = sqrt(segment->out_area / PI),
                            .is_directed = true,
                            .record = segment->line};
    TRY(graph_line(graph, &line, err));
    const double value[DECK_COLUMNS] = {[LENGTH] = segment->length,
                                        [IN_AREA] = segment->in_area,
                                        [OUT_AREA] = segment->out_area,
                                        [ELEMENTS] = segment->elements};
    for (size_t k = 0; k < DECK_COLUMNS; k++)
        TRY(graph_value(graph, k, i, value[k], err));
    return STATUS_OK;
}

/* Joins the ends of the segments of a list with *point, or makes the first *point. */
static Status join_list(Deck *deck, const Lists *lists, char *name, size_t *point, Err *err)
{
    size_t number;
    TRY(names_find(&lists->names, name, &number, err));
    const SegmentList *list = &lists->list[number];
    for (size_t i = 0; i < list->count; i++) {
        TRY(names_find(&deck->segments, deck->word[list->first + i], &number, err));
        const Segment *segment = &deck->segment[number];
        size_t end = lists->enters ? segment->out : segment->in;
        if (*point == deck->graph->n_points)
            *point = end;
        TRY(graph_join(deck->graph, *point, end, err));
    }
    return STATUS_OK;
}

static Status join_ends(Deck *deck, const Joint *joint, Err *err)
{
    size_t point = deck->graph->n_points;
    TRY(join_list(deck, &deck->inlets, joint->inlet, &point, err));
    return join_list(deck, &deck->outlets, joint->outlet, &point, err);
}

static Status add_segments(Deck *deck, Err *err)
{
    Graph *graph = deck->graph;
    size_t column;
    for (size_t k = 0; k < DECK_COLUMNS; k++)
        TRY(graph_column(graph, GRAPH_LINES, deck_columns[k].name, deck_columns[k].unit, &column,
                         err));
    for (size_t i = 0; i < deck->segments.n; i++)
        TRY(graph_blame(graph, GRAPH_LINES, deck->segment[i].line, add_segment(deck, i, err), err));
    for (size_t i = 0; i < deck->n_joints; i++)
        TRY(graph_blame(graph, GRAPH_LINES, deck->joint[i].line,
                        join_ends(deck, &deck->joint[i], err), err));
    return reading_note(graph->reading, err,
                        "a segment has the radius of its outlet area; materials, tables and "
                        "boundary conditions are left out");
}

Status oned_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    (void)size;
    Deck deck = {.graph = graph,
                 .nodes = {.what = "NODE"},
                 .segments = {.what = "SEGMENT of number"},
                 .inlets = {.names = {.what = "JOINTINLET"}, .enters = true},
                 .outlets = {.names = {.what = "JOINTOUTLET"}}};
    graph->unit = LENGTH_CM;
    graph->is_named = true;
    Status status = lines_read(graph->name, bytes, read_line, &deck, err);
    if (status == STATUS_OK)
        status = add_segments(&deck, err);
    release(&deck);
    return status;
}

/* ---- writing ---- */

/* A tree on its way into a deck: node i is NODE i, its segment SEGMENT i - 1. */
typedef struct DeckTree {
    const Tree *tree;
    Text *text;
    int32_t *children;                               /* of each node */
    double *share;                                   /* of the flow that leaves at each node */
    double all_shares, flow_cm3_s, pressure_dyn_cm2; /* through the inlet, at the terminals */
} DeckTree;

static void put_number(Text *text, double value)
{
    text_puts(text, " ");
    text_number(text, value);
}

static double cm_from_mm(double mm)
{
    return length_from_mm(mm, LENGTH_CM);
}

static void put_nodes(const DeckTree *deck)
{
    for (size_t i = 0; i < deck->tree->n; i++) {
        Vec3 at = deck->tree->position[i];
        text_printf(deck->text, "NODE %zu", i);
        put_number(deck->text, cm_from_mm(at.x));
        put_number(deck->text, cm_from_mm(at.y));
        put_number(deck->text, cm_from_mm(at.z));
        text_puts(deck->text, "\n");
    }
}

/* The joint at the end of segment i, whose children are `outlet`. */
static void put_joint(const DeckTree *deck, size_t i, const int32_t *outlet)
{
    int32_t count = deck->children[i];
    text_printf(deck->text, "JOINT J%zu %zu IN%zu OUT%zu\nJOINTINLET IN%zu 1 %zu\n", i, i, i, i, i,
                i - 1);
    text_printf(deck->text, "JOINTOUTLET OUT%zu %d", i, count);
    for (int32_t k = 0; k < count; k++)
        text_printf(deck->text, " %d", outlet[k] - 1);
    text_puts(deck->text, "\n");
}

/* Children of a node stand together in `child`, those of node i from first[i] on. */
static Status put_joints(const DeckTree *deck, Err *err)
{
    const Tree *tree = deck->tree;
    size_t *first = NULL;
    int32_t *child = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&first, tree->n + 1, sizeof *first, "children", err));
    TRY_GOTO(mem_calloc(&child, tree->n, sizeof *child, "children", err));
    for (size_t i = 0; i < tree->n; i++)
        first[i + 1] = first[i] + (size_t)deck->children[i];
    for (size_t i = tree->n; i-- > 1;)
        child[--first[tree->parent[i] + 1]] = (int32_t)i;
    for (size_t i = 1; i < tree->n; i++)
        if (deck->children[i] > 0)
            put_joint(deck, i, &child[first[i + 1]]);
done:
    free(first);
    free(child);
    return status;
}

bool oned_keeps(const TreeColumn *column)
{
    for (size_t k = 0; k < DECK_COLUMNS; k++)
        if (strcmp(column->name, deck_columns[k].name) == 0 &&
            strcmp(column->unit, deck_columns[k].unit) == 0)
            return true;
    return false;
}

/* The value of a column that a deck brought, or else `otherwise`. */
static double deck_value(const Tree *tree, DeckColumn k, size_t i, double otherwise)
{
    const TreeColumn *column = tree_column(tree, deck_columns[k].name);
    return column && oned_keeps(column) && column->value[i] > 0 ? column->value[i] : otherwise;
}

static void put_segment(const DeckTree *deck, size_t i)
{
    enum { ELEMENTS_OF_A_SEGMENT = 5 };
    const Tree *tree = deck->tree;
    double radius = cm_from_mm(tree->radius_mm[i]), area = PI * radius * radius;
    double outlet = deck_value(tree, OUT_AREA, i, area);
    bool as_read = fabs(outlet - area) <= 1e-9 * area;
    text_printf(deck->text, "SEGMENT segment%d %zu", tree->id[i], i - 1);
    put_number(deck->text, deck_value(tree, LENGTH, i, cm_from_mm(tree_segment_length(tree, i))));
    text_printf(deck->text, " %.0f %d %zu", deck_value(tree, ELEMENTS, i, ELEMENTS_OF_A_SEGMENT),
                tree->parent[i], i);
    put_number(deck->text, as_read ? deck_value(tree, IN_AREA, i, area) : area);
    put_number(deck->text, as_read ? outlet : area);
    text_puts(deck->text, " 0.0 BLOOD NONE 0.0 0 0");
    if (deck->children[i] == 0)
        text_printf(deck->text, " RESISTANCE R%zu\n", i);
    else
        text_puts(deck->text, " NOBOUND NONE\n");
}

/* What resists the flow out of each terminal so that the pressure there is as it should be. */
static void put_tables(const DeckTree *deck)
{
    for (size_t i = 1; i < deck->tree->n; i++) {
        if (deck->children[i] > 0)
            continue;
        double flow = deck->flow_cm3_s * deck->share[i] / deck->all_shares;
        text_printf(deck->text, "DATATABLE R%zu LIST\n0.0", i);
        put_number(deck->text, flow > 0 ? deck->pressure_dyn_cm2 / flow : 1e12);
        text_puts(deck->text, "\nENDDATATABLE\n");
    }
    text_puts(deck->text, "\nDATATABLE INFLOW LIST\n0.0");
    put_number(deck->text, deck->flow_cm3_s);
    text_puts(deck->text, "\n1.0");
    put_number(deck->text, deck->flow_cm3_s);
    text_puts(deck->text, "\nENDDATATABLE\n");
}

/* Walls as stiff as those of the solver's own test cases of rigid vessels. */
static void put_material(const DeckTree *deck)
{
    const TreeMeta *meta = &deck->tree->meta;
    double viscosity_cp = meta->known[META_VISCOSITY] ? meta->number[META_VISCOSITY] : 4;
    text_puts(deck->text, "\nMATERIAL BLOOD OLUFSEN 1.06");
    put_number(deck->text, viscosity_cp * 0.01);
    text_puts(deck->text, " 0 2.0 1.0e15 -20 1e9\n\n"
                          "SOLVEROPTIONS 0.001 100 1000 2 INFLOW FLOW 1.0e-6 1 1\n\nOUTPUT TEXT\n");
}

static Status check_tree(const DeckTree *deck, Err *err)
{
    size_t roots = 0;
    for (size_t i = 0; i < deck->tree->n; i++)
        roots += !tree_is_segment(deck->tree, i);
    if (roots > 1)
        return err_set(err, STATUS_INPUT,
                       "a deck of svOneDSolver holds one tree; this is a forest of %zu", roots);
    if (deck->children[0] != 1)
        return err_set(err, STATUS_INPUT,
                       "a deck of svOneDSolver has one segment at its inlet; this tree has %d",
                       deck->children[0]);
    return STATUS_OK;
}

/* What the tree does not say, the deck says in a comment to have been made up. */
static void choose_flow(DeckTree *deck)
{
    const TreeMeta *meta = &deck->tree->meta;
    bool flow = meta->known[META_Q_PERF], pressure = meta->known[META_P_TERM];
    deck->flow_cm3_s = flow ? meta->number[META_Q_PERF] / 60 : 1;
    deck->pressure_dyn_cm2 = 10 * pa_from_mmhg(pressure ? meta->number[META_P_TERM] : 60);
    if (!flow)
        text_puts(deck->text, "# The tree says no flow: that of INFLOW, 1 cm3/s, stands for it.\n");
    if (!pressure)
        text_puts(deck->text, "# The tree says no pressure: that at the terminals is 60 mmHg.\n");
    for (size_t i = 0; i < deck->tree->n; i++)
        deck->all_shares += deck->share[i];
}

static Status put_deck(DeckTree *deck, Err *err)
{
    TRY(check_tree(deck, err));
    text_puts(deck->text, "# Units: cm, g, s\n");
    choose_flow(deck);
    text_puts(deck->text, "\nMODEL tree_\n\n");
    put_nodes(deck);
    text_puts(deck->text, "\n");
    TRY(put_joints(deck, err));
    text_puts(deck->text, "\n");
    for (size_t i = 1; i < deck->tree->n; i++)
        put_segment(deck, i);
    text_puts(deck->text, "\n");
    put_tables(deck);
    put_material(deck);
    return STATUS_OK;
}

Status oned_write(const Tree *tree, Text *text, Err *err)
{
    DeckTree deck = {.tree = tree, .text = text};
    Status status = STATUS_OK;
    comments_put(&tree->meta, NULL, text);
    TRY_GOTO(tree_child_counts(tree, &deck.children, err));
    TRY_GOTO(tree_flow_shares(tree, &deck.share, err));
    TRY_GOTO(put_deck(&deck, err));
done:
    free(deck.children);
    free(deck.share);
    return status;
}
