/* Restricts the blend groups of a geometry to a short list of segments, for example the segments on
 * a ray, in a tile, or in a cell. Call localgroups_new once, then localgroups_find for each list,
 * and localgroups_members for each group that it finds.
 *
 * A blend group is the set of segments that blend at one node [scene/vesseltree.h]. The body of a
 * group is the set of points where the sum of the terms of its segments exceeds FIELD_LEVEL. The
 * surface is the boundary of the union of all bodies. A group is restricted by removing the
 * segments that are not in the list. A restricted group that is a subset of another restricted
 * group adds nothing to the union, because no term is negative, and is left out. Exported by the
 * public header of the module field. */
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

/* Restricts the groups to the listed segments.
 *
 * list     n different indices of segments, borrowed until the next call of localgroups_find.
 * Returns  the number of restricted groups that are not empty and not a subset of another
 *          restricted group; of several equal groups one is counted.
 * Cost     proportional to the total size of the groups of the listed segments. */
size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n);

/* Returns the members of group `index`, which is below the number that localgroups_find returned:
 * *n positions in the list, rising. Valid until the next call of localgroups_find. */
const uint32_t *localgroups_members(LocalGroups *groups, size_t index, size_t *n);

#endif
