/* Ways from the ends of vessels to the faces of a block about them. */
#ifndef CORCAST_PRINT_PORTS_H
#define CORCAST_PRINT_PORTS_H

#include "print/casing.h"
#include "print/print.h"

/* Rings of points, after the vessel's own rim. */
enum { PORT_RINGS = 14 };

typedef struct PortRing {
    Vec3 center, way; /* mm; unit, across the ring, out of the block */
    double radius_mm;
} PortRing;

typedef struct Port {
    CutEnd *end;
    int face;
    int n_rings;
    Box box;                    /* of its walls and of what is left free about them */
    PortRing rings[PORT_RINGS]; /* the last one lies in the face ... */
    bool is_straight;           /* ... and is the only one, an ellipse: the face cuts off a cone */
    uint32_t *points;           /* of the last ring in the solid; owned */
} Port;

typedef struct Ports {
    Port *items; /* owned */
    size_t n;
} Ports;

/* Finds a way out for each end that is to have one and can, and marks these ends as opened: ways
 * keep off all vessels and each other. O(ends (log segments + ports)). */
MUST_CHECK Status ports_find(const VesselTree *tree, const CutEnds *ends, const Casing *casing,
                             const PrintBlock *block, Ports *out, Err *err);
void ports_release(Ports *ports);

/* Adds the walls of the ports, on whose outside the solid lies, to a solid that has the vessels'
 * surface turned inside out. */
MUST_CHECK Status ports_add(const VesselTree *tree, Ports *ports, Solid *solid, Err *err);

#endif
