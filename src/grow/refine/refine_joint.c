/* Moves all bifurcations of a tree at once towards the best positions (the joint move).
 *
 * With the weights dS_root / d length held constant, the target S_root is a weighted sum of
 * lengths, which is convex in all positions together. Lengths are smoothed, sqrt(l^2 +
 * smoothing^2), because a length has no derivative at 0. One step of Newton's method takes all
 * bifurcations to the minimum of the second-order model. The matrix of the step is that of springs
 * along the segments; it is eliminated from the terminals to the inlet in O(n), as in
 * bound_newton.c. A few steps, each with new weights, give the goals (find_goals). Segments that
 * would be shorter than wide are stretched.
 *
 * Moving bifurcations one by one gets stuck far from the optimum where bifurcations should merge:
 * each waits for the other. On the path to the goals the rules are kept [refine_approach.c]. */
#include "grow/refine/refine_joint.h"

#include <stdlib.h>
#include <string.h>

/* Smoothing relative to the mean length of the segments. Less smoothing needs more steps; more
 * smoothing moves the goals away from the optimum. The sweeps that follow find the rest. */
static const double smoothing_share = 0.1;
/* Segments shorter than need_radii times their radius are stretched, as by a spring that is `push`
 * times as stiff as their weight divided by that length. The rule needs 2 radii; the spare 0.4
 * leaves room for radii that change. A stiffer spring makes steps shorter. */
static const double need_radii = 2.4, push = 10;
/* Maximum number of Newton steps, and of halvings of a step that does not gain enough. */
enum { STEPS = 8, HALVINGS = 5 };
/* A step is taken if it gains this share of what its first derivatives promise (Armijo's rule). */
static const double least_share = 0.1;
/* A step that gains less than this share of S_root is the last. */
static const double least_gain = 1e-5;
/* If keeping the rules on the path costs more than the goals gain, all nodes try this share of the
 * path, up to SCALES times: shorter moves get in each other's way less. */
static const double next_scale = 0.3;
enum { SCALES = 3 };

Status joints_init(Joints *joints, size_t nodes, Err *err)
{
    TRY(mem_calloc(&joints->order, nodes, sizeof *joints->order, "segments", err));
    TRY(mem_calloc(&joints->parent, nodes, sizeof *joints->parent, "nodes", err));
    TRY(mem_calloc(&joints->start, nodes, sizeof *joints->start, "places", err));
    TRY(mem_calloc(&joints->goal, nodes, sizeof *joints->goal, "places", err));
    TRY(mem_calloc(&joints->place, nodes, sizeof *joints->place, "places", err));
    TRY(mem_calloc(&joints->spring, nodes, sizeof *joints->spring, "springs", err));
    return mem_calloc(&joints->mark, nodes, sizeof *joints->mark, "nodes", err);
}

void joints_release(Joints *joints)
{
    free(joints->order);
    free(joints->parent);
    free(joints->start);
    free(joints->goal);
    free(joints->place);
    free(joints->spring);
    free(joints->mark);
    *joints = (Joints){0};
}

/* Returns the first derivatives of the cost of segment i with respect to its distal end, and sets
 * `curvature` to the second derivatives. */
static Vec3 derive(const Joints *joints, const Arbor *arbor, int32_t i, double curvature[6])
{
    const Shape *shape = &arbor->shape[i];
    Vec3 by = vec3_sub(shape->to, shape->from);
    double length2 = vec3_dot(by, by) + joints->smoothing * joints->smoothing,
           length = sqrt(length2);
    Reduced reduced = arbor_reduce(arbor, i);
    double burden = arbor->branch[i].flow * arbor_viscosity(arbor, i);
    double weight = law_length_weight(&arbor->law, &reduced, arbor->marginal[i].adjoint, burden);
    weight = fmax(weight, 1e-12 * reduced.rho_lambda);
    double need = need_radii * joints->level * arbor_stored_radius(arbor, i);
    double stiff = length < need ? push * weight / need : 0;
    weight /= length;
    curvature[0] = weight * (1 - by.x * by.x / length2);
    curvature[1] = -weight * by.y * by.x / length2;
    curvature[2] = weight * (1 - by.y * by.y / length2);
    curvature[3] = -weight * by.z * by.x / length2;
    curvature[4] = -weight * by.z * by.y / length2;
    curvature[5] = weight * (1 - by.z * by.z / length2);
    double along = stiff / length2;
    curvature[0] += along * by.x * by.x;
    curvature[1] += along * by.y * by.x;
    curvature[2] += along * by.y * by.y;
    curvature[3] += along * by.z * by.x;
    curvature[4] += along * by.z * by.y;
    curvature[5] += along * by.z * by.z;
    return vec3_scale(by, weight + stiff * (length - need) / length);
}

/* Returns the product of a symmetric matrix and a vector. A matrix m stores its lower triangle row
 * by row: xx, yx, yy, zx, zy, zz. */
static Vec3 times(const double m[6], Vec3 v)
{
    return vec3(m[0] * v.x + m[1] * v.y + m[3] * v.z, m[1] * v.x + m[2] * v.y + m[4] * v.z,
                m[3] * v.x + m[4] * v.y + m[5] * v.z);
}

/* Computes the inverse of a symmetric matrix whose pivots are above 0. */
static void invert(const double m[6], double out[6])
{
    double a = m[2] * m[5] - m[4] * m[4], b = m[4] * m[3] - m[1] * m[5];
    double c = m[1] * m[4] - m[2] * m[3];
    double scale = 1 / (m[0] * a + m[1] * b + m[3] * c);
    out[0] = a * scale;
    out[1] = b * scale;
    out[2] = (m[0] * m[5] - m[3] * m[3]) * scale;
    out[3] = c * scale;
    out[4] = (m[1] * m[3] - m[0] * m[4]) * scale;
    out[5] = (m[0] * m[2] - m[1] * m[1]) * scale;
}

/* Adds K A^-1 H, made symmetric, to `to`: the spring of two springs in series, where A = K + H, and
 * `inverse` is A^-1. */
static void add_in_series(const double k[6], const double inverse[6], const double h[6],
                          double to[6])
{
    static const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double product[3][3];
    for (int column = 0; column < 3; column++) {
        Vec3 row = times(k, times(inverse, times(h, unit[column])));
        for (int axis = 0; axis < 3; axis++)
            product[axis][column] = vec3_component(row, axis);
    }
    for (int row = 0, at = 0; row < 3; row++)
        for (int column = 0; column <= row; column++, at++)
            to[at] += (product[row][column] + product[column][row]) / 2;
}

/* Eliminates the node at the end of segment i: adds its spring and its gradient, as its parent
 * feels them, to those of the parent. Leaves the inverse of its matrix in its spring, from which
 * find_step computes its step. */
static void eliminate(Joints *joints, const Arbor *arbor, int32_t i)
{
    int32_t above = arbor->branch[i].parent;
    JointSpring *own = &joints->spring[i], *mother = &joints->spring[above];
    double curvature[6], sum[6], inverse[6];
    Vec3 pull = derive(joints, arbor, i, curvature), handed = vec3(0, 0, 0);
    if (arbor->branch[i].child[0] < 0) {
        for (int k = 0; k < 6; k++)
            mother->matrix[k] += curvature[k];
    } else {
        for (int k = 0; k < 6; k++)
            sum[k] = own->matrix[k] + curvature[k];
        invert(sum, inverse);
        add_in_series(own->matrix, inverse, curvature, mother->matrix);
        own->gradient = vec3_add(own->gradient, pull);
        Vec3 alone = times(inverse, own->gradient);
        joints->predicted_gain += vec3_dot(own->gradient, alone);
        handed = times(curvature, alone);
        memcpy(own->matrix, inverse, sizeof inverse);
    }
    mother->gradient = vec3_add(mother->gradient, vec3_sub(handed, pull));
}

/* Computes the step of every bifurcation, and the gain that it promises. */
static void find_step(Joints *joints, const Arbor *arbor)
{
    joints->predicted_gain = 0;
    memset(joints->spring, 0, arbor->n * sizeof *joints->spring);
    for (size_t k = joints->n; k-- > 0;)
        eliminate(joints, arbor, joints->order[k]);
    for (size_t k = 0; k < joints->n; k++) {
        int32_t i = joints->order[k];
        double curvature[6];
        if (arbor->branch[i].child[0] < 0)
            continue;
        derive(joints, arbor, i, curvature);
        JointSpring *own = &joints->spring[i];
        Vec3 right = times(curvature, joints->spring[arbor->branch[i].parent].step);
        own->step = times(own->matrix, vec3_sub(right, own->gradient));
    }
}

/* Moves the goals by the largest tried part of the step that lowers S_root by enough. Returns false
 * if no part does, or if the gain is small. */
static bool take_step(Joints *joints, Arbor *arbor)
{
    double before = arbor_cost(arbor), part = 1;
    for (int k = 0; k < HALVINGS; k++, part /= 2) {
        for (size_t i = 0; i < arbor->n; i++)
            joints->place[i] = vec3_add_scaled(joints->goal[i], joints->spring[i].step, part);
        arbor_arrange(arbor, joints->parent, joints->place);
        double gain = before - arbor_cost(arbor);
        if (!(gain > least_share * part * joints->predicted_gain))
            continue;
        memcpy(joints->goal, joints->place, arbor->n * sizeof *joints->goal);
        return gain > before * least_gain;
    }
    arbor_arrange(arbor, joints->parent, joints->goal);
    return false;
}

/* Records the arbor as it is before the move. */
static void begin(Joints *joints, const Arbor *arbor, const Clearance *clearance)
{
    joints->n = 0;
    for (int32_t i = arbor_first(arbor); i != 0; i = arbor_next(arbor, i))
        joints->order[joints->n++] = i;
    for (size_t i = 0; i < arbor->n; i++) {
        joints->parent[i] = arbor->branch[i].parent;
        joints->start[i] = arbor->shape[i].to;
        joints->mark[i].was_clear = clearance_is_kept(clearance, arbor, (int32_t)i);
    }
    memcpy(joints->goal, joints->start, arbor->n * sizeof *joints->goal);
    double length = 0;
    for (size_t k = 0; k < joints->n; k++)
        length += arbor->branch[joints->order[k]].length;
    joints->smoothing = smoothing_share * length / (double)joints->n;
    joints->level = clearance->level;
}

/* Makes steps until one gains little. Returns false if S_root is not lower afterwards. */
static bool find_goals(Joints *joints, Arbor *arbor)
{
    double before = arbor_cost(arbor);
    for (int k = 0; k < STEPS; k++) {
        arbor_refresh(arbor);
        find_step(joints, arbor);
        if (!take_step(joints, arbor))
            break;
    }
    return arbor_cost(arbor) < before;
}

Status joint_move(Joints *joints, Arbor *arbor, Clearance *clearance, bool *kept, Err *err)
{
    double before = arbor_cost(arbor), fraction = 1;
    *kept = false;
    TRY(clearance_reserve(clearance, arbor, err));
    begin(joints, arbor, clearance);
    if (!find_goals(joints, arbor))
        return STATUS_OK;
    for (int k = 0; k < SCALES && !*kept; k++, fraction *= next_scale) {
        TRY(approach_goals(joints, arbor, clearance, fraction, kept, err));
        *kept = *kept && arbor_cost(arbor) < before;
    }
    if (*kept)
        return STATUS_OK;
    arbor_arrange(arbor, joints->parent, joints->start);
    return clearance_reserve(clearance, arbor, err);
}
