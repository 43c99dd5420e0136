/* Ports: channels from the ends of vessels to the faces of a block about them. */
#ifndef CORCAST_PRINT_PORTS_H
#define CORCAST_PRINT_PORTS_H

#include "print/casing.h"
#include "print/print.h"

/* Maximum number of rings of points of a port, without the vessel's own rim. */
enum { PORT_RINGS = 14 };

typedef struct PortRing {
    Vec3 center;    /* mm */
    Vec3 direction; /* unit, across the ring, out of the block */
    double radius_mm;
} PortRing;

typedef struct Port {
    CutEnd *end;
    int face;
    int n_rings;
    Box box;                    /* about its channel and the clearance to be left about it */
    PortRing rings[PORT_RINGS]; /* the last one is in the face */
    bool is_straight;           /* it has one ring, an ellipse where the face cuts off a cone */
    uint32_t *points;           /* of the last ring in the solid; owned */
} Port;

typedef struct Ports {
    Port *items; /* owned */
    size_t n;
} Ports;

/* Finds a port for each end that is to have one, and marks these ends as opened. Ports keep clear
 * of all vessels and of each other. An end without a possible port gets none. Release the ports
 * with ports_release. Errors: STATUS_MEMORY. O(ends (log segments + ports)). */
MUST_CHECK Status ports_find(const VesselTree *tree, const CutEnds *ends, const Casing *casing,
                             const PrintBlock *block, Ports *out, Err *err);
void ports_release(Ports *ports);

/* Adds the walls of the ports to a solid that has the vessels' surface turned inside out. The solid
 * is on the outside of the ports. Errors: STATUS_MEMORY. */
MUST_CHECK Status ports_add(const VesselTree *tree, Ports *ports, Solid *solid, Err *err);

#endif
