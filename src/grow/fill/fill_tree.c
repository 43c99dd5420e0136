/* Fills a grown tree with smaller vessels whose numbers, diameters and lengths follow a published
 * table of morphometry. The steps are: find the elements (vessels of one order) of the grown tree,
 * draw the others at random [fill_draw.c], place them [fill_place.c], repair [fill_repair.c], solve
 * the flow, and write the tree. */
#include "grow/fill/fill_place.h"
#include "grow/finish.h"

#include <math.h>
#include <stdlib.h>

/* Changes the seed, so that a filling does not draw the random numbers of growth with the same
 * seed. The bytes are the word "fill". */
static const uint64_t own_seed = 0x66696c6c;

static Status check(const GrowParams *params, const FillRules *rules, const Domain *domain,
                    Err *err)
{
    TRY(grow_blood_check(params, err));
    if (!params->from)
        return err_set(err, STATUS_USAGE, "`fill` needs `from`, the tree to be filled");
    if (domain->dimension != 3)
        return err_set(
            err, STATUS_USAGE,
            "`fill`: the domain has two dimensions; it must have three, because published "
            "tables describe vessels in three dimensions");
    if (rules->from < 2 || rules->from > (int)rules->table->n)
        return err_set(err, STATUS_USAGE,
                       "`fill_from` is %d; it must be from 2 to %zu, the highest order of %s",
                       rules->from, rules->table->n, rules->name);
    if (rules->to < 1 || rules->to >= rules->from)
        return err_set(err, STATUS_USAGE,
                       "`fill_to` is %d; it must be from 1 to %d, below `fill_from`", rules->to,
                       rules->from - 1);
    for (size_t i = 0; i < params->from->n; i++)
        if (tree_is_segment(params->from, i) && !(params->from->radius_mm[i] > 0))
            return err_set(err, STATUS_INPUT,
                           "`fill`: node %d of the tree has radius 0; vessels need radii above 0",
                           params->from->id[i]);
    return STATUS_OK;
}

/* ---- the grown elements ---------------------------------------------------------------------- */

/* Adds the element that segment i begins, as a daughter of element `above`, which may be none. */
static Status begin_element(Filling *filling, int32_t order, int32_t above, Err *err)
{
    if (above != NO_ELEMENT) {
        int less = filling->element[above].order - order;
        if (less < PUBLISHED_DAUGHTERS)
            filling->element[above].present[less]++;
    }
    return filling_add(filling, (FillElement){.order = order, .parent = NO_ELEMENT, .grown = true},
                       err);
}

/* Adds the elements of the grown tree, and sets `of_node` to the element of each segment. */
static Status add_grown(const Tree *tree, Filling *filling, int32_t *of_node, Err *err)
{
    const Lineage lineage = {tree->parent, tree->radius_mm, tree->n};
    const Morphometry *table = filling->rules.table;
    double *bound = NULL;
    int32_t *order = NULL, *heir = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&bound, table->n, sizeof *bound, "orders", err));
    TRY_GOTO(mem_calloc(&order, tree->n, sizeof *order, "orders", err));
    TRY_GOTO(mem_calloc(&heir, tree->n, sizeof *heir, "orders", err));
    for (size_t k = 0; k < table->n; k++)
        bound[k] = morphometry_bound_mm(table, (int)k + 1);
    lineage_bounded_orders(&lineage, bound, table->n, order);
    lineage_main_daughters(&lineage, order, heir);
    for (size_t i = 0; i < tree->n; i++) {
        int32_t parent = tree->parent[i];
        of_node[i] = NO_ELEMENT;
        if (parent == TREE_NO_PARENT)
            continue;
        of_node[i] = heir[parent] == (int32_t)i ? of_node[parent] : NO_ELEMENT;
        if (of_node[i] == NO_ELEMENT) {
            TRY_GOTO(begin_element(filling, order[i], of_node[parent], err));
            of_node[i] = (int32_t)filling->n - 1;
        }
        FillElement *element = &filling->element[of_node[i]];
        element->radius_mm = tree->radius_mm[i];
        element->widest_mm = fmax(element->widest_mm, tree->radius_mm[i]);
        element->grown_mm += tree_segment_length(tree, i);
    }
done:
    free(bound);
    free(order);
    free(heir);
    return status;
}

/* Marks the elements whose last segments are terminals. */
static Status find_open(const Tree *tree, const int32_t *of_node, Filling *filling, Err *err)
{
    int32_t *children = NULL;
    TRY(tree_child_counts(tree, &children, err));
    for (size_t i = 0; i < tree->n; i++)
        if (of_node[i] != NO_ELEMENT)
            filling->element[of_node[i]].is_open = children[i] == 0;
    free(children);
    return STATUS_OK;
}

/* ---- the flow -------------------------------------------------------------------------------- */

/* Sets the flow shares to the flows, ml/min, at which all terminals have one pressure. Conductances
 * are summed from the terminals to the roots, and flows divided from the roots to the terminals. */
static Status solve_flow(Tree *tree, double drop_pa, double *q_ml_min, Err *err)
{
    double *viscosity = NULL, *conductance = NULL, *below = NULL, *flow = NULL;
    Status status;
    *q_ml_min = 0;
    TRY_GOTO(derive_viscosity(tree, &(TreeMeta){0}, &viscosity, err));
    TRY_GOTO(mem_calloc(&conductance, tree->n, sizeof *conductance, "conductances", err));
    TRY_GOTO(mem_calloc(&below, tree->n, sizeof *below, "conductances", err));
    TRY_GOTO(mem_calloc(&flow, tree->n, sizeof *flow, "flows", err));
    for (size_t i = tree->n; i-- > 0;) {
        double resistance =
            poiseuille_resistance(viscosity[i], tree_segment_length(tree, i), tree->radius_mm[i]);
        conductance[i] = 1 / (resistance + (below[i] > 0 ? 1 / below[i] : 0));
        if (tree_is_segment(tree, i))
            below[tree->parent[i]] += conductance[i];
    }
    for (size_t i = 0; i < tree->n; i++) {
        int32_t parent = tree->parent[i];
        flow[i] = parent == TREE_NO_PARENT ? ml_min_from_mm3_s(below[i] * drop_pa)
                                           : flow[parent] * (conductance[i] / below[parent]);
        *q_ml_min += parent == TREE_NO_PARENT ? flow[i] : 0;
    }
    for (size_t i = 0; i < tree->n; i++)
        if (below[i] > 0)
            flow[i] = 0;
    tree_set_flow_shares(tree, flow);
    flow = NULL;
done:
    free(viscosity);
    free(conductance);
    free(below);
    free(flow);
    return status;
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Returns the id of node i. Nodes of `from`, which come first, keep their ids; new nodes have
 * larger ids. */
static int64_t id_of(const Places *places, const Tree *from, int32_t i)
{
    int32_t origin = places->node[i].origin;
    return origin == NO_NODE ? places->last_id + 1 + i - (int32_t)from->n : from->id[origin];
}

/* Adds a node to the builder. A node of `from` keeps its values in the columns, which have the same
 * indices as in `from`. */
static Status add_node(const Places *places, const Tree *from, int32_t i, TreeBuilder *builder,
                       Err *err)
{
    const FillNode *node = &places->node[i];
    bool is_new = node->origin == NO_NODE;
    TRY(builder_node(builder,
                     &(BuilderNode){.id = id_of(places, from, i),
                                    .parent = node->parent == NO_NODE
                                                  ? TREE_NO_PARENT
                                                  : id_of(places, from, node->parent),
                                    .type = is_new ? TREE_VESSEL_TYPE : from->type[node->origin],
                                    .position = node->at,
                                    .radius_mm = node->radius},
                     err));
    for (size_t k = 0; k < from->n_columns && !is_new; k++)
        TRY(builder_value(builder, k, from->column[k].value[node->origin], err));
    return STATUS_OK;
}

static Status write_nodes(const Places *places, const Tree *from, Tree *out, Err *err)
{
    TreeBuilder builder = {.name = "the filled tree"};
    Status status;
    size_t column;
    for (size_t k = 0; k < from->n_columns; k++)
        TRY_GOTO(
            builder_column(&builder, from->column[k].name, from->column[k].unit, &column, err));
    for (size_t i = 0; i < places->n; i++)
        TRY_GOTO(add_node(places, from, (int32_t)i, &builder, err));
    TRY_GOTO(builder_build(&builder, out, err));
done:
    builder_release(&builder);
    return status;
}

/* Sets the metadata: those of growth, without the law that the filled tree does not obey, and the
 * lines of `from`. */
static Status describe(const GrowParams *params, const FillRules *rules, const Domain *domain,
                       TreeMeta *meta, Err *err)
{
    char text[128];
    snprintf(text, sizeof text, "%s, orders %d to %d", rules->name, rules->to, rules->from - 1);
    TRY(meta_set_text(meta, META_FILL, text, err));
    TRY(finish_describe(params, domain, meta, err));
    meta->known[META_GAMMA] = meta->known[META_GAMMA_BY_RADIUS] = meta->known[META_LAMBDA] = false;
    meta->known[META_TERMINAL_FLOW] = false;
    TRY(meta_add_lines(meta, err));
    for (size_t i = 0; i < params->from->meta.n_lines; i++)
        if (params->from->meta.line[i].text)
            TRY(meta_add_text(meta, params->from->meta.line[i].key, params->from->meta.line[i].text,
                              err));
    return STATUS_OK;
}

/* Sets the number of terminals, and the spread of their flows. */
static void report_flow(const Tree *tree, GrowReport *report)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < tree->n; i++) {
        report->terminals += tree->flow_share[i] > 0;
        sum += tree->flow_share[i];
        squares += tree->flow_share[i] * tree->flow_share[i];
    }
    double n = (double)report->terminals;
    report->fill.flow_spread = sqrt(fmax(0, squares * n / (sum * sum) - 1));
}

/* Writes the tree with its metadata and flows. */
static Status write_tree(const Places *places, const GrowParams *params, Tree *out,
                         GrowReport *report, Err *err)
{
    double drop = pa_from_mmhg(params->blood.p_perf_mmhg - params->blood.p_term_mmhg);
    TRY(write_nodes(places, params->from, out, err));
    TRY(describe(params, &places->filling->rules, places->domain, &out->meta, err));
    TRY(solve_flow(out, drop, &report->fill.flow_ml_min, err));
    meta_set_number(&out->meta, META_Q_PERF, report->fill.flow_ml_min);
    report_flow(out, report);
    report->root_radius_mm = tree_root_radius(out);
    return STATUS_OK;
}

Status fill_tree(const GrowParams *params, const FillRules *rules, const Domain *domain, Tree *out,
                 GrowReport *report, Err *err)
{
    TRY(check(params, rules, domain, err));
    double begun = clock_seconds();
    const Tree *from = params->from;
    Filling filling = {0};
    Places places = {.domain = domain, .filling = &filling};
    GrowReport made = {
        .target = (double)NAN, .thickness = 1, .apart_mm = INFINITY, .complete = true};
    Tree tree = {0};
    int32_t *of_node = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&of_node, from->n, sizeof *of_node, "nodes", err));
    TRY_GOTO(filling_init(&filling, rules, params->seed ^ own_seed, err));
    TRY_GOTO(add_grown(from, &filling, of_node, err));
    TRY_GOTO(find_open(from, of_node, &filling, err));
    const size_t grown = filling.n;
    TRY_GOTO(filling_draw(&filling, err));
    TRY_GOTO(places_init(&places, from, err));
    for (size_t i = 0; i < from->n; i++)
        if (of_node[i] != NO_ELEMENT)
            places.end_node[of_node[i]] = (int32_t)i;
    TRY_GOTO(places_fill(&places, params, err));
    TRY_GOTO(places_repair(&places, &made.broken, err));
    TRY_GOTO(write_tree(&places, params, &tree, &made, err));
    made.fill.elements = filling.n - grown - places.left_out;
    made.fill.left_out = places.left_out;
    made.seconds = clock_seconds() - begun;
    *out = tree;
    tree = (Tree){0};
    if (report)
        *report = made;
done:
    free(of_node);
    tree_release(&tree);
    places_release(&places);
    filling_release(&filling);
    return status;
}
