/* Evaluates the blob model. The field of a vessel is a sum of POV-Ray blob components: two tubes of
 * different widths, spheres that take away half of a tube's round ends, and pairs of small spheres
 * (beads) before and behind each end [blob.h]. No component needs an exponential. Segments must
 * have a length.
 *
 * The numbers of blob_shape minimise the maximum of two errors, in the position of the surface and
 * in its normal, over 30 bifurcations and a free end. docs/METHODS.md section 2.6 derives what is
 * fitted; tests/fit/fit_blob.c finds the numbers. In the fitted cases the blob's surface is at most
 * 0.028 radii from the surface of the potential [field.h]. */
#include "field/blob.h"

#include <math.h>

const BlobShape blob_shape = BLOB_SHAPE;

/* Returns (1 - d^2 / R^2)^2 from d^2 and R^2, or 0 for d > R. */
static double profile(double distance2, double radius2)
{
    double inside = 1 - distance2 / radius2;
    return inside > 0 ? inside * inside : 0;
}

double blob_first_strength(const BlobShape *shape)
{
    double others = 0;
    for (int i = 1; i < BLOB_TUBES; i++)
        others +=
            shape->tube[i].strength * profile(1, shape->tube[i].radius * shape->tube[i].radius);
    return (1 - others) / profile(1, shape->tube[0].radius * shape->tube[0].radius);
}

double blob_reach(const BlobShape *shape)
{
    double reach = 0;
    for (int i = 0; i < BLOB_TUBES; i++)
        reach = fmax(reach, shape->tube[i].radius);
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        reach = fmax(reach, shape->bead[i].radius + fabs(shape->bead[i].offset));
    return reach;
}

Ball blob_ball(const FieldSegment *segment)
{
    Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
    double reach = blob_reach(&blob_shape) * segment->radius_mm;
    /* The factor is far above the rounding errors of the center and the radius. */
    return (Ball){middle, 1.000001 * (vec3_distance(middle, segment->a) + reach)};
}

void blob_components(const BlobShape *shape, const FieldSegment *segment,
                     BlobComponent components[BLOB_COMPONENTS])
{
    double r = segment->radius_mm;
    const Vec3 end[2] = {segment->a, segment->b};
    Vec3 span = vec3_sub(segment->b, segment->a);
    Vec3 along = vec3_scale(span, r / vec3_length(span));
    int n = 0;
    for (int i = 0; i < BLOB_TUBES; i++)
        components[n++] =
            (BlobComponent){end[0], end[1], shape->tube[i].radius * r, shape->tube[i].strength};
    /* Two tubes in a row overlap by a sphere at their common end. Each takes half of it away. */
    for (int i = 0; i < BLOB_TUBES; i++)
        for (int e = 0; e < 2; e++)
            components[n++] = (BlobComponent){end[e], end[e], shape->tube[i].radius * r,
                                              shape->tube[i].strength * -0.5};
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++) {
        const BlobBead *bead = &shape->bead[i];
        for (int e = 0; e < 2; e++)
            for (int side = 1; side >= -1; side -= 2) { /* 1: inside the segment; -1: beyond */
                Vec3 center = vec3_add_scaled(end[e], along, (e ? -side : side) * bead->offset);
                components[n++] =
                    (BlobComponent){center, center, bead->radius * r, side * bead->strength};
            }
    }
}

/* Returns the vector to x from the nearest point of the component's axis. */
static Vec3 from_axis(const BlobComponent *component, bool tube, Vec3 x)
{
    Vec3 from_a = vec3_sub(x, component->a);
    if (!tube)
        return from_a;
    Vec3 span = vec3_sub(component->b, component->a);
    double along = vec3_dot(from_a, span) / vec3_dot(span, span);
    return along >= 1 ? vec3_sub(x, component->b) : vec3_add_scaled(from_a, span, -fmax(along, 0));
}

double blob_components_at(const BlobComponent components[BLOB_COMPONENTS], Vec3 x, Vec3 *gradient)
{
    double sum = 0;
    *gradient = vec3(0, 0, 0);
    for (int i = 0; i < BLOB_COMPONENTS; i++) {
        const BlobComponent *component = &components[i];
        Vec3 from = from_axis(component, blob_component_is_tube(i), x);
        double radius2 = component->radius_mm * component->radius_mm;
        double inside = 1 - vec3_dot(from, from) / radius2;
        if (!(inside > 0))
            continue;
        sum += component->strength * inside * inside;
        *gradient = vec3_add_scaled(*gradient, from, -4 * component->strength * inside / radius2);
    }
    return sum;
}

double blob_segment_value(const FieldSegment *segment, Vec3 x)
{
    BlobComponent components[BLOB_COMPONENTS];
    Vec3 gradient;
    blob_components(&blob_shape, segment, components);
    return blob_components_at(components, x, &gradient);
}
