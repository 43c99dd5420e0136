/* The blend groups of a geometry, reduced to a few segments: those on a ray, in a tile, or in a
 * cell.
 *
 * A blend group is the set of segments that blend at one node [scene/vesseltree.h]. Its body is the
 * set of points where the sum of their terms exceeds FIELD_LEVEL. The surface is the boundary of
 * the union of all bodies. The segments of a short list are members of few groups. Reduced to the
 * list, some of these groups are subsets of others, or equal to them; they add nothing.
 * localgroups_find returns the groups that remain. Exported by the public header of the module
 * field. */
#ifndef CORCAST_FIELD_LOCALGROUPS_H
#define CORCAST_FIELD_LOCALGROUPS_H

#include "base/base.h"
#include "scene/scene.h"

/* The workspace of one thread. localgroups_new allocates all its memory. */
typedef struct LocalGroups LocalGroups;

/* Makes a workspace for a geometry that has blend groups. The geometry is borrowed. Free the
 * workspace with localgroups_free. Errors: STATUS_MEMORY. */
MUST_CHECK Status localgroups_new(const Geometry *geometry, LocalGroups **out, Err *err);
/* Frees the workspace; NULL is allowed. */
void localgroups_free(LocalGroups *groups);

/* Reduces the groups to the listed segments.
 *
 * list     n different indices of segments, borrowed until the next call of localgroups_find.
 * Returns  the number of groups, reduced to the list, that are not empty and not a subset of
 *          another one; of equal groups one is counted. The union of their bodies is the union of
 *          the bodies of all reduced groups.
 * Cost     proportional to the lengths of the groups of the segments. */
size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n);

/* Returns the members of group `index`, which is below the number that localgroups_find returned:
 * *n positions in the list, rising. Valid until the next call of localgroups_find. */
const uint32_t *localgroups_members(LocalGroups *groups, size_t index, size_t *n);

#endif
