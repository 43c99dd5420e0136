/* Finds the vessel whose surface is nearest to each voxel centre of a block, by halving the block
 * along each axis again and again, and shortening a list of candidate vessels at each step.
 *
 * The distances of two points to a site differ by at most the distance between the two points. So a
 * site can be the nearest one of a point within h of a centre only if the site is at most 2 h
 * farther from the centre than the centre's nearest site. A block passes its list of these sites to
 * its eight parts, and each part shortens the list further. The result is identical to that of a
 * loop over all sites, bit by bit, because both call site_distance. Distances to a site are
 * negative inside the vessel. */
#include "coverage/sites.h"

#include <string.h>

/* Allowance for rounding errors of distances: a fraction of a block's half diagonal, and a fraction
 * of the coordinates, about 5 units of rounding. 1e-9 is far above the rounding errors of a
 * distance and adds nearly no site to a list. Larger values make lists longer, but do not change
 * results. */
static const double diagonal_slack = 1e-9, coordinate_slack = 1e-15;

static Box site_box(const DomainTube *tube)
{
    return box_with_ball(box_with_ball(box_empty(), tube->a, tube->radius), tube->b, tube->radius);
}

static VesselSite make_site(const DomainTube *tube)
{
    Vec3 along = vec3_sub(tube->b, tube->a);
    double length2 = vec3_dot(along, along);
    return (VesselSite){tube->a, along, length2 > 0 ? 1 / length2 : 0, tube->radius};
}

Status sites_make(const DomainTube *tubes, size_t n, Sites *out, Err *err)
{
    Sites made = {.n = n};
    Box *boxes = NULL;
    Status status;
    TRY_GOTO(mem_alloc(&made.site, n, sizeof *made.site, "vessels", err));
    TRY_GOTO(mem_alloc(&boxes, n, sizeof *boxes, "vessels", err));
    for (size_t i = 0; i < n; i++) {
        made.site[i] = make_site(&tubes[i]);
        boxes[i] = site_box(&tubes[i]);
    }
    TRY_GOTO(boxtree_build(boxes, n, &made.tree, err));
    *out = made;
    made = (Sites){0};
done:
    free(boxes);
    sites_release(&made);
    return status;
}

void sites_release(Sites *sites)
{
    boxtree_release(&sites->tree);
    free(sites->site);
    *sites = (Sites){0};
}

void sitelists_release(SiteLists *lists)
{
    ARRAY_RELEASE(&lists->site);
    ARRAY_RELEASE(&lists->distance);
}

/* ---- the tree of boxes ----------------------------------------------------------------------- */

/* Returns the squared distance of a point from a box; 0 inside. */
static inline double box_distance2(const Box *box, Vec3 p)
{
    double x = box_max(0, box_max(box->low.x - p.x, p.x - box->high.x));
    double y = box_max(0, box_max(box->low.y - p.y, p.y - box->high.y));
    double z = box_max(0, box_max(box->low.z - p.z, p.z - box->high.z));
    return x * x + y * y + z * z;
}

/* Returns true if the distance of a site in the box from the point may be at most max_mm. A
 * negative max_mm, which is a distance inside a vessel, is possible only if the point is in the
 * box. */
static bool may_reach(const Box *box, Vec3 point, double max_mm)
{
    double distance2 = box_distance2(box, point);
    return distance2 == 0 || (max_mm > 0 && distance2 <= max_mm * max_mm);
}

/* Pushes the children of an inner node so that the nearer one comes off the stack first. */
static int push_children(const BoxTree *tree, uint32_t node, Vec3 point, uint32_t *stack, int top)
{
    uint32_t near = node + 1, far = tree->nodes[node].first;
    if (box_distance2(&tree->nodes[far].box, point) <
        box_distance2(&tree->nodes[near].box, point)) {
        near = far;
        far = node + 1;
    }
    stack[top++] = far;
    stack[top++] = near;
    return top;
}

/* The stack of a walk: at most one node per level waits, and two more are pushed at the deepest. */
enum { WALK_STACK = BOXTREE_DEPTH + 2 };

double sites_nearest(const Sites *sites, Vec3 point, double enough_mm)
{
    uint32_t stack[WALK_STACK] = {0};
    double best = INFINITY;
    for (int top = 1; top > 0 && best > enough_mm;) {
        uint32_t at = stack[--top];
        const BoxNode *node = &sites->tree.nodes[at];
        if (!may_reach(&node->box, point, best))
            continue;
        if (node->n_items == 0)
            top = push_children(&sites->tree, at, point, stack, top);
        for (uint32_t i = 0; i < node->n_items; i++) {
            const VesselSite *site = &sites->site[sites->tree.items[node->first + i]];
            best = box_min(best, site_distance(site, point));
        }
    }
    return best;
}

/* ---- lists ----------------------------------------------------------------------------------- */

/* A list on the stack: the entries [first, first + n) of both arrays of SiteLists. */
typedef struct SiteRange {
    size_t first, n;
} SiteRange;

static Status push_site(SiteLists *lists, uint32_t site, double distance, Err *err)
{
    TRY(ARRAY_PUSH(&lists->site, "vessels", err, site));
    return ARRAY_PUSH(&lists->distance, "distances", err, distance);
}

/* Returns the allowance for rounding errors of distances to the points of a block, mm. */
static double slack_of(Vec3 centre, double half_diagonal)
{
    return diagonal_slack * half_diagonal +
           coordinate_slack * (fabs(centre.x) + fabs(centre.y) + fabs(centre.z));
}

/* Pushes a list of all sites whose distance from `centre` is at most max_mm. */
static Status gather_sites(SiteLists *lists, const Sites *sites, Vec3 centre, double max_mm,
                           SiteRange *out, Err *err)
{
    uint32_t stack[WALK_STACK] = {0};
    *out = (SiteRange){lists->site.n, 0};
    for (int top = 1; top > 0;) {
        uint32_t at = stack[--top];
        const BoxNode *node = &sites->tree.nodes[at];
        if (!may_reach(&node->box, centre, max_mm))
            continue;
        if (node->n_items == 0)
            top = push_children(&sites->tree, at, centre, stack, top);
        for (uint32_t i = 0; i < node->n_items; i++) {
            uint32_t site = sites->tree.items[node->first + i];
            double distance = site_distance(&sites->site[site], centre);
            if (distance <= max_mm)
                TRY(push_site(lists, site, distance, err));
        }
    }
    out->n = lists->site.n - out->first;
    return STATUS_OK;
}

/* Stores the distance of each site of a list from a point, and returns the nearest site. */
static Nearest measure_list(SiteLists *lists, const Sites *sites, SiteRange list, Vec3 point)
{
    Nearest nearest = {INFINITY, UINT32_MAX};
    const uint32_t *site = lists->site.items + list.first;
    double *distance = lists->distance.items + list.first;
    for (size_t i = 0; i < list.n; i++) {
        double d = distance[i] = site_distance(&sites->site[site[i]], point);
        if (d < nearest.distance_mm || (d == nearest.distance_mm && site[i] < nearest.site))
            nearest = (Nearest){d, site[i]};
    }
    return nearest;
}

/* Pushes a new list: the sites of `list` whose stored distance is at most max_mm. */
static Status narrow_list(SiteLists *lists, SiteRange list, double max_mm, SiteRange *out, Err *err)
{
    TRY(ARRAY_RESERVE(&lists->site, list.n, "vessels", err));
    TRY(ARRAY_RESERVE(&lists->distance, list.n, "distances", err));
    *out = (SiteRange){lists->site.n, 0};
    for (size_t i = list.first; i < list.first + list.n; i++)
        if (lists->distance.items[i] <= max_mm)
            lists->site.items[out->first + out->n++] = lists->site.items[i];
    lists->site.n = lists->distance.n = out->first + out->n;
    return STATUS_OK;
}

/* Pops all lists above `list`, which becomes the top of the stack. */
static void pop_to(SiteLists *lists, SiteRange list)
{
    lists->site.n = lists->distance.n = list.first + list.n;
}

/* ---- blocks ---------------------------------------------------------------------------------- */

Vec3 block_centre(const VoxelGrid *grid, const VoxelBlock *block)
{
    const int64_t *low = block->low, *high = block->high;
    return vec3(grid->first.x + grid->step.x * 0.5 * (double)(low[0] + high[0] - 1),
                grid->first.y + grid->step.y * 0.5 * (double)(low[1] + high[1] - 1),
                grid->first.z + grid->step.z * 0.5 * (double)(low[2] + high[2] - 1));
}

/* Returns the largest distance of a voxel centre of a block from its block_centre, mm. */
static double block_reach(const VoxelGrid *grid, const VoxelBlock *block)
{
    const int64_t *low = block->low, *high = block->high;
    return 0.5 * vec3_length(vec3(grid->step.x * (double)(high[0] - low[0] - 1),
                                  grid->step.y * (double)(high[1] - low[1] - 1),
                                  grid->step.z * (double)(high[2] - low[2] - 1)));
}

/* Returns the index of a voxel in the arrays of the block. */
static size_t voxel_index(const VoxelBlock *block, int64_t x, int64_t y, int64_t z)
{
    int64_t nx = block->high[0] - block->low[0], ny = block->high[1] - block->low[1];
    return (size_t)(x - block->low[0] + nx * (y - block->low[1] + ny * (z - block->low[2])));
}

/* Returns true if a voxel of `part`, which is a part of the search's block, is wanted. */
static bool is_wanted(const SiteSearch *search, const VoxelBlock *part)
{
    int64_t width = part->high[0] - part->low[0];
    for (int64_t z = part->low[2]; z < part->high[2]; z++)
        for (int64_t y = part->low[1]; y < part->high[1]; y++)
            if (memchr(&search->wanted[voxel_index(search->block, part->low[0], y, z)], true,
                       (size_t)width))
                return true;
    return false;
}

/* A block is wide if its half diagonal is more than this many times its centre's distance from the
 * nearest vessel. In trees of 10^4 and of 10^6 segments, 1 and 6 are slower. */
static const double wide_ratio = 3;

/* Returns part `which` of the eight parts of a block. Bits 0, 1 and 2 of `which` select the upper
 * half in x, y and z. The upper half of an axis of one voxel is empty. */
static VoxelBlock part_of(const VoxelBlock *block, int which)
{
    VoxelBlock part = *block;
    for (int axis = 0; axis < 3; axis++) {
        int64_t middle = block->low[axis] + (block->high[axis] - block->low[axis] + 1) / 2;
        if (which >> axis & 1)
            part.low[axis] = middle;
        else
            part.high[axis] = middle;
    }
    return part;
}

static bool is_empty(const VoxelBlock *block)
{
    return block->low[0] == block->high[0] || block->low[1] == block->high[1] ||
           block->low[2] == block->high[2];
}

/* Sets the nearest site of each wanted voxel of a block. `list` has all candidates, and stays on
 * the stack; shorter lists are pushed above it. */
static Status search_list(const SiteSearch *search, const VoxelBlock *block, SiteRange list,
                          Err *err)
{
    const int64_t *low = block->low;
    Vec3 centre = block_centre(search->grid, block);
    double reach = block_reach(search->grid, block);
    Nearest nearest = measure_list(search->lists, search->sites, list, centre);
    if (reach == 0) {
        search->nearest[voxel_index(search->block, low[0], low[1], low[2])] = nearest;
        return STATUS_OK;
    }
    SiteRange shorter;
    double max_mm = nearest.distance_mm + 2 * reach + slack_of(centre, reach);
    TRY(narrow_list(search->lists, list, max_mm, &shorter, err));
    for (int which = 0; which < 8; which++) {
        VoxelBlock part = part_of(block, which);
        if (!is_empty(&part) && is_wanted(search, &part))
            TRY(search_list(search, &part, shorter, err));
        pop_to(search->lists, shorter);
    }
    return STATUS_OK;
}

/* Sets the nearest site of each wanted voxel of a block. nearest_mm is the distance of the block's
 * centre from its nearest site. The list of a wide block would be long. So a wide block is split
 * first, and each part gathers its own list from the tree of boxes, which is faster. */
static Status search_block(const SiteSearch *search, const VoxelBlock *block, double nearest_mm,
                           Err *err)
{
    const double reach = block_reach(search->grid, block);
    SiteRange list;
    if (reach <= wide_ratio * fabs(nearest_mm) || reach == 0) {
        pop_to(search->lists, (SiteRange){0});
        Vec3 centre = block_centre(search->grid, block);
        double max_mm = nearest_mm + 2 * reach + slack_of(centre, reach);
        TRY(gather_sites(search->lists, search->sites, centre, max_mm, &list, err));
        return search_list(search, block, list, err);
    }
    for (int which = 0; which < 8; which++) {
        VoxelBlock part = part_of(block, which);
        if (is_empty(&part) || !is_wanted(search, &part))
            continue;
        Vec3 centre = block_centre(search->grid, &part);
        TRY(search_block(search, &part, sites_nearest(search->sites, centre, -INFINITY), err));
    }
    return STATUS_OK;
}

Status sites_search(const SiteSearch *search, double nearest_mm, Err *err)
{
    const VoxelBlock *block = search->block;
    return is_wanted(search, block) ? search_block(search, block, nearest_mm, err) : STATUS_OK;
}
