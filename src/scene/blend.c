/* The groups of a tree's potential, and of a part of it. Neighbouring nodes often have the same
 * segments, and what blends at the end of a twig blends where the twig leaves, too, having passed
 * there. A group that is part of another adds nothing to their union, so only those are kept that
 * no other holds. A holder has every member, so it is looked for among the nodes of the member that
 * has the fewest.
 */
#include "scene/vesseltree.h"

#include <stdlib.h>

/* The lists of the numbers below n_items: in which of the n lists each is. */
static Status turn_over(const IndexLists *lists, size_t n, size_t n_items, IndexLists *out,
                        Err *err)
{
    IndexLists turned = {0};
    Status status;
    TRY_GOTO(mem_calloc(&turned.first, n_items + 2, sizeof *turned.first, "groups", err));
    TRY_GOTO(mem_calloc(&turned.items, lists->first[n], sizeof *turned.items, "groups", err));
    for (uint32_t i = 0; i < lists->first[n]; i++)
        turned.first[lists->items[i] + 2]++;
    for (size_t i = 2; i <= n_items; i++)
        turned.first[i] += turned.first[i - 1];
    for (uint32_t list = 0; list < n; list++)
        for (uint32_t i = lists->first[list]; i < lists->first[list + 1]; i++)
            turned.items[turned.first[lists->items[i] + 1]++] = list;
    *out = turned;
    return STATUS_OK;
done:
    indexlists_release(&turned);
    return status;
}

static uint32_t length_of(const IndexLists *lists, uint32_t i)
{
    return lists->first[i + 1] - lists->first[i];
}

/* Whether list b holds all of list a, which is not empty. */
static bool is_part(const IndexLists *lists, uint32_t a, uint32_t b)
{
    const uint32_t *of_a = lists->items + lists->first[a],
                   *end_a = lists->items + lists->first[a + 1];
    const uint32_t *of_b = lists->items + lists->first[b],
                   *end_b = lists->items + lists->first[b + 1];
    if (end_a - of_a > end_b - of_b || *of_a < *of_b || end_a[-1] > end_b[-1])
        return false;
    for (; of_a < end_a; of_a++) {
        while (*of_b < *of_a)
            of_b++;
        if (*of_b != *of_a)
            return false;
    }
    return true;
}

/* Whether the list is empty, part of another, or the same as an earlier one; `holders` are the
 * lists that hold each number. */
static bool is_idle(const IndexLists *lists, const IndexLists *holders, uint32_t self)
{
    uint32_t rarest = 0, fewest = UINT32_MAX;
    for (uint32_t i = lists->first[self]; i < lists->first[self + 1]; i++) {
        uint32_t count = length_of(holders, lists->items[i]);
        rarest = count < fewest ? lists->items[i] : rarest;
        fewest = count < fewest ? count : fewest;
    }
    if (fewest == UINT32_MAX)
        return true;
    for (uint32_t i = holders->first[rarest]; i < holders->first[rarest + 1]; i++) {
        uint32_t other = holders->items[i];
        bool larger = length_of(lists, other) > length_of(lists, self);
        if ((larger || other < self) && is_part(lists, self, other))
            return true;
    }
    return false;
}

/* The lists that are not idle, in *out, and how many. */
static Status keep_busy(const IndexLists *lists, const IndexLists *holders, size_t n,
                        IndexLists *out, size_t *n_out, Err *err)
{
    IndexLists kept = {0};
    size_t count = 0;
    Status status;
    TRY_GOTO(mem_calloc(&kept.first, n + 1, sizeof *kept.first, "groups", err));
    TRY_GOTO(mem_calloc(&kept.items, lists->first[n], sizeof *kept.items, "groups", err));
    for (uint32_t i = 0; i < n; i++) {
        if (is_idle(lists, holders, i))
            continue;
        kept.first[count + 1] = kept.first[count];
        count++;
        for (uint32_t k = lists->first[i]; k < lists->first[i + 1]; k++)
            kept.items[kept.first[count]++] = lists->items[k];
    }
    *out = kept;
    *n_out = count;
    return STATUS_OK;
done:
    indexlists_release(&kept);
    return status;
}

Status vesseltree_blend(const VesselTree *tree, Blend *out, Err *err)
{
    IndexLists incident = {0}, blending = {0}, nodes = {0};
    Blend blend = {0};
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &incident, err));
    TRY_GOTO(vesseltree_blending(tree, &incident, &blending, err));
    TRY_GOTO(turn_over(&blending, tree->n_nodes, tree->n_segments, &nodes, err));
    TRY_GOTO(keep_busy(&blending, &nodes, tree->n_nodes, &blend.members, &blend.n_groups, err));
    TRY_GOTO(turn_over(&blend.members, blend.n_groups, tree->n_segments, &blend.groups, err));
    *out = blend;
    blend = (Blend){0};
done:
    indexlists_release(&incident);
    indexlists_release(&blending);
    indexlists_release(&nodes);
    indexlists_release(&blend.members);
    indexlists_release(&blend.groups);
    return status;
}

/* Appends those members of a group that are among `indices`, unless the first of them is not
 * number `i`: then the group is listed elsewhere. */
static bool add_members(const IndexLists *members, uint32_t group, const uint32_t *indices,
                        size_t n, size_t i, uint32_t *items, size_t *n_items)
{
    size_t end = *n_items;
    for (uint32_t k = members->first[group]; k < members->first[group + 1]; k++) {
        size_t place = sorted_find(indices, n, members->items[k]);
        if (place < n)
            items[end++] = (uint32_t)place;
    }
    if (items[*n_items] != i)
        return false;
    *n_items = end;
    return true;
}

/* The groups of some segments, each listed where its first segment is. */
static Status part_members(const Blend *whole, const uint32_t *indices, size_t n, Blend *part,
                           Err *err)
{
    const IndexLists *groups = &whole->groups, *members = &whole->members;
    size_t most = 0, n_items = 0;
    uint32_t longest = 0;
    for (size_t i = 0; i < n; i++)
        most += length_of(groups, indices[i]);
    for (uint32_t g = 0; g < whole->n_groups; g++)
        longest = length_of(members, g) > longest ? length_of(members, g) : longest;
    TRY(mem_calloc(&part->members.first, most + 1, sizeof *part->members.first, "groups", err));
    TRY(mem_calloc(&part->members.items, most + longest, sizeof *part->members.items, "groups",
                   err));
    for (size_t i = 0; i < n; i++)
        for (uint32_t k = groups->first[indices[i]]; k < groups->first[indices[i] + 1]; k++)
            if (add_members(members, groups->items[k], indices, n, i, part->members.items,
                            &n_items))
                part->members.first[++part->n_groups] = (uint32_t)n_items;
    return STATUS_OK;
}

Status geometry_part(const Geometry *whole, const uint32_t *indices, size_t n, Geometry *part,
                     Err *err)
{
    Geometry made = *whole;
    Status status;
    made.primitives = NULL;
    made.axes = NULL;
    made.ids = NULL;
    made.segments = NULL;
    made.blend = (Blend){0};
    made.n_primitives = made.n_ends = made.n_ids = 0;
    TRY_GOTO(mem_calloc(&made.segments, n, sizeof *made.segments, "segments", err));
    for (size_t i = 0; i < n; i++)
        made.segments[i] = whole->segments[indices[i]];
    made.n_segments = made.drawn = n;
    if (whole->blend.n_groups) {
        TRY_GOTO(part_members(&whole->blend, indices, n, &made.blend, err));
        TRY_GOTO(turn_over(&made.blend.members, made.blend.n_groups, n, &made.blend.groups, err));
    }
    *part = made;
    return STATUS_OK;
done:
    geometry_release(&made);
    return status;
}
