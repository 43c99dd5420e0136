/* How much of a box the union of bodies covers; private to the room voxel. */
#ifndef CORCAST_VOXEL_COVER_H
#define CORCAST_VOXEL_COVER_H

#include "base/base.h"
#include "voxel/body.h"

/* Room for cover_part, kept from call to call: zeroed at first, freed with cover_release. */
typedef struct CoverRoom {
    uint32_t *lists;
    double (*chords)[2];
    size_t n_lists, n_chords;
} CoverRoom;

MUST_CHECK Status cover_reserve(CoverRoom *room, size_t n_bodies, Err *err);
void cover_release(CoverRoom *room);

/* The part of the cell, in [0, 1], that is in at least one of n bodies, for as many of which there
 * is room: as body_part where one alone meets the cell; else within 0.01, and within 0.0014 in the
 * mean square. The order of the list does not matter. */
double cover_part(const Body *bodies, const uint32_t *list, size_t n, const Cell *cell,
                  CoverRoom *room);

#endif
