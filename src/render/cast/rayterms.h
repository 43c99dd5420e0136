/* The terms of the potential along one ray, and the groups in which their stretches overlap;
 * fieldcast.c says why. */
#ifndef CORCAST_RENDER_RAYTERMS_H
#define CORCAST_RENDER_RAYTERMS_H

#include "base/base.h"
#include "field/field.h"
#include "render/cast/raysearch.h"

/* How the ray passes a tube: the term at t_mid + x is radial exp(-w^2) (erf(u) + erf(h - u)) / 2,
 * w = w0 + w1 x, u = u0 + u1 x. */
typedef struct RayTerm {
    double t0, t1;           /* the term may exceed the cut-off in between */
    double window0, window1; /* it may be what the group needs in between; empty when reversed */
    double t_mid;
    double w0, w1, u0, u1, h;
    double e2, radial; /* e^2, exp(-e^2) */
    double peak, log_peak;
    double convex, concave; /* bounds of the second derivative and of its negative, 1/mm^2 */
    uint32_t segment;
} RayTerm;

/* The workspace of one thread: room for the segments of one ray, of which only the part that
 * rays need is ever touched. Nothing is allocated later. */
typedef struct FieldScratch {
    RayTerm *terms;
    Heap heap;       /* indices of the terms that are in no group yet, by t0, then segment */
    RayTerm **group; /* by t0 */
    size_t n_terms, n_group;
    uint32_t *near;      /* segments of the terms */
    LocalGroups *groups; /* of the terms; NULL where all segments blend */
} FieldScratch;

/* The workspace functions of field_search. */
MUST_CHECK Status fieldscratch_new(const Geometry *geometry, size_t n, void **out, Err *err);
void fieldscratch_free(void *workspace);

/* Empties the scratch. Follow with rayterms_add for every segment that may matter. */
void rayterms_clear(FieldScratch *scratch);
/* Adds the term of a tube if the ray passes it near enough. part->t_max must be finite. */
void rayterms_add(FieldScratch *scratch, const FieldTube *tube, const RayPart *part);
/* Empties the scratch and adds the terms of all tubes of the index. part->t_max must be finite. */
void rayterms_find(const FieldIndex *index, FieldScratch *scratch, const RayPart *part);

/* Chooses the terms that groups are made of: all, or the `n` numbered. */
void rayterms_choose_all(FieldScratch *scratch);
void rayterms_choose(FieldScratch *scratch, const uint32_t *numbers, size_t n);

/* Makes the next run of terms whose stretches overlap the group. False when none is left. */
bool rayterms_next_group(FieldScratch *scratch);

/* Sets the windows of the group, outside which its potential is below the level, and, when there is
 * any, `radial` and the bounds of the curvature. False when there is none. */
bool rayterms_find_windows(FieldScratch *scratch);

#endif
