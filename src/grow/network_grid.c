/* A segment stands in the grid as a capsule wider than the vessel, so that a refresh of the radii
 * only has to enter those anew that outgrew their capsules. */
#include "grow/network_grid.h"

#include <string.h>

/* Whether the item is in the grid's cells: one without length is not. */
static bool has_length(const GridItem *item)
{
    return memcmp(item->proximal, item->distal, sizeof item->distal) != 0;
}

Status entry_add(Grid *grid, const Rules *rules, const Network *net, int32_t segment, Err *err)
{
    Capsule capsule = network_capsule(net, segment);
    double radius = capsule.radius;
    capsule.radius = entry_reach(rules, radius);
    GridItem item = grid_item(grid, capsule, radius);
    if (has_length(&item))
        return grid_add(grid, 0, segment, net->segment[segment].child[0] < 0, item, err);
    grid->item[segment] = item;
    return STATUS_OK;
}

Status entry_renew(Grid *grid, const Rules *rules, const Network *net, int32_t segment, Err *err)
{
    if (has_length(&grid->item[segment]))
        grid_remove(grid, segment);
    return entry_add(grid, rules, net, segment, err);
}

Status entries_widen(Grid *grid, const Rules *rules, const Network *net, Err *err)
{
    for (size_t i = 0; i < net->n; i++) {
        GridItem *item = &grid->item[i];
        if (net->segment[i].parent < 0)
            continue;
        item->radius = net->segment[i].radius;
        double reach = (double)item->reach;
        if (rules->thickness * (double)item->radius > reach && reach < rules->widest)
            TRY(entry_renew(grid, rules, net, (int32_t)i, err));
    }
    return STATUS_OK;
}
