/* The blend groups of a geometry, reduced to a few segments: those on a ray, in a tile, or in a
 * cell. Exported by the module's public header. */
#ifndef CORCAST_FIELD_LOCALGROUPS_H
#define CORCAST_FIELD_LOCALGROUPS_H

#include "base/base.h"
#include "scene/scene.h"

/* The workspace of one thread. Nothing is allocated after it was made. */
typedef struct LocalGroups LocalGroups;

/* Makes a workspace for a geometry that has blend groups. The geometry is borrowed. Free the
 * workspace with localgroups_free. Errors: STATUS_MEMORY. */
MUST_CHECK Status localgroups_new(const Geometry *geometry, LocalGroups **out, Err *err);
void localgroups_free(LocalGroups *groups);

/* Reduces the groups to the listed segments, each of which is listed once.
 *
 * list     is borrowed until the next call.
 * Returns  the number of groups that are not empty and not part of another group. The union of
 * their bodies is the union of the bodies of all groups. Cost     proportional to the lengths of
 * the groups of the segments. */
size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n);

/* Returns the members of group `index`: positions in the list, rising, *n of them. Valid until the
 * next call. */
const uint32_t *localgroups_members(LocalGroups *groups, size_t index, size_t *n);

#endif
