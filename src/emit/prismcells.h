/* The cells of a file with prism layers, in one order for all formats. Private to the module emit.
 */
#ifndef CORCAST_EMIT_PRISMCELLS_H
#define CORCAST_EMIT_PRISMCELLS_H

#include "emit/emit.h"

typedef enum PrismCellKind {
    CELL_SURFACE, /* a triangle of the wall, or of a flat end inside the layers */
    CELL_PRISM,   /* its outer corners, then its inner ones */
    CELL_RING,    /* a quadrangle of a flat end, at the side of a prism */
    CELL_INNER    /* a triangle between the layers and the core */
} PrismCellKind;

/* Faces are counterclockwise when viewed from outside the vessels. */
typedef struct PrismCell {
    PrismCellKind kind;
    int n_corners;
    uint32_t corners[6]; /* indices in PrismLayers.points */
    size_t triangle;     /* the triangle of the mesh that the cell comes from */
    size_t layer;        /* of a prism or a quadrangle: from 1, at the wall; else 0 */
} PrismCell;

/* Returns the number of places for cells; some places are empty. */
size_t prismcell_places(const EmitParams *params);
/* Returns the number of cells. */
size_t prismcell_count(const EmitParams *params);
/* Finds the cell at a place. Returns false if the place is empty. */
bool prismcell_at(const EmitParams *params, size_t place, PrismCell *cell);

#endif
