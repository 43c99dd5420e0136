/* Tests whether B is A rotated, enlarged or cropped: whether one affine map takes each pixel of B
 * to its position in A. The six numbers of the map are found by Gauss-Newton iterations [Lucas and
 * Kanade 1981] on an image pyramid. They start at the smallest level of the pyramid, where all
 * displacements are small, and go on with larger levels.
 *
 * The map is the cause if it leaves less than 1/25 of the sum of squared differences in the whole
 * picture and less than 1/8 in each quarter. Flat parts must keep their codes, at least half of the
 * pixels of B must be mapped to pixels of A, and the tones must be kept [keeps_tones]. Cost:
 * O(pixels).
 *
 * A pyramid level is one of the reduced pictures. An 8-bit step is a difference of 1 in a code of 8
 * bits. The thresholds were chosen strict, because a wrong cause misleads more than no cause. */
#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    NUMBERS = 6,     /* number of unknowns of the map */
    STEPS = 10,      /* maximum number of Gauss-Newton steps per pyramid level; a level usually ends
                      * earlier [find_map], and a map that needs more has diverged */
    COARSEST = 20,   /* a level is halved while both sides have at least twice this many pixels; a
                      * smaller picture has too few pixels for six unknowns */
    FINEST = 700,    /* wider levels are not fitted, because the map is accurate enough by then */
    LEVELS_MAX = 12, /* maximum number of pyramid levels, enough for sides of 80,000 pixels */
    MARGIN = 4       /* width of the border of a picture that is not compared, pixels: the smoothing
                      * mixes in values from beyond the edge */
};

/* An affine map from B to A: position in A = m (position in B - middle) + middle + shift. Positions
 * are in pixels of the full-size picture. */
typedef struct Affine {
    double m[2][2], shift[2];
} Affine;

static float *value_at(const Plane *plane, int x, int y, int c)
{
    return plane->values +
           ((size_t)y * (size_t)plane->width + (size_t)x) * (size_t)plane->channels + c;
}

/* Adds `weight` times each of `n` values to the values `to`. */
static void add_weighted(const float *restrict from, float weight, size_t n, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * from[i];
}

static int clamp_index(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* Smooths by the binomial filter 1 4 6 4 1 along rows, then along columns. Pixels beyond an edge
 * equal the pixels at the edge. Whole rows are added at once, which costs a fifth of adding pixel
 * by pixel. */
static Status smooth(Plane *plane, Err *err)
{
    enum { REACH = 2 };
    static const float taps[2 * REACH + 1] = {0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};
    const int width = plane->width, height = plane->height, channels = plane->channels;
    const size_t stride = (size_t)width * (size_t)channels;
    Plane rows = {0}, padded = {0};
    Status status = STATUS_OK;
    TRY_GOTO(plane_init(&rows, width, height, channels, err));
    TRY_GOTO(plane_init(&padded, width + 2 * REACH, 1, channels, err));
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < padded.width; x++)
            memcpy(value_at(&padded, x, 0, 0), value_at(plane, clamp_index(x - REACH, width), y, 0),
                   (size_t)channels * sizeof(float));
        for (int k = 0; k <= 2 * REACH; k++)
            add_weighted(value_at(&padded, k, 0, 0), taps[k], stride, value_at(&rows, 0, y, 0));
    }
    memset(plane->values, 0, (size_t)height * stride * sizeof(float));
    for (int y = 0; y < height; y++)
        for (int k = 0; k <= 2 * REACH; k++)
            add_weighted(value_at(&rows, 0, clamp_index(y + k - REACH, height), 0), taps[k], stride,
                         value_at(plane, 0, y, 0));
done:
    plane_release(&rows);
    plane_release(&padded);
    return status;
}

/* Converts a picture to floats in 8-bit steps. If `is_mean` is true, the plane has one channel: the
 * mean of the picture's channels. */
static Status take_plane(Plane *plane, const Picture *picture, bool is_mean, Err *err)
{
    const float level = 1.0F / (float)codes_per_level(picture);
    const int channels = picture->channels;
    TRY(plane_init(plane, picture->width, picture->height, is_mean ? 1 : channels, err));
    size_t n = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < channels; c++) {
            float value = level * picture_code(picture, i * (size_t)channels + (size_t)c);
            if (is_mean)
                plane->values[i] += value / (float)channels;
            else
                plane->values[i * (size_t)channels + (size_t)c] = value;
        }
    return STATUS_OK;
}

/* Makes a plane of half the width and height. Each pixel is the mean of four. */
static Status halve(const Plane *from, Plane *to, Err *err)
{
    TRY(plane_init(to, from->width / 2, from->height / 2, 1, err));
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++)
            *value_at(to, x, y, 0) =
                (*value_at(from, 2 * x, 2 * y, 0) + *value_at(from, 2 * x + 1, 2 * y, 0) +
                 *value_at(from, 2 * x, 2 * y + 1, 0) + *value_at(from, 2 * x + 1, 2 * y + 1, 0)) /
                4;
    return STATUS_OK;
}

/* ---- the map --------------------------------------------------------------------------------- */

/* The geometry of a pyramid level. `middle`: center of the full-size picture, in its pixels.
 * `scale`: full-size pixels per pixel of the level. */
typedef struct LevelFrame {
    double middle[2], scale;
} LevelFrame;

/* Finds the position in A of the pixel (x, y) of B. `from` receives the position of the pixel in B
 * relative to the middle, in full-size pixels. `to` receives the position in A, in pixels of the
 * level. */
static void place_in_a(const Affine *map, const LevelFrame *frame, int x, int y, double from[2],
                       double to[2])
{
    from[0] = (x + 0.5) * frame->scale - frame->middle[0];
    from[1] = (y + 0.5) * frame->scale - frame->middle[1];
    for (int i = 0; i < 2; i++) {
        double at = map->m[i][0] * from[0] + map->m[i][1] * from[1] + map->shift[i];
        to[i] = (at + frame->middle[i]) / frame->scale - 0.5;
    }
}

/* Interpolates channel `c` of a plane linearly at a position. Sets out[0] to the value, and out[1]
 * and out[2] to the derivatives along x and y. Returns false outside of the plane. */
static bool sample(const Plane *planes, const double at[2], int c, double out[3])
{
    int x = (int)floor(at[0]), y = (int)floor(at[1]);
    if (x < 1 || y < 1 || x + 2 >= planes->width || y + 2 >= planes->height)
        return false;
    double u = at[0] - x, v = at[1] - y;
    double p = (double)*value_at(planes, x, y, c), q = (double)*value_at(planes, x + 1, y, c);
    double r = (double)*value_at(planes, x, y + 1, c),
           s = (double)*value_at(planes, x + 1, y + 1, c);
    out[0] = (1 - v) * ((1 - u) * p + u * q) + v * ((1 - u) * r + u * s);
    out[1] = (1 - v) * (q - p) + v * (s - r);
    out[2] = (1 - u) * (r - p) + u * (s - q);
    return true;
}

/* Solves the normal equations by Gaussian elimination, in place. Returns false if they are
 * singular. */
static bool solve(double matrix[NUMBERS][NUMBERS + 1], double out[NUMBERS])
{
    for (int i = 0; i < NUMBERS; i++) {
        if (!(matrix[i][i] > 1e-12))
            return false;
        for (int k = i + 1; k < NUMBERS; k++) {
            double factor = matrix[k][i] / matrix[i][i];
            for (int j = i; j <= NUMBERS; j++)
                matrix[k][j] -= factor * matrix[i][j];
        }
    }
    for (int i = NUMBERS; i-- > 0;) {
        out[i] = matrix[i][NUMBERS];
        for (int j = i + 1; j < NUMBERS; j++)
            out[i] -= matrix[i][j] * out[j];
        out[i] /= matrix[i][i];
    }
    return true;
}

/* Improves the map by one Gauss-Newton step. Returns the largest change of a position in the
 * picture, in pixels of the level; -1 if the normal equations are singular. */
static double improve(const Plane *a, const Plane *b, const LevelFrame *frame, Affine *map)
{
    /* The normal equations; the last column is the right-hand side. `slopes` are the derivatives of
     * the mapped A by the six numbers of the map. */
    double normal[NUMBERS][NUMBERS + 1] = {{0}}, step[NUMBERS], from[2], to[2], value[3];
    for (int y = 0; y < b->height; y++)
        for (int x = 0; x < b->width; x++) {
            place_in_a(map, frame, x, y, from, to);
            if (!sample(a, to, 0, value))
                continue;
            const double rest = (double)*value_at(b, x, y, 0) - value[0];
            const double slopes[NUMBERS] = {value[1] * from[0], value[1] * from[1], value[1],
                                            value[2] * from[0], value[2] * from[1], value[2]};
            for (int i = 0; i < NUMBERS; i++) {
                for (int k = 0; k < NUMBERS; k++)
                    normal[i][k] += slopes[i] * slopes[k];
                normal[i][NUMBERS] += slopes[i] * rest;
            }
        }
    if (!solve(normal, step))
        return -1;
    for (int i = 0; i < 2; i++) {
        map->m[i][0] += frame->scale * step[3 * i];
        map->m[i][1] += frame->scale * step[3 * i + 1];
        map->shift[i] += frame->scale * step[3 * i + 2];
    }
    return fmax(fabs(step[2]), fabs(step[5])) +
           fmax(fabs(step[0]) + fabs(step[3]), fabs(step[1]) + fabs(step[4])) *
               fmax(frame->middle[0], frame->middle[1]);
}

/* ---- differences that remain after the map --------------------------------------------------- */

/* Sums over the pixels of B of the difference from A: `before` from A as it is, all others from A
 * mapped onto B. */
typedef struct Leavings {
    double before[2][2], after[2][2]; /* per quarter of the picture: sums of (B - A)^2 */
    double flat, flat_n;              /* sum of (B - A)^2 where A and B are flat, and count */
    double pixels;                    /* number of pixels */
    double rest[3], shown[3]; /* per channel: sum of B - A, and number of pixels at which A is
                               * neither black nor white */
} Leavings;

/* Adds the pixel (x, y) of B. A and B are flat there if no slope reaches one 8-bit step per pixel.
 * A value of A above 2 and below 253 is neither black nor white. */
static void add_leavings(const Plane planes[2], const LevelFrame *frame, const Affine *map, int x,
                         int y, Leavings *sums)
{
    const Plane *a = &planes[0], *b = &planes[1];
    double from[2], to[2], value[3];
    place_in_a(map, frame, x, y, from, to);
    const int row = 2 * y / b->height, column = 2 * x / b->width;
    for (int c = 0; c < b->channels; c++) {
        if (!sample(a, to, c, value))
            return;
        const double is = (double)*value_at(b, x, y, c), was = (double)*value_at(a, x, y, c);
        const double rest = is - value[0];
        sums->before[row][column] += (is - was) * (is - was);
        sums->after[row][column] += rest * rest;
        sums->rest[c] += rest;
        sums->shown[c] += value[0] > 2 && value[0] < 253;
        const double slope = fmax(fabs((double)*value_at(b, x + 1, y, c) - is),
                                  fabs((double)*value_at(b, x, y + 1, c) - is));
        if (fabs(value[1]) < 1 && fabs(value[2]) < 1 && slope < 1) {
            sums->flat += rest * rest;
            sums->flat_n++;
        }
    }
    sums->pixels++;
}

/* Returns true if no channel is brighter or darker by more than three 8-bit steps, in the mean over
 * pixels that are neither black nor white. Interpolation that rings and is clipped changes this
 * mean by up to two 8-bit steps. */
static bool keeps_tones(const Leavings *sums)
{
    for (int c = 0; c < 3; c++)
        if (fabs(sums->rest[c]) > 3 * fmax(sums->shown[c], 1))
            return false;
    return true;
}

/* Returns true if the map explains the differences of two planes, by the tests that the head of
 * this file lists. Quarters of the picture with less than 2 % of the squared differences are not
 * tested, because rounding dominates them. In flat parts the mean square may be at most 0.5. */
static bool explains(const Plane planes[2], const LevelFrame *frame, const Affine *map)
{
    const Plane *b = &planes[1];
    Leavings found = {0}, *sums = &found;
    for (int y = MARGIN; y < b->height - MARGIN; y++)
        for (int x = MARGIN; x < b->width - MARGIN; x++)
            add_leavings(planes, frame, map, x, y, sums);
    double before = 0, after = 0;
    for (int i = 0; i < 4; i++) {
        before += sums->before[i / 2][i % 2];
        after += sums->after[i / 2][i % 2];
    }
    if (!(before > 0) || 25 * after > before ||
        2 * sums->pixels < (double)b->width * (double)b->height)
        return false;
    for (int i = 0; i < 4; i++) {
        double here = sums->before[i / 2][i % 2];
        if (here > 0.02 * before && 8 * sums->after[i / 2][i % 2] > here)
            return false;
    }
    return sums->flat <= 0.5 * fmax(sums->flat_n, 1) && keeps_tones(sums);
}

/* ---- the search ------------------------------------------------------------------------------ */

/* Returns true if the map changes areas by less than a factor of 4. This excludes iterations that
 * diverged. */
static bool is_sane(const Affine *map)
{
    double determinant = map->m[0][0] * map->m[1][1] - map->m[0][1] * map->m[1][0];
    return determinant > 0.25 && determinant < 4;
}

/* Finds the map on the pyramid, from the smallest level to larger levels. *found receives false if
 * there is no map. The means of the channels are fitted, which costs a third of fitting all
 * channels. A level is done if a step moves no pixel by more than 0.005 pixels. */
static Status find_map(const Picture *a, const Picture *b, Affine *map, bool *found, Err *err)
{
    Plane levels[2][LEVELS_MAX] = {{{0}}};
    int n = 0, last = 0;
    const LevelFrame whole = {{a->width / 2.0, a->height / 2.0}, 1};
    Status status = STATUS_OK;
    *map = (Affine){.m = {{1, 0}, {0, 1}}};
    *found = true;
    do {
        for (int side = 0; side < 2; side++) {
            Plane *level = &levels[side][n];
            TRY_GOTO(n == 0 ? take_plane(level, side ? b : a, true, err)
                            : halve(level - 1, level, err));
            TRY_GOTO(smooth(level, err));
        }
        n++;
    } while (n < LEVELS_MAX && levels[0][n - 1].width >= 2 * COARSEST &&
             levels[0][n - 1].height >= 2 * COARSEST);
    for (int level = n; level-- > 0 && *found;) {
        LevelFrame frame = whole;
        frame.scale = (double)(1 << level);
        if (level + 1 < n && levels[0][level].width > FINEST)
            break;
        double change = 1;
        for (int i = 0; i < STEPS && change > 0.005; i++)
            change = improve(&levels[0][level], &levels[1][level], &frame, map);
        *found = change >= 0 && is_sane(map);
        last = level;
    }
    if (*found) { /* a first check, before try_map looks at all channels */
        LevelFrame frame = whole;
        frame.scale = (double)(1 << last);
        const Plane both[2] = {levels[0][last], levels[1][last]};
        *found = explains(both, &frame, map);
    }
done:
    for (int i = 0; i < LEVELS_MAX; i++) {
        plane_release(&levels[0][i]);
        plane_release(&levels[1][i]);
    }
    return status;
}

/* Tests the map on all channels of the full-size pictures. */
static Status try_map(const Picture *a, const Picture *b, const Affine *map, bool *fits, Err *err)
{
    Plane planes[2] = {{0}, {0}};
    const LevelFrame whole = {{b->width / 2.0, b->height / 2.0}, 1};
    Status status = STATUS_OK;
    for (int side = 0; side < 2; side++) {
        TRY_GOTO(take_plane(&planes[side], side ? b : a, false, err));
        TRY_GOTO(smooth(&planes[side], err));
    }
    *fits = explains(planes, &whole, map);
done:
    plane_release(&planes[0]);
    plane_release(&planes[1]);
    return status;
}

/* ---- sentences ------------------------------------------------------------------------------- */

/* Describes a map without rotation. It is a crop if B shows an off-center part of A that is
 * entirely inside A; otherwise it is a change of size. Factors that differ by more than `seen` have
 * a number each. Positions are compared with a tolerance of 0.5 pixels. */
static void say_scaled(const Affine *map, double seen, const Picture *a, Sentence *out)
{
    const double size[2] = {map->m[0][0] * a->width, map->m[1][1] * a->height};
    const double left = a->width / 2.0 + map->shift[0] - size[0] / 2,
                 top = a->height / 2.0 + map->shift[1] - size[1] / 2;
    const bool centered = fabs(map->shift[0]) < 0.5 && fabs(map->shift[1]) < 0.5;
    const bool inside = left > -0.5 && top > -0.5 && left + size[0] < a->width + 0.5 &&
                        top + size[1] < a->height + 0.5;
    const double factor = 2 / (map->m[0][0] + map->m[1][1]);
    if (inside && !centered)
        snprintf(out->text, out->size,
                 "B is A cropped to about %.0f x %.0f pixels at (%.0f, %.0f) and enlarged to its "
                 "size",
                 size[0], size[1], fmax(left, 0), fmax(top, 0));
    else if (fabs(map->m[0][0] - map->m[1][1]) > seen)
        snprintf(out->text, out->size,
                 "B is A with its width changed by a factor of %.3g and its height by %.3g%s",
                 1 / map->m[0][0], 1 / map->m[1][1], centered ? "" : ", and moved");
    else
        snprintf(out->text, out->size, "B is A %s by a factor of %.3g%s",
                 factor > 1 ? "enlarged" : "reduced", factor,
                 centered ? ", about its middle" : ", and moved");
}

/* Describes a map whose rotation or change of size moves the corners by at least 0.3 pixels. Writes
 * nothing for a map that shears, or stretches and rotates: whose skew or stretch exceeds `seen` and
 * a tenth of the rotation. `seen` is the smallest rotation or relative change of size that counts.
 * The map leads from B to A and y is downwards; a positive angle therefore means that B is A
 * rotated counterclockwise. */
static void say_map(const Affine *map, const Picture *a, Sentence *out)
{
    const double seen = 0.3 / (elementary_hypot(a->width, a->height) / 2);
    const double turn = (map->m[1][0] - map->m[0][1]) / 2, skew = map->m[1][0] + map->m[0][1];
    const double stretch = map->m[0][0] - map->m[1][1],
                 scale = sqrt(map->m[0][0] * map->m[1][1] - map->m[0][1] * map->m[1][0]);
    const bool turned = fabs(turn) > seen,
               scaled = fabs(map->m[0][0] - 1) > seen || fabs(map->m[1][1] - 1) > seen;
    const double degrees = elementary_atan2(turn, (map->m[0][0] + map->m[1][1]) / 2) / DEGREE;
    if (fabs(skew) > fmax(seen, 0.1 * fabs(turn)) || (!turned && !scaled))
        return;
    if (!turned) {
        say_scaled(map, seen, a, out);
        return;
    }
    if (fabs(stretch) > fmax(seen, 0.1 * fabs(turn)))
        return;
    int length = snprintf(out->text, out->size, "B is A rotated by %.2g degrees %s", fabs(degrees),
                          degrees > 0 ? "counterclockwise" : "clockwise");
    if (fabs(scale - 1) > seen)
        snprintf(out->text + length, out->size - (size_t)length, " and %s by a factor of %.3g",
                 scale < 1 ? "enlarged" : "reduced", 1 / scale);
    else if (fabs(map->shift[0]) > 0.5 || fabs(map->shift[1]) > 0.5)
        snprintf(out->text + length, out->size - (size_t)length, " and moved");
}

Status cause_affine(const Picture *a, const Picture *b, Sentence *out, Err *err)
{
    Affine map;
    bool found, fits = false;
    if (a->width < 2 * COARSEST || a->height < 2 * COARSEST)
        return STATUS_OK;
    TRY(find_map(a, b, &map, &found, err));
    if (found)
        TRY(try_map(a, b, &map, &fits, err));
    if (fits)
        say_map(&map, a, out);
    return STATUS_OK;
}
