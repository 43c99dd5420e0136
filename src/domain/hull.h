/* The hull of vessels: all points within a given distance of at least one vessel. The state of a
 * grid cell decides for most points whether they are inside. Distances to vessels are computed only
 * in cells at the hull's edge. Private to the module domain. */
#ifndef CORCAST_DOMAIN_HULL_H
#define CORCAST_DOMAIN_HULL_H

#include "domain/domain.h"
#include <stdint.h>

/* The state of a cell of the grid. */
typedef enum HullCell {
    HULL_OUTSIDE, /* the whole cell is outside the hull */
    HULL_EDGE,    /* unknown: each point must be tested */
    HULL_INSIDE   /* the whole cell is inside */
} HullCell;

struct Hull {
    DomainTube *tube; /* the vessels, with the radii of the hull around them, mm; owned */
    size_t n;
    BoxTree tree;       /* over the tubes; owned */
    Vec3 low;           /* low corner of the grid, mm */
    double edge;        /* edge of a cell, mm */
    int count[3];       /* cells along each axis; 1 along z in two dimensions */
    uint8_t *cell;      /* per cell: a HullCell; x runs fastest; owned */
    uint32_t *occupied; /* the indices of cells that are not HULL_OUTSIDE, rising; owned */
    size_t n_occupied;
};

/* Builds the hull of `n` > 0 tubes: sets dimension, hull, bounds, volume and inlet of the domain.
 * domain->size[0] is set before: the distance from a tube's wall to the hull's boundary, mm.
 *
 * domain   is released with domain_release, also after an error. The tubes are copied.
 * Errors   STATUS_USAGE if the distance is out of range; STATUS_MEMORY. */
MUST_CHECK Status hull_build(Domain *domain, const DomainTube *tubes, size_t n, Err *err);

#endif
