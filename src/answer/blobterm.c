/* The components of a blob as terms along single rays. The unit of length of a component is its
 * radius, and its field is S (1 - q)^2 where q, the squared distance from its axis, is below 1.
 * Beside the axis of a tube, q is the squared distance from the axis line. Beyond an end, the
 * square of the distance from the end along the axis is added. */
#include "answer/levelterm.h"

/* Returns 1 - q, or 0 for q > 1, at a constant form zeta. Sets *beyond to the distance beyond an
 * end along the axis, negative at the first end and 0 between the ends. */
static Form inside_of(const LevelTerm *term, Form zeta, Form *beyond)
{
    const Form *c = term->distance.square;
    const Form moved = form_mul(term->along[1], zeta);
    *beyond = form_sub(form_positive(form_sub(moved, term->before)),
                       form_positive(form_neg(form_add(moved, term->along[0]))));
    const Form across =
        form_add(c[0], form_mul(form_add(form_scale(c[1], 2), form_mul(c[2], zeta)), zeta));
    return form_positive(form_sub(form_of(1, 0), form_add(across, form_mul(*beyond, *beyond))));
}

/* The error of zeta is that of the potential. */
static LevelSample sample_component(const LevelTerm *term, double z)
{
    const Form *c = term->distance.square;
    const double exact = z - term->distance.middle;
    const Form zeta = form_of(exact, 4 * FORM_U * fabs(exact));
    Form beyond;
    const Form inside = inside_of(term, zeta, &beyond);
    const Form half_rate =
        form_add(form_add(c[1], form_mul(c[2], zeta)), form_mul(beyond, term->along[1]));
    const Form value = form_scale(form_mul(inside, inside), term->ends);
    const Form slope = form_scale(form_mul(inside, half_rate), -4 * term->ends);
    return (LevelSample){value.c, slope.c, value.e, slope.e};
}

static Form3 component_gradient(const LevelTerm *term, Form zeta)
{
    Form beyond;
    const Form inside = inside_of(term, zeta, &beyond);
    const Form factor =
        form_scale(form_mul(inside, form_mul(term->unit, term->unit)), -4 * term->ends);
    const Form3 across = form3_add(term->across, form3_mul(term->across_rate, zeta));
    const Form along = form_mul(beyond, form_inverse(term->unit));
    return form3_mul(form3_add(across, form3_mul(term->axis, along)), factor);
}

/* The component is at least its peak / ratio where 1 - q is at least (1 - least) / sqrt(ratio). */
static void find_component_window(LevelTerm *term, double ratio)
{
    const double room = (1 - term->least) * (1 - 1 / sqrt(ratio)) * (1 + 1e-9);
    const double reach = sqrt(fmax(room, 0));
    levelterm_interval(term, reach, reach, &term->window_from, &term->window_to);
}

static const LevelKind component_kind = {sample_component, component_gradient,
                                         find_component_window};

/* Makes the term of a component, a number of its radii wide. Returns false if it is left out. With
 * q'' in [0, 2 unit^2], and q'^2 <= 4 unit^2 (q - least), the second derivative of (1 - q)^2 is
 * between -4 and 8 times unit^2 (1 - least). */
static bool make_component(const LevelAxis *axis, double strength, uint32_t face, const Beam *ray,
                           LevelTerm *term)
{
    if (!levelterm_place(axis, 1, ray, term) || !(term->least < 1))
        return false;
    const double inside = (1 - term->least) * (1 + 1e-9), unit = form_most(axis->unit);
    const double bend = fabs(strength) * inside * unit * unit * (1 + 1e-9);
    term->kind = &component_kind;
    term->face = face;
    term->ends = strength;
    term->peak = strength > 0 ? strength * inside * inside : 0;
    term->convex = (strength > 0 ? 8 : 4) * bend;
    term->concave = (strength > 0 ? 4 : 8) * bend;
    return true;
}

/* Returns 1 / (radii * radius of the face). */
static Form unit_of(const Face *face, double radii)
{
    return form_inverse(form_scale(form_of(face->radius, 0), radii));
}

/* Makes the terms of the ball at each end of a segment, `offset` mm inside it, and returns their
 * number. */
static size_t make_balls(const Face *face, uint32_t index, double radii, double offset,
                         double strength, const Beam *ray, LevelTerm *terms)
{
    size_t n = 0;
    for (int e = 0; e < 2; e++) {
        const Form inwards = form_scale(form_of(face->radius, 0), e ? -offset : offset);
        const LevelAxis ball = {.start = form3_add(form3_exact(e ? face->end : face->at),
                                                   form3_mul(face->axis, inwards)),
                                .unit = unit_of(face, radii)};
        n += make_component(&ball, strength, index, ray, &terms[n]);
    }
    return n;
}

size_t blob_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms)
{
    size_t n = 0;
    for (int i = 0; i < BLOB_TUBES; i++) {
        const BlobTube *tube = &blob_shape.tube[i];
        const LevelAxis axis = levelaxis_of(face, unit_of(face, tube->radius));
        n += make_component(&axis, tube->strength, index, ray, &terms[n]);
        n += make_balls(face, index, tube->radius, 0, -0.5 * tube->strength, ray, &terms[n]);
    }
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        for (int side = 1; side >= -1; side -= 2) {
            const BlobBead *bead = &blob_shape.bead[i];
            n += make_balls(face, index, bead->radius, side * bead->offset, side * bead->strength,
                            ray, &terms[n]);
        }
    return n;
}
