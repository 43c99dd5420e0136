/* The terms of the potential along one ray, and the groups in which their stretches overlap;
 * fieldcast.c says why. */
#ifndef CORCAST_RENDER_RAYTERMS_H
#define CORCAST_RENDER_RAYTERMS_H

#include "base/base.h"
#include "field/field.h"
#include "render/cast/raysearch.h"

/* The term of one tube along a ray: at t_mid + x it is radial exp(-w^2) (erf(u) + erf(h - u)) / 2
 * with w = w0 + w1 x and u = u0 + u1 x. */
typedef struct RayTerm {
    double t0, t1;           /* the term may exceed the cut-off only in [t0, t1] */
    double window0, window1; /* in a hit of its group, the term may be the largest only in here;
                              * window0 > window1: nowhere */
    double t_mid;
    double w0, w1, u0, u1, h;
    double e2, radial; /* e^2, exp(-e^2) */
    double peak, log_peak;
    double convex, concave; /* bounds of the second derivative and of its negative, 1/mm^2 */
    uint32_t segment;       /* index of the segment */
} RayTerm;

/* The workspace of one thread. All arrays are owned, and have room for all segments that a ray may
 * pass. */
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

/* Chooses the terms that groups are made of: all terms, or the `n` terms whose indices are listed.
 */
void rayterms_choose_all(FieldScratch *scratch);
void rayterms_choose(FieldScratch *scratch, const uint32_t *numbers, size_t n);

/* Sets scratch->group to the next group along the ray: a maximal run of terms whose intervals
 * [t0, t1] overlap. Returns false if no term is left. */
bool rayterms_next_group(FieldScratch *scratch);

/* Sets the windows of the group's terms. Outside all windows the group's potential is below the
 * level. Also sets `radial` and the bounds of the curvature, unless all windows are empty: then
 * returns false. */
bool rayterms_find_windows(FieldScratch *scratch);

#endif
