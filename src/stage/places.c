/* Nodes joined by segments of no length are one place. A segment that shares both ends with a sister at
 * least as thick lies inside her and is left out; measured trees hold such pairs. Their distal nodes are
 * one place, too. */
#include "stage/places.h"

#include <stdlib.h>

static bool has_length(const Tree *tree, size_t i)
{
    return tree_segment_length(tree, i) > SHORTEST_MM;
}

bool segment_can_be_drawn(const Tree *tree, size_t i)
{
    return tree_is_segment(tree, i) && tree->radius_mm[i] > 0 && has_length(tree, i);
}

/* Compares each segment with its elder sisters, which are kept in lists, latest first. */
static void find_covers(const Tree *tree, int32_t *last, int32_t *previous, int32_t *cover)
{
    for (size_t i = 0; i < tree->n; i++) {
        last[i] = cover[i] = TREE_NO_PARENT;
        if (!segment_can_be_drawn(tree, i))
            continue;
        int32_t self = (int32_t)i, *youngest = &last[tree->parent[i]];
        for (int32_t sister = *youngest; sister >= 0; sister = previous[sister]) {
            if (cover[sister] >= 0 ||
                vec3_distance(tree->position[i], tree->position[sister]) > SHORTEST_MM)
                continue;
            bool thicker = tree->radius_mm[i] > tree->radius_mm[sister];
            cover[thicker ? sister : self] = thicker ? self : sister;
            break;
        }
        previous[i] = *youngest;
        *youngest = self;
    }
}

Status places_find(const Tree *tree, Places *places, Err *err)
{
    int32_t *last = NULL, *previous = NULL;
    Places found = {0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&last, tree->n, sizeof *last, "nodes", err));
    TRY_GOTO(mem_calloc(&previous, tree->n, sizeof *previous, "nodes", err));
    TRY_GOTO(mem_calloc(&found.cover, tree->n, sizeof *found.cover, "nodes", err));
    TRY_GOTO(mem_calloc(&found.place, tree->n, sizeof *found.place, "nodes", err));
    find_covers(tree, last, previous, found.cover);
    for (size_t i = 0; i < tree->n; i++) {
        int32_t self = (int32_t)i;
        while (found.cover[self] >= 0)
            self = found.cover[self];
        bool joined = tree_is_segment(tree, i) && !has_length(tree, i);
        found.place[i] = joined ? found.place[tree->parent[i]] : self;
    }
done:
    free(last);
    free(previous);
    if (status == STATUS_OK)
        *places = found;
    else
        places_release(&found);
    return status;
}

void places_release(Places *places)
{
    free(places->cover);
    free(places->place);
    *places = (Places){0};
}
