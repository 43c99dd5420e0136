/* Computes diameter-defined Strahler orders [Z. L. Jiang, G. S. Kassab, Y. C. Fung, J. Appl.
 * Physiol. 76 (1994) 882-892], in rounds that begin with Strahler orders.
 *
 * A round computes the mean and standard deviation of the diameters of each order; they give the
 * bounds between orders. Then it orders all vessels again, terminals first. A vessel gets the order
 * m + 1, where m is the largest order among its daughters, if it is thicker than the bound between
 * m and m + 1. Otherwise it gets m. Orders therefore never fall towards the root, and have no gaps.
 *
 * The rounds end when at most one vessel in a hundred changes; the authors of the method also stop
 * at changes of 1 %. If diameters have no gaps, the bounds would otherwise continue to move, more
 * and more slowly, and in the end merge orders that should be separate. */
#include "derive/fields.h"
#include "derive/vessels.h"

#include <stdlib.h>
#include <string.h>

/* Rounds after which vessels_diameter_orders gives up and reports that it has not converged. Grown
 * trees of 200 to 3000 terminals and traced coronary and brain arteries needed 2 to 6 rounds; the
 * limit only ends rounds that repeat themselves. */
enum { MAX_ROUNDS = 100 };

/* The diameters of the vessels of one order. */
typedef struct OrderBin {
    size_t count;
    double mean, sd; /* of the diameters, mm; sd 0 for a single vessel */
    double bound;    /* between this order and the next; infinite for the last */
} OrderBin;

/* Computes the bins from the orders. Uses two passes, because the difference of sums of squares
 * would lose the spread of nearly equal diameters to rounding. */
static void measure_bins(const Vessels *vessels, const int32_t *order, OrderBin *bin, int n_bins)
{
    for (int b = 0; b < n_bins; b++)
        bin[b] = (OrderBin){.bound = HUGE_VAL};
    for (size_t v = 0; v < vessels->n; v++) {
        bin[order[v] - 1].count++;
        bin[order[v] - 1].mean += 2 * vessels->radius_mm[v];
    }
    for (int b = 0; b < n_bins && bin[b].count; b++)
        bin[b].mean /= (double)bin[b].count;
    for (size_t v = 0; v < vessels->n; v++) {
        double deviation = 2 * vessels->radius_mm[v] - bin[order[v] - 1].mean;
        bin[order[v] - 1].sd += deviation * deviation;
    }
    for (int b = 0; b < n_bins; b++)
        bin[b].sd = bin[b].count > 1 ? sqrt(bin[b].sd / (double)(bin[b].count - 1)) : 0;
    for (int b = 0; b + 1 < n_bins && bin[b + 1].count; b++)
        bin[b].bound = (bin[b].mean + bin[b].sd + bin[b + 1].mean - bin[b + 1].sd) / 2;
}

/* Computes the order of every vessel again. Returns the number of vessels whose order changed.
 * `largest` is a workspace: per vessel, the largest order among its daughters. */
static size_t assign_orders(const Vessels *vessels, const OrderBin *bin, int32_t *largest,
                            int32_t *order)
{
    size_t changed = 0;
    memset(largest, 0, vessels->n * sizeof *largest);
    for (size_t v = vessels->n; v-- > 0;) {
        int32_t below = largest[v], parent = vessels->parent[v];
        bool rises = below == 0 || 2 * vessels->radius_mm[v] > bin[below - 1].bound;
        int32_t next = below + rises;
        changed += next != order[v];
        order[v] = next;
        if (parent != NO_VESSEL && next > largest[parent])
            largest[parent] = next;
    }
    return changed;
}

static int largest_strahler(const Vessels *vessels)
{
    int32_t largest = 0;
    for (size_t v = 0; v < vessels->n; v++)
        if (vessels->strahler[v] > largest)
            largest = vessels->strahler[v];
    return largest;
}

Status vessels_diameter_orders(const Vessels *vessels, int32_t **order, DiameterOrders *result,
                               Err *err)
{
    int n_bins = largest_strahler(vessels);
    int32_t *made = NULL, *largest = NULL;
    OrderBin *bin = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made, vessels->n, sizeof *made, "orders", err));
    TRY_GOTO(mem_calloc(&largest, vessels->n, sizeof *largest, "orders", err));
    TRY_GOTO(mem_calloc(&bin, (size_t)n_bins, sizeof *bin, "orders", err));
    for (size_t v = 0; v < vessels->n; v++)
        made[v] = vessels->strahler[v];
    *result = (DiameterOrders){0};
    while (!result->converged && result->rounds < MAX_ROUNDS) {
        measure_bins(vessels, made, bin, n_bins);
        result->converged = assign_orders(vessels, bin, largest, made) * 100 <= vessels->n;
        result->rounds++;
    }
    *order = made;
    made = NULL;
done:
    free(made);
    free(largest);
    free(bin);
    return status;
}

Status field_diameter_strahler(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    Vessels vessels;
    if (tree->link) {
        orders_set_unknown(tree, value);
        return STATUS_OK;
    }
    TRY(vessels_init(&vessels, tree, err));
    int32_t *order = NULL;
    DiameterOrders result;
    Status status = vessels_diameter_orders(&vessels, &order, &result, err);
    for (size_t i = 0; i < tree->n && status == STATUS_OK; i++)
        if (vessels.of_node[i] != NO_VESSEL)
            value[i] = order[vessels.of_node[i]];
    free(order);
    vessels_release(&vessels);
    return status;
}
