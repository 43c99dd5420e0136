/* The terms of the potential along one ray, and the groups of terms whose intervals overlap.
 * fieldcast.c explains the method. A search collects the terms near the ray, takes one group after
 * another along the ray, and looks for the level within the windows of the group's terms:
 *
 *     rayterms_find(field, scratch, &part);
 *     rayterms_choose(scratch, NULL, scratch->n_terms);
 *     while (rayterms_next_group(scratch))
 *         if (rayterms_find_windows(scratch))
 *             ... */
#ifndef CORCAST_RENDER_CAST_RAYTERMS_H
#define CORCAST_RENDER_CAST_RAYTERMS_H

#include "base/base.h"
#include "field/field.h"
#include "render/cast/raysearch.h"

/* The term of one tube along a ray. At t = t_mid + x it has the value radial exp(-w^2) (erf(u) +
 * erf(h - u)) / 2, with w = w0 + w1 x and u = u0 + u1 x. */
typedef struct RayTerm {
    double t0, t1;           /* the term may exceed the cut-off only in [t0, t1] */
    double window0, window1; /* the term can be the largest of its group at a hit only in this
                              * interval of t; window0 > window1: nowhere */
    double t_mid;
    double w0, w1, u0, u1, h;
    double e2, radial; /* e^2, exp(-e^2) */
    double peak, log_peak;
    double convex, concave; /* bounds of the second derivative and of its negative, 1/mm^2 */
    uint32_t segment;       /* index of the segment */
} RayTerm;

/* The workspace of one thread. All arrays are owned. Their capacity is the number of segments that
 * a ray can pass. */
typedef struct FieldScratch {
    RayTerm *terms;
    Heap heap;       /* heap of the indices of terms that are in no group yet, by t0, then
                      * segment */
    RayTerm **group; /* the present group, by t0 */
    size_t n_terms, n_group;
    uint32_t *near;      /* per term: its segment */
    LocalGroups *groups; /* blend groups of the terms; NULL if all segments blend */
} FieldScratch;

/* The workspace functions of field_search [RaySearch.workspace_new]. The caller frees *out with
 * fieldscratch_free, which accepts NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldscratch_new(const Geometry *geometry, size_t n, void **out, Err *err);
void fieldscratch_free(void *workspace);

/* Empties the scratch and adds the terms of all tubes of the index that the ray passes near enough.
 * part->t_max must be finite. */
void rayterms_find(const FieldIndex *index, FieldScratch *scratch, const RayPart *part);
/* Does the same with the n listed segments of a geometry. */
void rayterms_find_listed(const Geometry *geometry, const uint32_t *list, size_t n,
                          FieldScratch *scratch, const RayPart *part);

/* Selects the `n` terms, whose indices are listed, from which rayterms_next_group forms groups.
 * NULL: the first n terms. */
void rayterms_choose(FieldScratch *scratch, const uint32_t *numbers, size_t n);

/* Sets scratch->group to the next group along the ray: a maximal run of terms whose intervals
 * [t0, t1] overlap. Returns false if no term is left. */
bool rayterms_next_group(FieldScratch *scratch);

/* Sets the windows of the terms of the present group. Outside all windows the group's potential is
 * below the level. Returns false if all windows are empty. Otherwise also sets `radial` and the
 * bounds of the curvature, and returns true. */
bool rayterms_find_windows(FieldScratch *scratch);

#endif
