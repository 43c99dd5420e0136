/* Ports: channels from the ends of vessels to the faces of the block around them.
 *
 * The surface of a port is a sequence of rings (circles of points) from the rim of a vessel end to
 * a face, and triangles between the rings. A straight port continues the vessel's axis as a cone. A
 * bent port follows a curve and meets the face at a right angle, as a Luer fitting needs. First
 * ports_find chooses the paths, then ports_add adds the triangles to a solid. Private to the module
 * print. */
#ifndef CORCAST_PRINT_PORTS_H
#define CORCAST_PRINT_PORTS_H

#include "print/casing.h"
#include "print/print.h"

/* Maximum number of rings of a port, without the rim of the vessel. With fewer rings, bends are
 * coarser; reason of the value not recorded. */
enum { PORT_RINGS = 14 };

/* One ring of a port. */
typedef struct PortRing {
    Vec3 center;    /* mm */
    Vec3 direction; /* unit, perpendicular to the ring, out of the block */
    double radius_mm;
} PortRing;

/* One port. */
typedef struct Port {
    CutEnd *end; /* the vessel end at which the port begins; borrowed */
    int face;    /* the face to which the port leads [casing.h] */
    int n_rings;
    Box box;                        /* mm; contains the channel and its clearance from other
                                     * vessels */
    PortRing rings[PORT_RINGS];     /* from the vessel on; the last one is in the face */
    FieldSegment parts[PORT_RINGS]; /* per ring: the channel between the previous ring and this
                                     * ring, as a segment with a radius */
    bool is_straight;               /* true: the port is a cone with the single ring rings[0].
                                     * ports_add moves the ring's points along the cone into the
                                     * face, where they form an ellipse */
    uint32_t *points;               /* indices, in the solid's points, of the last ring; owned; set
                                     * by ports_add */
} Port;

typedef struct Ports {
    Port *items; /* owned */
    size_t n;
} Ports;

/* Chooses the path of a port for each end that PrintBlock.ports selects, and sets `opened` of these
 * ends. Ports keep a clearance of 0.4 times the smaller radius, which is NEAR_GAP, from all vessels
 * and from each other. An end for which no path is possible gets no port.
 *
 * ends     the flat ends of the vessels' mesh. Paths are chosen for inlets first, then for outlets.
 * out      receives the ports, which point into `ends`; release them with ports_release.
 * Errors   STATUS_MEMORY.
 * Cost     O(ends (log segments + ports)). */
MUST_CHECK Status ports_find(const VesselTree *tree, const CutEnds *ends, const Casing *casing,
                             const PrintBlock *block, Ports *out, Err *err);
void ports_release(Ports *ports);

/* Adds the surfaces of the ports to a solid. The solid must already contain the vessels' surface
 * turned inside out, with the rims of the ends stored in CutEnd.rim [solid_surface]. The channels
 * of the ports are cavities of the solid. Errors: STATUS_MEMORY. */
MUST_CHECK Status ports_add(const VesselTree *tree, Ports *ports, Solid *solid, Err *err);

#endif
