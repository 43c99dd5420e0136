/* A plate that vessels stand on, and pins between them. */
#ifndef CORCAST_PRINT_SUPPORTPINS_H
#define CORCAST_PRINT_SUPPORTPINS_H

#include "print/casing.h"
#include "print/print.h"
#include "print/seams.h"

/* Segments that are added to a tree: pins, whose second ends lie on the plate, and pieces that
 * vessels are cut into where a pin begins. */
typedef struct Pins {
    size_t n_segments; /* that the tree had before */
    uint32_t *owner;   /* of each that is added: one that the tree had; owned, as all of it */
    bool *is_pin;
    size_t n_added, n_pins;
    size_t n_hanging; /* places that need a pin and have no room for it */
    double top_mm;    /* of the plate */
} Pins;

void pins_release(Pins *pins);

/* Adds pins to a tree whose arrays are its own, from each node that has nothing below it: a printer
 * would begin it in the air; but for pins that cannot be cut off flat. Where vessels are open at
 * their ends, a pin begins beside the end. O(pins segments). */
MUST_CHECK Status pins_add(VesselTree *tree, const PrintBase *base, bool open_ends,
                           const MeshParams *params, Pins *out, Err *err);

/* The plate below the pins. */
Casing pins_plate(const VesselTree *tree, const PrintBase *base, const Pins *pins);

/* Joins the plate to the pins, whose ends are opened and in the solid. */
MUST_CHECK Status pins_join(Solid *solid, const Casing *plate, const CutEnds *ends,
                            const Pins *pins, Seams *seams, Err *err);

/* The segment of the tree as it was that a segment stands for. */
static inline uint32_t pins_owner(const Pins *pins, uint32_t segment)
{
    return segment < pins->n_segments ? segment : pins->owner[segment - pins->n_segments];
}

#endif
