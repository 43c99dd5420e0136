/* Reduces a geometry to the capsules that block ambient light, and makes the occlusion directions.
 *
 * All shading points use the same occlusion directions, which divide the sphere evenly. For each
 * direction, a point has a cone. The cone begins at the point with the width 0, and widens as its
 * part of the sphere does, up to the width of a few vessels. The ambient visibility of the cone is
 * the product of the fractions that the capsules leave unblocked.
 *
 * Why cones: the error of single rays falls with the root of their number (0.061 in a ball of
 * 20,000 segments with 128 directions of the sphere, 0.046 with 256). Rays leave bands if points
 * share directions, and noise if not. A cone is the mean of many rays: its error is 0.034 with 128
 * directions, and its shadows have soft edges. Cones that widen without a limit have a smaller
 * error in a ball, but each of them touches many vessels. A cone never widens beyond its height
 * above the surface, so that nothing below the horizon can block it.
 *
 * Vessels of all models count as capsules about their segments. The capsule of a cut cylinder
 * begins where the joint that leads to it begins, and stands for both. If joints had capsules of
 * their own, they would be multiplied with what they overlap, and the error of a disc would be
 * 0.037 instead of 0.029. At a flat end that is visible, such as a tip, the capsule's round end
 * stays within the cylinder. Otherwise it would block all points of the flat end, and the error of
 * a dense ball would be 0.052 instead of 0.031. */
#include "render/light/occlusion.h"

#include <math.h>
#include <stdlib.h>

/* Largest half width of a cone, in units of the mean radius of the vessels. Wider cones err less in
 * dense trees and more in sparse ones; the value is a compromise. */
static const double max_half_width_in_radii = 3.5;
static const double golden_turn = 2.399963229728653; /* the golden angle, radians */

static void store_point(float to[3][OCCLUDER_BLOCK], size_t lane, Vec3 point, Vec3 origin)
{
    to[0][lane] = (float)(point.x - origin.x);
    to[1][lane] = (float)(point.y - origin.y);
    to[2][lane] = (float)(point.z - origin.z);
}

static Vec3 load_point(float from[3][OCCLUDER_BLOCK], size_t lane, Vec3 origin)
{
    return vec3_add(origin,
                    vec3((double)from[0][lane], (double)from[1][lane], (double)from[2][lane]));
}

/* The list of capsules of a geometry while it is made. */
typedef struct Listing {
    OccluderSet *occluders;
    size_t n;
    double radii; /* sum of the radii */
    uint32_t
        *last; /* per segment: the index of its cylinder's capsule plus 1; 0: it has none. Owned. */
} Listing;

static void add_capsule(Listing *listing, Vec3 a, Vec3 b, double radius)
{
    size_t lane = listing->n % OCCLUDER_BLOCK;
    CapsuleBlock *block = &listing->occluders->capsules[listing->n++ / OCCLUDER_BLOCK];
    store_point(block->a, lane, a, listing->occluders->origin);
    store_point(block->b, lane, b, listing->occluders->origin);
    block->radius[lane] = (float)radius;
    listing->radii += radius;
}

/* Moves the end of a segment's capsule to the beginning of the joint that leads to it. */
static void stretch_capsule(const Listing *listing, const Primitive *joint)
{
    size_t number = listing->last[joint->segment] - 1, lane = number % OCCLUDER_BLOCK;
    Vec3 origin = listing->occluders->origin;
    CapsuleBlock *block = &listing->occluders->capsules[number / OCCLUDER_BLOCK];
    bool begins_at_a = vec3_distance(joint->b, load_point(block->a, lane, origin)) <
                       vec3_distance(joint->b, load_point(block->b, lane, origin));
    store_point(begins_at_a ? block->a : block->b, lane, joint->a, origin);
}

/* Returns an end of a segment, moved towards the other end, at most to the middle. */
static Vec3 drawn_back(Vec3 end, Vec3 other, double by)
{
    double length = vec3_distance(end, other);
    return vec3_add_scaled(end, vec3_sub(other, end), fmin(by / length, 0.5));
}

/* Keeps the capsule's round ends within flat ends that are visible. */
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

/* Returns the largest segment number of all primitives, plus 1. */
static size_t end_of_segments(const Geometry *geometry)
{
    size_t end = 0;
    for (size_t i = 0; i < geometry->n_primitives; i++)
        if (geometry->primitives[i].segment >= end)
            end = (size_t)geometry->primitives[i].segment + 1;
    return end;
}

Status occluderset_new(const Geometry *geometry, OccluderSet *occluders, Err *err)
{
    size_t most = geometry->n_primitives - geometry->n_ends + geometry->n_segments;
    OccluderSet made = {.origin = box_center(geometry->bounds)};
    Listing listing = {.occluders = &made};
    TRY(mem_calloc(&listing.last, end_of_segments(geometry), sizeof *listing.last, "occlusion",
                   err));
    Status status = mem_calloc(&made.capsules, most / OCCLUDER_BLOCK + 1, sizeof *made.capsules,
                               "occlusion", err);
    if (status == STATUS_OK) {
        list_primitives(&listing, geometry);
        for (size_t i = 0; i < geometry->n_segments; i++) {
            const FieldSegment *one = &geometry->segments[i];
            add_capsule(&listing, one->a, one->b, one->radius_mm);
        }
        made.max_half_width =
            listing.n > 0 ? (float)(max_half_width_in_radii * listing.radii / (double)listing.n)
                          : 0;
        made.slack = (float)(1e-6 * vec3_distance(geometry->bounds.low, geometry->bounds.high));
        made.n_blocks = (listing.n + OCCLUDER_BLOCK - 1) / OCCLUDER_BLOCK;
        while (listing.n % OCCLUDER_BLOCK)
            add_capsule(&listing, made.origin, made.origin, -1);
        *occluders = made;
    }
    free(listing.last);
    return status;
}

void occluderset_release(OccluderSet *occluders)
{
    free(occluders->capsules);
    *occluders = (OccluderSet){0};
}

/* The directions are a Fibonacci lattice of the hemisphere: point k lies in ring k of n rings of
 * equal area, turned by k golden angles. */
Vec3 occlusion_direction(int n, int k)
{
    double z = 1 - (k + 0.5) / n, across = sqrt(1 - z * z);
    return vec3(across * elementary_cos(golden_turn * k), across * elementary_sin(golden_turn * k),
                z);
}
