/* The potential field of a junction region, and its restriction to a ball.
 *
 * Each segment has one term of the potential. Each node of the region has a group of terms, those
 * that blend at the node. The field is the largest of the groups' sums; the surface is where the
 * field is FIELD_LEVEL. In a small ball only few terms matter. A LocalField lists them, so that the
 * field in the ball costs little. Local fields are stored in a LocalFieldPool, which an octree uses
 * as a stack while it descends: localfield_from_field for the root, localfield_narrow for a cell,
 * localfield_value and localfield_gradient at a point. Private to the module mesh. */
#ifndef CORCAST_MESH_REGIONS_JUNCTIONFIELD_H
#define CORCAST_MESH_REGIONS_JUNCTIONFIELD_H

#include "base/base.h"
#include "scene/scene.h"
#include <stdint.h>

/* One segment's term of the potential, with precomputed constants. In the following, lengths are
 * multiplied by k, which makes them multiples of radius / sqrt 2. The term of a BODY_POTENTIAL
 * segment is exp(-e^2) (erf u + erf v) / 2, where e is the distance from the axis line, and u and v
 * are the distances along the axis from the two ends, positive inwards. The term of a BODY_ROUND
 * segment is exp(-d^2), where d is the distance from the segment: its level set at FIELD_LEVEL is a
 * capsule of the segment's radius. */
typedef struct PotentialTerm {
    uint32_t segment; /* index of the segment in the tree; first, because sorted_find_row searches
                       * by the first member */
    uint16_t stub;    /* index of the branch stub in the region: of the part of a segment that ends
                       * at a plane, beyond which the segment is a tube [junctions.h]; or NO_STUB */
    bool is_round;    /* the tree's body is BODY_ROUND */
    Vec3 a, axis;     /* the segment's first end, and the unit direction from there */
    double k;         /* sqrt 2 / radius, 1/mm */
    double length_k;  /* length of the segment, times k */
    double radius_mm;
} PotentialTerm;

/* Value of PotentialTerm.stub if the segment is entirely in the region. */
#define NO_STUB UINT16_MAX

/* Returns the term of a segment from a to b, with `stub` set to NO_STUB. a and b must differ, and
 * radius_mm must be above 0. */
PotentialTerm potentialterm_make(Vec3 a, Vec3 b, double radius_mm, uint32_t segment,
                                 VesselBody body);
/* Returns the term's value at x, in [0, 1]. */
double potentialterm_value(const PotentialTerm *term, Vec3 x);

/* The terms of one junction region, and their groups. All arrays are owned. Group i holds the terms
 * that blend at the region's i-th node. BODY_ROUND terms do not blend: each is a group of its own.
 */
typedef struct JunctionField {
    PotentialTerm *terms;
    uint32_t n_terms;
    uint32_t *first;   /* per group, and one more: index of its first element of `members` */
    uint32_t *members; /* group g has the terms members[first[g] .. first[g + 1]) */
    uint32_t n_groups;
} JunctionField;

/* The terms and groups that are significant in a ball, as offsets into a LocalFieldPool. A
 * LocalField is valid until the pool is cut back below its first term or group. A group is a bit
 * set over the local terms, of `words` 64-bit words. */
typedef struct LocalField {
    uint32_t first_term, n_terms, first_group, n_groups, words;
} LocalField;

/* Bounds of one term, while a local field is narrowed. */
typedef struct TermBounds {
    size_t index; /* index of the term in the wider local field */
    double upper, lower;
} TermBounds;

/* The storage of local fields, used as a stack: to remove a field and all later ones, set n_terms
 * and n_groups to its first_term and first_group. Zero it before first use; release it with
 * localfieldpool_release. */
typedef struct LocalFieldPool {
    uint32_t *terms;  /* indices of terms in the JunctionField */
    uint64_t *groups; /* the words of all bit sets; n_groups and first_group count words */
    TermBounds *work; /* scratch of localfield_narrow */
    size_t work_capacity;
    size_t n_terms, n_groups, term_capacity, group_capacity;
} LocalFieldPool;

void localfieldpool_release(LocalFieldPool *pool);

/* Maximum number of terms of a local field that may be evaluated. Evaluation keeps one value per
 * term on the stack (16 kB), so callers must check n_terms first. */
enum { MAX_LOCAL_TERMS = 2048 };

/* Sets the error "more than MAX_LOCAL_TERMS segments" and returns STATUS_INFEASIBLE. */
Status localfield_too_many_terms(Err *err);

/* Appends all terms and groups of a field to the pool. Errors: STATUS_MEMORY. */
MUST_CHECK Status localfield_from_field(const JunctionField *field, LocalFieldPool *pool,
                                        LocalField *out, Err *err);
/* Appends a copy of a local field of the pool `from` to the pool `to`. Errors: STATUS_MEMORY. */
MUST_CHECK Status localfield_copy(const LocalFieldPool *from, const LocalField *local,
                                  LocalFieldPool *to, LocalField *out, Err *err);

/* Bounds on the field in a ball. */
typedef struct FieldBounds {
    double lower, upper;          /* of the field */
    double sum_upper;             /* upper bound of the sum of all terms */
    double largest_upper;         /* upper bound of the largest term */
    uint32_t largest_term;        /* index in the field of the term with that bound */
    double min_radius_mm;         /* smallest radius of the significant terms, which are those that
                                   * may exceed FIELD_LEVEL / 10: such a term moves the surface of
                                   * another vessel by up to 0.025 radii. HUGE_VAL: there is none */
    bool has_unblended_terms;     /* consider the significant terms in groups whose sum may be the
                                   * largest in the ball. true: no single group contains all of
                                   * them. Always false for BODY_ROUND */
    double max_normal_difference; /* BODY_ROUND: maximum of |n1 - n2| over the unit normals of
                                   * surfaces that may meet in the ball; else 0 */
} FieldBounds;

/* Two balls with the same centre. */
typedef struct FieldBalls {
    Vec3 center;
    double radius_mm, inner_radius_mm; /* radii of the larger and of the smaller ball */
} FieldBalls;

/* The part of a field that is significant in the larger ball, with bounds for the smaller ball. */
typedef struct NarrowField {
    LocalField local;
    FieldBounds bounds;
} NarrowField;

/* Finds the terms of `local` that may exceed 1e-5, or 7e-5 FIELD_LEVEL, in the larger ball, and
 * appends them, with their groups, to the pool. Leaves out groups that are subsets of other groups;
 * compares only the first 256, which bounds the time. Sets out->bounds for the smaller ball.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status localfield_narrow(const JunctionField *field, LocalFieldPool *pool,
                                    const LocalField *local, const FieldBalls *balls,
                                    NarrowField *out, Err *err);

/* The value of the field at a point. */
typedef struct FieldValue {
    double phi;            /* the field, dimensionless; FIELD_LEVEL on the surface, larger inside */
    uint32_t group;        /* index of the local group with the largest sum */
    uint32_t largest_term; /* index in the field of the largest term of that group; set by
                            * localfield_gradient; localfield_value sets 0 */
} FieldValue;

/* Returns the field at x. `local` must have at most MAX_LOCAL_TERMS terms, and x must be in its
 * ball. */
FieldValue localfield_value(const JunctionField *field, const LocalFieldPool *pool,
                            const LocalField *local, Vec3 x);
/* Returns the field at x, as localfield_value does. Sets *gradient to the gradient of the largest
 * group's sum, 1/mm. */
FieldValue localfield_gradient(const JunctionField *field, const LocalFieldPool *pool,
                               const LocalField *local, Vec3 x, Vec3 *gradient);

/* Returns the height sqrt(-2 ln phi) - 2, where phi is first clamped to [1e-12, 0.9], so that the
 * height is finite. It is 0 on the surface, where phi = FIELD_LEVEL = exp(-2), and below 0 inside.
 * For a vessel without neighbours it is linear in the distance d to the axis: (d - r) / (r / 2),
 * where r is the radius. */
double field_height(double phi);

#endif
