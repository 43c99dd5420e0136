/* Ports: channels from the ends of vessels to the faces of a block about them.
 *
 * A port is a sequence of rings, circles of points, from the rim of a vessel end to a face. A
 * straight port continues the vessel's axis as a cone. A bent port follows a curve and meets the
 * face at a right angle, as a Luer fitting needs. ports_find chooses the paths, ports_add makes the
 * triangles. Private to the module print. */
#ifndef CORCAST_PRINT_PORTS_H
#define CORCAST_PRINT_PORTS_H

#include "print/casing.h"
#include "print/print.h"

/* Maximum number of rings of a port, without the vessel's own rim. The reason for the number is not
 * recorded; fewer rings make bends coarser. */
enum { PORT_RINGS = 14 };

/* One ring of a port. */
typedef struct PortRing {
    Vec3 center;    /* mm */
    Vec3 direction; /* unit, perpendicular to the ring, out of the block */
    double radius_mm;
} PortRing;

typedef struct Port {
    CutEnd *end; /* the vessel end that the port begins at; borrowed */
    int face;    /* the face that it leads to [casing.h] */
    int n_rings;
    Box box;                    /* about the channel and the clearance that is left about it, mm */
    PortRing rings[PORT_RINGS]; /* from the vessel on; the last one is in the face */
    FieldSegment parts[PORT_RINGS]; /* per ring: a capsule about the channel before the ring */
    bool is_straight; /* the port has one ring, an ellipse where the face cuts off a cone */
    uint32_t *points; /* indices in the solid of the last ring's points; owned; set by
                       * ports_add */
} Port;

typedef struct Ports {
    Port *items; /* owned */
    size_t n;
} Ports;

/* Finds a port for each end that PrintBlock.ports selects, and sets these ends to opened. Ports
 * keep clear of all vessels and of each other. An end without a possible port gets none.
 *
 * ends     the flat ends of the vessels' mesh. Inlets are served first, then outlets.
 * out      receives the ports; release them with ports_release. They point into `ends`.
 * Errors   STATUS_MEMORY.
 * Cost     O(ends (log segments + ports)). */
MUST_CHECK Status ports_find(const VesselTree *tree, const CutEnds *ends, const Casing *casing,
                             const PrintBlock *block, Ports *out, Err *err);
void ports_release(Ports *ports);

/* Adds the surfaces of the ports to a solid that holds the vessels' surface turned inside out, with
 * the rims of the ends filled [solid_surface]. The channels are cavities of the solid. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status ports_add(const VesselTree *tree, Ports *ports, Solid *solid, Err *err);

#endif
