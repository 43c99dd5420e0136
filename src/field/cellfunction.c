/* Builds the terms of the potential in a form that is cheap for POV-Ray, and evaluates this form
 * and the functions of cells [cells.h].
 *
 * A term is split into affine functions of x that stay precise far from the origin: two axes v and
 * w across the segment and one along it, in units of 1/c = sqrt(2) s, s the width of the Gaussian,
 * half of the radius. The Gaussian is exp(-(v^2 + w^2)), a sum of squares instead of a difference
 * of large squares. v is perpendicular to the coordinate axis that makes the largest angle with the
 * segment. So v has only two nonzero coefficients, and in a planar tree w has only one.
 *
 * The axial factor is (erf(start) + erf(end)) / 2, where start and end are the distances of x from
 * the two ends, positive inwards. With step(u) = (1 + erf u) / 2 it is step(start) + step(end) - 1.
 * Where one step is 1, the axial factor is the other step; where both are 1, it is 1. erf u is
 * replaced by tanh of the odd polynomial of u that minimises the maximum error over all u for its
 * degree. Then step(u) = 1 / (1 + exp(-2 polynomial)) takes one exp.
 *
 * If segments blend in groups, a cell has the groups of its terms, and its function is that of the
 * group with the largest sum, so that the surface is the union of the groups' surfaces. */
#include "field/field.h"

/* -2 times the coefficients of u, u^3, u^5, ... of the polynomial. */
const double erf_forms[][ERF_TERMS] = {
    [ERF_FAST] = {-2.2593813716768, -0.199532717478024, 0, 0, 0},
    [ERF_EXACT] = {-2.2567159143614, -0.20586869074822, 0.00099789952449538, 0.00082826271063574,
                   -6.4207848748694e-5},
};

/* An upper bound, at most 11 % too large, of each form's error over all u. tests/unit/cells_test.c
 * measures the errors. */
double erf_form_error(ErfForm form)
{
    return form == ERF_FAST ? 2.85e-4 : 3e-6;
}

/* An error p of the potential moves the surface by p / (4 FIELD_LEVEL) = 1.85 p radii. A term is in
 * error by at most half of the error of erf, so the first term allows for three terms. The second
 * allows for ten ends or terms of up to 1e-6 that a cell leaves out. */
double cell_displacement(double radius_mm, ErfForm form)
{
    return (3 * erf_form_error(form) + 2e-5) * radius_mm;
}

/* Returns the function c direction . (x - origin). Its coefficients are rounded to 12 digits of c,
 * and its offset to 1e-10, so that numbers that should be equal are equal to the last bit:
 * POV-Ray's time to read a scene grows with the square of the number of different constants. */
static Linear linear(Vec3 direction, double c, Vec3 origin)
{
    double unit = elementary_pow(10, 11 - floor(elementary_log10(c)));
    Vec3 k = {round(direction.x * c * unit) / unit, round(direction.y * c * unit) / unit,
              round(direction.z * c * unit) / unit};
    return (Linear){{k.x, k.y, k.z, round(-vec3_dot(k, origin) * 1e10) / 1e10}};
}

/* Returns the coordinate axis that makes the largest angle with `axis`. */
static Vec3 least_along(Vec3 axis)
{
    double x = fabs(axis.x), y = fabs(axis.y), z = fabs(axis.z);
    return z <= x && z <= y ? vec3(0, 0, 1) : y <= x ? vec3(0, 1, 0) : vec3(1, 0, 0);
}

TermForm term_form(const FieldSegment *segment)
{
    double c = potential_k(segment->radius_mm);
    Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    Vec3 v = vec3_normalized(vec3_cross(axis, least_along(axis)));
    return (TermForm){linear(v, c, segment->a), linear(vec3_cross(v, axis), c, segment->a),
                      linear(axis, c, segment->a), linear(vec3_scale(axis, -1), c, segment->b)};
}

static double linear_at(const Linear *linear, Vec3 x)
{
    const double *k = linear->k;
    return x.x * k[0] + x.y * k[1] + x.z * k[2] + k[3];
}

static double step_form(double u, ErfForm form)
{
    const double *k = erf_forms[form];
    double exponent =
        form == ERF_FAST
            ? u * (u * u * k[1] + k[0])
            : u * ((((u * u * k[4] + k[3]) * u * u + k[2]) * u * u + k[1]) * u * u + k[0]);
    return 1 / (elementary_exp(exponent) + 1);
}

double term_form_value(const TermForm *term, TermPart part, ErfForm form, Vec3 x)
{
    double v = linear_at(&term->v, x), w = linear_at(&term->w, x);
    double gauss = elementary_exp(-(v * v + w * w));
    switch (part) {
    case TERM_BOTH_ENDS:
        return gauss * (step_form(linear_at(&term->start, x), form) +
                        step_form(linear_at(&term->end, x), form) - 1);
    case TERM_START:
        return gauss * step_form(linear_at(&term->start, x), form);
    case TERM_END:
        return gauss * step_form(linear_at(&term->end, x), form);
    case TERM_MIDDLE:
        break;
    }
    return gauss;
}

const uint32_t *cell_group(const CellTree *cells, const Cell *cell, uint32_t group, uint32_t *n)
{
    size_t number = cell->first_group + group;
    size_t first = number > 0 ? cells->group_ends[number - 1] : 0;
    *n = (uint32_t)(cells->group_ends[number] - first);
    return cells->members + first;
}

static double term_at(const CellTree *cells, const CellTerm *term, Vec3 x)
{
    return term_form_value(&cells->forms[term->segment], (TermPart)term->part, cells->erf, x);
}

/* A sum of terms of a cell, and the largest of these terms. */
typedef struct TermSum {
    double phi, largest;
    uint32_t segment; /* of the largest term */
    uint32_t group;   /* index in the cell of the group that was summed; 0 if the cell has none */
} TermSum;

/* Sums n of the terms: those at these positions, or, if positions is NULL, the first n. */
static TermSum sum_terms(const CellTree *cells, const CellTerm *terms, const uint32_t *positions,
                         uint32_t n, Vec3 x)
{
    TermSum sum = {.largest = -1};
    for (uint32_t i = 0; i < n; i++) {
        const CellTerm *term = &terms[positions ? positions[i] : i];
        double value = term_at(cells, term, x);
        sum.phi += value;
        if (value > sum.largest) {
            sum.largest = value;
            sum.segment = term->segment;
        }
    }
    return sum;
}

/* Returns the largest of the sums of the cell's groups at x; on a tie, the first. */
static TermSum largest_sum(const CellTree *cells, const Cell *cell, Vec3 x)
{
    const CellTerm *terms = cells->terms + cell->first;
    if (cell->n_groups == 0)
        return sum_terms(cells, terms, NULL, cell->count, x);
    TermSum best = {.phi = -1};
    for (uint32_t group = 0; group < cell->n_groups; group++) {
        uint32_t n;
        const uint32_t *positions = cell_group(cells, cell, group, &n);
        TermSum sum = sum_terms(cells, terms, positions, n, x);
        sum.group = group;
        best = sum.phi > best.phi ? sum : best;
    }
    return best;
}

double cell_function(const CellTree *cells, const Cell *cell, Vec3 x)
{
    if (cell_is_tube(cells, cell)) { /* the log form of exp(-(v^2 + w^2)) */
        const TermForm *form = &cells->forms[cells->terms[cell->first].segment];
        double v = linear_at(&form->v, x), w = linear_at(&form->w, x);
        return (sqrt(v * v + w * w) * TUBE_SLOPE - 2) * cell->scale;
    }
    return potential_log_form(largest_sum(cells, cell, x).phi) * cell->scale;
}

uint32_t cell_largest_term(const CellTree *cells, const Cell *cell, Vec3 x)
{
    return largest_sum(cells, cell, x).segment;
}

/* If segments without a value have more than half of the weight, the point has no value either. */
double cell_mean(const CellTree *cells, const Cell *cell, const FieldSegment *segments,
                 const double *values, Vec3 x)
{
    uint32_t n = cell->count;
    const uint32_t *positions =
        cell->n_groups ? cell_group(cells, cell, largest_sum(cells, cell, x).group, &n) : NULL;
    double all = 0, known = 0, sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        const CellTerm *term = &cells->terms[cell->first + (positions ? positions[i] : i)];
        double weight = term_at(cells, term, x), value = values[segments[term->segment].segment];
        all += weight;
        if (isnan(value))
            continue;
        known += weight;
        sum += weight * value;
    }
    return 2 * known >= all && known > 0 ? sum / known : (double)NAN;
}
