/* The sky is cut into directions that are the same for all places. A place asks how much of a beam
 * is free that widens as its part of the sky does up to a width of some vessels, and is a line
 * where it begins. The parts of the beam that capsules leave free are multiplied.
 *
 * Why this: single rays err as random numbers do, by the root of their number (0.046 in a ball of
 * 20,000 segments by 256 directions of the sphere, 0.061 by 128), and leave bands where directions
 * are shared, grain where they are not. A beam is the mean of many rays: 0.034 by 128 directions,
 * and its edges are soft. Beams that widen for ever err less in a ball, but each of them touches
 * many vessels, and a box about distant ones does not stand for them until it is narrower than the
 * beam. A beam never widens beyond its height above the surface, so that it cannot be covered by
 * what lies below the horizon.
 *
 * All models are seen as capsules about their segments: against the rays of the model itself the
 * error is the same for rounded, joined and isosurface to 0.001. */
#include "render/sky/beams.h"

#include <math.h>
#include <stdlib.h>

/* Of the mean radius; wider beams err less in dense trees and more in thin ones. */
static const double wide_in_radii = 3.5;
static const double golden_turn = 2.399963229728653;

static void store_point(float to[3][BEAM_BLOCK], size_t lane, Vec3 point, Vec3 origin)
{
    to[0][lane] = (float)(point.x - origin.x);
    to[1][lane] = (float)(point.y - origin.y);
    to[2][lane] = (float)(point.z - origin.z);
}

/* Puts a capsule behind the n that there are. */
static void add_capsule(Beams *beams, size_t n, Vec3 a, Vec3 b, double radius)
{
    CapsuleBlock *block = &beams->capsules[n / BEAM_BLOCK];
    store_point(block->a, n % BEAM_BLOCK, a, beams->origin);
    store_point(block->b, n % BEAM_BLOCK, b, beams->origin);
    block->radius[n % BEAM_BLOCK] = (float)radius;
}

Status beams_new(const Geometry *geometry, Beams *beams, Err *err)
{
    size_t primitives = geometry->n_primitives - geometry->n_ends, n = 0;
    Beams made = {.n_blocks = (primitives + geometry->n_segments + BEAM_BLOCK - 1) / BEAM_BLOCK,
                  .origin = box_center(geometry->bounds)};
    double sum = 0;
    TRY(mem_calloc(&made.capsules, made.n_blocks, sizeof *made.capsules, "occlusion", err));
    for (size_t i = 0; i < primitives; i++) {
        const Primitive *one = &geometry->primitives[i];
        double radius = (one->radius_mm + primitive_radius_b(one)) / 2;
        add_capsule(&made, n++, one->a, one->kind == PRIMITIVE_SPHERE ? one->a : one->b, radius);
        sum += radius;
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *one = &geometry->segments[i];
        add_capsule(&made, n++, one->a, one->b, one->radius_mm);
        sum += one->radius_mm;
    }
    made.wide = n > 0 ? (float)(wide_in_radii * sum / (double)n) : 0;
    made.slack = (float)(1e-6 * vec3_distance(geometry->bounds.low, geometry->bounds.high));
    for (; n % BEAM_BLOCK; n++)
        add_capsule(&made, n, made.origin, made.origin, -1);
    *beams = made;
    return STATUS_OK;
}

void beams_release(Beams *beams)
{
    free(beams->capsules);
    *beams = (Beams){0};
}

/* Fibonacci's lattice: rings of equal area, each a golden angle on from the last. */
Vec3 beams_direction(int n, int k)
{
    double z = 1 - (2 * k + 1.0) / n, across = sqrt(1 - z * z);
    return vec3(across * cos(golden_turn * k), across * sin(golden_turn * k), z);
}
