/* Enumerates the cells of a mesh, with or without prism layers, in the same order for all formats.
 * A writer iterates over the slots 0 to prismcell_slots - 1; prismcell_at returns the cell of a
 * slot. The cells are the outer surface, the prisms of the layers, and the surface between the
 * layers and the core. The core has no cells: a volume mesher fills it. Private to the module emit.
 */
#ifndef CORCAST_EMIT_PRISMCELLS_H
#define CORCAST_EMIT_PRISMCELLS_H

#include "emit/emit.h"

/* The kinds of cells. */
typedef enum PrismCellKind {
    CELL_SURFACE,  /* a triangle of the outer surface: of the wall, or of a flat end inside the
                    * innermost layer */
    CELL_PRISM,    /* three outer corners, then three inner corners */
    CELL_END_QUAD, /* a quadrangle of a flat end, at the side of a prism */
    CELL_CORE      /* a triangle of the surface between the layers and the core */
} PrismCellKind;

/* A cell. Faces are counterclockwise seen from outside the vessels. */
typedef struct PrismCell {
    PrismCellKind kind;
    int n_corners;
    uint32_t corners[6]; /* indices in PrismLayers.points; without layers, in VesselMesh.points */
    size_t triangle;     /* index in the mesh of the triangle that the cell belongs to; for
                          * CELL_END_QUAD, a triangle of the flat end */
    size_t layer;        /* layer of a prism or quadrangle, counted from 1 at the wall; else 0 */
} PrismCell;

/* Returns true if the file has layers. Otherwise its cells are the triangles of the mesh. */
static inline bool prismcell_has_layers(const EmitParams *params)
{
    return params->layers && params->layers->n_layers > 0;
}
/* Returns the number of slots: for each triangle, one for CELL_SURFACE, one per layer and, with
 * layers, one for CELL_CORE, which is empty if the triangle is part of a flat end. */
size_t prismcell_slots(const EmitParams *params);
/* Returns the number of cells. */
size_t prismcell_count(const EmitParams *params);
/* Finds the cell in a slot. Returns false if the slot is empty. */
bool prismcell_at(const EmitParams *params, size_t slot, PrismCell *cell);

#endif
