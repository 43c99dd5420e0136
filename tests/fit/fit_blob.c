/* Computes the numbers of blob_shape [src/field/blob.h; docs/METHODS.md section 2.6].
 *
 *   fit_blob                  prints how far the blob's surface is from the potential's
 *   fit_blob fit [ROUNDS]     searches the numbers again; takes minutes per round
 *
 * The search minimises the p-norm, with p rising from 24 to 96, of distance / DISTANCE and
 * angle / ANGLE over all sample points of all bifurcations. It uses the simplex method [Nelder
 * & Mead 1965] and starts from round numbers. */
#include "blob_deviation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FORKS = N_RATIOS * N_ANGLES + 1, NUMBERS = 2 * BLOB_TUBES - 1 + 3 * BLOB_BEAD_PAIRS };

/* What counts as 1: of a radius, and degrees. */
#define DISTANCE 0.03
#define ANGLE 13.0

static Fork forks[FORKS];
static Spot spots[FORKS][MAX_SPOTS];
static int n_spots[FORKS];

/* Segments are `length` of their radii long. */
static void make_forks(double length, double step)
{
    for (int i = 0; i < N_RATIOS; i++)
        for (int j = 0; j < N_ANGLES; j++)
            forks[i * N_ANGLES + j] = fork_of(deviation_ratios[i], deviation_angles[j], length);
    forks[FORKS - 1] = free_end(8);
    for (int i = 0; i < FORKS; i++)
        n_spots[i] = find_spots(&forks[i], step, spots[i]);
}

/* The numbers of a shape; the first strength follows from the others. */
static void numbers_of(const BlobShape *shape, double x[NUMBERS])
{
    int k = 0;
    for (int i = 0; i < BLOB_TUBES; i++) {
        x[k++] = shape->tube[i].radius;
        if (i)
            x[k++] = shape->tube[i].strength;
    }
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++) {
        x[k++] = shape->bead[i].offset;
        x[k++] = shape->bead[i].radius;
        x[k++] = shape->bead[i].strength;
    }
}

static BlobShape shape_of(const double x[NUMBERS])
{
    BlobShape shape;
    int k = 0;
    for (int i = 0; i < BLOB_TUBES; i++) {
        shape.tube[i].radius = x[k++];
        shape.tube[i].strength = i ? x[k++] : 0;
    }
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++) {
        shape.bead[i].offset = x[k++];
        shape.bead[i].radius = x[k++];
        shape.bead[i].strength = x[k++];
    }
    shape.tube[0].strength = blob_first_strength(&shape);
    return shape;
}

static double misfit(const double x[NUMBERS], double power)
{
    BlobShape shape = shape_of(x);
    double sum = 0;
    for (int i = 0; i < BLOB_TUBES; i++)
        if (!(shape.tube[i].radius > 1.01 && shape.tube[i].radius < 2.5))
            return 1e9;
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        if (!(shape.bead[i].radius > 0.3 && shape.bead[i].radius < 2.5))
            return 1e9;
    for (int i = 0; i < FORKS; i++) {
        ForkBlob blob = fork_blob(&shape, &forks[i]);
        for (int j = 0; j < n_spots[i]; j++) {
            Deviation here = deviation_at(&blob, &spots[i][j]);
            sum += pow(fabs(here.radii) / DISTANCE, power) + pow(here.degrees / ANGLE, power);
        }
    }
    return pow(sum / FORKS, 1 / power);
}

/* ---- the simplex method ---------------------------------------------------------------------- */

typedef struct Corner {
    double x[NUMBERS], y;
} Corner;

static int by_misfit(const void *a, const void *b)
{
    double x = ((const Corner *)a)->y, y = ((const Corner *)b)->y;
    return (x > y) - (x < y);
}

/* The corner at center + factor (from - center). */
static Corner corner_at(const double center[NUMBERS], const Corner *from, double factor,
                        double power)
{
    Corner corner;
    for (int k = 0; k < NUMBERS; k++)
        corner.x[k] = center[k] + factor * (from->x[k] - center[k]);
    corner.y = misfit(corner.x, power);
    return corner;
}

static void improve(double x[NUMBERS], double power, int steps)
{
    Corner s[NUMBERS + 1];
    for (int i = 0; i <= NUMBERS; i++) {
        memcpy(s[i].x, x, sizeof s[i].x);
        if (i)
            s[i].x[i - 1] += 0.06 * (fabs(x[i - 1]) + 0.2);
        s[i].y = misfit(s[i].x, power);
    }
    for (int step = 0; step < steps; step++) {
        qsort(s, NUMBERS + 1, sizeof *s, by_misfit);
        Corner *worst = &s[NUMBERS];
        if (worst->y - s[0].y < 1e-6)
            break;
        double center[NUMBERS] = {0};
        for (int i = 0; i < NUMBERS; i++)
            for (int k = 0; k < NUMBERS; k++)
                center[k] += s[i].x[k] / NUMBERS;
        Corner turned = corner_at(center, worst, -1, power);
        if (turned.y < s[0].y) {
            Corner further = corner_at(center, worst, -2, power);
            *worst = further.y < turned.y ? further : turned;
        } else if (turned.y < s[NUMBERS - 1].y) {
            *worst = turned;
        } else {
            Corner nearer = corner_at(center, turned.y < worst->y ? &turned : worst, 0.5, power);
            if (nearer.y < fmin(turned.y, worst->y))
                *worst = nearer;
            else
                for (int i = 1; i <= NUMBERS; i++)
                    s[i] = corner_at(s[0].x, &s[i], 0.5, power);
        }
    }
    qsort(s, NUMBERS + 1, sizeof *s, by_misfit);
    memcpy(x, s[0].x, sizeof s[0].x);
}

/* ---- what is printed ------------------------------------------------------------------------- */

static void print_shape(const BlobShape *shape)
{
    for (int i = 0; i < BLOB_TUBES; i++)
        printf("tube: radius %.4f, strength %.10f\n", shape->tube[i].radius,
               shape->tube[i].strength);
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        printf("bead: offset %.4f, radius %.4f, strength %.4f\n", shape->bead[i].offset,
               shape->bead[i].radius, shape->bead[i].strength);
}

static void print_table(const BlobShape *shape)
{
    printf("| thin / thick daughter |");
    for (int j = 0; j < N_ANGLES; j++)
        printf(" %.0f° |", deviation_angles[j]);
    printf("\n|---|");
    for (int j = 0; j < N_ANGLES; j++)
        printf("---|");
    double radii = 0, degrees = 0;
    for (int i = 0; i < FORKS; i++) {
        Deviation worst = worst_deviation(shape, &forks[i], spots[i], n_spots[i]);
        radii = fmax(radii, fabs(worst.radii));
        degrees = fmax(degrees, worst.degrees);
        if (i == FORKS - 1)
            printf("\nfree end: %+.2f %% of r, %.0f°; ", 100 * worst.radii, worst.degrees);
        else if (i % N_ANGLES == 0)
            printf("\n| %g |", deviation_ratios[i / N_ANGLES]);
        if (i < FORKS - 1)
            printf(" %+.2f, %.0f° |", 100 * worst.radii, worst.degrees);
    }
    printf("overshoot %.3f r\nlargest: %.2f %% of r, %.1f°\n", overshoot_of(shape), 100 * radii,
           degrees);
}

static void print_largest(const char *what, const BlobShape *shape)
{
    Deviation most = {0, 0};
    for (int i = 0; i < FORKS; i++) {
        Deviation worst = worst_deviation(shape, &forks[i], spots[i], n_spots[i]);
        most.radii = fmax(most.radii, fabs(worst.radii));
        most.degrees = fmax(most.degrees, worst.degrees);
    }
    printf("%s: %.2f %% of r, %.0f°; overshoot %.3f r\n", what, 100 * most.radii, most.degrees,
           overshoot_of(shape));
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "fit") == 0) {
        BlobShape shape = {.tube = {{1.2, 0}, {1.6, 2}}, .bead = {{0.05, 1, 2}, {0.2, 1.4, 1}}};
        double x[NUMBERS];
        int rounds = argc > 2 ? atoi(argv[2]) : 1;
        make_forks(8, 0.09);
        numbers_of(&shape, x);
        for (double power = 24; power <= 96; power *= 2)
            for (int round = 0; round < rounds; round++) {
                improve(x, power, 400);
                shape = shape_of(x);
                printf("p = %g: %.5f\n", power, misfit(x, power));
                print_shape(&shape);
                fflush(stdout);
            }
        print_table(&shape);
        return 0;
    }
    const BlobShape plain = {.tube = {{sqrt(2), 4}, {1.5, 0}}, .bead = {{0, 1, 0}, {0, 1, 0}}};
    make_forks(8, 0.1);
    print_shape(&blob_shape);
    print_table(&blob_shape);
    print_largest("one tube of strength 4 and half balls", &plain);
    for (int length = 2; length >= 1; length--) {
        make_forks(length, 0.1);
        printf("segments %d r long, ", length);
        print_largest("the largest", &blob_shape);
    }
    return 0;
}
