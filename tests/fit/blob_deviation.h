/* Measures how far the blob is from the surface of the potential, at bifurcations and free
 * ends. For points of that surface it computes the distance along the normal to the blob's
 * surface, and the angle between both normals. */
#ifndef CORCAST_TESTS_BLOB_DEVIATION_H
#define CORCAST_TESTS_BLOB_DEVIATION_H

#include "field/field.h"
#include <math.h>

enum { N_RATIOS = 5, N_ANGLES = 6, MAX_ENDS = 3 };
static const double deviation_ratios[N_RATIOS] = {1, 0.8, 0.6, 0.4, 0.25};
static const double deviation_angles[N_ANGLES] = {40, 60, 80, 100, 120, 150};

/* Segments that begin at the origin. */
typedef struct Fork {
    FieldSegment segments[MAX_ENDS];
    int n;
} Fork;

/* A parent of radius 1 and two daughters, thin over thick radius as given, by Murray's law with
 * gamma = 3; the angle between the daughters is split so that r^2 sin is the same on both sides of
 * the parent's line. Lengths are in radii of each. */
static inline Fork fork_of(double ratio, double angle_deg, double length)
{
    double angle = angle_deg * acos(-1) / 180;
    double thick = pow(1 + ratio * ratio * ratio, -1.0 / 3), thin = ratio * thick;
    double turn = atan2(ratio * ratio * sin(angle), 1 + ratio * ratio * cos(angle));
    Fork fork = {.n = 3};
    const double radius[] = {1, thick, thin}, towards[] = {acos(-1), turn, turn - angle};
    for (int i = 0; i < 3; i++) {
        Vec3 axis = vec3(sin(towards[i]), cos(towards[i]), 0);
        fork.segments[i] =
            (FieldSegment){.b = vec3_scale(axis, length * radius[i]), .radius_mm = radius[i]};
    }
    return fork;
}

static inline Fork free_end(double length)
{
    return (Fork){{{.b = {0, length, 0}, .radius_mm = 1}}, 1};
}

/* The potential over its level, and its gradient; the segment whose term is largest. */
static inline double fork_potential(const Fork *fork, Vec3 x, Vec3 *gradient, int *largest)
{
    double sum = 0, most = -1;
    *largest = 0;
    *gradient = vec3(0, 0, 0);
    for (int i = 0; i < fork->n; i++) {
        Vec3 part;
        double term = potential_term_gradient(&fork->segments[i], x, &part);
        *gradient = vec3_add_scaled(*gradient, part, 1 / FIELD_LEVEL);
        sum += term / FIELD_LEVEL;
        if (term > most) {
            most = term;
            *largest = i;
        }
    }
    return sum;
}

/* A point of the surface. */
typedef struct Spot {
    Vec3 x, normal;
    double radius_mm; /* of the segment whose term is largest there */
} Spot;

/* Where the way from a point on an axis outwards leaves the surface: false where it does not begin
 * within, or leads into another vessel at once. */
static inline bool find_spot(const Fork *fork, Vec3 from, Vec3 outwards, double radius, Spot *spot)
{
    Vec3 gradient;
    int largest;
    double low = 0, high = 0;
    if (fork_potential(fork, from, &gradient, &largest) < 1)
        return false;
    while (high < 6 * radius &&
           fork_potential(fork, vec3_add_scaled(from, outwards, high), &gradient, &largest) > 1) {
        low = high;
        high += 0.05 * radius;
    }
    for (int i = 0; i < 50; i++) {
        double middle = (low + high) / 2;
        Vec3 x = vec3_add_scaled(from, outwards, middle);
        if (fork_potential(fork, x, &gradient, &largest) > 1)
            low = middle;
        else
            high = middle;
    }
    spot->x = vec3_add_scaled(from, outwards, low);
    double value = fork_potential(fork, spot->x, &gradient, &largest);
    spot->normal = vec3_scale(vec3_normalized(gradient), -1);
    spot->radius_mm = fork->segments[largest].radius_mm;
    return fabs(value - 1) < 1e-9;
}

enum { MAX_SPOTS = 2048, SPOT_SIDES = 16 };

/* Points around each segment from its end to its middle, at most 4 radii along; in a step of `step`
 * radii. How many: at most MAX_SPOTS. */
static inline int find_spots(const Fork *fork, double step, Spot spots[MAX_SPOTS])
{
    int n = 0;
    for (int i = 0; i < fork->n; i++) {
        const FieldSegment *segment = &fork->segments[i];
        double length = vec3_length(segment->b), radius = segment->radius_mm;
        Vec3 axis = vec3_scale(segment->b, 1 / length), side = vec3(-axis.y, axis.x, 0);
        double from = fork->n == 1 ? -0.54 : 0;
        for (double t = from; t <= fmin(4, length / radius / 2) && n < MAX_SPOTS; t += step)
            for (int k = 0; k < SPOT_SIDES && n < MAX_SPOTS; k++) {
                double turn = 2 * acos(-1) * k / SPOT_SIDES;
                Vec3 outwards =
                    vec3_add_scaled(vec3_scale(side, cos(turn)), vec3(0, 0, 1), sin(turn));
                n += find_spot(fork, vec3_scale(axis, t * radius), outwards, radius, &spots[n]);
            }
    }
    return n;
}

typedef struct ForkBlob {
    BlobComponent components[MAX_ENDS][BLOB_COMPONENTS];
    int n;
} ForkBlob;

static inline ForkBlob fork_blob(const BlobShape *shape, const Fork *fork)
{
    ForkBlob blob = {.n = fork->n};
    for (int i = 0; i < fork->n; i++)
        blob_components(shape, &fork->segments[i], blob.components[i]);
    return blob;
}

static inline double fork_blob_at(const ForkBlob *blob, Vec3 x, Vec3 *gradient)
{
    double sum = 0;
    *gradient = vec3(0, 0, 0);
    for (int i = 0; i < blob->n; i++) {
        Vec3 part;
        sum += blob_components_at(blob->components[i], x, &part);
        *gradient = vec3_add(*gradient, part);
    }
    return sum;
}

typedef struct Deviation {
    double radii;   /* outwards, over the radius there; at most 0.3 either way */
    double degrees; /* between the normals */
} Deviation;

/* By Newton's method along the normal. */
static inline Deviation deviation_at(const ForkBlob *blob, const Spot *spot)
{
    double way = 0, limit = 0.3 * spot->radius_mm;
    Vec3 gradient;
    for (int i = 0; i < 12; i++) {
        Vec3 x = vec3_add_scaled(spot->x, spot->normal, way);
        double step = (1 - fork_blob_at(blob, x, &gradient)) / vec3_dot(gradient, spot->normal);
        double bounded = fmax(-limit / 4, fmin(limit / 4, step));
        way = fmax(-limit, fmin(limit, way + bounded));
        if (fabs(step) < 1e-9)
            break;
    }
    double cosine = -vec3_dot(gradient, spot->normal) / vec3_length(gradient);
    return (Deviation){way / spot->radius_mm, acos(fmin(1, cosine)) * 180 / acos(-1)};
}

/* The largest of each over all spots of a fork; of the distance with its sign. */
static inline Deviation worst_deviation(const BlobShape *shape, const Fork *fork, const Spot *spots,
                                        int n)
{
    ForkBlob blob = fork_blob(shape, fork);
    Deviation worst = {0, 0};
    for (int i = 0; i < n; i++) {
        Deviation here = deviation_at(&blob, &spots[i]);
        if (fabs(here.radii) > fabs(worst.radii))
            worst.radii = here.radii;
        worst.degrees = fmax(worst.degrees, here.degrees);
    }
    return worst;
}

/* How far the blob of a lone segment of radius 1 reaches beyond its end. */
static inline double overshoot_of(const BlobShape *shape)
{
    Fork fork = free_end(8);
    ForkBlob blob = fork_blob(shape, &fork);
    double low = 0, high = 2;
    Vec3 gradient;
    for (int i = 0; i < 50; i++) {
        double middle = (low + high) / 2;
        if (fork_blob_at(&blob, vec3(0, -middle, 0), &gradient) > 1)
            low = middle;
        else
            high = middle;
    }
    return low;
}

#endif
