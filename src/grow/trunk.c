/* Computes pressures and costs along the trunk: the segments of a continued tree whose radii are
 * kept (keep_radii).
 *
 * Along the trunk, pressures follow from the flows, which are counts of terminals. One walk lists
 * the kept segments, parents first. Gauges [cco/law.h], which state how much of the pressure drop
 * is left, are computed forward along the list. Drop costs are summed backward: the drop cost of a
 * segment is the cost, for all subtrees that leave the trunk at or below the segment's end, of
 * spending more of the pressure drop on this segment. A further terminal costs, on every kept
 * segment on its path, the drop cost times the share of the drop that it spends there;
 * Sensitivity.extra [network.h] is the sum.
 *
 * The sums of kept segments are computed as if their radii followed the law. Only the check of the
 * range of doubles uses them. */
#include "grow/network.h"

#include <float.h>

double trunk_gauge(double gauge, double spent)
{
    double gauge2 = gauge * gauge, left = 1 / (gauge2 * gauge2) - spent;
    return 1 / sqrt(sqrt(fmax(left, 1 - TRUNK_MOST_SPENT)));
}

/* Returns true if segment i exists and keeps its radius. */
static bool is_kept(const Network *net, int32_t i)
{
    return i >= 0 && net->trunk->radius[i] > 0;
}

void trunk_set_daughter(Network *net, int32_t i, const Reduced *reduced, int32_t parent)
{
    const Segment *mother = &net->segment[parent];
    double kept = net->trunk->radius[i];
    double gauge =
        trunk_gauge((double)mother->gauge, trunk_drop_fraction(net, parent, mother->terminals, 1));
    net->segment[i].gauge = (float)gauge;
    net->segment[i].radius =
        (float)(kept > 0 ? kept : fmin(net->radius_unit * gauge * reduced->rho, (double)FLT_MAX));
    net->sensitivity[i] = (Sensitivity){0, net->sensitivity[parent].extra +
                                               net->trunk->drop_cost[parent] *
                                                   trunk_drop_fraction(net, parent, 1, 1)};
}

/* Lists the kept segments, mothers first. */
static size_t list_trunk(const Network *net)
{
    int32_t *order = net->trunk->order;
    size_t n = 0, next = 0;
    for (size_t k = 0; k < net->inlets; k++)
        order[n++] = net->inlet[k];
    for (size_t inlets = n; next < n; next++)
        for (int slot = 0; slot < 2; slot++) {
            int32_t child = net->segment[order[next]].child[slot];
            if (is_kept(net, child))
                order[n++] = child;
            if (next < inlets && is_kept(net, child))
                net->segment[child].gauge = 1;
        }
    return n;
}

/* Returns the derivative of the cost of segment i, which has the gauge `gauge`, with respect to the
 * share of the pressure drop that is spent above it; 0 if there is no segment or if it is kept. */
static double drop_cost_of(const Network *net, int32_t i, double gauge)
{
    if (i < 0 || is_kept(net, i))
        return 0;
    double gauge2 = gauge * gauge, cost = network_reduce(net, i).cost;
    return net->law.lambda / 4 * law_lambda_power(&net->law, gauge) * cost * gauge2 * gauge2;
}

/* Computes the gauges forward along the list and the drop costs backward. */
void trunk_refresh(Network *net)
{
    Trunk *trunk = net->trunk;
    size_t n = list_trunk(net);
    for (size_t k = net->inlets; k < n; k++) {
        int32_t i = trunk->order[k];
        const Segment *segment = &net->segment[i];
        double gauge =
            trunk_gauge((double)segment->gauge, trunk_drop_fraction(net, i, segment->terminals, 1));
        trunk->drop_cost[i] = 0;
        for (int slot = 0; slot < 2; slot++) {
            trunk->drop_cost[i] += drop_cost_of(net, segment->child[slot], gauge);
            if (is_kept(net, segment->child[slot]))
                net->segment[segment->child[slot]].gauge = (float)gauge;
        }
    }
    while (n-- > net->inlets) {
        int32_t above = net->segment[trunk->order[n]].parent;
        if (net->segment[above].parent >= 0)
            trunk->drop_cost[above] += trunk->drop_cost[trunk->order[n]];
    }
}

double trunk_most_spent(const Network *net, double *spent, size_t *where)
{
    double most = 0;
    for (size_t i = 0; i < net->n; i++) {
        const Segment *segment = &net->segment[i];
        if (segment->parent < 0 || !is_kept(net, (int32_t)i)) {
            spent[i] = 0;
            continue;
        }
        spent[i] =
            spent[segment->parent] + trunk_drop_fraction(net, (int32_t)i, segment->terminals, 1);
        if (spent[i] > most) {
            most = spent[i];
            *where = i;
        }
    }
    return most;
}
