/* The first segment of every tree. */
#ifndef CORCAST_GROW_FIRST_SEGMENTS_H
#define CORCAST_GROW_FIRST_SEGMENTS_H

#include "domain/domain.h"
#include "grow/network.h"

/* Gives each inlet of `net` its root segment, which leads within the domain to a random point that
 * is nearer to it than to any other inlet and about as far from it as points are; the segments keep
 * clear of each other. *distance, mm, is how far points have to be at first, and becomes how far
 * those of the nearest had to be; *tosses counts the points drawn. STATUS_INFEASIBLE when there is
 * no such point. */
MUST_CHECK Status first_segments_add(Network *net, const Domain *domain, Random *random,
                                     double *distance, uint64_t *tosses, Err *err);

#endif
