/* A term is largest half way along its segment, erf(k l / 2). Only segments for which that is below
 * the level, those shorter than 0.17 of their radius, can be hidden, and are unless their
 * neighbours make up for it; the index of segments finds those neighbours, and is built only when
 * there is such a segment. */
#include "field/field.h"

/* The largest of the sums that the segment is part of. */
static double potential_of_groups(const Geometry *geometry, size_t segment, Vec3 x)
{
    const IndexLists *groups = &geometry->blend.groups, *members = &geometry->blend.members;
    double largest = 0;
    for (uint32_t i = groups->first[segment]; i < groups->first[segment + 1]; i++) {
        uint32_t group = groups->items[i];
        double sum = 0;
        for (uint32_t k = members->first[group]; k < members->first[group + 1]; k++)
            sum += potential_term(&geometry->segments[members->items[k]], x);
        largest = fmax(largest, sum);
    }
    return largest;
}

Status surface_count_hidden(const Geometry *geometry, size_t *count, Err *err)
{
    FieldIndex *index = NULL;
    size_t found = 0;
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        if (potential_term_peak(segment) >= FIELD_LEVEL)
            continue;
        bool all_blend = geometry->blend.n_groups == 0;
        if (!index && all_blend)
            TRY(fieldindex_build(geometry, &index, err));
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        double potential = all_blend ? fieldindex_potential(index, middle)
                                     : potential_of_groups(geometry, i, middle);
        found += potential < FIELD_LEVEL;
    }
    fieldindex_free(index);
    *count = found;
    return STATUS_OK;
}
