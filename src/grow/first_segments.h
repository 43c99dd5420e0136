/* The first segment of every tree. */
#ifndef CORCAST_GROW_FIRST_SEGMENTS_H
#define CORCAST_GROW_FIRST_SEGMENTS_H

#include "domain/domain.h"
#include "grow/network_grid.h"

/* Gives each inlet of `net`, which holds nothing but inlets, its root segment. It leads within the
 * domain to a random point that is nearer to this inlet than to any other, and about as far from it
 * as points of the domain are; root segments keep clear of each other, and trees apart as the rules
 * say. Where terminals are pairs, the second tree's point is a mate of the first's, and neither has
 * to be nearer to its inlet. *distance, mm: how far points have to be from their inlet at first;
 * becomes the least distance that was asked for in the end. *tosses is increased by the points
 * drawn. Leaves right sums, and no radii. STATUS_INFEASIBLE when there is no such point. */
MUST_CHECK Status first_segments_add(Network *net, const Domain *domain, const Rules *rules,
                                     Random *random, double *distance, uint64_t *tosses, Err *err);

#endif
