/* Hits of rays with the surface of a field, and shadows. The terms of a ray are made once; each
 * blend group is then searched for itself. */
#include "answer/isosurface.h"

#include <math.h>
#include <stdlib.h>

/* Error of the hits of renderers, as a fraction of the level: they leave out terms up to 1e-6, each
 * of which is 7.4e-6 of the level. Such a hit decides differently whether a path inwards is longer
 * than AnswerPlan.shadow_from_mm. */
static const double hit_error = 2e-5;

/* ---- rays ------------------------------------------------------------------------------------ */

Status levelworkspace_make(const AnswerPlan *plan, LevelWorkspace *work, Err *err)
{
    const Geometry *geometry = &plan->scene->geometry;
    if (!plan->is_field)
        return STATUS_OK;
    const size_t n = plan->n * (plan->is_blob ? LEVEL_SEGMENT_TERMS : 1);
    TRY(mem_calloc(&work->terms, n, sizeof *work->terms, "terms", err));
    TRY(mem_calloc(&work->chosen, n, sizeof *work->chosen, "terms", err));
    TRY(mem_calloc(&work->segments, n, sizeof *work->segments, "terms", err));
    return geometry->blend.n_groups ? localgroups_new(geometry, &work->groups, err) : STATUS_OK;
}

void levelworkspace_release(LevelWorkspace *work)
{
    free(work->terms);
    free(work->chosen);
    free(work->segments);
    localgroups_free(work->groups);
}

static void find_terms(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                       const FaceList *list)
{
    work->n = 0;
    for (size_t i = 0; i < list->n; i++) {
        const uint32_t face = list->faces[i];
        if (plan->faces[face].kind != FACE_SEGMENT)
            continue;
        size_t n = (plan->is_blob ? blob_terms : potential_terms)(&plan->faces[face], face, ray,
                                                                  &work->terms[work->n]);
        while (n-- > 0)
            work->segments[work->n++] = face;
    }
}

/* Chooses the terms of a blend group, or all terms. Sets the windows of the terms: where the
 * sum reaches the level, at least one term reaches level * its peak / sum of all peaks. Returns the
 * ray through the terms; its n is 0 if the level cannot be reached. */
static LevelRay choose_terms(const AnswerPlan *plan, LevelWorkspace *work, size_t group)
{
    size_t n = work->n;
    const uint32_t *members = work->groups ? localgroups_members(work->groups, group, &n) : NULL;
    LevelRay ray = {work->chosen, n, plan->level, plan->dropped, plan->dropped_slope};
    double total = 0;
    for (size_t i = 0; i < n; i++) {
        work->chosen[i] = &work->terms[members ? members[i] : i];
        total += work->chosen[i]->peak;
    }
    const double ratio = total / (plan->level - plan->dropped) * (1 + 1e-9);
    if (!(ratio >= 1))
        ray.n = 0;
    for (size_t i = 0; i < ray.n; i++) {
        LevelTerm *term = &work->terms[members ? members[i] : i];
        term->kind->find_window(term, ratio);
        term->window_from = fmax(term->window_from, term->from);
        term->window_to = term->peak > 0 ? fmin(term->window_to, term->to) : -(double)INFINITY;
    }
    return ray;
}

/* Returns the number of groups of terms to choose from. */
static size_t count_groups(LevelWorkspace *work)
{
    return work->n == 0   ? 0
           : work->groups ? localgroups_find(work->groups, work->segments, work->n)
                          : 1;
}

/* ---- hits ------------------------------------------------------------------------------------ */

/* Returns the outward unit normal of the sum of the ray's terms at a crossing. */
static Form3 normal_at(const LevelRay *ray, const LevelCrossing *at)
{
    const Form left_out = form_of(0, ray->dropped_slope);
    Form3 sum = {left_out, left_out, left_out};
    for (size_t i = 0; i < ray->n; i++) {
        const LevelTerm *term = ray->terms[i];
        const double zeta = at->z - term->distance.middle;
        if (term->to >= at->z - at->error && term->from <= at->z + at->error)
            sum = form3_add(sum, term->kind->gradient(
                                     term, form_rounded(form_of(zeta, at->error), fabs(zeta))));
    }
    const Form3 normal = form3_neg(form3_unit(sum));
    return (Form3){form_known(normal.x, -1, 1), form_known(normal.y, -1, 1),
                   form_known(normal.z, -1, 1)};
}

/* Bounds the sum of the terms of one segment at a crossing. `first` is the first of its terms.
 * Returns the index after its last term. */
static size_t bound_segment(const LevelRay *ray, size_t first, const LevelCrossing *at, double *low,
                            double *high)
{
    size_t i = first;
    *low = *high = 0;
    for (; i < ray->n && ray->terms[i]->face == ray->terms[first]->face; i++) {
        const LevelTerm *term = ray->terms[i];
        const LevelSample sample = term->kind->sample(term, at->z);
        const double error =
            sample.value_error +
            at->error * (fabs(sample.slope) + sample.slope_error +
                         at->error * (term->convex + term->concave)) +
            LEVEL_SEGMENT_TERMS * FORM_U * (fabs(*low) + fabs(*high) + fabs(sample.value));
        *low += sample.value - error;
        *high += sample.value + error;
    }
    return i;
}

/* Adds a hit for each segment that may have the largest sum of terms at the crossing. Returns false
 * if there is no space for all. */
static bool add_hits(const AnswerPlan *plan, const LevelRay *ray, const LevelCrossing *at,
                     FaceHit *hits, size_t *n, size_t capacity, const Beam *beam)
{
    const Form depth = form_mul(form_of(at->z, at->error), beam->inverse);
    const Form3 normal = normal_at(ray, at);
    double largest = -(double)INFINITY, low, high;
    for (size_t i = 0; i < ray->n;) {
        i = bound_segment(ray, i, at, &low, &high);
        largest = fmax(largest, low);
    }
    for (size_t i = 0; i < ray->n;) {
        const Face *face = &plan->faces[ray->terms[i]->face];
        i = bound_segment(ray, i, at, &low, &high);
        if (high < largest)
            continue;
        if (*n == capacity)
            return false;
        hits[(*n)++] = (FaceHit){.face = face, .depth = depth, .v = normal};
    }
    return true;
}

LevelHits isosurface_hits(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                          const FaceList *list, FaceHit *hits, size_t capacity)
{
    LevelHits found = {0};
    find_terms(plan, work, ray, list);
    const size_t groups = count_groups(work);
    for (size_t group = 0; group < groups; group++) {
        const LevelRay terms = choose_terms(plan, work, group);
        const LevelCrossing at = levelray_first(&terms, 0, (double)INFINITY, true);
        if (at.state == LEVEL_UNDECIDED ||
            (at.state == LEVEL_FOUND &&
             !add_hits(plan, &terms, &at, hits, &found.n, capacity, ray)))
            return (LevelHits){.undecided = true};
    }
    return found;
}

int isosurface_blocks(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                      const FaceList *list, bool parallel, bool leaves)
{
    const double near = parallel ? (double)INFINITY : form_low(ray->length);
    const double far = parallel ? (double)INFINITY : form_high(ray->length);
    int blocked = 0;
    find_terms(plan, work, ray, list);
    const size_t groups = count_groups(work);
    for (size_t group = 0; group < groups && blocked != 1; group++) {
        const LevelRay terms = choose_terms(plan, work, group);
        if (!leaves) {
            blocked =
                levelray_is_above(&terms, plan->shadow_from_mm, hit_error * plan->level) ? 1 : -1;
            continue;
        }
        const LevelCrossing at = levelray_first(&terms, 0, far, false);
        if (at.state == LEVEL_UNDECIDED)
            blocked = -1;
        else if (at.state == LEVEL_FOUND)
            blocked = at.z - at.error > plan->shadow_from_mm && at.z + at.error < near ? 1 : -1;
    }
    return blocked;
}
