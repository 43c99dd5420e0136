/* One step of Newton's method for the lower bound: minimises the target in the states (position and
 * pressure drop) of all bifurcations (joints) together.
 *
 * Every segment costs phi = factor l^(1 + a) d^-a, with its length l and its pressure drop d. This
 * is jointly convex in the states of both its ends [docs/METHODS.md 1.5]. Its second derivatives H
 * are a 4 x 4 matrix. The matrix of the whole tree is that of springs H along its segments. They
 * are eliminated from the outlets to the inlets in O(n):
 *
 * Let K and b be the spring and the load that a joint's daughters hand up together, and g the
 * gradient. The joint's step s follows from its parent's step s' by (K + H) s = H s' - (b + g). The
 * joint hands up the spring K (K + H)^-1 H, which is H - H (K + H)^-1 H without its cancellation,
 * and the load H (K + H)^-1 (b + g) - g. A fixed joint hands up H and -g. */
#include "grow/bound/bound_newton.h"

#include <stdlib.h>
#include <string.h>

/* A step goes at most this share of the distance to where a pressure drop would be 0, at which the
 * cost is infinite. Closer to 1, the next steps begin where the cost is steep; smaller shares make
 * steps shorter. */
static const double most_of_drop = 0.95;
/* A step is taken if the target falls by at least this share of the fall that the slope promises
 * (Armijo's rule; 1e-4 is the usual value). */
static const double least_gain = 1e-4;
/* Maximum number of halvings of a step: 2^-40 of a step changes nothing. */
enum { MAX_HALVINGS = 40 };

static inline int entry(int row, int column)
{
    return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

Status newton_init(Newton *newton, size_t n, Err *err)
{
    TRY(mem_calloc(&newton->step, n, sizeof *newton->step, "steps", err));
    TRY(mem_calloc(&newton->load, n, sizeof *newton->load, "loads", err));
    return mem_calloc(&newton->spring, n, sizeof *newton->spring, "springs", err);
}

void newton_release(Newton *newton)
{
    free(newton->step);
    free(newton->load);
    free(newton->spring);
    *newton = (Newton){0};
}

double newton_cost(const Problem *problem, const Newton *newton, double smoothing, double part)
{
    double sum = 0;
    for (size_t i = 0; i < problem->n; i++) {
        const Joint *joint = &problem->joint[i];
        if (joint_is_inlet(joint))
            continue;
        JointDifference reach = problem_reach(problem, i, 0);
        for (int k = 0; k < STATE; k++)
            reach.by[k] += part * (newton->step[i][k] - newton->step[joint->parent][k]);
        if (!(reach.by[DROP] > 0))
            return INFINITY;
        reach.length2 = reach.by[0] * reach.by[0] + reach.by[1] * reach.by[1] +
                        reach.by[2] * reach.by[2] + smoothing * smoothing;
        sum += problem_cost(problem, i, &reach);
    }
    return sum;
}

/* Computes the first and second derivatives of the cost of segment i with respect to the state of
 * its joint. */
static void derive(const Problem *problem, size_t i, double smoothing, State gradient,
                   Symmetric curvature)
{
    const JointDifference reach = problem_reach(problem, i, smoothing);
    const double a = problem->a, drop = reach.by[DROP], cost = problem_cost(problem, i, &reach);
    const double by_place = (1 + a) * cost / reach.length2, by_drop = -a * cost / drop;
    for (int k = 0; k < SPACE_AXES; k++) {
        gradient[k] = by_place * reach.by[k];
        for (int j = 0; j <= k; j++)
            curvature[entry(k, j)] =
                by_place * ((k == j) + (a - 1) * reach.by[k] * reach.by[j] / reach.length2);
        curvature[entry(DROP, k)] = -a * by_place * reach.by[k] / drop;
    }
    gradient[DROP] = by_drop;
    curvature[entry(DROP, DROP)] = -(1 + a) * by_drop / drop;
}

static void multiply(const Symmetric matrix, const State vector, State out)
{
    for (int row = 0; row < STATE; row++) {
        out[row] = 0;
        for (int k = 0; k < STATE; k++)
            out[row] += matrix[entry(row, k)] * vector[k];
    }
}

/* Computes the Cholesky factor L of a matrix, L L' = matrix. The diagonal of `lower` has the
 * inverses of the diagonal of L. */
static void factorise(const Symmetric matrix, Symmetric lower)
{
    for (int row = 0; row < STATE; row++)
        for (int column = 0; column <= row; column++) {
            double sum = matrix[entry(row, column)];
            for (int k = 0; k < column; k++)
                sum -= lower[entry(row, k)] * lower[entry(column, k)];
            /* Rounding alone can make a pivot too small. */
            double least = 1e-15 * matrix[entry(row, row)];
            lower[entry(row, column)] =
                row == column ? 1 / sqrt(fmax(sum, least)) : sum * lower[entry(column, column)];
        }
}

/* Solves L L' out = right. */
static void solve(const Symmetric lower, const State right, State out)
{
    for (int row = 0; row < STATE; row++) {
        double sum = right[row];
        for (int k = 0; k < row; k++)
            sum -= lower[entry(row, k)] * out[k];
        out[row] = sum * lower[entry(row, row)];
    }
    for (int row = STATE; row-- > 0;) {
        double sum = out[row];
        for (int k = row + 1; k < STATE; k++)
            sum -= lower[entry(k, row)] * out[k];
        out[row] = sum * lower[entry(row, row)];
    }
}

/* Adds K A^-1 H, made symmetric, to `to`. */
static void add_in_series(const Symmetric spring, const Symmetric lower, const Symmetric curvature,
                          Symmetric to)
{
    double product[STATE][STATE];
    for (int column = 0; column < STATE; column++) {
        State right, solved;
        for (int row = 0; row < STATE; row++)
            right[row] = curvature[entry(row, column)];
        solve(lower, right, solved);
        multiply(spring, solved, product[column]);
    }
    for (int row = 0; row < STATE; row++)
        for (int column = 0; column <= row; column++)
            to[entry(row, column)] += (product[row][column] + product[column][row]) / 2;
}

/* Eliminates joint i: what it hands up is added to its parent, and what its step follows from is
 * left in its own load (b + g) and spring (L). */
static void eliminate(const Problem *problem, Newton *newton, double smoothing, size_t i)
{
    const Joint *joint = &problem->joint[i];
    double *load = newton->load[i], *spring = newton->spring[i];
    double *load_above = newton->load[joint->parent], *above = newton->spring[joint->parent];
    State gradient, solved, handed = {0};
    Symmetric curvature, sum, lower;
    derive(problem, i, smoothing, gradient, curvature);
    if (joint->is_free) {
        for (size_t k = 0; k < sizeof sum / sizeof *sum; k++)
            sum[k] = spring[k] + curvature[k];
        factorise(sum, lower);
        add_in_series(spring, lower, curvature, above);
        for (int k = 0; k < STATE; k++)
            load[k] += gradient[k];
        solve(lower, load, solved);
        multiply(curvature, solved, handed);
        memcpy(spring, lower, sizeof lower);
    } else
        for (size_t k = 0; k < sizeof curvature / sizeof *curvature; k++)
            above[k] += curvature[k];
    for (int k = 0; k < STATE; k++)
        load_above[k] += handed[k] - gradient[k];
}

/* Computes the step of joint i from its parent's step. Returns the first-order change of its
 * segment's cost along the step. */
static double descend(const Problem *problem, Newton *newton, double smoothing, size_t i)
{
    const Joint *joint = &problem->joint[i];
    const double *above = newton->step[joint->parent];
    State gradient, right;
    Symmetric curvature;
    derive(problem, i, smoothing, gradient, curvature);
    if (joint->is_free) {
        multiply(curvature, above, right);
        for (int k = 0; k < STATE; k++)
            right[k] -= newton->load[i][k];
        solve(newton->spring[i], right, newton->step[i]);
    }
    double slope = 0;
    for (int k = 0; k < STATE; k++)
        slope += gradient[k] * (newton->step[i][k] - above[k]);
    return slope;
}

double newton_step(const Problem *problem, Newton *newton, double smoothing)
{
    memset(newton->load, 0, problem->n * sizeof *newton->load);
    memset(newton->spring, 0, problem->n * sizeof *newton->spring);
    for (size_t i = problem->n; i-- > 0;)
        if (!joint_is_inlet(&problem->joint[i]))
            eliminate(problem, newton, smoothing, i);
    double slope = 0;
    for (size_t i = 0; i < problem->n; i++)
        if (!joint_is_inlet(&problem->joint[i]))
            slope += descend(problem, newton, smoothing, i);
    return slope;
}

void newton_force(const Problem *problem, const Newton *newton, double smoothing, size_t i,
                  State force)
{
    State gradient, by;
    Symmetric curvature;
    derive(problem, i, smoothing, gradient, curvature);
    for (int k = 0; k < STATE; k++)
        by[k] = newton->step[i][k] - newton->step[problem->joint[i].parent][k];
    multiply(curvature, by, force);
    for (int k = 0; k < STATE; k++)
        force[k] += gradient[k];
}

/* Returns the part of the step at which the first pressure drop would be 0; INFINITY if none falls.
 */
static double end_of_drops(const Problem *problem, const Newton *newton)
{
    double end = INFINITY;
    for (size_t i = 0; i < problem->n; i++) {
        const Joint *joint = &problem->joint[i];
        if (joint_is_inlet(joint))
            continue;
        double drop = joint->at[DROP] - problem->joint[joint->parent].at[DROP];
        double falls = newton->step[joint->parent][DROP] - newton->step[i][DROP];
        if (falls > 0)
            end = fmin(end, drop / falls);
    }
    return end;
}

bool newton_move(Problem *problem, const Newton *newton, double smoothing, double slope)
{
    double before = newton_cost(problem, newton, smoothing, 0);
    double part = fmin(1, most_of_drop * end_of_drops(problem, newton));
    for (int halvings = 0; halvings < MAX_HALVINGS; halvings++, part /= 2) {
        double after = newton_cost(problem, newton, smoothing, part);
        if (!(after < before + least_gain * part * slope))
            continue;
        for (size_t i = 0; i < problem->n; i++)
            for (int k = 0; k < STATE; k++)
                problem->joint[i].at[k] += part * newton->step[i][k];
        return true;
    }
    return false;
}
