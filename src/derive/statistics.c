/* Computes the statistics of a tree: numbers, radii and lengths by bifurcation level, by Strahler
 * order and by diameter-defined order, and the symmetry and area ratios of bifurcations.
 *
 * Everything is counted over vessels (chains of segments between bifurcations), not segments. A
 * measured tree, whose vessels consist of many short segments, can then be compared with a grown
 * tree. Levels and both kinds of orders use the same two steps: vessels are merged into elements
 * (vessels of one order in series), and elements are evaluated group by group. */
#include "derive/derive.h"
#include "derive/vessels.h"

#include <limits.h>
#include <stdlib.h>

/* An element: vessels of the same order in series. The group of an element is its order. In tables
 * of levels, the group is the level, and each vessel is an element. */
typedef struct VesselElement {
    int32_t group;
    size_t vessels;
    double radius_mm, length_mm; /* mean radius of its vessels, sum of their lengths */
} VesselElement;

/* Merges vessels into elements, and returns their number.
 *
 * heir         per vessel: the daughter that continues it in the same element
 *              [lineage_main_daughters]. NULL: each vessel is an element.
 * element_of   receives, per vessel, the index of its element.
 * element      receives the elements; zeroed, with space for one per vessel. */
static size_t merge_vessels(const Vessels *vessels, const int32_t *group, const int32_t *heir,
                            int32_t *element_of, VesselElement *element)
{
    size_t n = 0;
    for (size_t v = 0; v < vessels->n; v++) {
        int32_t parent = vessels->parent[v];
        bool continues = heir && parent != NO_VESSEL && heir[parent] == (int32_t)v;
        element_of[v] = continues ? element_of[parent] : (int32_t)n++;
        VesselElement *own = &element[element_of[v]];
        own->group = group[v];
        own->vessels++;
        own->radius_mm += (vessels->radius_mm[v] - own->radius_mm) / (double)own->vessels;
        own->length_mm += vessels->row[v].length_mm;
    }
    return n;
}

/* Fills the rows of the groups 0 to n_groups - 1 from `n` elements. A row without elements gets NAN
 * as means. */
static void fill_rows(const VesselElement *element, size_t n, StatisticsRow *row, int n_groups)
{
    for (size_t e = 0; e < n; e++) {
        StatisticsRow *own = &row[element[e].group];
        own->vessels += element[e].vessels;
        own->elements++;
        own->radius_mm.mean += element[e].radius_mm;
        own->length_mm.mean += element[e].length_mm;
    }
    for (int g = 0; g < n_groups; g++) {
        row[g].number = g;
        row[g].radius_mm.mean /= (double)row[g].elements;
        row[g].length_mm.mean /= (double)row[g].elements;
    }
    for (size_t e = 0; e < n; e++) {
        StatisticsRow *own = &row[element[e].group];
        double radius = element[e].radius_mm - own->radius_mm.mean;
        double length = element[e].length_mm - own->length_mm.mean;
        own->radius_mm.sd += radius * radius;
        own->length_mm.sd += length * length;
    }
    for (int g = 0; g < n_groups; g++) {
        double freedom = row[g].elements > 1 ? (double)(row[g].elements - 1) : 1;
        row[g].radius_mm.sd = sqrt(row[g].radius_mm.sd / freedom);
        row[g].length_mm.sd = sqrt(row[g].length_mm.sd / freedom);
    }
}

/* Sets entry (m - 1) n + k - 1 of `daughters` to the mean number of elements of order k that branch
 * off an element of order m. `row` has a row for each order and for 0. */
static void count_daughters(const Vessels *vessels, const int32_t *element_of,
                            const VesselElement *element, const StatisticsRow *row, int n,
                            double *daughters)
{
    for (size_t v = 0; v < vessels->n; v++) {
        int32_t parent = vessels->parent[v];
        if (parent == NO_VESSEL || element_of[parent] == element_of[v])
            continue;
        int32_t from = element[element_of[parent]].group, to = element[element_of[v]].group;
        daughters[(ptrdiff_t)(from - 1) * n + to - 1] += 1 / (double)row[from].elements;
    }
}

/* Makes the table of all groups that have elements. If `daughters` is not NULL, groups are orders,
 * from 1, and *daughters receives an array that the caller frees. */
static Status make_table(const Vessels *vessels, const int32_t *group, const int32_t *heir,
                         StatisticsTable *table, double **daughters, Err *err)
{
    int n_groups = 0;
    for (size_t v = 0; v < vessels->n; v++)
        if (group[v] >= n_groups)
            n_groups = group[v] + 1;
    int32_t *element_of = NULL;
    VesselElement *element = NULL;
    StatisticsRow *row = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&element_of, vessels->n, sizeof *element_of, "elements", err));
    TRY_GOTO(mem_calloc(&element, vessels->n, sizeof *element, "elements", err));
    TRY_GOTO(mem_calloc(&row, (size_t)n_groups, sizeof *row, "rows of statistics", err));
    size_t n = merge_vessels(vessels, group, heir, element_of, element);
    fill_rows(element, n, row, n_groups);
    if (daughters) {
        size_t orders = n_groups > 0 ? (size_t)n_groups - 1 : 0;
        TRY_GOTO(mem_calloc(daughters, orders * orders, sizeof **daughters, "orders", err));
        count_daughters(vessels, element_of, element, row, (int)orders, *daughters);
    }
    table->n = 0;
    for (int g = 0; g < n_groups; g++)
        if (row[g].elements > 0)
            row[table->n++] = row[g];
    table->row = row;
    row = NULL;
done:
    free(element_of);
    free(element);
    free(row);
    return status;
}

/* The quantities whose growth from order to order statistics_ratios computes. */
static double element_number(const StatisticsRow *row)
{
    return (double)row->elements;
}

static double element_diameter(const StatisticsRow *row)
{
    return 2 * row->radius_mm.mean;
}

static double element_length(const StatisticsRow *row)
{
    return row->length_mm.mean;
}

/* Returns the mean factor by which a quantity grows from one order to the next: exp(slope) of the
 * least-squares line through log(quantity) over the order. Rows in which it is not positive are
 * left out. Returns NAN if fewer than two rows are left. */
static double growth_ratio(const StatisticsRow *row, size_t rows,
                           double (*quantity)(const StatisticsRow *row))
{
    double n = 0, mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < rows; i++) {
        if (!(quantity(&row[i]) > 0))
            continue;
        n++;
        mean_x += row[i].number;
        mean_y += elementary_log(quantity(&row[i]));
    }
    mean_x /= n;
    mean_y /= n;
    for (size_t i = 0; i < rows; i++) {
        if (!(quantity(&row[i]) > 0))
            continue;
        double x = row[i].number - mean_x;
        xx += x * x;
        xy += x * (elementary_log(quantity(&row[i])) - mean_y);
    }
    return n >= 2 ? elementary_exp(xy / xx) : (double)NAN;
}

OrderRatios statistics_ratios(const StatisticsTable *table, int first, int last)
{
    const StatisticsRow *row = table->row;
    size_t rows = table->n;
    while (rows > 0 && row->number < first) {
        row++;
        rows--;
    }
    while (rows > 0 && row[rows - 1].number > last)
        rows--;
    return (OrderRatios){1 / growth_ratio(row, rows, element_number),
                         growth_ratio(row, rows, element_diameter),
                         growth_ratio(row, rows, element_length)};
}

/* Returns the statistics of n values, and sorts them. */
static BifurcationSpread spread_of(double *value, size_t n)
{
    const double none = (double)NAN;
    if (n == 0)
        return (BifurcationSpread){0, none, none, none};
    double sum = 0, squares = 0;
    for (size_t i = 0; i < n; i++)
        sum += value[i];
    double mean = sum / (double)n;
    for (size_t i = 0; i < n; i++)
        squares += (value[i] - mean) * (value[i] - mean);
    sort_numbers(value, n);
    double sd = n > 1 ? sqrt(squares / (double)(n - 1)) : 0;
    return (BifurcationSpread){n, mean, sd, (value[(n - 1) / 2] + value[n / 2]) / 2};
}

/* The vessels that start at a node. */
typedef struct VesselFork {
    int32_t daughters, parent; /* vessels; parent NO_VESSEL at a root */
    double thinnest, thickest; /* radii, mm */
    double squares;            /* sum of the squared radii, mm^2 */
} VesselFork;

/* Fills the forks of all nodes. A node where no vessel starts keeps zeros. */
static void find_forks(const Vessels *vessels, VesselFork *fork)
{
    for (size_t v = 0; v < vessels->n; v++) {
        VesselFork *own = &fork[vessels->row[v].start];
        double radius = vessels->radius_mm[v];
        own->parent = vessels->parent[v];
        own->thinnest = own->daughters ? fmin(own->thinnest, radius) : radius;
        own->thickest = fmax(own->thickest, radius);
        own->squares += radius * radius;
        own->daughters++;
    }
}

/* Computes the symmetry ratio (thinnest over thickest daughter) and the area ratio (cross sections
 * of the daughters over that of the parent) of all bifurcations. */
static Status measure_forks(const Tree *tree, const Vessels *vessels, TreeStatistics *statistics,
                            Err *err)
{
    VesselFork *fork = NULL;
    double *symmetry = NULL, *area = NULL;
    size_t n_symmetry = 0, n_area = 0;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&fork, tree->n, sizeof *fork, "bifurcations", err));
    TRY_GOTO(mem_calloc(&symmetry, tree->n, sizeof *symmetry, "symmetry ratios", err));
    TRY_GOTO(mem_calloc(&area, tree->n, sizeof *area, "area ratios", err));
    find_forks(vessels, fork);
    for (size_t i = 0; i < tree->n; i++) {
        if (fork[i].daughters < 2)
            continue;
        if (fork[i].thickest > 0)
            symmetry[n_symmetry++] = fork[i].thinnest / fork[i].thickest;
        double parent = fork[i].parent == NO_VESSEL ? 0 : vessels->radius_mm[fork[i].parent];
        if (parent > 0)
            area[n_area++] = fork[i].squares / (parent * parent);
    }
    statistics->symmetry = spread_of(symmetry, n_symmetry);
    statistics->area_ratio = spread_of(area, n_area);
done:
    free(fork);
    free(symmetry);
    free(area);
    return status;
}

/* Makes the table of the elements of all orders. */
static Status make_order_table(const Vessels *vessels, const int32_t *order, StatisticsTable *table,
                               double **daughters, Err *err)
{
    int32_t *heir = NULL;
    const Lineage lineage = vessels_lineage(vessels);
    TRY(mem_calloc(&heir, vessels->n, sizeof *heir, "continued vessels", err));
    lineage_main_daughters(&lineage, order, heir);
    Status status = make_table(vessels, order, heir, table, daughters, err);
    free(heir);
    return status;
}

Status statistics_by_bounds(const Tree *tree, const double *bound_mm, size_t n,
                            StatisticsTable *elements, double **daughters, Err *err)
{
    Vessels vessels;
    int32_t *order = NULL;
    TRY(vessels_init(&vessels, tree, err));
    Status status = STATUS_OK;
    const Lineage lineage = vessels_lineage(&vessels);
    TRY_GOTO(mem_calloc(&order, vessels.n, sizeof *order, "orders", err));
    lineage_bounded_orders(&lineage, bound_mm, n, order);
    TRY_GOTO(make_order_table(&vessels, order, elements, daughters, err));
done:
    free(order);
    vessels_release(&vessels);
    return status;
}

static double volume_mm3(const Tree *tree)
{
    double volume = 0;
    for (size_t i = 0; i < tree->n; i++)
        volume += PI * tree->radius_mm[i] * tree->radius_mm[i] * tree_segment_length(tree, i);
    return volume;
}

/* Computes what a tree without links has: orders, symmetry and area ratio. */
static Status make_orders(const Tree *tree, const Vessels *vessels, TreeStatistics *made, Err *err)
{
    int32_t *diameter_order = NULL;
    DiameterOrders result;
    Status status;
    TRY_GOTO(make_order_table(vessels, vessels->strahler, &made->by_strahler, NULL, err));
    made->strahler_ratios = statistics_ratios(&made->by_strahler, 0, INT_MAX);
    TRY_GOTO(vessels_diameter_orders(vessels, &diameter_order, &result, err));
    made->diameter_rounds = result.rounds;
    made->diameter_orders_converged = result.converged;
    TRY_GOTO(make_order_table(vessels, diameter_order, &made->by_diameter_strahler,
                              &made->daughters, err));
    made->diameter_strahler_ratios = statistics_ratios(&made->by_diameter_strahler, 0, INT_MAX);
    TRY_GOTO(measure_forks(tree, vessels, made, err));
done:
    free(diameter_order);
    return status;
}

/* Completes the rows of the vessels, and hands them over to the statistics. */
static void take_vessels(const Tree *tree, Vessels *vessels, TreeStatistics *made)
{
    for (size_t v = 0; v < vessels->n; v++) {
        VesselRow *row = &vessels->row[v];
        row->radius_mm = vessels->radius_mm[v];
        row->chord_mm = vec3_distance(tree->position[row->start], tree->position[row->end]);
    }
    made->vessel = vessels->row;
    vessels->row = NULL;
}

/* Counts the segments at each node (its degree). A node that is linked to another is not
 * counted. */
static Status count_degrees(const Tree *tree, TreeStatistics *made, Err *err)
{
    int32_t *others = NULL;
    TRY(mem_calloc(&made->degree, tree->n, sizeof *made->degree, "degrees", err));
    TRY(tree_child_counts(tree, &others, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (tree_has_link(tree, i))
            continue;
        int32_t degree = others[i] + tree_is_segment(tree, i);
        made->degree[i] = (uint8_t)(degree < UINT8_MAX ? degree : UINT8_MAX);
        made->nodes_of_degree[degree < READ_MAX_DEGREE ? degree : READ_MAX_DEGREE]++;
    }
    free(others);
    return STATUS_OK;
}

Status derive_statistics(const Tree *tree, TreeStatistics *statistics, Err *err)
{
    TreeStatistics made = {.volume_mm3 = volume_mm3(tree), .has_orders = !tree->link};
    Vessels vessels;
    TRY(vessels_init(&vessels, tree, err));
    made.vessels = vessels.n;
    Status status = STATUS_OK;
    TRY_GOTO(make_table(&vessels, vessels.level, NULL, &made.by_level, NULL, err));
    TRY_GOTO(count_degrees(tree, &made, err));
    if (made.has_orders)
        TRY_GOTO(make_orders(tree, &vessels, &made, err));
    take_vessels(tree, &vessels, &made);
    *statistics = made;
    made = (TreeStatistics){0};
done:
    statistics_release(&made);
    vessels_release(&vessels);
    return status;
}

void statistics_release(TreeStatistics *statistics)
{
    free(statistics->vessel);
    free(statistics->degree);
    free(statistics->by_level.row);
    free(statistics->by_strahler.row);
    free(statistics->by_diameter_strahler.row);
    free(statistics->daughters);
    *statistics = (TreeStatistics){0};
}
