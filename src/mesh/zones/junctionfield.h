/* The field of a junction zone, and the part of it that matters in a ball: the largest, over the
 * zone's nodes, of the sum of the terms of the node's group. */
#ifndef CORCAST_MESH_ZONES_JUNCTIONFIELD_H
#define CORCAST_MESH_ZONES_JUNCTIONFIELD_H

#include "base/base.h"
#include "scene/scene.h"
#include <stdint.h>

/* A term of the potential, prepared: lengths times k are in units of radius / sqrt2. Of a round
 * body a term is exp(-(k d)^2), d being the distance from the segment itself: at FIELD_LEVEL a
 * cylinder with balls at its ends. */
typedef struct ZoneTerm {
    Vec3 a, axis;    /* from a on; unit */
    double k;        /* sqrt2 / radius, 1/mm */
    double length_k; /* of the segment, times k */
    double radius_mm;
    uint32_t segment; /* of the tree */
    uint16_t arm;     /* of the zone, that the term is of, or NO_ARM */
    bool is_round;
} ZoneTerm;

#define NO_ARM UINT16_MAX

/* The term of a segment that is no arm. */
ZoneTerm zoneterm_of(Vec3 a, Vec3 b, double radius_mm, uint32_t segment, VesselBody body);
/* The term at x, in [0, 1]. */
double zoneterm_value(const ZoneTerm *term, Vec3 x);

/* Of the terms of one zone: groups[i] lists the numbers of those that blend at its i-th node; of a
 * round body none blend, and each is a group. */
typedef struct ZoneField {
    ZoneTerm *terms;
    uint32_t n_terms;
    uint32_t *first, *members; /* of group g: members[first[g] .. first[g + 1]) */
    uint32_t n_groups;
} ZoneField;

/* Terms and groups that matter in a ball; places in a PartPool. A group is a set of the part's
 * terms, `words` words of bits. Of few groups none is a subset of another. */
typedef struct FieldPart {
    uint32_t first_term, n_terms, first_group, n_groups, words;
} FieldPart;

/* A term of a part that is being narrowed. */
typedef struct TermWork {
    size_t place; /* in the wider part */
    double upper, lower;
} TermWork;

typedef struct PartPool {
    uint32_t *terms;
    uint64_t *groups;
    TermWork *work;
    size_t work_capacity;
    size_t n_terms, n_groups, term_capacity, group_capacity;
} PartPool;

void partpool_release(PartPool *pool);

/* Of a part whose field is asked for. */
enum { MOST_PART_TERMS = 2048 };

/* STATUS_INFEASIBLE, saying that a part has more. */
Status zonefield_refuse(Err *err);

/* All terms and groups of a field, put into the pool. */
MUST_CHECK Status fieldpart_all(const ZoneField *field, PartPool *pool, FieldPart *out, Err *err);
/* A copy of a part of `from` in `to`. */
MUST_CHECK Status fieldpart_copy(const PartPool *from, const FieldPart *part, PartPool *to,
                                 FieldPart *out, Err *err);

/* What bounds the field in a ball. */
typedef struct PartBounds {
    double lower, upper;     /* of the field */
    double all;              /* of the sum of all terms, from above */
    double largest;          /* of the largest term, from above */
    uint32_t largest_term;   /* number of that term in the field */
    double thinnest, widest; /* radii of terms that may exceed a tenth of the level, mm */
    bool parted;             /* two such terms do not blend: no group holds both */
    double crease; /* of a round body: how much the normals of walls that may pass differ at most */
} PartBounds;

/* The part of `part` that matters in the ball: terms that may exceed 10^-5 there; and what bounds
 * them in the smaller ball of `inner_mm` about the same centre. Put on top of the same pool. */
MUST_CHECK Status fieldpart_narrow(const ZoneField *field, PartPool *pool, const FieldPart *part,
                                   Vec3 center, double radius_mm, double inner_mm, FieldPart *out,
                                   PartBounds *bounds, Err *err);

/* The field at a place. */
typedef struct FieldValue {
    double phi;
    uint32_t group;   /* where the sum is largest, of the part */
    uint32_t largest; /* number in the field of that group's largest term */
} FieldValue;

FieldValue fieldpart_value(const ZoneField *field, const PartPool *pool, const FieldPart *part,
                           Vec3 x);
/* Likewise, and the gradient of the group's sum, 1/mm. */
FieldValue fieldpart_gradient(const ZoneField *field, const PartPool *pool, const FieldPart *part,
                              Vec3 x, Vec3 *gradient);

/* sqrt(-2 ln phi) - 2, which is linear in the distance to a lone vessel's wall: (d - r) / s, below
 * 0 inside. phi is clamped to [1e-12, 0.9]. */
double field_height(double phi);

#endif
