/* The hull of vessels: all points in a vessel, or outside it within a given distance of its wall.
 * It is not a convex hull. Private to the module domain.
 *
 * A grid of cells covers the hull. Most cells are wholly inside or wholly outside it; for a point
 * of such a cell a look-up is enough. Distances to vessels are computed only for points in the
 * other cells. */
#ifndef CORCAST_DOMAIN_HULL_H
#define CORCAST_DOMAIN_HULL_H

#include "domain/domain.h"
#include <stdint.h>

/* The state of a cell of the grid. */
typedef enum HullCell {
    HULL_OUTSIDE,  /* the whole cell is outside the hull */
    HULL_BOUNDARY, /* the boundary may pass through the cell: each point must be tested */
    HULL_INSIDE    /* the whole cell is inside */
} HullCell;

struct Hull {
    DomainTube *tube; /* the vessels, with radii enlarged by the distance of the hull, mm; owned */
    size_t n;
    BoxTree tree;       /* over the tubes; owned */
    Vec3 low;           /* low corner of the grid, mm */
    double cell_mm;     /* edge of a cell, mm */
    int count[3];       /* cells along each axis; 1 along z in two dimensions */
    uint8_t *cell;      /* per cell: a HullCell; x runs fastest; owned */
    uint32_t *occupied; /* indices of the cells that are not HULL_OUTSIDE, rising; random points are
                         * drawn from these cells; owned */
    size_t n_occupied;
};

/* Builds the hull of `n` tubes, 0 < n < 2^31: sets dimension, hull, bounds, volume and inlet of the
 * domain. The caller, domain_of_tubes, sets the other members.
 *
 * domain   the caller sets ops, and parameter[0] to the distance from the walls of the tubes to
 *          the boundary of the hull, mm; the rest is zero. It calls domain_release, also after an
 *          error.
 * tubes    are copied.
 * Errors   STATUS_USAGE if the distance is out of range; STATUS_MEMORY. */
MUST_CHECK Status hull_build(Domain *domain, const DomainTube *tubes, size_t n, Err *err);

#endif
