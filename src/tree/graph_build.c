/* Builds the tree of a network in three steps.
 *
 * Loops: if loops are to be cut, the lines are sorted, thickest first, and taken one by one unless
 * they close a loop (Kruskal, Proc. AMS 7 (1956), 48). The lines that are left out are then the
 * thinnest line of each loop.
 *
 * Roots: the root of a component is the first of the points with the highest rank. The ranks, from
 * high to low, are: a stated inlet; a point that directed lines only leave; an end; any point.
 * Among points of equal rank the thickest wins.
 *
 * Directions: a breadth-first search from each root directs the lines. It follows vessels, the
 * chains of lines between points that do not join just two lines, from end to end. A line that
 * reaches a point for the second time closes a loop, and gets a node with a link. It is therefore
 * the last line of its vessel. */
#include "tree/graph_parts.h"
#include "tree/tree.h"

#include <stdlib.h>
#include <string.h>

static const ReadOptions no_options = {0};

/* A line of the graph as a connection of two kept points (points that represent merged points). */
typedef struct GraphLink {
    uint32_t a, b;
    uint32_t line;    /* index in Graph.line */
    double thickness; /* mm */
} GraphLink;

typedef struct Building {
    Graph *graph;
    const ReadOptions *options;
    TreeReading *reading;
    /* All arrays are owned. */
    uint32_t *representative; /* per point: the kept point that it is merged with */
    GraphLink *link;
    size_t n_links;
    uint32_t *component; /* per point: the sets of connected points [base/sets.h] */
    IndexLists links;    /* per kept point: its links */
    uint32_t *parent;    /* per kept point: its parent + 1; 0: none */
    uint32_t *above;     /* per kept point: the link to its parent */
    bool *used;          /* per link: it has been directed; `a` is then its proximal point */
    uint32_t *closing;   /* the links that get nodes with links */
    size_t n_closing;
    size_t n_spanning; /* number of the links that close no loop */
} Building;

static void release(Building *building)
{
    free(building->representative);
    free(building->link);
    free(building->component);
    indexlists_release(&building->links);
    free(building->parent);
    free(building->above);
    free(building->used);
    free(building->closing);
}

/* ---- lines ---- */

/* Returns the radius of a line; if it has none, the smaller radius of its points, or 0. */
static double thickness_of(const Graph *graph, const GraphLine *line)
{
    if (!isnan(line->radius))
        return line->radius;
    double a = graph->point[line->a].radius, b = graph->point[line->b].radius;
    return isnan(a) || isnan(b) ? 0 : fmin(a, b);
}

/* Makes the links of all lines whose points were not merged with each other. */
static Status link_lines(Building *building, Err *err)
{
    const Graph *graph = building->graph;
    TRY(mem_calloc(&building->link, graph->n_lines, sizeof *building->link, "lines", err));
    for (size_t i = 0; i < graph->n_lines; i++) {
        const GraphLine *line = &graph->line[i];
        if (line->a >= graph->n_points || line->b >= graph->n_points)
            return graph_blame(graph, GRAPH_LINES, line->record,
                               err_set(err, STATUS_INPUT,
                                       "the line leads to point %zu; there are %zu points, "
                                       "numbered from 0 on",
                                       line->a > line->b ? line->a : line->b, graph->n_points),
                               err);
        GraphLink link = {building->representative[line->a], building->representative[line->b],
                          (uint32_t)i, thickness_of(graph, line)};
        if (link.a == link.b)
            building->reading->network.without_length++;
        else
            building->link[building->n_links++] = link;
    }
    return STATUS_OK;
}

static int order_lines(const void *a, const void *b)
{
    const GraphLink *one = a, *other = b;
    return one->line < other->line ? -1 : 1;
}

static int thickest_first(const void *a, const void *b)
{
    const GraphLink *one = a, *other = b;
    int order = compare_numbers(other->thickness, one->thickness);
    return order ? order : order_lines(a, b);
}

/* Describes a link by numbers that are equal for two links exactly if one repeats the other: both
 * points, the radii, and the values of the line and of its two ends in all columns. Polylines of
 * several lines may overlap, such as polylines that each lead from the root to one outlet; for
 * their lines, only points and radii count. `out` has space for 4 numbers and 2 per column. Returns
 * the count of numbers. */
static size_t describe_link(const Building *building, const GraphLink *link, double *out)
{
    const Graph *graph = building->graph;
    const GraphLine *line = &graph->line[link->line];
    const bool turned = link->a > link->b;
    const size_t ends[] = {turned ? line->b : line->a, turned ? line->a : line->b};
    size_t n = 0;
    out[n++] = turned ? link->b : link->a;
    out[n++] = turned ? link->a : link->b;
    for (size_t side = 0; side < 2; side++)
        out[n++] = isnan(line->radius) ? graph->point[ends[side]].radius : line->radius;
    for (size_t k = 0; k < graph->n_columns && !line->is_part; k++) {
        const GraphColumn *column = &graph->column[k];
        const bool of_lines = column->of == GRAPH_LINES;
        for (size_t side = 0; side < (of_lines ? 1 : 2); side++) {
            size_t at = of_lines ? link->line : ends[side];
            out[n++] = at < column->n ? column->value[at] : (double)NAN;
        }
    }
    for (size_t i = 0; i < n; i++)
        out[i] = isnan(out[i]) ? (double)NAN : out[i] + 0.0; /* one NAN, and no -0 */
    return n;
}

/* The links found so far, by the hash of their descriptions. */
typedef struct LinkTable {
    KeyMap last;         /* per hash: its last link + 1 */
    uint32_t *next;      /* per link: the next link + 1 with the same hash; owned */
    double *one, *other; /* descriptions of two links; owned */
} LinkTable;

static bool joins_same(const GraphLink *one, const GraphLink *other)
{
    return (one->a == other->a && one->b == other->b) || (one->a == other->b && one->b == other->a);
}

/* Adds the link with the index `kept` to the table. If the link repeats a link of the table, sets
 * *repeats and adds nothing. */
static Status take_link(const Building *building, LinkTable *table, size_t kept, bool *repeats,
                        Err *err)
{
    const GraphLink *link = building->link;
    size_t n = describe_link(building, &link[kept], table->one);
    uint32_t *last;
    bool is_new;
    TRY(keymap_put(&table->last, key_of_numbers(table->one, n), &last, &is_new, err));
    *repeats = false;
    for (uint32_t i = *last; i && !*repeats; i = table->next[i - 1])
        *repeats = joins_same(&link[kept], &link[i - 1]) &&
                   describe_link(building, &link[i - 1], table->other) == n &&
                   memcmp(table->one, table->other, n * sizeof *table->one) == 0;
    if (*repeats)
        return STATUS_OK;
    table->next[kept] = *last;
    *last = (uint32_t)kept + 1;
    return STATUS_OK;
}

static Status begin_links(const Building *building, LinkTable *table, Err *err)
{
    const size_t most = 4 + 2 * building->graph->n_columns;
    TRY(keymap_begin(&table->last, building->n_links, "slots for lines", err));
    TRY(mem_calloc(&table->next, building->n_links, sizeof *table->next, "lines", err));
    TRY(mem_calloc(&table->one, most, sizeof *table->one, "values of a line", err));
    return mem_calloc(&table->other, most, sizeof *table->other, "values of a line", err);
}

/* Drops each link that repeats an earlier one. Links between the same two points that differ in
 * radius or values are vessels of their own, which close a loop. */
static Status drop_repeated(Building *building, Err *err)
{
    LinkTable table = {0};
    size_t kept = 0;
    Status status = STATUS_OK;
    TRY_GOTO(begin_links(building, &table, err));
    for (size_t i = 0; i < building->n_links; i++) {
        bool repeats;
        building->link[kept] = building->link[i];
        TRY_GOTO(take_link(building, &table, kept, &repeats, err));
        kept += !repeats;
    }
    building->reading->network.repeated = building->n_links - kept;
    building->n_links = kept;
done:
    keymap_release(&table.last);
    free(table.next);
    free(table.one);
    free(table.other);
    return status;
}

/* ---- loops ---- */

/* Records a cut link in the report. */
static Status note_cut(Building *building, const GraphLink *link, Err *err)
{
    TreeReading *reading = building->reading;
    const Graph *graph = building->graph;
    if (reading->network.n_cuts == READ_MAX_CUTS)
        return STATUS_OK;
    if (!reading->network.cut)
        TRY(mem_calloc(&reading->network.cut, READ_MAX_CUTS, sizeof *reading->network.cut, "cuts",
                       err));
    Vec3 a = graph->point[link->a].position, b = graph->point[link->b].position;
    reading->network.cut[reading->network.n_cuts++] =
        (ReadCut){graph->line[link->line].record, vec3_scale(vec3_add(a, b), 0.5), link->thickness};
    return STATUS_OK;
}

/* Finds a spanning forest: takes the links in their order, and moves each link that closes a loop
 * to the end. *kept receives the number of links that close no loop. */
static void span(Building *building, size_t *kept)
{
    uint32_t *component = building->component;
    GraphLink *link = building->link;
    sets_begin(component, building->graph->n_points);
    *kept = 0;
    for (size_t i = 0; i < building->n_links; i++) {
        if (!sets_join(component, link[i].a, link[i].b))
            continue;
        GraphLink taken = link[i];
        link[i] = link[*kept];
        link[(*kept)++] = taken;
    }
}

/* Merges points, and makes the links between kept points. Replaces the links of an earlier call.
 * `by_position` as in graph_merge. */
static Status connect_points(Building *building, bool by_position, Err *err)
{
    free(building->representative);
    free(building->link);
    building->representative = NULL;
    building->link = NULL;
    building->n_links = building->reading->network.without_length = 0;
    TRY(graph_merge(building->graph, by_position, &building->representative, err));
    TRY(link_lines(building, err));
    return building->graph->is_tree ? STATUS_OK : drop_repeated(building, err);
}

/* Counts the links that close loops, and the components of the points that have links. */
static Status count_loops(Building *building, size_t *loops, size_t *components, Err *err)
{
    size_t kept, nodes = 0;
    bool *linked = NULL;
    TRY(mem_calloc(&linked, building->graph->n_points, sizeof *linked, "points", err));
    for (size_t i = 0; i < building->n_links; i++) {
        nodes += !linked[building->link[i].a];
        linked[building->link[i].a] = true;
        nodes += !linked[building->link[i].b];
        linked[building->link[i].b] = true;
    }
    free(linked);
    span(building, &kept);
    *loops = building->n_links - kept;
    *components = nodes - kept;
    return STATUS_OK;
}

/* Merges points at one position. Exception: if merging closes loops in a file whose lines name
 * their points, and if the names alone give the same number of components, points stay apart. A
 * vessel may end at a position where another vessel passes. */
static Status connect(Building *building, Err *err)
{
    Graph *graph = building->graph;
    size_t loops, components, named_loops, named_components;
    TRY(mem_calloc(&building->component, graph->n_points, sizeof *building->component, "components",
                   err));
    TRY(connect_points(building, !graph->is_tree, err));
    if (!graph->is_named || graph->is_tree)
        return STATUS_OK;
    TRY(count_loops(building, &loops, &components, err));
    if (loops == 0)
        return STATUS_OK;
    TRY(connect_points(building, false, err));
    TRY(count_loops(building, &named_loops, &named_components, err));
    return named_components == components ? STATUS_OK : connect_points(building, true, err);
}

static Status refuse_loops(const Building *building, const GraphLink *link, size_t loops, Err *err)
{
    const Graph *graph = building->graph;
    Vec3 at = graph->point[link->a].position;
    return graph_blame(graph, GRAPH_LINES, graph->line[link->line].record,
                       err_set(err, STATUS_INPUT,
                               "the line closes a loop at %g, %g, %g mm (loops in the network: "
                               "%zu); use `break_loops` to cut each loop at its thinnest segment",
                               at.x, at.y, at.z, loops),
                       err);
}

/* Drops the thinnest link of each loop, from the index `kept` on after sorting. */
static Status cut_loops(Building *building, size_t *kept, Err *err)
{
    size_t loops = building->reading->network.loops = building->n_links - *kept;
    qsort(building->link, building->n_links, sizeof *building->link, thickest_first);
    span(building, kept);
    qsort(building->link + *kept, loops, sizeof *building->link, order_lines);
    for (size_t i = *kept; i < building->n_links; i++)
        TRY(note_cut(building, &building->link[i], err));
    building->n_links = *kept;
    return STATUS_OK;
}

/* Cuts the loops, or counts the links that close them. Refuses loops of parents. */
static Status treat_loops(Building *building, Err *err)
{
    size_t kept;
    span(building, &kept);
    building->n_spanning = kept;
    if (kept == building->n_links)
        return STATUS_OK;
    if (building->options->break_loops)
        return cut_loops(building, &kept, err);
    if (building->graph->is_tree)
        return refuse_loops(building, &building->link[kept], building->n_links - kept, err);
    building->reading->network.links = building->n_links - kept;
    qsort(building->link, building->n_links, sizeof *building->link, order_lines);
    return mem_calloc(&building->closing, building->n_links - kept, sizeof *building->closing,
                      "links", err);
}

/* ---- roots ---- */

/* Returns the number of links of a kept point. */
static uint32_t degree_of(const Building *building, size_t point)
{
    return indexlists_length(&building->links, point);
}

/* Returns true if a point becomes a node. A point without lines does so only if the file was
 * written from a tree. */
static bool is_node(const Building *building, size_t point)
{
    return building->representative[point] == point &&
           (degree_of(building, point) > 0 || building->graph->is_tree);
}

/* Lists the links of each point. */
static Status list_links(Building *building, Err *err)
{
    IndexLists *links = &building->links;
    TRY(indexlists_begin(links, building->graph->n_points, "links of points", err));
    for (size_t i = 0; i < building->n_links; i++) {
        indexlists_count(links, building->link[i].a);
        indexlists_count(links, building->link[i].b);
    }
    TRY(indexlists_allot(links, "links of points", err));
    for (uint32_t i = 0; i < building->n_links; i++) {
        indexlists_put(links, building->link[i].a, i);
        indexlists_put(links, building->link[i].b, i);
    }
    return STATUS_OK;
}

static const GraphLink *link_at(const Building *building, uint32_t point, uint32_t k)
{
    return &building->link[building->links.items[building->links.first[point] + k]];
}

/* How good a root a point is for its component; the highest rank wins. */
typedef enum Rank { RANK_ANY, RANK_END, RANK_SOURCE, RANK_INLET } Rank;

typedef struct RootCandidate {
    uint32_t point; /* + 1; 0: none yet */
    Rank rank;
    double thickness;
} RootCandidate;

/* Returns a point as a candidate for the root of its component. */
static RootCandidate candidate_of(const Building *building, uint32_t point)
{
    const Graph *graph = building->graph;
    RootCandidate made = {.point = point + 1};
    bool leads_away = true;
    for (uint32_t k = 0; k < degree_of(building, point); k++) {
        const GraphLink *link = link_at(building, point, k);
        leads_away = leads_away && graph->line[link->line].is_directed && link->a == point;
        made.thickness = fmax(made.thickness, link->thickness);
    }
    made.rank = graph->point[point].is_inlet      ? RANK_INLET
                : leads_away                      ? RANK_SOURCE
                : degree_of(building, point) == 1 ? RANK_END
                                                  : RANK_ANY;
    return made;
}

static bool is_better(const RootCandidate *a, const RootCandidate *b)
{
    return !b->point || a->rank > b->rank || (a->rank == b->rank && a->thickness > b->thickness);
}

/* Finds the root of each component. best[i] receives the best candidate of the component whose
 * first point is i. */
static Status choose_roots(Building *building, RootCandidate *best, Err *err)
{
    TreeReading *reading = building->reading;
    const Graph *graph = building->graph;
    for (uint32_t i = 0; i < graph->n_points; i++) {
        if (!is_node(building, i))
            continue;
        RootCandidate candidate = candidate_of(building, i),
                      *of = &best[sets_find(building->component, i)];
        if (is_better(&candidate, of))
            *of = candidate;
    }
    static const RootReason reasons[] = {[RANK_ANY] = ROOT_THICKEST,
                                         [RANK_END] = ROOT_THICKEST,
                                         [RANK_SOURCE] = ROOT_DIRECTION,
                                         [RANK_INLET] = ROOT_STATED};
    for (uint32_t i = 0; i < graph->n_points; i++) {
        if (!best[i].point)
            continue;
        TRY(mem_reserve(&reading->root, &reading->roots_capacity, reading->n_roots + 1,
                        sizeof *reading->root, "roots", err));
        reading->root[reading->n_roots++] = (ReadRoot){
            (int32_t)best[i].point, graph->is_tree ? ROOT_STATED : reasons[best[i].rank], 0};
    }
    return STATUS_OK;
}

/* Notes how many stated inlets did not become roots. */
static Status note_other_inlets(const Building *building, Err *err)
{
    const TreeReading *reading = building->reading;
    const GraphPoint *point = building->graph->point;
    size_t inlets = 0;
    for (size_t i = 0; i < building->graph->n_points; i++)
        inlets += is_node(building, i) && point[i].is_inlet;
    for (size_t i = 0; i < reading->n_roots; i++)
        inlets -= point[reading->root[i].id - 1].is_inlet;
    if (inlets == 0)
        return STATUS_OK;
    return reading_note(
        building->reading, err,
        "inlets stated in the file that are not roots: %zu (each tree has one root, the thickest "
        "of its inlets)",
        inlets);
}

/* Makes `from` the proximal point of a link, and returns its distal point. */
static uint32_t direct_link(Building *building, GraphLink *link, uint32_t from)
{
    bool turned = link->b == from;
    building->reading->network.against += turned && building->graph->line[link->line].is_directed;
    link->b = turned ? link->a : link->b;
    link->a = from;
    return link->b;
}

#define NO_POINT UINT32_MAX

/* Directs a vessel, from its link `at` at the point `from` on. Returns the point at its other end
 * if no link led there before, else NO_POINT. */
static uint32_t direct_vessel(Building *building, uint32_t from, uint32_t at, bool *reached)
{
    while (!building->used[at]) {
        building->used[at] = true;
        uint32_t to = direct_link(building, &building->link[at], from);
        if (reached[to]) {
            building->closing[building->n_closing++] = at;
            return NO_POINT;
        }
        reached[to] = true;
        building->parent[to] = from + 1;
        building->above[to] = at;
        if (degree_of(building, to) != 2)
            return to;
        const uint32_t *both = building->links.items + building->links.first[to];
        at = both[both[0] == at];
        from = to;
    }
    return NO_POINT;
}

/* Sets the parents of all points of the root's component, breadth first. `queue` and `reached` have
 * space for all points. */
static void direct_from(Building *building, uint32_t root, uint32_t *queue, bool *reached)
{
    size_t done = 0, n = 0;
    queue[n++] = root;
    reached[root] = true;
    while (done < n) {
        uint32_t point = queue[done++];
        for (uint32_t k = 0; k < degree_of(building, point); k++) {
            uint32_t at = building->links.items[building->links.first[point] + k];
            uint32_t end = direct_vessel(building, point, at, reached);
            if (end != NO_POINT)
                queue[n++] = end;
        }
    }
}

/* Chooses the roots, and directs all links away from them. */
static Status direct_links(Building *building, Err *err)
{
    size_t n = building->graph->n_points;
    RootCandidate *best = NULL;
    uint32_t *queue = NULL;
    bool *reached = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&best, n, sizeof *best, "roots", err));
    TRY_GOTO(choose_roots(building, best, err));
    TRY_GOTO(note_other_inlets(building, err));
    TRY_GOTO(mem_calloc(&queue, n, sizeof *queue, "points", err));
    TRY_GOTO(mem_calloc(&reached, n, sizeof *reached, "points", err));
    TRY_GOTO(mem_calloc(&building->used, building->n_links, sizeof *building->used, "lines", err));
    TRY_GOTO(mem_calloc(&building->parent, n, sizeof *building->parent, "parents", err));
    TRY_GOTO(mem_calloc(&building->above, n, sizeof *building->above, "parents", err));
    for (size_t i = 0; i < building->reading->n_roots; i++)
        direct_from(building, (uint32_t)building->reading->root[i].id - 1, queue, reached);
done:
    free(best);
    free(queue);
    free(reached);
    return status;
}

/* ---- nodes ---- */

/* Chooses the ids of all nodes: of the kept points, and from the number of points on, of the nodes
 * with links. The ids of points are those of the file if all kept points have one, else the points'
 * numbers + 1. Nodes with links have the next ids. If these exceed TREE_MAX_ID, all ids are 1, 2,
 * ... in order. The caller frees *id. */
static Status number_nodes(const Building *building, int32_t **id, Err *err)
{
    const Graph *graph = building->graph;
    const size_t points = graph->n_points, most = points + building->n_closing;
    int32_t *made = NULL;
    bool given = true;
    size_t last = 0, n = building->n_closing;
    for (size_t i = 0; i < points; i++)
        if (is_node(building, i)) {
            given = given && graph->point[i].id != 0;
            n++;
        }
    if (n > TREE_MAX_ID)
        return err_set(err, STATUS_INFEASIBLE, "%s: a tree of %zu nodes is too large: at most %d",
                       graph->name, n, TREE_MAX_ID);
    TRY(mem_calloc(&made, most, sizeof *made, "ids", err));
    for (size_t i = 0; i < most; i++)
        if (i >= points || is_node(building, i)) {
            size_t next = i >= points ? last + 1 : given ? (size_t)graph->point[i].id : i + 1;
            made[i] = (int32_t)next;
            last = next > last ? next : last;
        }
    n = 0;
    for (size_t i = 0; i < most && last > TREE_MAX_ID; i++)
        made[i] = made[i] ? (int32_t)++n : 0;
    *id = made;
    return STATUS_OK;
}

/* Returns the point of the file at the distal end of a link, before merging. */
static size_t distal_point(const Building *building, const GraphLink *link)
{
    const GraphLine *line = &building->graph->line[link->line];
    return building->representative[line->b] == link->b ? line->b : line->a;
}

/* Finds the radius of the segment that a link becomes; NAN if the options replace missing radii. */
static Status radius_of_link(const Building *building, const GraphLink *link, double *radius,
                             Err *err)
{
    const Graph *graph = building->graph;
    const GraphLine *line = &graph->line[link->line];
    *radius =
        isnan(line->radius) ? graph->point[distal_point(building, link)].radius : line->radius;
    if (!isnan(*radius) || building->options->repair_radii || building->options->radius_mm > 0)
        return STATUS_OK;
    return graph_blame(graph, GRAPH_LINES, line->record,
                       err_set(err, STATUS_INPUT,
                               "neither the line nor its distal point has a radius; set one with "
                               "`radius`"),
                       err);
}

/* Finds the radius of a root: that of the thickest segment that leaves it, or in a file that was
 * written from a tree the radius of its point. */
static Status radius_of_root(const Building *building, uint32_t kept, double *radius, Err *err)
{
    const Graph *graph = building->graph;
    double thickest = 0;
    if (graph->is_tree && !isnan(graph->point[kept].radius)) {
        *radius = graph->point[kept].radius;
        return STATUS_OK;
    }
    for (uint32_t k = 0; k < degree_of(building, kept); k++) {
        const GraphLink *link = link_at(building, kept, k);
        double of_link;
        TRY(radius_of_link(building, link, &of_link, err));
        if (link->a == kept)
            thickest = fmax(thickest, of_link);
    }
    *radius = thickest;
    return STATUS_OK;
}

/* `link` leads to the node; NULL at a root. Its values are those of the point `distal`. */
static Status add_values(const Building *building, TreeBuilder *builder, const GraphLink *link,
                         size_t distal, Err *err)
{
    const Graph *graph = building->graph;
    for (size_t k = 0; k < graph->n_columns; k++) {
        const GraphColumn *column = &graph->column[k];
        size_t at = distal;
        if (column->of == GRAPH_LINES)
            at = link ? link->line : column->n;
        if (at < column->n && !isnan(column->value[at]))
            TRY(builder_value(builder, k, column->value[at], err));
    }
    return STATUS_OK;
}

/* Adds the node of a kept point. */
static Status add_point(const Building *building, TreeBuilder *builder, uint32_t kept,
                        const int32_t *id, Err *err)
{
    const GraphPoint *point = &building->graph->point[kept];
    uint32_t parent = building->parent[kept];
    const GraphLink *link = parent ? &building->link[building->above[kept]] : NULL;
    BuilderNode node = {.id = id[kept],
                        .parent = parent ? id[parent - 1] : TREE_NO_PARENT,
                        .type = point->has_type ? point->type : TREE_VESSEL_TYPE,
                        .position = point->position,
                        .record = point->record};
    TRY(link ? radius_of_link(building, link, &node.radius_mm, err)
             : radius_of_root(building, kept, &node.radius_mm, err));
    TRY(graph_blame(building->graph, GRAPH_POINTS, point->record, builder_node(builder, &node, err),
                    err));
    if (point->flow_share > 0)
        TRY(builder_share(builder, node.id, point->flow_share, node.record, err));
    return add_values(building, builder, link, link ? distal_point(building, link) : kept, err);
}

/* Adds the node with a link at the distal end of closing link `k`. */
static Status add_closing(const Building *building, TreeBuilder *builder, size_t k,
                          const int32_t *id, Err *err)
{
    const Graph *graph = building->graph;
    const GraphLink *link = &building->link[building->closing[k]];
    size_t distal = distal_point(building, link), record = graph->line[link->line].record;
    const GraphPoint *point = &graph->point[distal];
    BuilderNode node = {.id = id[graph->n_points + k],
                        .parent = id[link->a],
                        .type = point->has_type ? point->type : TREE_VESSEL_TYPE,
                        .position = graph->point[link->b].position,
                        .record = record};
    TRY(radius_of_link(building, link, &node.radius_mm, err));
    TRY(graph_blame(graph, GRAPH_LINES, record, builder_node(builder, &node, err), err));
    TRY(builder_link(builder, node.id, id[link->b], record, err));
    return add_values(building, builder, link, distal, err);
}

/* Adds node `i`, which is numbered as in number_nodes. */
static Status add_node(const Building *building, TreeBuilder *builder, uint32_t i,
                       const int32_t *id, Err *err)
{
    const size_t points = building->graph->n_points;
    return i < points ? add_point(building, builder, i, id, err)
                      : add_closing(building, builder, i - points, id, err);
}

static bool has_column(const Graph *graph, GraphElement of, const char *name)
{
    for (size_t k = 0; k < graph->n_columns; k++)
        if (graph->column[k].of == of && strcmp(graph->column[k].name, name) == 0)
            return true;
    return false;
}

/* Adds the columns of points and of lines to the builder. If both have a column of one name, the
 * column of points becomes "NAME of points". */
static Status add_columns(const Graph *graph, TreeBuilder *builder, Err *err)
{
    Text name = TEXT_INIT;
    Status status = STATUS_OK;
    for (size_t k = 0; k < graph->n_columns; k++) {
        const GraphColumn *column = &graph->column[k];
        bool twice = column->of == GRAPH_POINTS && has_column(graph, GRAPH_LINES, column->name);
        size_t number;
        text_clear(&name);
        text_printf(&name, twice ? "%s of points" : "%s", column->name);
        TRY_GOTO(text_check(&name, err));
        TRY_GOTO(builder_column(builder, text_chars(&name), column->unit, &number, err));
    }
done:
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    text_release(&name);
    return status;
}

/* A node, numbered as in number_nodes, and its id. */
typedef struct Numbered {
    int32_t id;
    uint32_t node;
} Numbered;

static int by_id(const void *a, const void *b)
{
    const Numbered *one = a, *other = b;
    return (one->id > other->id) - (one->id < other->id);
}

/* Lists the nodes (their ids are above 0) by rising id. The caller frees *order. */
static Status order_nodes(const Building *building, const int32_t *id, Numbered **order, size_t *n,
                          Err *err)
{
    Numbered *made = NULL;
    size_t count = 0, most = building->graph->n_points + building->n_closing;
    TRY(mem_calloc(&made, most, sizeof *made, "ids", err));
    for (uint32_t i = 0; i < most; i++)
        if (id[i] > 0)
            made[count++] = (Numbered){id[i], i};
    qsort(made, count, sizeof *made, by_id);
    *order = made;
    *n = count;
    return STATUS_OK;
}

/* Adds the nodes in the order of the file. If the file was written from a tree, adds them by rising
 * id: the tree's nodes were in this order, but the file's points may be in any order. */
static Status add_nodes(const Building *building, TreeBuilder *builder, const int32_t *id, Err *err)
{
    size_t n = building->graph->n_points + building->n_closing;
    if (!building->graph->is_tree) {
        for (uint32_t i = 0; i < n; i++)
            if (id[i] > 0)
                TRY(add_node(building, builder, i, id, err));
        return STATUS_OK;
    }
    Numbered *order = NULL;
    size_t count = 0;
    TRY(order_nodes(building, id, &order, &count, err));
    Status status = STATUS_OK;
    for (size_t k = 0; k < count && status == STATUS_OK; k++)
        status = add_node(building, builder, order[k].node, id, err);
    free(order);
    return status;
}

/* Moves the metadata, columns and nodes to the builder. */
static Status fill_builder(Building *building, TreeBuilder *builder, Err *err)
{
    const Graph *graph = building->graph;
    TreeReading *reading = building->reading;
    int32_t *id = NULL;
    Status status = STATUS_OK;
    TRY(number_nodes(building, &id, err));
    builder->record = graph->point_record;
    builder->meta = graph->meta;
    building->graph->meta = (TreeMeta){0};
    TRY_GOTO(add_columns(graph, builder, err));
    TRY_GOTO(add_nodes(building, builder, id, err));
    for (size_t i = 0; i < reading->n_roots; i++)
        reading->root[i].id = id[reading->root[i].id - 1];
done:
    free(id);
    return status;
}

static void count_points(const Building *building)
{
    const Graph *graph = building->graph;
    for (size_t i = 0; i < graph->n_points; i++)
        if (building->representative[i] != i)
            building->reading->network.merged++;
        else if (!is_node(building, i))
            building->reading->network.unused++;
}

static bool looks_like_voxels(const Graph *graph)
{
    for (size_t i = 0; i < graph->n_points; i++)
        if (!reading_is_voxel(graph->point[i].position))
            return false;
    return graph->n_points >= READ_MIN_POINTS;
}

/* Returns the widest gap, mm, at an end that counts as a rounding error. It is at most the radius.
 * It is also at most half the length of the last line or, in dense centrelines with short lines, a
 * twentieth of the radius. With these bounds, a merge tolerance as wide as the gap joins few points
 * besides the ends. */
static double reach_of(const Graph *graph, const GraphLink *link)
{
    double length = vec3_distance(graph->point[link->a].position, graph->point[link->b].position);
    return fmin(link->thickness, fmax(length / 2, link->thickness / 20));
}

static Status median_thickness(const Building *building, double *median, Err *err)
{
    double *thickness = NULL;
    size_t n = building->n_links;
    TRY(mem_calloc(&thickness, n, sizeof *thickness, "radii", err));
    for (size_t i = 0; i < n; i++)
        thickness[i] = building->link[i].thickness;
    *median = select_number(thickness, n, n / 2);
    free(thickness);
    return STATUS_OK;
}

/* Looks for ends that nearly touch another component [reach_of]: the user may want them joined. */
static Status find_near_ends(Building *building, Err *err)
{
    Graph *graph = building->graph;
    size_t nodes = 0;
    double median = 0, *reach = NULL;
    uint32_t *component = NULL;
    Status status = STATUS_OK;
    for (size_t i = 0; i < graph->n_points; i++)
        nodes += is_node(building, i);
    if (nodes == building->n_spanning + 1) /* one component */
        return STATUS_OK;
    TRY(median_thickness(building, &median, err));
    if (median == 0)
        return STATUS_OK;
    TRY_GOTO(mem_calloc(&reach, graph->n_points, sizeof *reach, "reaches of ends", err));
    TRY_GOTO(mem_calloc(&component, graph->n_points, sizeof *component, "components", err));
    for (uint32_t i = 0; i < graph->n_points; i++) {
        component[i] = is_node(building, i) ? sets_find(building->component, i) + 1 : 0;
        if (component[i] && degree_of(building, i) == 1)
            reach[i] = fmin(median, reach_of(graph, link_at(building, i, 0)));
    }
    status = graph_near_ends(graph, component, reach, median, building->reading, err);
done:
    free(reach);
    free(component);
    return status;
}

/* Records what the network of the file contains, before anything is changed. */
static void describe(const Graph *graph, const ReadOptions *options, TreeReading *reading)
{
    reading->is_network = true;
    reading->network.points = graph->n_points;
    reading->network.lines = graph->n_lines;
    reading->unit = options->has_unit ? options->unit : graph->unit;
    reading->unit_is_stated = options->has_unit || graph->unit_is_stated;
    reading->voxels = options->has_voxel_size;
    reading->looks_like_voxels =
        !reading->voxels && !graph->unit_is_stated && looks_like_voxels(graph);
}

/* Runs the three steps, and measures the network between them. */
static Status build(Building *building, TreeBuilder *builder, Err *err)
{
    Graph *graph = building->graph;
    if (graph->n_lines == 0 && !graph->is_tree)
        return err_set(err, STATUS_INPUT, "%s: the file has no lines; a tree has at least one",
                       graph->name);
    describe(graph, building->options, building->reading);
    graph_scale(graph);
    TRY(connect(building, err));
    for (size_t i = 0; i < graph->n_points; i++)
        graph->point[building->representative[i]].is_inlet |= graph->point[i].is_inlet;
    if (building->n_links == 0 && !graph->is_tree)
        return err_set(err, STATUS_INPUT,
                       "%s: each line has both ends at the same position; a tree needs a line that "
                       "is longer than 0",
                       graph->name);
    TRY(treat_loops(building, err));
    TRY(list_links(building, err));
    if (!graph->is_tree)
        TRY(find_near_ends(building, err));
    count_points(building);
    TRY(direct_links(building, err));
    return fill_builder(building, builder, err);
}

Status graph_build(Graph *graph, TreeBuilder *builder, Err *err)
{
    TreeReading own = {0};
    Building building = {.graph = graph,
                         .options = graph->options ? graph->options : &no_options,
                         .reading = graph->reading ? graph->reading : &own};
    Status status = build(&building, builder, err);
    release(&building);
    reading_release(&own);
    return status;
}
