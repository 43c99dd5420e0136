/* Two sparse sets mark which segments are in the list and which groups have been found, without
 * initialising or clearing an array: position[s] counts only if the list has s at this position
 * [Briggs & Torczon, "An efficient representation for sparse sets", 1993].
 *
 * A group that contains another group contains its rarest member. So only the groups of this member
 * are compared. The number of listed segments of both groups, and the lowest and the highest of
 * these, decide most comparisons. */
#include "field/localgroups.h"

#include <stdlib.h>

/* The listed segments of a group. */
typedef struct GroupPart {
    uint32_t group;
    uint32_t count, low, high; /* number of listed segments, their lowest and highest index */
    bool is_subset;            /* another part has all of them */
} GroupPart;

struct LocalGroups {
    const Blend *blend;
    const uint32_t *list;
    size_t n_list;
    uint32_t *position; /* per segment: its position in the list */
    uint32_t *met;      /* per group: the index of its part */
    GroupPart *parts;   /* in the order in which the list has their first members */
    size_t n_parts;
    uint32_t *members; /* per segment: result of localgroups_members */
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
    TRY_GOTO(mem_calloc(&groups->met, blend->n_groups, sizeof *groups->met, "groups", err));
    TRY_GOTO(mem_calloc(&groups->parts, blend->n_groups, sizeof *groups->parts, "groups", err));
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
    free(groups->met);
    free(groups->parts);
    free(groups);
}

static bool is_listed(const LocalGroups *groups, uint32_t segment)
{
    uint32_t position = groups->position[segment];
    return position < groups->n_list && groups->list[position] == segment;
}

static GroupPart *part_of(const LocalGroups *groups, uint32_t group)
{
    uint32_t number = groups->met[group];
    bool met = number < groups->n_parts && groups->parts[number].group == group;
    return met ? &groups->parts[number] : NULL;
}

/* Adds a segment to the parts of its groups. */
static void meet(LocalGroups *groups, uint32_t segment)
{
    const IndexLists *lists = &groups->blend->groups;
    for (uint32_t i = lists->first[segment]; i < lists->first[segment + 1]; i++) {
        uint32_t group = lists->items[i];
        GroupPart *part = part_of(groups, group);
        if (!part) {
            groups->met[group] = (uint32_t)groups->n_parts;
            part = &groups->parts[groups->n_parts++];
            *part = (GroupPart){.group = group, .low = segment, .high = segment};
        }
        part->count++;
        part->low = segment < part->low ? segment : part->low;
        part->high = segment > part->high ? segment : part->high;
    }
}

/* Returns the listed member of a part that is in the fewest groups. */
static uint32_t rarest_of(const LocalGroups *groups, const GroupPart *part)
{
    const IndexLists *members = &groups->blend->members, *holders = &groups->blend->groups;
    uint32_t rarest = part->low, fewest = UINT32_MAX;
    for (uint32_t i = members->first[part->group]; i < members->first[part->group + 1]; i++) {
        uint32_t segment = members->items[i];
        uint32_t count = holders->first[segment + 1] - holders->first[segment];
        if (count < fewest && is_listed(groups, segment)) {
            rarest = segment;
            fewest = count;
        }
    }
    return rarest;
}

/* Returns true if all listed segments of `part` are in the group of `other`. */
static bool is_within(const LocalGroups *groups, const GroupPart *part, const GroupPart *other)
{
    const IndexLists *members = &groups->blend->members;
    if (other->count < part->count || other->low > part->low || other->high < part->high)
        return false;
    for (uint32_t i = members->first[part->group], k = members->first[other->group];
         i < members->first[part->group + 1]; i++) {
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

/* Returns true if a part is a subset of another part. Of equal parts, the first one is none. */
static bool is_subset(const LocalGroups *groups, const GroupPart *part)
{
    const IndexLists *holders = &groups->blend->groups;
    uint32_t rarest = rarest_of(groups, part);
    for (uint32_t i = holders->first[rarest]; i < holders->first[rarest + 1]; i++) {
        const GroupPart *other = part_of(groups, holders->items[i]);
        if ((other->count > part->count || other < part) && is_within(groups, part, other))
            return true;
    }
    return false;
}

size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n)
{
    groups->list = list;
    groups->n_list = n;
    groups->n_parts = 0;
    for (size_t i = 0; i < n; i++)
        groups->position[list[i]] = (uint32_t)i;
    for (size_t i = 0; i < n; i++)
        meet(groups, list[i]);
    for (size_t i = 0; i < groups->n_parts; i++)
        groups->parts[i].is_subset = is_subset(groups, &groups->parts[i]);
    size_t kept = 0;
    for (size_t i = 0; i < groups->n_parts; i++)
        if (!groups->parts[i].is_subset)
            groups->parts[kept++] = groups->parts[i];
    groups->n_parts = kept;
    return kept;
}

const uint32_t *localgroups_members(LocalGroups *groups, size_t number, size_t *n)
{
    const IndexLists *lists = &groups->blend->members;
    uint32_t group = groups->parts[number].group;
    size_t count = 0;
    for (uint32_t i = lists->first[group]; i < lists->first[group + 1]; i++) {
        if (!is_listed(groups, lists->items[i]))
            continue;
        uint32_t position = groups->position[lists->items[i]];
        size_t hole = count++;
        for (; hole > 0 && groups->members[hole - 1] > position; hole--)
            groups->members[hole] = groups->members[hole - 1];
        groups->members[hole] = position;
    }
    *n = count;
    return groups->members;
}
