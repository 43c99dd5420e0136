/* Segments in the camera's frame, and as the terms of a tile. */
#ifndef CORCAST_RENDER_FIELDTERMS_H
#define CORCAST_RENDER_FIELDTERMS_H

#include "render/tile/interval.h"
#include "render/tile/tile.h"

typedef struct FrameSegment {
    Vec3 a, b, axis;
    double length, k;
    double sine, per_sine;   /* orthographic: of the angle between axis and rays; 0 when parallel */
    double reach;            /* mm from the axis, beyond which the term is below the cut-off */
    int first_row, last_row; /* of tiles; first > last: nowhere */
} FrameSegment;

/* Sets the terms of a tile, one for each of the n segments listed that is within reach of its rays,
 * and the list of those segments; there is room for n. */
void fieldterms_make(const FrameSegment *segments, const uint32_t *list, size_t n, FieldTile *tile,
                     TileTerm *terms, uint32_t *kept);

#endif
