/* Builds the blend groups of a tree and of a part of a tree. A group is the set of segments whose
 * surfaces blend at one node; the surface is the union over all groups. Neighbouring nodes often
 * have the same segments: every segment that blends at the end of a twig also blends where the twig
 * leaves its parent, because it reaches the end only by a path through that node. A group that is a
 * subset of another group does not change the union, so only groups that no other group contains
 * are kept. A group that contains this one also contains its rarest member, the one that is in the
 * fewest groups. So only the groups of that member are compared. */
#include "scene/vesseltree.h"

#include <stdlib.h>

/* Inverts lists: out[item] becomes the ascending list of the indices of all lists that contain the
 * item, for each item below n_items. */
static Status invert_lists(const IndexLists *lists, size_t n_items, IndexLists *out, Err *err)
{
    TRY(indexlists_begin(out, n_items, "groups", err));
    for (uint32_t i = 0; i < lists->first[lists->n]; i++)
        indexlists_count(out, lists->items[i]);
    TRY(indexlists_allot(out, "groups", err));
    for (uint32_t list = 0; list < lists->n; list++)
        for (uint32_t i = lists->first[list]; i < lists->first[list + 1]; i++)
            indexlists_put(out, lists->items[i], list);
    return STATUS_OK;
}

/* Returns true if list b holds all of list a, which is not empty. Lists are ascending, so both are
 * traversed once. */
static bool is_subset(const IndexLists *lists, uint32_t a, uint32_t b)
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

/* Returns true if the list with the index `list` is empty, a subset of another list, or equal to an
 * earlier list. `holders` is the inverse of `lists`. */
static bool is_redundant(const IndexLists *lists, const IndexLists *holders, uint32_t list)
{
    uint32_t rarest = 0, fewest = UINT32_MAX;
    for (uint32_t i = lists->first[list]; i < lists->first[list + 1]; i++) {
        uint32_t count = indexlists_length(holders, lists->items[i]);
        rarest = count < fewest ? lists->items[i] : rarest;
        fewest = count < fewest ? count : fewest;
    }
    if (fewest == UINT32_MAX)
        return true;
    for (uint32_t i = holders->first[rarest]; i < holders->first[rarest + 1]; i++) {
        uint32_t other = holders->items[i];
        bool larger = indexlists_length(lists, other) > indexlists_length(lists, list);
        if ((larger || other < list) && is_subset(lists, list, other))
            return true;
    }
    return false;
}

/* Copies the lists that are not redundant. */
static Status copy_needed(const IndexLists *lists, const IndexLists *holders, IndexLists *kept,
                          Err *err)
{
    uint32_t *busy = NULL;
    size_t n = 0;
    Status status;
    TRY_GOTO(mem_calloc(&busy, lists->n, sizeof *busy, "groups", err));
    for (uint32_t i = 0; i < lists->n; i++)
        if (!is_redundant(lists, holders, i))
            busy[n++] = i;
    TRY_GOTO(indexlists_begin(kept, n, "groups", err));
    for (size_t i = 0; i < n; i++) /* what indexlists_count would count, one by one */
        kept->first[i + 2] = indexlists_length(lists, busy[i]);
    TRY_GOTO(indexlists_allot(kept, "groups", err));
    for (size_t i = 0; i < n; i++)
        for (uint32_t k = lists->first[busy[i]]; k < lists->first[busy[i] + 1]; k++)
            indexlists_put(kept, i, lists->items[k]);
done:
    free(busy);
    return status;
}

Status vesseltree_blend(const VesselTree *tree, Blend *out, Err *err)
{
    IndexLists incident = {0}, blending = {0}, nodes = {0};
    Blend blend = {0};
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &incident, err));
    TRY_GOTO(vesseltree_blending(tree, &incident, &blending, err));
    TRY_GOTO(invert_lists(&blending, tree->n_segments, &nodes, err));
    TRY_GOTO(copy_needed(&blending, &nodes, &blend.members, err));
    TRY_GOTO(invert_lists(&blend.members, tree->n_segments, &blend.groups, err));
    blend.n_groups = blend.members.n;
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

/* Appends the positions in `indices` of those members of a group that are among `indices`. Does so,
 * and returns true, only if the first of them has the position `i`, so that each group is added
 * once. */
static bool add_group_once(const IndexLists *members, uint32_t group, const uint32_t *indices,
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

/* Lists the groups that contain some of `n` segments; each group is listed at its first segment.
 * `capacity` counts a group once per segment, which bounds both the groups and their members.
 * add_group_once also writes a group that it then does not list, so there is space for one more,
 * the longest. */
static Status part_members(const Blend *whole, const uint32_t *indices, size_t n, Blend *part,
                           Err *err)
{
    const IndexLists *groups = &whole->groups, *members = &whole->members;
    size_t capacity = 0, n_items = 0;
    uint32_t longest = 0;
    for (size_t i = 0; i < n; i++)
        capacity += indexlists_length(groups, indices[i]);
    for (uint32_t g = 0; g < whole->n_groups; g++)
        longest = indexlists_length(members, g) > longest ? indexlists_length(members, g) : longest;
    TRY(mem_calloc(&part->members.first, capacity + 1, sizeof *part->members.first, "groups", err));
    TRY(mem_calloc(&part->members.items, capacity + longest, sizeof *part->members.items, "groups",
                   err));
    for (size_t i = 0; i < n; i++)
        for (uint32_t k = groups->first[indices[i]]; k < groups->first[indices[i] + 1]; k++)
            if (add_group_once(members, groups->items[k], indices, n, i, part->members.items,
                               &n_items))
                part->members.first[++part->n_groups] = (uint32_t)n_items;
    part->members.n = part->n_groups;
    return STATUS_OK;
}

/* A geometry of field segments has no mesh. Every array of `made` that geometry_release frees is
 * therefore either new or NULL. */
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
        TRY_GOTO(invert_lists(&made.blend.members, n, &made.blend.groups, err));
    }
    *part = made;
    return STATUS_OK;
done:
    geometry_release(&made);
    return status;
}
