/* The terms of the potential along one ray. A term is the contribution of one segment; the surface
 * is where the sum of the terms is the level FIELD_LEVEL. fieldcast.c explains the method.
 *
 * A search collects the terms near the ray. It then processes the terms in runs along the ray; a
 * run is a maximal chain of terms whose intervals [t0, t1] leave no gap. In a run, it
 * searches for the surface in the windows of the terms [RayTerm.window0]:
 *
 *     rayterms_find(field, scratch, &part);
 *     rayterms_choose(scratch, NULL, scratch->n_terms);
 *     while (rayterms_next_run(scratch))
 *         if (rayterms_find_windows(scratch))
 *             ... */
#ifndef CORCAST_RENDER_CAST_RAYTERMS_H
#define CORCAST_RENDER_CAST_RAYTERMS_H

#include "base/base.h"
#include "field/field.h"
#include "render/cast/raysearch.h"

/* The term of one segment along a ray. At t = t_mid + x its value is radial exp(-w^2) (erf(u) +
 * erf(h - u)) / 2, with w = w0 + w1 x and u = u0 + u1 x. t_mid is the t at which the ray is nearest
 * to the segment. w and u are coordinates in a plane parallel to the ray and the axis: w, which may
 * be negative, across the axis, and u along the axis from the segment's first end. h is the length
 * of the segment. All three are multiplied by potential_k [field.h]. The cut-off is
 * RAY_TERM_CUTOFF. */
typedef struct RayTerm {
    double t0, t1;           /* the term may exceed the cut-off only in [t0, t1] */
    double window0, window1; /* the term can be the largest of its run at a hit only for t in
                              * [window0, window1]; window0 > window1: for no t */
    double t_mid;
    double w0, w1, u0, u1, h;
    double e2;     /* squared distance between the ray and the axis line, times potential_k^2 */
    double radial; /* exp(-e2), set by rayterms_find_windows */
    double peak, log_peak;  /* upper bound of the term on the ray, and its logarithm */
    double convex, concave; /* upper bounds of the second derivative and of its negative, 1/mm^2,
                             * set by rayterms_find_windows */
    uint32_t segment;       /* index of the segment */
} RayTerm;

/* The workspace of one thread. All arrays are owned. Their capacity is the maximum number of
 * segments near a ray. */
typedef struct FieldScratch {
    RayTerm *terms;
    Heap heap;     /* indices of the terms that are in no run yet, ordered by t0, then
                    * segment */
    RayTerm **run; /* the current run, ordered by t0 */
    size_t n_terms, n_run;
    uint32_t *near;      /* per term: its segment */
    LocalGroups *groups; /* blend groups of the terms; NULL if all segments blend */
} FieldScratch;

/* The workspace functions of field_search [RaySearch.workspace_new]. `n` is the maximum number of
 * segments near a ray. The caller frees *out with
 * fieldscratch_free, which accepts NULL. Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldscratch_new(const Geometry *geometry, size_t n, void **out, Err *err);
void fieldscratch_free(void *workspace);

/* Replaces the terms of the scratch by the terms of all segments of the index that are near enough
 * to the ray to exceed the cut-off. part->t_max must be finite. */
void rayterms_find(const FieldIndex *index, FieldScratch *scratch, const RayPart *part);
/* Does the same as rayterms_find, for the n segments of `geometry` whose indices are in `list`. */
void rayterms_find_listed(const Geometry *geometry, const uint32_t *list, size_t n,
                          FieldScratch *scratch, const RayPart *part);

/* Selects the n terms from which rayterms_next_run forms runs: all, or those of one blend group.
 * `indices` lists their indices; NULL: the first n terms. */
void rayterms_choose(FieldScratch *scratch, const uint32_t *indices, size_t n);

/* Sets scratch->run to the next run along the ray. Returns false if no term is left. */
bool rayterms_next_run(FieldScratch *scratch);

/* Computes the windows of the terms of the current run. Outside all windows the run's potential is
 * below the level. Returns false if all windows are empty. If it returns true, it has
 * also set `radial` and the bounds of the second derivative. */
bool rayterms_find_windows(FieldScratch *scratch);

#endif
