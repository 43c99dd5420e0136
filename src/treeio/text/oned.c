/* Reads and writes decks, the input files of SimVascular's svOneDSolver: one card per line, with
 * the fields that the solver's reader defines (cvOneDOptionsLegacySerializer.cxx).
 *
 * A JOINT card connects ends of segments. The nodes at these ends may differ in position; they
 * become one point of the graph. A segment tapers from its inlet area to its outlet area. The
 * segment's radius in the tree is that of the outlet, because other formats state the radius at the
 * distal end. Both areas are kept as columns of the tree, so that the writer can restore them.
 * Cards may come in any order, so the names of segments in joints are looked up after the last
 * card. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/text/dialect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The cards. The cards from OTHER_CARDS on are accepted and ignored. */
enum { NODE, SEGMENT, JOINT, JOINT_INLET, JOINT_OUTLET, DATA_TABLE, OTHER_CARDS, CARDS = 11 };

/* The segments that a JOINTINLET or JOINTOUTLET card names. */
typedef struct SegmentList {
    size_t first, count; /* in DeckState.segment_names */
} SegmentList;

/* All JOINTINLET lists, or all JOINTOUTLET lists, with the names of the lists. */
typedef struct SegmentLists {
    bool is_inlet; /* true: blood enters the joint through these segments */
    Names names;
    ARRAY(SegmentList) list;
} SegmentLists;

typedef struct DeckJoint {
    char *inlet, *outlet; /* names of lists */
    size_t line;
} DeckJoint;

/* The joints of a deck, and the state of reading. Texts are borrowed from the file. */
typedef struct DeckState {
    SegmentLists inlets, outlets;
    ARRAY(DeckJoint) joint;
    ARRAY(char *) segment_names; /* of all lists, one list after another */
    bool in_table;               /* the next line is in a DATATABLE */
} DeckState;

static Status read_joint(DialectReader *reader, DialectRow *row, Err *err)
{
    DeckState *deck = reader->own;
    return ARRAY_PUSH(&deck->joint, "joints", err,
                      (DeckJoint){row->field[3], row->field[4], row->line});
}

/* Notes the segments that a JOINTINLET or JOINTOUTLET card names. */
static Status read_list(DialectReader *reader, DialectRow *row, Err *err)
{
    DeckState *deck = reader->own;
    SegmentLists *lists = reader->section == JOINT_INLET ? &deck->inlets : &deck->outlets;
    size_t n = lists->list.n, first = deck->segment_names.n;
    int32_t count = 0;
    TRY(field_integer("number of segments", row->field[2], 1, INT32_MAX, &count, err));
    if ((size_t)count != row->count - 3)
        return err_set(err, STATUS_INPUT, "the card states %d segments, but names %zu", count,
                       row->count - 3);
    TRY(names_add(&lists->names, row->field[1], n, row->line, err));
    TRY(ARRAY_PUSH(&lists->list, "lists of segments", err, (SegmentList){first, (size_t)count}));
    for (size_t k = 3; k < row->count; k++)
        TRY(ARRAY_PUSH(&deck->segment_names, "segments of joints", err, row->field[k]));
    return STATUS_OK;
}

/* Per card: its name; the word for it in errors; the minimum number of its fields; the maximum
 * number (0: any number); the kind of element that the card's columns describe, without effect for
 * cards that have no columns; the function that reads its other fields. */
static const DialectSection cards[CARDS] = {
    [NODE] = {"NODE", "a NODE card", 5, 5, GRAPH_POINTS, NULL},
    [SEGMENT] = {"SEGMENT", "a SEGMENT card", 9, 17, GRAPH_LINES, NULL},
    [JOINT] = {"JOINT", "a JOINT card", 5, 5, GRAPH_LINES, read_joint},
    [JOINT_INLET] = {"JOINTINLET", "a JOINTINLET card", 4, 0, GRAPH_LINES, read_list},
    [JOINT_OUTLET] = {"JOINTOUTLET", "a JOINTOUTLET card", 4, 0, GRAPH_LINES, read_list},
    [DATA_TABLE] = {"DATATABLE", "a DATATABLE card", 2, 0, GRAPH_LINES, NULL},
    [OTHER_CARDS] = {.title = "MODEL"},
    {.title = "SOLVEROPTIONS"},
    {.title = "MATERIAL"},
    {.title = "OUTPUT"},
    {.title = "COUPLING"},
};

/* The first fields are the columns of the tree, in this order. */
enum { LENGTH, IN_AREA, OUT_AREA, ELEMENTS, DECK_COLUMNS };

static const DialectField fields[] = {
    [LENGTH] = {SEGMENT, 3, FIELD_NUMBER, "length", "cm", true},
    [IN_AREA] = {SEGMENT, 7, FIELD_NUMBER, "inlet area", "cm2", true},
    [OUT_AREA] = {SEGMENT, 8, FIELD_NUMBER, "outlet area", "cm2", true},
    [ELEMENTS] = {SEGMENT, 4, FIELD_NUMBER, "elements", "", true},
    {SEGMENT, 2, FIELD_SEGMENT, "number", "", false},
    {SEGMENT, 5, FIELD_FROM, "node", "", false},
    {SEGMENT, 6, FIELD_TO, "node", "", false},
    {SEGMENT, 8, FIELD_AREA, "outlet area", "cm2", true},
    {NODE, 2, FIELD_POSITION, "coordinate", "cm", false},
    {NODE, 1, FIELD_POINT, "node", "", false},
};

/* Recognizes the comments that state the unit. SimVascular begins its decks with "UNITS IN CGS",
 * corcast with "Units: cm, g, s". */
static Status read_comment(Graph *graph, const char *comment, Err *err)
{
    if (strcasestr(comment, "units in cgs") || strcasestr(comment, "units: cm, g, s"))
        graph->unit_is_stated = true;
    return comment_read_key_only(&graph->meta, comment, err);
}

/* Finds the card of a line, and skips the lines in a DATATABLE. */
static Status choose_card(DialectReader *reader, DialectRow *row, bool *is_row, Err *err)
{
    DeckState *deck = reader->own;
    *is_row = !deck->in_table;
    if (deck->in_table) {
        deck->in_table = strcasecmp(row->field[0], "ENDDATATABLE") != 0;
        return STATUS_OK;
    }
    reader->section = dialect_find_section(reader->dialect, row->field[0]);
    deck->in_table = reader->section == DATA_TABLE;
    return reader->section < CARDS
               ? STATUS_OK
               : err_set(err, STATUS_INPUT, "'%.40s' is not a card of svOneDSolver", row->field[0]);
}

static const Dialect dialect = {.section = cards,
                                .n_sections = CARDS,
                                .field = fields,
                                .n_fields = sizeof fields / sizeof *fields,
                                .comment = read_comment,
                                .choose = choose_card};

/* Returns true if the first word of the first row is the name of a card. */
bool oned_detect(const char *start)
{
    char word[32];
    start = text_first_row(start);
    size_t length = strcspn(start, TEXT_BLANKS "\r\n");
    snprintf(word, sizeof word, "%.*s", length < sizeof word ? (int)length : 0, start);
    return dialect_find_section(&dialect, word) < CARDS;
}

/* ---- joints ---------------------------------------------------------------------------------- */

/* Joins the ends of the segments of a list to *point. If *point is not a point of the graph yet, it
 * becomes the first of these ends. */
static Status join_list(DialectReader *reader, const SegmentLists *lists, char *name, size_t *point,
                        Err *err)
{
    const DeckState *deck = reader->own;
    size_t number;
    TRY(names_find(&lists->names, name, &number, err));
    const SegmentList *list = &lists->list.items[number];
    for (size_t i = 0; i < list->count; i++) {
        TRY(names_find(&reader->segments, deck->segment_names.items[list->first + i], &number,
                       err));
        const GraphLine *line = &reader->pending.items[number].line;
        size_t end = lists->is_inlet ? line->b : line->a;
        if (*point == reader->graph->n_points)
            *point = end;
        TRY(graph_join(reader->graph, *point, end, err));
    }
    return STATUS_OK;
}

/* Joins all segments of a JOINT card. */
static Status join_ends(DialectReader *reader, const DeckJoint *joint, Err *err)
{
    const DeckState *deck = reader->own;
    size_t point = reader->graph->n_points;
    TRY(join_list(reader, &deck->inlets, joint->inlet, &point, err));
    return join_list(reader, &deck->outlets, joint->outlet, &point, err);
}

static void release_lists(SegmentLists *lists)
{
    names_release(&lists->names);
    ARRAY_RELEASE(&lists->list);
}

Status oned_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    DeckState deck = {.inlets = {.names = {.what = "JOINTINLET"}, .is_inlet = true},
                      .outlets = {.names = {.what = "JOINTOUTLET"}}};
    DialectReader reader = {.dialect = &dialect,
                            .graph = graph,
                            .own = &deck,
                            .points = {.what = "NODE"},
                            .segments = {.what = "SEGMENT number"}};
    Status status = STATUS_OK;
    graph->unit = LENGTH_CM;
    graph->is_named = true;
    TRY_GOTO(dialect_read(&reader, bytes, size, err));
    TRY_GOTO(dialect_add_segments(&reader, err));
    for (size_t i = 0; i < deck.joint.n; i++)
        TRY_GOTO(graph_blame(graph, GRAPH_LINES, deck.joint.items[i].line,
                             join_ends(&reader, &deck.joint.items[i], err), err));
    TRY_GOTO(reading_note(graph->reading, err,
                          "radii come from the outlet areas; materials, tables and boundary "
                          "conditions were left out"));
done:
    dialect_release(&reader);
    release_lists(&deck.inlets);
    release_lists(&deck.outlets);
    ARRAY_RELEASE(&deck.joint);
    ARRAY_RELEASE(&deck.segment_names);
    return status;
}

/* ---- writing ---- */

/* A tree that is being written. Node 0 is the root. Node i is NODE i, and its segment is SEGMENT
 * i - 1. */
typedef struct DeckTree {
    const Tree *tree;
    Text *text;
    int32_t *children;       /* per node: number of its children; owned */
    double *share;           /* per node: its flow share; owned */
    double all_shares;       /* sum of the shares */
    double flow_cm3_s;       /* flow through the inlet */
    double pressure_dyn_cm2; /* pressure at the terminals */
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

/* Appends the joint at the end of segment i. `outlet` lists its children. */
static void put_joint(const DeckTree *deck, size_t i, const uint32_t *outlet)
{
    int32_t count = deck->children[i];
    text_printf(deck->text, "JOINT J%zu %zu IN%zu OUT%zu\nJOINTINLET IN%zu 1 %zu\n", i, i, i, i, i,
                i - 1);
    text_printf(deck->text, "JOINTOUTLET OUT%zu %d", i, count);
    for (int32_t k = 0; k < count; k++)
        text_printf(deck->text, " %u", outlet[k] - 1);
    text_puts(deck->text, "\n");
}

/* Appends the joint of each node that has children. */
static Status put_joints(const DeckTree *deck, Err *err)
{
    const Tree *tree = deck->tree;
    IndexLists children = {0};
    Status status = STATUS_OK;
    TRY_GOTO(indexlists_begin(&children, tree->n, "children", err));
    for (size_t i = 1; i < tree->n; i++)
        indexlists_count(&children, (size_t)tree->parent[i]);
    TRY_GOTO(indexlists_allot(&children, "children", err));
    for (size_t i = 1; i < tree->n; i++)
        indexlists_put(&children, (size_t)tree->parent[i], (uint32_t)i);
    for (size_t i = 1; i < tree->n; i++)
        if (deck->children[i] > 0)
            put_joint(deck, i, children.items + children.first[i]);
done:
    indexlists_release(&children);
    return status;
}

bool oned_stores(const TreeColumn *column)
{
    for (size_t k = 0; k < DECK_COLUMNS; k++)
        if (strcmp(column->name, fields[k].name) == 0 && strcmp(column->unit, fields[k].unit) == 0)
            return true;
    return false;
}

/* Returns the value of a column that came from a deck, or `otherwise` if there is none. */
static double deck_value(const Tree *tree, size_t k, size_t i, double otherwise)
{
    const TreeColumn *column = tree_column(tree, fields[k].name);
    return column && oned_stores(column) && column->value[i] > 0 ? column->value[i] : otherwise;
}

/* Appends a SEGMENT card. The areas of a deck are restored only if the radius still agrees with the
 * outlet area, to 1e-9, which is above the rounding errors of the conversion. */
static void put_segment(const DeckTree *deck, size_t i)
{
    /* Finite elements along a segment. The flow is steady, so the pressure falls linearly along a
     * segment, which few elements represent well. The solver's time grows with their number. */
    enum { ELEMENTS_OF_A_SEGMENT = 5 };
    const Tree *tree = deck->tree;
    double radius = cm_from_mm(tree->radius_mm[i]), area = PI * radius * radius;
    double outlet = deck_value(tree, OUT_AREA, i, area);
    bool is_unchanged = fabs(outlet - area) <= 1e-9 * area;
    text_printf(deck->text, "SEGMENT segment%d %zu", tree->id[i], i - 1);
    put_number(deck->text, deck_value(tree, LENGTH, i, cm_from_mm(tree_segment_length(tree, i))));
    text_printf(deck->text, " %.0f %d %zu", deck_value(tree, ELEMENTS, i, ELEMENTS_OF_A_SEGMENT),
                tree->parent[i], i);
    put_number(deck->text, is_unchanged ? deck_value(tree, IN_AREA, i, area) : area);
    put_number(deck->text, is_unchanged ? outlet : area);
    text_puts(deck->text, " 0.0 BLOOD NONE 0.0 0 0");
    if (deck->children[i] == 0)
        text_printf(deck->text, " RESISTANCE R%zu\n", i);
    else
        text_puts(deck->text, " NOBOUND NONE\n");
}

/* Appends the resistance at each terminal, and the constant flow at the inlet. The resistance is
 * the terminal pressure over the flow, since the pressure beyond it is 0. A terminal without flow
 * gets a resistance of 1e12 dyn s/cm5, which lets almost nothing through. */
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

/* Appends the material and the options of the solver.
 *
 * The numbers of the material, in this order:
 * - 1.06: density, g/cm3, a usual value for blood.
 * - the viscosity, poise. The default, 4 cP, is a usual value for blood.
 * - 0: reference pressure.
 * - 2.0: exponent of the velocity profile.
 * - 1.0e15, -20 and 1e9: k1, k2 and k3 of Olufsen's law for the stiffness of walls. They are those
 *   of the solver's own test cases of rigid vessels.
 *
 * The options of the solver, in this order. The inflow is constant and the walls are stiff, so
 * the flow is steady long before the end:
 * - 0.001: time step, s. A shorter step takes longer and gives the same steady flow.
 * - 100: number of steps between outputs: ten outputs, the last of which is the result.
 * - 1000: number of steps, one second in all.
 * - 2: number of quadrature points per element. They integrate polynomials of degree 3 exactly.
 * - INFLOW FLOW: table and kind of the inlet's condition.
 * - 1.0e-6: tolerance that ends the iterations of a step.
 * - 1 and 1: the conservative formulation, and stabilization on. */
static void put_material(const DeckTree *deck)
{
    const TreeMeta *meta = &deck->tree->meta;
    double viscosity_cp = meta->known[META_VISCOSITY] ? meta->number[META_VISCOSITY] : 4;
    text_puts(deck->text, "\nMATERIAL BLOOD OLUFSEN 1.06");
    put_number(deck->text, viscosity_cp * 0.01);
    text_puts(deck->text, " 0 2.0 1.0e15 -20 1e9\n\n"
                          "SOLVEROPTIONS 0.001 100 1000 2 INFLOW FLOW 1.0e-6 1 1\n\nOUTPUT TEXT\n");
}

/* Refuses trees that a deck cannot hold. */
static Status check_tree(const DeckTree *deck, Err *err)
{
    size_t roots = 0;
    for (size_t i = 0; i < deck->tree->n; i++)
        roots += !tree_is_segment(deck->tree, i);
    if (roots > 1)
        return err_set(err, STATUS_INPUT,
                       "an input file of svOneDSolver can hold one tree; this file has %zu", roots);
    if (deck->children[0] != 1)
        return err_set(
            err, STATUS_INPUT,
            "an input file of svOneDSolver must have one segment at its inlet; this tree has %d",
            deck->children[0]);
    return STATUS_OK;
}

/* Chooses the flow and the pressure, and sums the flow shares. If the tree lacks one of the two, a
 * placeholder is used (1 cm3/s, 60 mmHg), and a comment in the deck states this. The user has to
 * replace a placeholder: it only lets the solver run. */
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

/* Appends all cards of the deck. */
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
