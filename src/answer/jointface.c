/* The ray meets the ruling of angle p where both are in one plane: where g(p) = unit . (C_1(p) x
 * (C_2(p) - C_1(p))) is 0, with C_1 relative to the ray [geom/joint.c]. On each half of the circle,
 * g is a quartic of x = tan(p / 2), or of the complement, in [-1, 1]. Its Bernstein coefficients
 * are constant forms. An interval without a change of sign has no root. One in which the
 * coefficients surely rise, or fall, has at most one root, and all differences bound the slope.
 * Other intervals are divided. */
#include "answer/jointface.h"

#include <math.h>

enum { MAX_CUTS = 40 }; /* depth of divisions, after which a ray is undecided */

/* A joint relative to a ray: C_1(p) = from + cos p across + sin p side, C_2(p) - C_1(p) = span +
 * cos p across_change + sin p side_change. */
typedef struct JointForms {
    Form3 from, across, side;
    Form3 span, across_change, side_change;
} JointForms;

Face joint_face(const Primitive *primitive, uint32_t solid)
{
    Face face = {.kind = FACE_JOINT,
                 .segment = primitive->segment,
                 .solid = solid,
                 .at = primitive->a,
                 .end = primitive->b,
                 .radius = primitive->radius_mm,
                 .joint = primitive};
    face.box = box_with_ball(box_with_ball(box_empty(), primitive->a, primitive->radius_mm),
                             primitive->b, primitive->radius_b_mm);
    return face;
}

/* Returns a vector whose cross product with the first axis has the direction of the joint's `f`.
 * For parallel axes any other vector serves: the joint is then a cone. */
static Vec3 other_axis(const Vec3 axes[2])
{
    if (vec3_length(vec3_cross(axes[0], axes[1])) >= 1e-12)
        return axes[1];
    return fabs(axes[0].x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
}

static JointForms forms_of(const Face *face, const Beam *ray, double middle)
{
    const Primitive *joint = face->joint;
    const Form3 axis = form3_exact(joint->axes[0]), start = form3_exact(joint->a);
    const Form3 side = form3_unit(form3_cross(axis, form3_exact(other_axis(joint->axes))));
    const Form first = form_of(joint->radius_mm, 0), last = form_of(joint->radius_b_mm, 0);
    const Form3 across = form3_mul(form3_cross(side, axis), first);
    const Form3 end_across = form3_mul(form3_cross(side, form3_exact(joint->axes[1])), last);
    return (JointForms){
        .from = form3_sub(form3_sub(start, ray->origin), form3_mul(ray->unit, form_of(middle, 0))),
        .across = across,
        .side = form3_mul(side, first),
        .span = form3_sub(form3_exact(joint->b), start),
        .across_change = form3_sub(end_across, across),
        .side_change = form3_mul(side, form_sub(last, first))};
}

/* ---- roots ----------------------------------------------------------------------------------- */

typedef struct JointRoots {
    Form x[JOINT_HITS];
    int n;
    bool undecided;
} JointRoots;

/* Divides the coefficients at `part` of their interval. */
static void divide(const Form b[5], double part, Form left[5], Form right[5])
{
    for (int i = 0; i < 5; i++)
        right[i] = b[i];
    for (int i = 0; i < 5; i++) {
        left[i] = right[0];
        for (int k = 0; k < 4 - i; k++)
            right[k] = form_add(form_scale(right[k], 1 - part), form_scale(right[k + 1], part));
    }
}

/* Returns a part of the interval near which g, which has the sign `first` before it and the
 * opposite sign behind it, is 0. Plain doubles suffice here. */
static double root_part(const Form b[5], double first)
{
    double from = 0, to = 1, part = 0.5;
    for (int i = 0; i < 60; i++) {
        double c[5], slope = 0;
        for (int k = 0; k < 5; k++)
            c[k] = b[k].c;
        for (int n = 4; n > 0; n--) {
            slope = 4 * (c[1] - c[0]);
            for (int k = 0; k < n; k++)
                c[k] = (1 - part) * c[k] + part * c[k + 1];
        }
        *((c[0] > 0) == (first > 0) ? &from : &to) = part;
        const double newton = part - c[0] / slope;
        const double next = newton > from && newton < to ? newton : 0.5 * (from + to);
        if (fabs(next - part) <= FORM_U)
            break;
        part = next;
    }
    return part;
}

/* Adds the root in [low, high]. The slope of g by the part of this interval is at least `slope`. */
static void add_root(const Form b[5], double low, double high, double slope, JointRoots *roots)
{
    const double part = root_part(b, b[0].c);
    Form left[5], right[5];
    divide(b, part, left, right);
    const double error =
        (form_most(right[0]) / slope * (high - low) + 2 * MAX_CUTS * FORM_U) * (1 + 1e-9);
    if (roots->n < JOINT_HITS)
        roots->x[roots->n++] = form_of(low + part * (high - low), error);
    else
        roots->undecided = true;
}

static void find_roots(const Form b[5], double low, double high, int cuts, JointRoots *roots)
{
    bool above = true, below = true;
    double rise = (double)INFINITY, fall = (double)INFINITY;
    for (int i = 0; i < 5; i++) {
        above = above && form_low(b[i]) > 0;
        below = below && form_high(b[i]) < 0;
        if (i == 4)
            break;
        const Form step = form_sub(b[i + 1], b[i]);
        rise = fmin(rise, form_low(step));
        fall = fmin(fall, -form_high(step));
    }
    if (above || below)
        return;
    const double slope = 4 * fmax(rise, fall);
    if (slope > 0 && fabs(b[0].c) > b[0].e && fabs(b[4].c) > b[4].e) {
        add_root(b, low, high, slope, roots); /* the ends have different signs */
        return;
    }
    Form left[5], right[5];
    const double part = 17.0 / 32, at = low + part * (high - low);
    if (cuts == MAX_CUTS || roots->undecided) {
        roots->undecided = true;
        return;
    }
    divide(b, part, left, right);
    find_roots(left, low, at, cuts + 1, roots);
    find_roots(right, at, high, cuts + 1, roots);
}

/* ---- hits ------------------------------------------------------------------------------------ */

static Form triple(Form3 a, Form3 b, Form3 c)
{
    return form3_dot(a, form3_cross(b, c));
}

/* Finds the roots of g where the cosine has the sign `half`. All coefficients are three times those
 * of geom/joint.c, which makes the factors exact. */
static JointRoots roots_of(const JointForms *j, Form3 unit, double half)
{
    const Form one = triple(unit, j->from, j->span);
    const Form by_cos = form_scale(
        form_add(triple(unit, j->from, j->across_change), triple(unit, j->across, j->span)),
        3 * half);
    const Form by_sin =
        form_add(triple(unit, j->from, j->side_change), triple(unit, j->side, j->span));
    const Form by_cos2 = triple(unit, j->across, j->across_change);
    const Form by_both = form_scale(
        form_add(triple(unit, j->across, j->side_change), triple(unit, j->side, j->across_change)),
        3 * half);
    const Form b[5] = {form_scale(form_sub(one, by_sin), 6), form_sub(by_cos, by_both),
                       form_scale(form_add(one, form_scale(by_cos2, 2)), 2),
                       form_add(by_cos, by_both), form_scale(form_add(one, by_sin), 6)};
    JointRoots roots = {.n = 0};
    find_roots(b, -1, 1, 0, &roots);
    return roots;
}

static Form3 combined(Form3 constant, Form3 by_cos, Form cosine, Form3 by_sin, Form sine)
{
    return form3_add(constant, form3_add(form3_mul(by_cos, cosine), form3_mul(by_sin, sine)));
}

/* Adds an edge. Returns false if the ray is surely outside it. */
static bool add_end(FaceHit *hit, Form edge)
{
    if (!(form_low(edge) >= 0))
        hit->edges[hit->n_edges++] = edge;
    return !(form_high(edge) < 0);
}

/* Sets the hit of the ruling with the angle of x. Returns false if the ray surely passes beyond its
 * ends. */
static bool set_hit(const JointForms *j, const Beam *ray, double middle, double half, Form x,
                    FaceHit *hit)
{
    const Form square = form_mul(x, x), one = form_of(1, 0);
    const Form inverse = form_inverse(form_add(one, square));
    const Form cosine = form_scale(form_mul(form_sub(one, square), inverse), half);
    const Form sine = form_scale(form_mul(x, inverse), 2);
    const Form3 start = combined(j->from, j->across, cosine, j->side, sine);
    const Form3 run = combined(j->span, j->across_change, cosine, j->side_change, sine);
    const Form3 run_across = form3_cross(ray->unit, run), off = form3_cross(ray->unit, start);
    const Form l = form_neg(
        form_mul(form3_dot(off, run_across), form_inverse(form3_dot(run_across, run_across))));
    hit->n_edges = 0;
    if (!add_end(hit, l) || !add_end(hit, form_sub(one, l)))
        return false;
    const Form along = form3_dot(form3_add(start, form3_mul(run, l)), ray->unit);
    hit->depth = form_mul(form_add(along, form_of(middle, 0)), ray->inverse);
    const Form3 across = form3_add(j->across, form3_mul(j->across_change, l));
    const Form3 side = form3_add(j->side, form3_mul(j->side_change, l));
    const Form3 turn = form3_sub(form3_mul(side, cosine), form3_mul(across, sine));
    hit->v = form3_unit(form3_cross(turn, run));
    return true;
}

int joint_hits(const Face *face, const Beam *ray, FaceHit hits[JOINT_HITS])
{
    const Vec3 unit = vec3(ray->unit.x.c, ray->unit.y.c, ray->unit.z.c);
    const Vec3 origin = vec3(ray->origin.x.c, ray->origin.y.c, ray->origin.z.c);
    const Vec3 center = vec3_scale(vec3_add(face->box.low, face->box.high), 0.5);
    const double middle = vec3_dot(vec3_sub(center, origin), unit);
    const double reach = 0.5001 * vec3_distance(face->box.low, face->box.high);
    if (vec3_distance(vec3_add_scaled(origin, unit, middle), center) > reach)
        return 0;
    const JointForms forms = forms_of(face, ray, middle);
    int n = 0;
    for (double half = 1; half >= -1; half -= 2) {
        const JointRoots roots = roots_of(&forms, ray->unit, half);
        if (roots.undecided)
            return -1;
        for (int i = 0; i < roots.n; i++) {
            FaceHit hit = {.face = face};
            if (!set_hit(&forms, ray, middle, half, roots.x[i], &hit))
                continue;
            if (n == JOINT_HITS)
                return -1;
            hits[n++] = hit;
        }
    }
    return n;
}

int joint_blocks(const Face *face, const Beam *ray, bool is_own, bool parallel, double from_mm)
{
    FaceHit hits[JOINT_HITS];
    const int n = joint_hits(face, ray, hits);
    int blocked = n < 0 ? -1 : 0, starts = 0;
    for (int i = 0; i < n; i++) {
        const double low = form_low(hits[i].depth), high = form_high(hits[i].depth);
        const bool at_start = is_own && low <= 0 && high >= 0;
        starts += at_start;
        if (at_start || high <= 0 || (!parallel && low >= 1))
            continue;
        if (hits[i].n_edges == 0 && form_low(form_mul(hits[i].depth, ray->length)) > from_mm &&
            (parallel || high < 1))
            return 1;
        blocked = -1;
    }
    return is_own && starts != 1 ? -1 : blocked;
}
