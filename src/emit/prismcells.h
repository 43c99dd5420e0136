/* Enumerates the cells of a mesh, with or without prism layers, in the same order for all formats.
 * A writer iterates over the slots 0 to prismcell_slots - 1; each slot has a cell or is empty.
 * Private to the module emit. */
#ifndef CORCAST_EMIT_PRISMCELLS_H
#define CORCAST_EMIT_PRISMCELLS_H

#include "emit/emit.h"

/* The kinds of cells. */
typedef enum PrismCellKind {
    CELL_SURFACE, /* a triangle of the wall, or of the part of a flat end that the core meets */
    CELL_PRISM,   /* three outer corners, then three inner corners */
    CELL_RING,    /* a quadrangle of a flat end, at the side of a prism */
    CELL_INNER    /* a triangle of the surface between the layers and the core */
} PrismCellKind;

/* A cell. Faces are counterclockwise seen from outside the vessels. */
typedef struct PrismCell {
    PrismCellKind kind;
    int n_corners;
    uint32_t corners[6]; /* indices in PrismLayers.points; without layers, in VesselMesh.points */
    size_t triangle;     /* index of the triangle of the mesh that the cell belongs to */
    size_t layer;        /* layer of a prism or quadrangle, counted from 1 at the wall; else 0 */
} PrismCell;

/* Returns true if the file has layers. Otherwise its cells are the triangles of the mesh. */
static inline bool prismcell_has_layers(const EmitParams *params)
{
    return params->layers && params->layers->n_layers > 0;
}
/* Returns the number of slots, including empty slots. */
size_t prismcell_slots(const EmitParams *params);
/* Returns the number of cells. */
size_t prismcell_count(const EmitParams *params);
/* Finds the cell in a slot. Returns false if the slot is empty. */
bool prismcell_at(const EmitParams *params, size_t slot, PrismCell *cell);

#endif
