/* Collects the terms of the potential along one ray, one term per segment, and forms runs of terms
 * whose intervals overlap. A term becomes a function of t, the position along the ray; fieldcast.c
 * searches the sum of a run.
 *
 * A term is stored relative to t_mid, where the ray is nearest to the segment, so that a distant
 * camera or a long segment costs no digits. A term is negligible outside a capsule around its
 * segment; a cylinder around this capsule is used instead. A cylinder is convex, so a term counts
 * on one interval of the ray. A heap orders the terms by their starts: a ray that hits its first
 * run never sorts the rest. */
#include "render/cast/rayterms.h"

#include <float.h>
#include <stdlib.h>

static const double ln2 = 0.69314718055994530942;

Status fieldscratch_new(const Geometry *geometry, size_t n, void **out, Err *err)
{
    Status status;
    FieldScratch *scratch = NULL;
    TRY_GOTO(mem_calloc(&scratch, 1, sizeof *scratch, "field workspaces", err));
    TRY_GOTO(mem_calloc(&scratch->terms, n, sizeof *scratch->terms, "terms of a ray", err));
    TRY_GOTO(
        mem_calloc(&scratch->heap.items, n, sizeof *scratch->heap.items, "terms of a ray", err));
    TRY_GOTO(mem_calloc(&scratch->run, n, sizeof *scratch->run, "terms of a ray", err));
    TRY_GOTO(mem_calloc(&scratch->near, n, sizeof *scratch->near, "terms of a ray", err));
    if (geometry->blend.n_groups)
        TRY_GOTO(localgroups_new(geometry, &scratch->groups, err));
    *out = scratch;
    return STATUS_OK;
done:
    fieldscratch_free(scratch);
    return status;
}

void fieldscratch_free(void *workspace)
{
    FieldScratch *scratch = workspace;
    if (!scratch)
        return;
    free(scratch->terms);
    ARRAY_RELEASE(&scratch->heap);
    free(scratch->run);
    free(scratch->near);
    localgroups_free(scratch->groups);
    free(scratch);
}

/* Finds the interval [*t0, *t1] in which w^2 <= w2_max and u is at most `beyond` outside [0, h], in
 * the notation of RayTerm. Returns false if it is empty. */
static bool find_interval(const RayTerm *term, double w2_max, double beyond, double *t0, double *t1)
{
    if (w2_max < 0)
        return false;
    double low = -HUGE_VAL, high = HUGE_VAL;
    if (term->w1 > 0) {
        double w_max = sqrt(w2_max);
        low = (-w_max - term->w0) / term->w1;
        high = (w_max - term->w0) / term->w1;
    }
    double u_low = -beyond - term->u0, u_high = term->h + beyond - term->u0;
    if (term->u1 != 0) {
        double first = u_low / term->u1, last = u_high / term->u1;
        low = fmax(low, fmin(first, last));
        high = fmin(high, fmax(first, last));
    } else if (u_low > 0 || u_high < 0) {
        return false;
    }
    *t0 = term->t_mid + low;
    *t1 = term->t_mid + high;
    return low <= high;
}

/* Returns the parameter at which the ray is nearest to the segment. If it is not well defined, any
 * value near the segment will do: it only keeps numbers small. */
static double nearest_parameter(const FieldTube *tube, Ray ray, double cosine)
{
    Vec3 to_a = vec3_sub(tube->a, ray.origin);
    double sine2 = fmax(1 - cosine * cosine, DBL_EPSILON);
    double along = (cosine * vec3_dot(to_a, ray.direction) - vec3_dot(to_a, tube->axis)) / sine2;
    along = fmin(fmax(along, 0), tube->length);
    return vec3_dot(vec3_add_scaled(to_a, tube->axis, along), ray.direction);
}

/* Computes the term of a tube along the ray. Returns false if the ray passes out of its reach. */
static bool pass_tube(const FieldTube *tube, Ray ray, RayTerm *term)
{
    double k = tube->k, cosine = vec3_dot(tube->axis, ray.direction);
    double t_mid = nearest_parameter(tube, ray, cosine);
    Vec3 from_a = vec3_sub(ray_at(ray, t_mid), tube->a);
    double along = vec3_dot(from_a, tube->axis);
    Vec3 across = vec3_scale(vec3_add_scaled(from_a, tube->axis, -along), k);
    Vec3 across1 = vec3_scale(vec3_add_scaled(ray.direction, tube->axis, -cosine), k);
    double w1 = vec3_length(across1);
    double w0 = w1 > 0 ? vec3_dot(across, across1) / w1 : 0;
    double e2 = fmax(vec3_dot(across, across) - w0 * w0, 0);
    *term = (RayTerm){.t_mid = t_mid,
                      .w0 = w0,
                      .w1 = w1,
                      .u0 = k * along,
                      .u1 = k * cosine,
                      .h = tube->length_k,
                      .e2 = e2,
                      .peak = tube->peak,
                      .log_peak = tube->log_peak,
                      .segment = tube->segment};
    return find_interval(term, tube->reach2 - e2, sqrt(tube->reach2), &term->t0, &term->t1);
}

/* Sets the bounds of the second derivative of a term along the ray, each from the factors
 * exp(-w^2) and (erf u + erf v) / 2 of the term. The numbers are the maxima, rounded up:
 * 0.8926 = 4 exp(-3/2), of the second derivative of exp(-w^2), and 2 of its negative;
 * 0.4840 = sqrt(2 / (e pi)) and 0.9680, twice this, for the axial factor; 0.9682 for the product of
 * the two slopes. */
static void bound_curvature(RayTerm *term)
{
    double w1 = term->w1, u1 = fabs(term->u1);
    term->radial = elementary_exp(-term->e2);
    double both = 0.9682 * w1 * u1;
    term->convex = term->radial * (0.8926 * term->peak * w1 * w1 + both + 0.4840 * u1 * u1);
    term->concave = term->radial * (2 * term->peak * w1 * w1 + both + 0.9680 * u1 * u1);
}

/* Returns true if the ray meets the box in [t0, t1]. If the ray lies in the plane of a face, the
 * product is NaN, every comparison with it is false, and the box counts as met. */
static bool meets_node(const FieldNode *node, const double origin[3], const double inverse[3],
                       double t0, double t1)
{
    for (int axis = 0; axis < 3; axis++) {
        int backward = inverse[axis] < 0;
        double near = (node->bounds[backward][axis] - origin[axis]) * inverse[axis];
        double far = (node->bounds[!backward][axis] - origin[axis]) * inverse[axis];
        t0 = near > t0 ? near : t0;
        t1 = far < t1 ? far : t1;
    }
    return t0 <= t1;
}

/* Adds the term of a tube if the ray passes it near enough. */
static void add_term(FieldScratch *scratch, const FieldTube *tube, const RayPart *part)
{
    RayTerm *term = &scratch->terms[scratch->n_terms];
    if (pass_tube(tube, part->ray, term) && term->t1 >= part->t_min && term->t0 <= part->t_max)
        scratch->n_terms++;
}

void rayterms_choose(FieldScratch *scratch, const uint32_t *numbers, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint32_t number = numbers ? numbers[i] : (uint32_t)i;
        const RayTerm *term = &scratch->terms[number];
        scratch->heap.items[i] = (HeapItem){term->t0, term->segment, number};
    }
    scratch->heap.n = n;
    heap_order(&scratch->heap);
}

void rayterms_find_listed(const Geometry *geometry, const uint32_t *list, size_t n,
                          FieldScratch *scratch, const RayPart *part)
{
    scratch->n_terms = 0;
    for (size_t i = 0; i < n; i++) {
        const FieldTube tube = fieldtube_of(&geometry->segments[list[i]], list[i]);
        if (tube.reach2 > 0)
            add_term(scratch, &tube, part);
    }
}

void rayterms_find(const FieldIndex *index, FieldScratch *scratch, const RayPart *part)
{
    const Ray ray = part->ray;
    const double origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const double inverse[3] = {1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z};
    uint32_t stack[FIELD_STACK_SIZE];
    int top = 0;
    scratch->n_terms = 0;
    if (index->n_nodes)
        stack[top++] = 0;
    while (top > 0) {
        uint32_t number = stack[--top];
        const FieldNode *node = &index->nodes[number];
        if (!meets_node(node, origin, inverse, part->t_min, part->t_max))
            continue;
        if (node->n_tubes == 0) {
            stack[top++] = node->first;
            stack[top++] = number + 1;
        }
        for (uint32_t i = node->first; i < node->first + node->n_tubes; i++)
            add_term(scratch, &index->tubes[i], part);
    }
}

bool rayterms_next_run(FieldScratch *scratch)
{
    double end = HUGE_VAL;
    scratch->n_run = 0;
    while (scratch->heap.n && scratch->heap.items[0].key <= end) {
        RayTerm *term = &scratch->terms[heap_pop(&scratch->heap).value];
        end = scratch->n_run ? fmax(end, term->t1) : term->t1;
        scratch->run[scratch->n_run++] = term;
    }
    return scratch->n_run > 0;
}

bool rayterms_find_windows(FieldScratch *scratch)
{
    bool any = false;
    double log_share = elementary_log((double)scratch->n_run / FIELD_LEVEL);
    for (size_t i = 0; i < scratch->n_run; i++) {
        RayTerm *term = scratch->run[i];
        double w2_max = log_share + term->log_peak - term->e2;
        double beyond = sqrt(fmax(log_share - ln2 - term->e2, 0));
        if (find_interval(term, w2_max, beyond, &term->window0, &term->window1)) {
            any = true;
        } else {
            term->window0 = HUGE_VAL;
            term->window1 = -HUGE_VAL;
        }
    }
    for (size_t i = 0; any && i < scratch->n_run; i++)
        bound_curvature(scratch->run[i]);
    return any;
}
