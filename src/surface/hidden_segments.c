/* A term is largest half way along its segment, erf(k l / 2). Only segments for which that is below
 * the level, those shorter than 0.17 of their radius, can be hidden, and are unless their
 * neighbours make up for it; the index of segments finds those neighbours, and is built only when
 * there is such a segment. */
#include "surface/surface.h"

Status surface_count_hidden(const Geometry *geometry, size_t *count, Err *err)
{
    FieldIndex *index = NULL;
    size_t found = 0;
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        if (potential_term_peak(segment) >= FIELD_LEVEL)
            continue;
        if (!index)
            TRY(fieldindex_build(geometry, &index, err));
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        found += fieldindex_potential(index, middle) < FIELD_LEVEL;
    }
    fieldindex_free(index);
    *count = found;
    return STATUS_OK;
}
