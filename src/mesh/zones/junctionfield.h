/* The field of a junction junction, and the part of it that matters in a ball: the largest, over
 * the junction's nodes, of the sum of the terms of the node's group. */
#ifndef CORCAST_MESH_ZONES_JUNCTIONFIELD_H
#define CORCAST_MESH_ZONES_JUNCTIONFIELD_H

#include "base/base.h"
#include "scene/scene.h"
#include <stdint.h>

/* A term of the potential, prepared: lengths times k are in units of radius / sqrt2. Of a round
 * body a term is exp(-(k d)^2), d being the distance from the segment itself: at FIELD_LEVEL a
 * cylinder with balls at its ends. */
typedef struct PotentialTerm {
    Vec3 a, axis;    /* from a on; unit */
    double k;        /* sqrt2 / radius, 1/mm */
    double length_k; /* of the segment, times k */
    double radius_mm;
    uint32_t segment; /* of the tree */
    uint16_t stub;    /* of the junction, that the term is of, or NO_STUB */
    bool is_round;
} PotentialTerm;

#define NO_STUB UINT16_MAX

/* The term of a segment that is no stub. */
PotentialTerm potentialterm_make(Vec3 a, Vec3 b, double radius_mm, uint32_t segment,
                                 VesselBody body);
/* The term at x, in [0, 1]. */
double potentialterm_value(const PotentialTerm *term, Vec3 x);

/* Of the terms of one junction: groups[i] lists the numbers of those that blend at its i-th node;
 * of a round body none blend, and each is a group. */
typedef struct JunctionField {
    PotentialTerm *terms;
    uint32_t n_terms;
    uint32_t *first, *members; /* of group g: members[first[g] .. first[g + 1]) */
    uint32_t n_groups;
} JunctionField;

/* Terms and groups that matter in a ball; places in a LocalFieldPool. A group is a set of the
 * part's terms, `words` words of bits. Of few groups none is a subset of another. */
typedef struct LocalField {
    uint32_t first_term, n_terms, first_group, n_groups, words;
} LocalField;

/* A term of a part that is being narrowed. */
typedef struct TermBounds {
    size_t place; /* in the wider part */
    double upper, lower;
} TermBounds;

typedef struct LocalFieldPool {
    uint32_t *terms;
    uint64_t *groups;
    TermBounds *work;
    size_t work_capacity;
    size_t n_terms, n_groups, term_capacity, group_capacity;
} LocalFieldPool;

void localfieldpool_release(LocalFieldPool *pool);

/* Of a part whose field is asked for. */
enum { MAX_LOCAL_TERMS = 2048 };

/* STATUS_INFEASIBLE, saying that a part has more. */
Status localfield_refuse(Err *err);

/* All terms and groups of a field, put into the pool. */
MUST_CHECK Status localfield_all(const JunctionField *field, LocalFieldPool *pool, LocalField *out,
                                 Err *err);
/* A copy of a part of `from` in `to`. */
MUST_CHECK Status localfield_copy(const LocalFieldPool *from, const LocalField *part,
                                  LocalFieldPool *to, LocalField *out, Err *err);

/* What bounds the field in a ball. */
typedef struct FieldBounds {
    double lower, upper;     /* of the field */
    double all;              /* of the sum of all terms, from above */
    double largest;          /* of the largest term, from above */
    uint32_t largest_term;   /* number of that term in the field */
    double thinnest, widest; /* radii of terms that may exceed a tenth of the level, mm */
    bool parted;             /* two such terms do not blend: no group holds both */
    double crease; /* of a round body: how much the normals of walls that may pass differ at most */
} FieldBounds;

/* The part of `part` that matters in the ball: terms that may exceed 10^-5 there; and what bounds
 * them in the smaller ball of `inner_mm` about the same centre. Put on top of the same pool. */
MUST_CHECK Status localfield_narrow(const JunctionField *field, LocalFieldPool *pool,
                                    const LocalField *part, Vec3 center, double radius_mm,
                                    double inner_mm, LocalField *out, FieldBounds *bounds,
                                    Err *err);

/* The field at a place. */
typedef struct FieldValue {
    double phi;
    uint32_t group;   /* where the sum is largest, of the part */
    uint32_t largest; /* number in the field of that group's largest term */
} FieldValue;

FieldValue localfield_value(const JunctionField *field, const LocalFieldPool *pool,
                            const LocalField *part, Vec3 x);
/* Likewise, and the gradient of the group's sum, 1/mm. */
FieldValue localfield_gradient(const JunctionField *field, const LocalFieldPool *pool,
                               const LocalField *part, Vec3 x, Vec3 *gradient);

/* sqrt(-2 ln phi) - 2, which is linear in the distance to a lone vessel's wall: (d - r) / s, below
 * 0 inside. phi is clamped to [1e-12, 0.9]. */
double field_height(double phi);

#endif
