/* The tissue about tubes; private to the room domain. */
#ifndef CORCAST_DOMAIN_HULL_H
#define CORCAST_DOMAIN_HULL_H

#include "domain/domain.h"
#include <stdint.h>

/* What is known of a cell of the grid over the hull. */
typedef enum HullCell { HULL_OUTSIDE, HULL_EDGE, HULL_INSIDE } HullCell;

struct Hull {
    DomainTube *tube; /* owned; radii are those of the hull about them */
    size_t n;
    BoxTree tree;   /* over the tubes; owned */
    Vec3 low;       /* of the grid, mm */
    double edge;    /* of its cells, mm */
    int count[3];   /* one along z in two dimensions */
    uint8_t *cell;  /* HullCell, x fastest; owned */
    uint32_t *some; /* the cells that are not outside, ascending; owned */
    size_t n_some;
};

/* Fills dimension, hull, bounds, volume and inlet of a domain whose size[0] is the reach of the
 * tissue beyond the tubes, mm. STATUS_USAGE for a reach out of range, STATUS_MEMORY. */
MUST_CHECK Status hull_build(Domain *domain, const DomainTube *tubes, size_t n, Err *err);

#endif
