/* Finds vessels that share no node but whose surfaces are near each other (nearpairs_find), and has
 * the small geometry of segments: ends, axes, angles, distances and boxes. Here a vessel is a
 * capsule: all points within the radius of the segment's axis.
 * Exported by the public header of the module mesh. */
#ifndef CORCAST_MESH_REGIONS_NEARPAIRS_H
#define CORCAST_MESH_REGIONS_NEARPAIRS_H

#include "mesh/meshreport.h"
#include "mesh/proof/boxpairs.h"

/* Lists the pairs of segments that share no node and whose gap is below NEAR_GAP times the smaller
 * radius.
 *
 * threads  number of threads; 0: one per processor. The result does not depend on it.
 * pairs    receives the pairs, by ascending indices; free it with free().
 * n        receives the number of pairs.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status nearpairs_find(const VesselTree *tree, int threads, NearPair **pairs, size_t *n,
                                 Err *err);

/* Returns the length of a segment, mm. */
static inline double segment_length(const FieldSegment *segment)
{
    return vec3_distance(segment->a, segment->b);
}

/* Returns the unit vector from a segment's first end `a` to its second end `b`. */
static inline Vec3 segment_axis(const FieldSegment *segment)
{
    return vec3_normalized(vec3_sub(segment->b, segment->a));
}

/* Returns the position of the segment's end 0 or 1. */
static inline Vec3 segment_end(const FieldSegment *segment, int end)
{
    return end ? segment->b : segment->a;
}

/* Returns the unit vector along the axis from the segment's end 0 or 1 to its other end. */
static inline Vec3 segment_inward(const FieldSegment *segment, int end)
{
    return vec3_normalized(vec3_sub(segment_end(segment, !end), segment_end(segment, end)));
}

/* Returns the angle of the point x about a segment's axis, from the first vector of
 * vec3_perpendiculars, in radians from -pi to pi. */
static inline double segment_angle(const FieldSegment *segment, Vec3 x)
{
    Vec3 u, v, from = vec3_sub(x, segment->a);
    vec3_perpendiculars(segment_axis(segment), &u, &v);
    return elementary_atan2(vec3_dot(from, v), vec3_dot(from, u));
}

/* Returns the end of a segment, 0 or 1, that is nearer to the middle of another segment. */
static inline int segment_nearer_end(const FieldSegment *segment, const FieldSegment *other)
{
    Vec3 middle = vec3_scale(vec3_add(other->a, other->b), 0.5);
    return vec3_distance(segment->b, middle) < vec3_distance(segment->a, middle);
}

/* Returns the unit vector in the plane of u and v, at `angle` radians from u towards v. u and v
 * must be perpendicular unit vectors. */
static inline Vec3 direction_at(Vec3 u, Vec3 v, double angle)
{
    return vec3_add(vec3_scale(u, elementary_cos(angle)), vec3_scale(v, elementary_sin(angle)));
}

/* Returns the distance of the point x from the nearest point of a segment's axis, mm. */
double segment_distance_to(const FieldSegment *segment, Vec3 x);
/* Returns the distance between the axes of two segments, mm. */
double segments_distance(const FieldSegment *a, const FieldSegment *b);
/* Returns the gap between the surfaces of two vessels, mm. It is below 0 if they overlap. */
double segments_gap(const FieldSegment *a, const FieldSegment *b);

/* Returns the box about a segment's axis, padded on all sides by radius_mm. */
Box segment_box(const FieldSegment *segment, double radius_mm);
/* Returns the box of segment_box in single precision, rounded outwards. */
FloatBox segment_floatbox(const FieldSegment *segment, double radius_mm);

/* Returns the box about all vessels of a tree, with their radii, padded by `margin_mm`. */
Box vesseltree_box(const VesselTree *tree, double margin_mm);
/* Builds a bounding volume hierarchy over the boxes of all vessels. `tree` must have at least one
 * segment. Release *out with boxtree_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status segments_boxtree(const VesselTree *tree, BoxTree *out, Err *err);

#endif
