/* Restricts blend groups, the sets of segments that blend, to a list of segments, and leaves out
 * the restricted groups that are subsets of others.
 *
 * Two sparse sets mark which segments are in the list and which groups have been found. So a new
 * list needs no clearing of arrays: position[s] counts only if the list has s at this position
 * [Briggs & Torczon, "An efficient representation for sparse sets", 1993].
 *
 * If a group contains all of group A, it contains the member of A that is in the fewest groups, the
 * rarest member. So A is compared only with the groups of its rarest member. Most comparisons are
 * decided by the number of listed segments in the two groups, or by the lowest and the highest
 * index of these segments. */
#include "field/localgroups.h"

#include <stdlib.h>

/* A group, restricted to the segments of the list. */
typedef struct LocalGroup {
    uint32_t group;            /* index of the group in the geometry */
    uint32_t count, low, high; /* number of listed segments; their lowest and highest index */
    bool is_subset;            /* another restricted group has all of these segments */
} LocalGroup;

struct LocalGroups {
    const Blend *blend;
    const uint32_t *list;
    size_t n_list;
    uint32_t *position; /* per segment: its position in the list */
    uint32_t *index_of; /* per group: its index in `found` */
    LocalGroup *found;  /* in the order in which the list has their first members */
    size_t n_found;
    uint32_t *members; /* result of localgroups_members: positions in the list; as many elements as
                        * segments */
};

Status localgroups_new(const Geometry *geometry, LocalGroups **out, Err *err)
{
    LocalGroups *groups = NULL;
    const Blend *blend = &geometry->blend;
    Status status;
    TRY_GOTO(mem_calloc(&groups, 1, sizeof *groups, "groups", err));
    groups->blend = blend;
    TRY_GOTO(mem_calloc(&groups->position, geometry->n_segments, sizeof *groups->position, "groups",
                        err));
    TRY_GOTO(
        mem_calloc(&groups->members, geometry->n_segments, sizeof *groups->members, "groups", err));
    TRY_GOTO(
        mem_calloc(&groups->index_of, blend->n_groups, sizeof *groups->index_of, "groups", err));
    TRY_GOTO(mem_calloc(&groups->found, blend->n_groups, sizeof *groups->found, "groups", err));
    *out = groups;
    return STATUS_OK;
done:
    localgroups_free(groups);
    return status;
}

void localgroups_free(LocalGroups *groups)
{
    if (!groups)
        return;
    free(groups->position);
    free(groups->members);
    free(groups->index_of);
    free(groups->found);
    free(groups);
}

static bool is_listed(const LocalGroups *groups, uint32_t segment)
{
    uint32_t position = groups->position[segment];
    return position < groups->n_list && groups->list[position] == segment;
}

/* Returns the restricted group of a group, or NULL if no segment of the list was added to it. */
static LocalGroup *find_local(const LocalGroups *groups, uint32_t group)
{
    uint32_t index = groups->index_of[group];
    bool is_found = index < groups->n_found && groups->found[index].group == group;
    return is_found ? &groups->found[index] : NULL;
}

/* Adds a listed segment to the restricted groups of its groups. */
static void add_segment(LocalGroups *groups, uint32_t segment)
{
    const IndexLists *lists = &groups->blend->groups;
    for (uint32_t i = lists->first[segment]; i < lists->first[segment + 1]; i++) {
        uint32_t group = lists->items[i];
        LocalGroup *local = find_local(groups, group);
        if (!local) {
            groups->index_of[group] = (uint32_t)groups->n_found;
            local = &groups->found[groups->n_found++];
            *local = (LocalGroup){.group = group, .low = segment, .high = segment};
        }
        local->count++;
        local->low = segment < local->low ? segment : local->low;
        local->high = segment > local->high ? segment : local->high;
    }
}

/* Returns the listed segment of a restricted group that is in the fewest groups. */
static uint32_t rarest_of(const LocalGroups *groups, const LocalGroup *local)
{
    const IndexLists *members = &groups->blend->members, *groups_of = &groups->blend->groups;
    uint32_t rarest = local->low, fewest = UINT32_MAX;
    for (uint32_t i = members->first[local->group]; i < members->first[local->group + 1]; i++) {
        uint32_t segment = members->items[i];
        uint32_t count = groups_of->first[segment + 1] - groups_of->first[segment];
        if (count < fewest && is_listed(groups, segment)) {
            rarest = segment;
            fewest = count;
        }
    }
    return rarest;
}

/* Returns true if all segments of `local` are in `other`. Members of groups ascend. */
static bool is_within(const LocalGroups *groups, const LocalGroup *local, const LocalGroup *other)
{
    const IndexLists *members = &groups->blend->members;
    if (other->count < local->count || other->low > local->low || other->high < local->high)
        return false;
    for (uint32_t i = members->first[local->group], k = members->first[other->group];
         i < members->first[local->group + 1]; i++) {
        uint32_t segment = members->items[i];
        if (!is_listed(groups, segment))
            continue;
        while (k < members->first[other->group + 1] && members->items[k] < segment)
            k++;
        if (k == members->first[other->group + 1] || members->items[k] != segment)
            return false;
    }
    return true;
}

/* Returns true if a restricted group is a subset of another one. Of equal restricted groups, all
 * but the first count as subsets. */
static bool is_subset(const LocalGroups *groups, const LocalGroup *local)
{
    const IndexLists *groups_of = &groups->blend->groups;
    uint32_t rarest = rarest_of(groups, local);
    for (uint32_t i = groups_of->first[rarest]; i < groups_of->first[rarest + 1]; i++) {
        const LocalGroup *other = find_local(groups, groups_of->items[i]);
        if ((other->count > local->count || other < local) && is_within(groups, local, other))
            return true;
    }
    return false;
}

size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n)
{
    groups->list = list;
    groups->n_list = n;
    groups->n_found = 0;
    for (size_t i = 0; i < n; i++)
        groups->position[list[i]] = (uint32_t)i;
    for (size_t i = 0; i < n; i++)
        add_segment(groups, list[i]);
    for (size_t i = 0; i < groups->n_found; i++)
        groups->found[i].is_subset = is_subset(groups, &groups->found[i]);
    size_t kept = 0;
    for (size_t i = 0; i < groups->n_found; i++)
        if (!groups->found[i].is_subset)
            groups->found[kept++] = groups->found[i];
    groups->n_found = kept;
    return kept;
}

/* The positions are sorted while they are inserted; most groups have few members. */
const uint32_t *localgroups_members(LocalGroups *groups, size_t index, size_t *n)
{
    const IndexLists *lists = &groups->blend->members;
    uint32_t group = groups->found[index].group;
    size_t count = 0;
    for (uint32_t i = lists->first[group]; i < lists->first[group + 1]; i++) {
        if (!is_listed(groups, lists->items[i]))
            continue;
        uint32_t position = groups->position[lists->items[i]];
        size_t slot = count++;
        for (; slot > 0 && groups->members[slot - 1] > position; slot--)
            groups->members[slot] = groups->members[slot - 1];
        groups->members[slot] = position;
    }
    *n = count;
    return groups->members;
}
