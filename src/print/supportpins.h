/* A base plate for printing, and the support pins between the plate and the vessels.
 *
 * A pin is added to the tree as one more vessel, so that it blends with the vessel that it
 * supports, and is cut flat at the plate. First supportpins_add extends the tree, then the extended
 * tree is meshed and added to a solid, then supportpins_join adds the plate. Private to the module
 * print. */
#ifndef CORCAST_PRINT_SUPPORTPINS_H
#define CORCAST_PRINT_SUPPORTPINS_H

#include "print/casing.h"
#include "print/print.h"
#include "print/seams.h"

/* A segment that was added to a tree for printing: a support pin, whose second end is on the base
 * plate, or a piece of a vessel that was split where a pin attaches. */
typedef struct AddedSegment {
    uint32_t owner; /* index of the original segment that it belongs to */
    bool is_pin;    /* false: a piece of a vessel */
} AddedSegment;

/* The added segments. Added segment i has the index n_original + i in the tree. */
typedef struct SupportPins {
    size_t n_original;         /* number of segments before any was added */
    ARRAY(AddedSegment) added; /* owned */
    size_t n_pins;
    size_t n_unsupported; /* number of nodes that need a pin, but where no pin is possible */
    double plate_top_mm;  /* z of the plate's upper face */
} SupportPins;

void supportpins_release(SupportPins *pins);

/* Adds a vertical pin below each node from which no segment leads downwards. Without a pin, the
 * printer would have to start printing this node in mid-air.
 *
 * If `open_ends` is true, the vessels are open at their ends; the pin of an end then attaches
 * beside the end. A node gets no pin in three cases: no place on the vessel beside its open end can
 * carry a pin; the gap between the pin and another vessel would be below 0.4 of the smaller radius,
 * as NEAR_GAP; or the pin could not be cut flat at the plate.
 *
 * tree     must own its arrays. Segments and nodes are added, possibly also before an error.
 * out      receives the pins; release it with supportpins_release.
 * Errors   STATUS_INPUT if the tree is too far from the origin, STATUS_MEMORY. If no pin is
 *          possible, the function succeeds and n_pins is 0.
 * Cost     O(pins * segments). */
MUST_CHECK Status supportpins_add(VesselTree *tree, const PrintBase *base, bool open_ends,
                                  const MeshParams *params, SupportPins *out, Err *err);

/* Returns the plate below the pins. The plate extends 2 mm beyond the vessels. The caller moves its
 * corners to points of the grid of the solid. */
Casing supportpins_base_plate(const VesselTree *tree, const PrintBase *base,
                              const SupportPins *pins);

/* Adds the plate to the solid and joins it to the pins. The pins must already be in the solid, with
 * the caps at their lower ends removed.
 *
 * plate    from supportpins_base_plate, rounded to the grid of the solid.
 * ends     the flat ends of the outer surface.
 * seams    is extended by the surface of the plate and one ring per pin.
 * Errors   STATUS_INFEASIBLE if two pins touch at the plate, STATUS_MEMORY. */
MUST_CHECK Status supportpins_join(Solid *solid, const Casing *plate, const CutEnds *ends,
                                   const SupportPins *pins, SeamGraph *seams, Err *err);

/* Returns the original segment that a segment of the extended tree belongs to. */
static inline uint32_t supportpins_original_segment(const SupportPins *pins, uint32_t segment)
{
    return segment < pins->n_original ? segment
                                      : pins->added.items[segment - pins->n_original].owner;
}

/* Returns true if a segment of the extended tree is a pin. */
static inline bool supportpins_is_pin(const SupportPins *pins, uint32_t segment)
{
    return segment >= pins->n_original && pins->added.items[segment - pins->n_original].is_pin;
}

#endif
