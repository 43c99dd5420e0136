/* Segments for the tests of the potential: trees, joints, chains and degenerate cases. Also the
 * potential itself, computed from its definition in long double. */
#ifndef CORCAST_TESTS_FIELD_SCENES_H
#define CORCAST_TESTS_FIELD_SCENES_H

#include "field/field.h"
#include "scene/scene.h"
#include <string.h>

enum { MAX_SEGMENTS = 64 };

typedef enum SceneKind {
    KIND_TREE,        /* random, three generations, radii by Murray's law over a decade */
    KIND_BIFURCATION, /* one joint of three */
    KIND_CHAIN,       /* a bent chain of unequal steps */
    KIND_PARALLEL,    /* vessels that touch or nearly touch along their length */
    KIND_SHORT,       /* segments shorter than their radius */
    KIND_STAR,        /* 50 segments through one point, radii over two decades */
    N_TAME_KINDS,
    KIND_WIDE_STAR = N_TAME_KINDS, /* over four */
    N_KINDS
} SceneKind;

static const char *const kind_names[N_KINDS] = {"tree",  "bifurcation", "chain",    "parallel",
                                                "short", "star",        "wide star"};

typedef struct TestScene {
    FieldSegment segments[MAX_SEGMENTS];
    Geometry geometry;
} TestScene;

static inline double uniform(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static inline Vec3 random_direction(Random *random)
{
    double z = uniform(random, -1, 1), phi = uniform(random, 0, 6.283185307179586);
    double across = sqrt(1 - z * z);
    return vec3(across * cos(phi), across * sin(phi), z);
}

static inline Vec3 random_point(Random *random, double extent)
{
    double x = uniform(random, -extent, extent), y = uniform(random, -extent, extent);
    return vec3(x, y, uniform(random, -extent, extent));
}

/* A unit vector at a right angle to `axis`. */
static inline Vec3 random_normal_to(Random *random, Vec3 axis)
{
    Vec3 v = random_direction(random);
    return vec3_normalized(vec3_add_scaled(v, axis, -vec3_dot(v, axis)));
}

static inline void put_segment(TestScene *test, Vec3 a, Vec3 b, double radius)
{
    size_t n = test->geometry.n_segments++;
    test->segments[n] = (FieldSegment){.a = a, .b = b, .radius_mm = radius, .segment = (uint32_t)n};
}

static inline void put_subtree(TestScene *test, Random *random, Vec3 from, Vec3 direction,
                               double radius, int generations)
{
    Vec3 to = vec3_add_scaled(from, direction, radius * uniform(random, 2.3, 9.7));
    put_segment(test, from, to, radius);
    if (generations == 0)
        return;
    double share = uniform(random, 0.02, 0.98);
    for (int side = 0; side < 2; side++) {
        Vec3 turned = vec3_add_scaled(direction, random_direction(random), 0.9);
        put_subtree(test, random, to, vec3_normalized(turned),
                    radius * cbrt(side ? share : 1 - share), generations - 1);
    }
}

static inline void put_chain(TestScene *test, Random *random)
{
    Vec3 at = random_point(random, 3), direction = random_direction(random);
    double radius = uniform(random, 0.4, 1.3);
    for (int i = 0; i < 14; i++) {
        Vec3 to = vec3_add_scaled(at, direction, radius * uniform(random, 0.2, 4.1));
        put_segment(test, at, to, radius);
        at = to;
        direction = vec3_normalized(vec3_add_scaled(direction, random_direction(random), 0.35));
        radius *= uniform(random, 0.85, 1.12);
    }
}

static inline void put_parallel(TestScene *test, Random *random)
{
    Vec3 at = random_point(random, 3), axis = random_direction(random);
    Vec3 across = random_normal_to(random, axis);
    double radius = uniform(random, 0.3, 0.9);
    const double gaps[] = {0, 1e-3, 0.32, 0.321, 0.5};
    for (int i = 0; i < 6; i++) {
        Vec3 from = vec3_add_scaled(at, axis, uniform(random, -2, 2));
        put_segment(test, from, vec3_add_scaled(from, axis, uniform(random, 5, 11)), radius);
        if (i < 5)
            at = vec3_add_scaled(at, across, radius * (2 + gaps[i]));
    }
}

static inline void put_short(TestScene *test, Random *random)
{
    for (int i = 0; i < 30; i++) {
        double radius = uniform(random, 0.3, 1.1), length = radius * uniform(random, 1e-3, 0.9);
        Vec3 a = random_point(random, 2.7);
        put_segment(test, a, vec3_add_scaled(a, random_direction(random), length), radius);
    }
}

static inline void put_star(TestScene *test, Random *random, double smallest)
{
    Vec3 center = random_point(random, 1);
    for (int i = 0; i < 50; i++) {
        Vec3 d = random_direction(random);
        double radius = smallest * pow(3 / smallest, random_uniform(random));
        double length = uniform(random, 1, 9);
        put_segment(test, vec3_add_scaled(center, d, -length * random_uniform(random)),
                    vec3_add_scaled(center, d, length), radius);
    }
}

static inline void make_test_scene(SceneKind kind, Random *random, TestScene *test)
{
    memset(test, 0, sizeof *test);
    test->geometry.model = SCENE_ISOSURFACE;
    test->geometry.segments = test->segments;
    switch (kind) {
    case KIND_TREE:
        put_subtree(test, random, random_point(random, 2), random_direction(random), 2.385, 4);
        break;
    case KIND_BIFURCATION:
        put_subtree(test, random, random_point(random, 2), random_direction(random), 1.37, 1);
        break;
    case KIND_CHAIN:
        put_chain(test, random);
        break;
    case KIND_PARALLEL:
        put_parallel(test, random);
        break;
    case KIND_SHORT:
        put_short(test, random);
        break;
    default:
        put_star(test, random, kind == KIND_STAR ? 0.03 : 3e-4);
    }
}

typedef struct LongVec3 {
    long double x, y, z;
} LongVec3;

/* The term at x by its definition, and its gradient unless that is NULL. */
static inline long double exact_term(const FieldSegment *segment, LongVec3 x, LongVec3 *gradient)
{
    long double s = (long double)segment->radius_mm / 2;
    long double ux = (long double)segment->b.x - (long double)segment->a.x;
    long double uy = (long double)segment->b.y - (long double)segment->a.y;
    long double uz = (long double)segment->b.z - (long double)segment->a.z;
    long double length = sqrtl(ux * ux + uy * uy + uz * uz);
    ux /= length;
    uy /= length;
    uz /= length;
    long double px = x.x - (long double)segment->a.x, py = x.y - (long double)segment->a.y,
                pz = x.z - (long double)segment->a.z;
    long double t = px * ux + py * uy + pz * uz;
    px -= t * ux;
    py -= t * uy;
    pz -= t * uz;
    long double d2 = px * px + py * py + pz * pz;
    if (d2 > 200 * s * s && !gradient)
        return 0; /* below e^-100 */
    long double gauss = expl(-d2 / (2 * s * s)), c = sqrtl(2) * s;
    long double axial = (t < 0        ? erfcl(-t / c) - erfcl((length - t) / c)
                         : t > length ? erfcl((t - length) / c) - erfcl(t / c)
                                      : erfl((length - t) / c) + erfl(t / c)) /
                        2;
    long double term = gauss * axial;
    if (gradient) {
        long double along = gauss / (sqrtl(2 * acosl(-1.0L)) * s) *
                            (expl(-t * t / (c * c)) - expl(-(length - t) * (length - t) / (c * c)));
        long double radial = -term / (s * s);
        *gradient = (LongVec3){radial * px + along * ux, radial * py + along * uy,
                               radial * pz + along * uz};
    }
    return term;
}

static inline LongVec3 long_vec3(Vec3 x)
{
    return (LongVec3){(long double)x.x, (long double)x.y, (long double)x.z};
}

/* Adds a component of a blob, from POV-Ray's definition: a tube from a to b, or a ball where these
 * are the same; and its gradient unless that is NULL. */
static inline long double add_exact_component(LongVec3 a, LongVec3 b, long double radius,
                                              long double strength, LongVec3 x, LongVec3 *gradient)
{
    long double sx = b.x - a.x, sy = b.y - a.y, sz = b.z - a.z;
    long double px = x.x - a.x, py = x.y - a.y, pz = x.z - a.z;
    long double square = sx * sx + sy * sy + sz * sz;
    long double t = square > 0 ? (px * sx + py * sy + pz * sz) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    px -= t * sx;
    py -= t * sy;
    pz -= t * sz;
    long double inside = 1 - (px * px + py * py + pz * pz) / (radius * radius);
    if (!(inside > 0))
        return 0;
    if (gradient) {
        long double pull = -4 * strength * inside / (radius * radius);
        gradient->x += pull * px;
        gradient->y += pull * py;
        gradient->z += pull * pz;
    }
    return strength * inside * inside;
}

/* The field at x of a segment of the blob, component by component, and its gradient unless that is
 * NULL. */
static inline long double exact_blob_term(const FieldSegment *segment, LongVec3 x,
                                          LongVec3 *gradient)
{
    LongVec3 a = long_vec3(segment->a), b = long_vec3(segment->b);
    long double r = (long double)segment->radius_mm, sum = 0;
    long double length =
        sqrtl((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y) + (b.z - a.z) * (b.z - a.z));
    if (gradient)
        *gradient = (LongVec3){0, 0, 0};
    for (int i = 0; i < BLOB_TUBES; i++) {
        long double radius = (long double)blob_shape.tube[i].radius * r;
        long double strength = (long double)blob_shape.tube[i].strength;
        sum += add_exact_component(a, b, radius, strength, x, gradient);
        sum += add_exact_component(a, a, radius, -strength / 2, x, gradient);
        sum += add_exact_component(b, b, radius, -strength / 2, x, gradient);
    }
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        for (int side = -1; side <= 1; side += 2) {
            long double h = side * (long double)blob_shape.bead[i].offset * r / length;
            long double radius = (long double)blob_shape.bead[i].radius * r;
            long double strength = side * (long double)blob_shape.bead[i].strength;
            LongVec3 at_a = {a.x + h * (b.x - a.x), a.y + h * (b.y - a.y), a.z + h * (b.z - a.z)};
            LongVec3 at_b = {b.x - h * (b.x - a.x), b.y - h * (b.y - a.y), b.z - h * (b.z - a.z)};
            sum += add_exact_component(at_a, at_a, radius, strength, x, gradient);
            sum += add_exact_component(at_b, at_b, radius, strength, x, gradient);
        }
    return sum;
}

#endif
