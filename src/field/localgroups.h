/* The groups of a blend, as few segments see them: those on a ray, in a tile or in a cell. Exported
 * by the room's door. */
#ifndef CORCAST_FIELD_LOCALGROUPS_H
#define CORCAST_FIELD_LOCALGROUPS_H

#include "base/base.h"
#include "scene/scene.h"

/* The workspace of one thread: nothing is allocated once it is made. */
typedef struct LocalGroups LocalGroups;

/* For lists of segments of the geometry, which is borrowed and has a blend. STATUS_MEMORY. */
MUST_CHECK Status localgroups_new(const Geometry *geometry, LocalGroups **out, Err *err);
void localgroups_free(LocalGroups *groups);

/* Cuts the groups down to the segments listed, each of which comes once, and returns how many are
 * left that are neither empty nor part of another: the union of their bodies is that of all. Takes
 * time in proportion to the lengths of the groups of the segments. The list is borrowed until the
 * next. */
size_t localgroups_find(LocalGroups *groups, const uint32_t *list, size_t n);

/* The places in the list of what a group, numbered from 0, has there, rising; valid until the next
 * call. */
const uint32_t *localgroups_members(LocalGroups *groups, size_t number, size_t *n);

#endif
