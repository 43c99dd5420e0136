/* The sky is cut into directions that are the same for all places. A place asks how much of a beam
 * is free that widens as its part of the sky does up to a width of some vessels, and is a line
 * where it begins. The parts of the beam that capsules leave free are multiplied.
 *
 * Why this: single rays err as random numbers do, by the root of their number (0.046 in a ball of
 * 20,000 segments by 256 directions of the sphere, 0.061 by 128), and leave bands where directions
 * are shared, grain where they are not. A beam is the mean of many rays: 0.034 by 128 directions,
 * and its edges are soft. OccluderSet that widen for ever err less in a ball, but each of them
 * touches many vessels, and a box about distant ones does not stand for them until it is narrower
 * than the beam. A beam never widens beyond its height above the surface, so that it cannot be
 * covered by what lies below the horizon.
 *
 * All models are seen as capsules about their segments. That of a cut cylinder begins where the
 * joint that leads to it does, and stands for both: with capsules of their own, joints would be
 * multiplied with what they overlap, and the error of a disc be 0.037 instead of 0.029. At
 * a flat end that is seen, as those of tips are, the capsule's round end stays within the cylinder:
 * beyond it, it would cover all places of the flat end, and the error of a dense ball be 0.052
 * instead of 0.031. */
#include "render/light/occluders.h"

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

static Vec3 load_point(float from[3][BEAM_BLOCK], size_t lane, Vec3 origin)
{
    return vec3_add(origin,
                    vec3((double)from[0][lane], (double)from[1][lane], (double)from[2][lane]));
}

/* The capsules of a geometry while they are listed. */
typedef struct Listing {
    OccluderSet *beams;
    size_t n;
    double radii;   /* their sum */
    uint32_t *last; /* owned; of each segment that has a cylinder, the number behind its capsule */
} Listing;

static void add_capsule(Listing *listing, Vec3 a, Vec3 b, double radius)
{
    size_t lane = listing->n % BEAM_BLOCK;
    CapsuleBlock *block = &listing->beams->capsules[listing->n++ / BEAM_BLOCK];
    store_point(block->a, lane, a, listing->beams->origin);
    store_point(block->b, lane, b, listing->beams->origin);
    block->radius[lane] = (float)radius;
    listing->radii += radius;
}

/* Lets the capsule of the joint's segment begin where the joint does. */
static void stretch_capsule(const Listing *listing, const Primitive *joint)
{
    size_t number = listing->last[joint->segment] - 1, lane = number % BEAM_BLOCK;
    Vec3 origin = listing->beams->origin;
    CapsuleBlock *block = &listing->beams->capsules[number / BEAM_BLOCK];
    bool begins_at_a = vec3_distance(joint->b, load_point(block->a, lane, origin)) <
                       vec3_distance(joint->b, load_point(block->b, lane, origin));
    store_point(begins_at_a ? block->a : block->b, lane, joint->a, origin);
}

/* An end of a segment, moved towards its other end, at most to the middle. */
static Vec3 drawn_back(Vec3 end, Vec3 other, double by)
{
    double length = vec3_distance(end, other);
    return vec3_add_scaled(end, vec3_sub(other, end), fmin(by / length, 0.5));
}

/* The capsule's round ends stay within flat ones that are seen. */
static void add_cylinder(Listing *listing, const Primitive *one)
{
    Vec3 a = one->free_a ? drawn_back(one->a, one->b, one->radius_mm) : one->a;
    Vec3 b = one->free_b ? drawn_back(one->b, one->a, one->radius_mm) : one->b;
    add_capsule(listing, a, b, one->radius_mm);
    listing->last[one->segment] = (uint32_t)listing->n;
}

static void list_primitives(Listing *listing, const Geometry *geometry)
{
    size_t n = geometry->n_primitives - geometry->n_ends;
    for (size_t i = 0; i < n; i++) {
        const Primitive *one = &geometry->primitives[i];
        if (one->kind == PRIMITIVE_CYLINDER)
            add_cylinder(listing, one);
        else if (one->kind == PRIMITIVE_SPHERE)
            add_capsule(listing, one->a, one->a, one->radius_mm);
    }
    for (size_t i = 0; i < n; i++) {
        const Primitive *one = &geometry->primitives[i];
        if (one->kind == PRIMITIVE_JOINT && listing->last[one->segment] > 0)
            stretch_capsule(listing, one);
        else if (one->kind == PRIMITIVE_JOINT)
            add_capsule(listing, one->a, one->b, (one->radius_mm + one->radius_b_mm) / 2);
    }
}

/* What all numbers of segments of primitives are below. */
static size_t end_of_segments(const Geometry *geometry)
{
    size_t end = 0;
    for (size_t i = 0; i < geometry->n_primitives; i++)
        if (geometry->primitives[i].segment >= end)
            end = (size_t)geometry->primitives[i].segment + 1;
    return end;
}

Status occluderset_new(const Geometry *geometry, OccluderSet *beams, Err *err)
{
    size_t most = geometry->n_primitives - geometry->n_ends + geometry->n_segments;
    OccluderSet made = {.origin = box_center(geometry->bounds)};
    Listing listing = {.beams = &made};
    TRY(mem_calloc(&listing.last, end_of_segments(geometry), sizeof *listing.last, "occlusion",
                   err));
    Status status =
        mem_calloc(&made.capsules, most / BEAM_BLOCK + 1, sizeof *made.capsules, "occlusion", err);
    if (status == STATUS_OK) {
        list_primitives(&listing, geometry);
        for (size_t i = 0; i < geometry->n_segments; i++) {
            const FieldSegment *one = &geometry->segments[i];
            add_capsule(&listing, one->a, one->b, one->radius_mm);
        }
        made.wide = listing.n > 0 ? (float)(wide_in_radii * listing.radii / (double)listing.n) : 0;
        made.slack = (float)(1e-6 * vec3_distance(geometry->bounds.low, geometry->bounds.high));
        made.n_blocks = (listing.n + BEAM_BLOCK - 1) / BEAM_BLOCK;
        while (listing.n % BEAM_BLOCK)
            add_capsule(&listing, made.origin, made.origin, -1);
        *beams = made;
    }
    free(listing.last);
    return status;
}

void occluderset_release(OccluderSet *beams)
{
    free(beams->capsules);
    *beams = (OccluderSet){0};
}

/* Fibonacci's lattice of a hemisphere: rings of equal area, each a golden angle on from the last.
 */
Vec3 occlusion_direction(int n, int k)
{
    double z = 1 - (k + 0.5) / n, across = sqrt(1 - z * z);
    return vec3(across * elementary_cos(golden_turn * k), across * elementary_sin(golden_turn * k),
                z);
}
