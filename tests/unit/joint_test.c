/* Hits of rays with joints, compared with brute force. */
#include "geom/geom.h"
#include "unit.h"

#include "base/base.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Vec3 unit(Random *random)
{
    for (;;) {
        double x = number(random, -1, 1), y = number(random, -1, 1);
        Vec3 v = vec3(x, y, number(random, -1, 1));
        double length = vec3_length(v);
        if (length > 0.1 && length <= 1)
            return vec3_scale(v, 1 / length);
    }
}

typedef struct Discs {
    Vec3 center[2], axis[2];
    double radius[2];
} Discs;

/* Discs at the ends of two vessels that meet at a point, cut back far enough that each lies on one
 * side of the other's plane: by no more than that when `tight`, which makes the inner sides meet in
 * a point. */
static Discs throw_discs(Random *random, bool tight)
{
    for (;;) {
        Vec3 place = vec3_scale(unit(random), 5), in = unit(random), out = unit(random);
        double cosine = -vec3_dot(in, out), sine = vec3_length(vec3_cross(in, out));
        if (cosine > 0.5 || sine < 0.02)
            continue;
        double r = number(random, 0.1, 2), s = number(random, 0.3, 1) * r;
        double cut_in = fmax(0, (s + r * cosine) / sine),
               cut_out = fmax(0, (r + s * cosine) / sine);
        if (!tight) {
            cut_in += number(random, 0, 2);
            cut_out += number(random, 0, 2);
        }
        if (cut_in < cut_out * cosine + s * sine || cut_out < cut_in * cosine + r * sine)
            continue;
        return (Discs){{vec3_add_scaled(place, in, -cut_in), vec3_add_scaled(place, out, cut_out)},
                       {in, out},
                       {r, s}};
    }
}

static JointFrame frame_of(const Discs *discs)
{
    return joint_frame(discs->center, discs->axis, discs->radius);
}

/* Whether x lies in the solid between the discs and the rulings, found through the ellipses of
 * equal l, by bisection for l: no root of any polynomial. */
static bool within(const JointFrame *joint, const Discs *discs, Vec3 x)
{
    if (vec3_dot(vec3_sub(x, discs->center[0]), discs->axis[0]) < 0 ||
        vec3_dot(vec3_sub(x, discs->center[1]), discs->axis[1]) > 0)
        return false;
    double low = 0, high = 1;
    Vec3 half = {0}, from = {0};
    for (int i = 0; i < 60; i++) {
        double l = (low + high) / 2;
        half = vec3_add_scaled(joint->across, joint->across_change, l);
        from = vec3_sub(x, vec3_add_scaled(joint->base, joint->span, l));
        /* beyond the plane of l, seen along the first axis */
        Vec3 normal = vec3_cross(half, joint->side);
        if (vec3_dot(from, normal) > 0)
            low = l;
        else
            high = l;
    }
    double along = vec3_dot(from, half) / vec3_dot(half, half);
    double up = vec3_dot(from, joint->side) / (joint->radius + joint->radius_change * low);
    return along * along + up * up < 1;
}

/* A ray towards the joint from `away` mm before it; one in three is square to both axes. */
static Ray throw_ray(Random *random, const JointFrame *joint, int i, double away)
{
    double cosine = number(random, -1, 1), sine = number(random, -1, 1);
    Vec3 target = joint_point(joint, cosine, sine, number(random, -0.2, 1.2));
    Vec3 direction = i % 3 ? unit(random) : joint->side;
    return (Ray){vec3_add_scaled(target, direction, -away), direction};
}

static double off_disc(const Discs *discs, int k, Vec3 x)
{
    return fabs(vec3_dot(vec3_sub(x, discs->center[k]), discs->axis[k]));
}

static void normals_lead_from_the_inside_out(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 31);
    int checked = 0;
    for (int i = 0; i < 20000; i++) {
        Discs discs = throw_discs(&random, i % 2);
        JointFrame joint = frame_of(&discs);
        Ray ray = throw_ray(&random, &joint, i, i % 5 ? 12 : 1000);
        Hit hits[4];
        int n = hit_joint(ray, &joint, hits);
        for (int k = 0; k < n; k++) {
            Vec3 x = ray_at(ray, hits[k].t);
            assert_true(fabs(vec3_length(hits[k].normal) - 1) < 1e-12);
            if (off_disc(&discs, 0, x) < 1e-3 || off_disc(&discs, 1, x) < 1e-3)
                continue;
            assert_false(within(&joint, &discs, vec3_add_scaled(x, hits[k].normal, 1e-7)));
            assert_true(within(&joint, &discs, vec3_add_scaled(x, hits[k].normal, -1e-7)));
            checked++;
        }
    }
    assert_true(checked > 10000);
}

/* How often the ray crosses the wall or a disc for t in (from, to]. */
static int crossings_between(const Discs *discs, Ray ray, const Hit *hits, int n, double from,
                             double to)
{
    int crossings = 0;
    for (int k = 0; k < n; k++)
        crossings += hits[k].t > from && hits[k].t <= to;
    for (int k = 0; k < 2; k++) {
        double t = vec3_dot(vec3_sub(discs->center[k], ray.origin), discs->axis[k]) /
                   vec3_dot(ray.direction, discs->axis[k]);
        bool on_disc = vec3_distance(ray_at(ray, t), discs->center[k]) < discs->radius[k];
        crossings += on_disc && t > from && t <= to;
    }
    return crossings;
}

static void the_solid_is_entered_and_left_at_hits_and_discs_only(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 32);
    int met = 0;
    for (int i = 0; i < 2500; i++) {
        Discs discs = throw_discs(&random, i % 2);
        JointFrame joint = frame_of(&discs);
        double away = i % 5 ? 12 : 1000, step = 0.019;
        Ray ray = throw_ray(&random, &joint, i, away);
        Hit hits[4];
        int n = hit_joint(ray, &joint, hits);
        bool before = false;
        for (double t = away - 8; t < away + 8; t += step) {
            bool after = within(&joint, &discs, ray_at(ray, t));
            int crossings = crossings_between(&discs, ray, hits, n, t - step, t);
            if ((before != after) != (crossings % 2))
                fail_msg("joint %d: %d crossings from %d to %d at t = %g", i, crossings, before,
                         after, t);
            before = after;
            met += crossings;
        }
    }
    assert_true(met > 2500);
}

/* Axes that are the same to the last bits, or nearly: the surface is a cone. */
static void coaxial_discs_make_a_cone(void **state)
{
    (void)state;
    for (int exponent = 4; exponent <= 18; exponent++) {
        double bend = exponent == 18 ? 0 : pow(10, -exponent);
        const Vec3 center[2] = {{1, 2, 3}, {1 + 2 * bend, 2, 5}};
        const Vec3 axis[2] = {{0, 0, 1}, {sin(bend), 0, cos(bend)}};
        const double radius[2] = {1.5, 0.5};
        JointFrame joint = joint_frame(center, axis, radius);
        Hit hits[4];
        int n = hit_joint((Ray){{1, 2, -9}, {0, 0, 1}}, &joint, hits);
        assert_int_equal(n, 0); /* along the axis */
        n = hit_joint((Ray){{1, -10, 4}, {0, 1, 0}}, &joint, hits);
        assert_int_equal(n, 2);
        double nearest = fmin(hits[0].t, hits[1].t);
        assert_true(fabs(nearest - 11) < 3 * bend + 1e-9);
        n = hit_joint((Ray){{2, 2, -9}, {0, 0, 1}}, &joint, hits);
        assert_int_equal(n, 1);
        assert_true(fabs(hits[0].t - 13) < 9 * bend + 1e-9);
        assert_true(fabs(hits[0].normal.x - 2 / sqrt(5)) < 3 * bend + 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_lead_from_the_inside_out),
        cmocka_unit_test(the_solid_is_entered_and_left_at_hits_and_discs_only),
        cmocka_unit_test(coaxial_discs_make_a_cone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
