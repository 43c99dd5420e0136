/* Keeps the grid of a growing tree up to date with its network. A segment is entered in the grid as
 * a capsule that is wider than the vessel. After radii have changed, only segments that have
 * outgrown their capsules must be entered again. */
#include "grow/site.h"

#include <string.h>

/* Returns true if the item is in the grid's cells: an item without length is in none. */
static bool has_length(const GridItem *item)
{
    return memcmp(item->proximal, item->distal, sizeof item->distal) != 0;
}

Status site_enter(Site *site, int32_t segment, Err *err)
{
    const Network *net = &site->net;
    const Segment *own = &net->segment[segment];
    double radius = (double)own->radius;
    Capsule capsule = {net->position[own->parent], net->position[segment],
                       site_reach(&site->rules, radius)};
    GridItem item = grid_item(&site->grid, capsule, radius);
    if (has_length(&item))
        return grid_add(&site->grid, 0, segment, own->child[0] < 0, item, err);
    site->grid.item[segment] = item;
    return STATUS_OK;
}

Status site_renew(Site *site, int32_t segment, Err *err)
{
    if (has_length(&site->grid.item[segment]))
        grid_remove(&site->grid, segment);
    return site_enter(site, segment, err);
}

Status site_update_radii(Site *site, Err *err)
{
    for (size_t i = 0; i < site->net.n; i++) {
        GridItem *item = &site->grid.item[i];
        if (site->net.segment[i].parent < 0)
            continue;
        item->radius = site->net.segment[i].radius;
        double reach = (double)item->reach;
        if (site->rules.thickness * (double)item->radius > reach && reach < site->rules.max_radius)
            TRY(site_renew(site, (int32_t)i, err));
    }
    return STATUS_OK;
}
