/* Moved by parts of pixels, or blurred: questions about the signal that the pixels sample, asked of
 * patches about pixels that differ, so that they cost the same for pictures of any size. Both sides
 * are smoothed first (a binomial filter of standard deviation 1.4 pixels), since what two renderers
 * make of an outline within a pixel says nothing about where it lies.
 *
 * A shift is found by Gauss-Newton on the squares of what is left of B when A, moved by it, is
 * taken away [Lucas and Kanade 1981]; A is moved by cubic interpolation. A blur is one number,
 * found by golden section. Either is named when it leaves less than a twenty-fifth of the squares,
 * so that a fifth of the difference at most is something else. */
#include "verify/cause.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATCHES = 64, CORE = 32, MARGIN = 12, SIDE = CORE + 2 * MARGIN, CELLS = SIDE * SIDE };
/* Pixels so near to an edge of the picture are mixed with what was made up beyond it. */
enum { RIM = 6 };

/* The patches of both pictures, those of A moved by whole pixels. */
typedef struct Patches {
    const Picture *a, *b;
    Shift start;
    const float *levels; /* of each code, parts of 1: of light, or of the code itself */
    int n;
    double left;                       /* the least part of the squares that a guess has left */
    PixelPlace at[PATCHES];            /* pixels of B; the first of each patch */
    float *before, *from, *to, *moved; /* owned; A in its place, A moved, B, work: CELLS a patch */
} Patches;

/* The mean of a pixel's channels, from 0 to 255. */
static float level_at(const Picture *picture, int x, int y, const float *levels)
{
    x = x < 0 ? 0 : x < picture->width ? x : picture->width - 1;
    y = y < 0 ? 0 : y < picture->height ? y : picture->height - 1;
    size_t channels = (size_t)picture->channels;
    size_t i = ((size_t)y * (size_t)picture->width + (size_t)x) * channels;
    float sum = 0;
    for (size_t c = 0; c < channels; c++)
        sum += levels[picture_code(picture, i + c)];
    return 255 * sum / (float)channels;
}

/* Filters rows, then columns; `taps` are the weights of cells `first`, first + 1, ... from each;
 * cells that reach over the edge of the patch keep their values. */
static void filter(const float *in, float *out, const float *taps, int first, int n)
{
    float rows[CELLS];
    int from = first < 0 ? -first : 0, to = SIDE - (first + n > 1 ? first + n - 1 : 0);
    for (int i = 0; i < CELLS; i++)
        rows[i] = in[i];
    for (int y = 0; y < SIDE; y++)
        for (int x = from; x < to; x++) {
            float sum = 0;
            for (int k = 0; k < n; k++)
                sum += taps[k] * in[y * SIDE + x + first + k];
            rows[y * SIDE + x] = sum;
        }
    for (int i = 0; i < CELLS; i++)
        out[i] = rows[i];
    for (int y = from; y < to; y++)
        for (int k = 0; k < n; k++)
            for (int x = 0; x < SIDE; x++) {
                float value = taps[k] * rows[(y + first + k) * SIDE + x];
                out[y * SIDE + x] = k ? out[y * SIDE + x] + value : value;
            }
}

static void load(const Picture *picture, int left, int top, const float *table, float *out)
{
    static const float binomial[9] = {1 / 256.0F,  8 / 256.0F,  28 / 256.0F,
                                      56 / 256.0F, 70 / 256.0F, 56 / 256.0F,
                                      28 / 256.0F, 8 / 256.0F,  1 / 256.0F};
    float levels[CELLS];
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            levels[y * SIDE + x] = level_at(picture, left + x, top + y, table);
    filter(levels, out, binomial, -4, 9);
}

static Status patches_init(Patches *patches, const Samples *samples, Err *err)
{
    int step = (samples->n + PATCHES - 1) / PATCHES;
    for (int i = 0; i < samples->n; i += step)
        patches->at[patches->n++] =
            (PixelPlace){.x = samples->at[i].x - SIDE / 2, .y = samples->at[i].y - SIDE / 2};
    size_t cells = (size_t)patches->n * CELLS;
    TRY(mem_calloc(&patches->before, 4 * cells, sizeof(float), "values of patches", err));
    patches->from = patches->before + cells;
    patches->to = patches->from + cells;
    patches->moved = patches->to + cells;
    const Shift *start = &patches->start;
    for (int i = 0; i < patches->n; i++) {
        int x = patches->at[i].x, y = patches->at[i].y;
        size_t first = (size_t)i * CELLS;
        load(patches->a, x, y, patches->levels, patches->before + first);
        if (start->dx || start->dy)
            load(patches->a, x - start->dx, y - start->dy, patches->levels, patches->from + first);
        else
            memcpy(patches->from + first, patches->before + first, CELLS * sizeof(float));
        load(patches->b, x, y, patches->levels, patches->to + first);
    }
    return STATUS_OK;
}

/* Whether a cell counts: in the core, and in both pictures, away from their edges. */
static bool counts(const Patches *patches, int patch, int x, int y)
{
    if (x < MARGIN || x >= SIDE - MARGIN || y < MARGIN || y >= SIDE - MARGIN)
        return false;
    int u = patches->at[patch].x + x, v = patches->at[patch].y + y;
    int s = u - patches->start.dx, t = v - patches->start.dy;
    int right = patches->a->width - RIM, bottom = patches->a->height - RIM;
    return u >= RIM && u < right && v >= RIM && v < bottom && s >= RIM && s < right && t >= RIM &&
           t < bottom;
}

/* Steps through all cells that count, patch after patch; false behind the last. Begin with
 * NO_CELL. */
enum { NO_CELL = -1 };

static bool next_cell(const Patches *patches, int *cell)
{
    while (++*cell < patches->n * CELLS) {
        int in_patch = *cell % CELLS;
        if (counts(patches, *cell / CELLS, in_patch % SIDE, in_patch / SIDE))
            return true;
    }
    return false;
}

/* The sum of squares between two sides. */
static double squares(const Patches *patches, const float *side, const float *other)
{
    double sum = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        double d = (double)(side[cell] - other[cell]);
        sum += d * d;
    }
    return sum;
}

/* ---- moved ----------------------------------------------------------------------------------- */

/* A, moved by (dx, dy), each in (-MARGIN / 2, MARGIN / 2): cubic interpolation [Keys 1981]. */
static void weigh_cubic(double d, float taps[4], int *first)
{
    double whole = floor(d), t = 1 - (d - whole);
    taps[0] = (float)(0.5 * (-t + 2 * t * t - t * t * t));
    taps[1] = (float)(0.5 * (2 - 5 * t * t + 3 * t * t * t));
    taps[2] = (float)(0.5 * (t + 4 * t * t - 3 * t * t * t));
    taps[3] = (float)(0.5 * (-t * t + t * t * t));
    *first = (int)-whole - 2;
}

static void filter_row_taps(const float *in, float *out, const float *across, int x_first,
                            const float *down, int y_first)
{
    for (int y = MARGIN - 1; y <= SIDE - MARGIN; y++)
        for (int x = MARGIN - 1; x <= SIDE - MARGIN; x++) {
            float sum = 0;
            for (int j = 0; j < 4; j++)
                for (int i = 0; i < 4; i++)
                    sum += down[j] * across[i] * in[(y + y_first + j) * SIDE + x + x_first + i];
            out[y * SIDE + x] = sum;
        }
}

static void move(Patches *patches, const double d[2])
{
    float across[4], down[4];
    int x_first, y_first;
    weigh_cubic(d[0], across, &x_first);
    weigh_cubic(d[1], down, &y_first);
    for (int i = 0; i < patches->n; i++)
        filter_row_taps(patches->from + (size_t)i * CELLS, patches->moved + (size_t)i * CELLS,
                        across, x_first, down, y_first);
}

/* One step of Gauss-Newton; false where the patches have no gradients. */
static bool improve(const Patches *patches, double d[2])
{
    double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        const float *at = patches->moved + cell;
        double gx = (double)(at[1] - at[-1]) / 2, gy = (double)(at[SIDE] - at[-SIDE]) / 2;
        double rest = (double)(patches->to[cell] - *at);
        xx += gx * gx;
        xy += gx * gy;
        yy += gy * gy;
        xr += gx * rest;
        yr += gy * rest;
    }
    double ridge = 1e-6 * (xx + yy), determinant = (xx + ridge) * (yy + ridge) - xy * xy;
    if (!(determinant > 0))
        return false;
    d[0] -= ((yy + ridge) * xr - xy * yr) / determinant;
    d[1] -= ((xx + ridge) * yr - xy * xr) / determinant;
    return fabs(d[0]) < MARGIN / 4.0 && fabs(d[1]) < MARGIN / 4.0;
}

static bool explains(Patches *patches, double before, double after)
{
    patches->left = before > 0 ? fmin(patches->left, after / before) : patches->left;
    return before > 0 && 25 * after < before;
}

/* What is left of the squares when what a slight blur does, a multiple of the second derivatives,
 * is taken away from the rest, too; the multiple in *blurred. */
static double left_by_blur(const Patches *patches, double *blurred)
{
    double rest_rest = 0, rest_bend = 0, bend_bend = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        const float *at = patches->moved + cell;
        double rest = (double)(patches->to[cell] - *at);
        double bend = (double)(at[1] + at[-1] + at[SIDE] + at[-SIDE] - 4 * *at);
        rest_rest += rest * rest;
        rest_bend += rest * bend;
        bend_bend += bend * bend;
    }
    *blurred = bend_bend > 0 ? rest_bend / bend_bend : 0;
    return rest_rest - *blurred * rest_bend;
}

/* Never minus zero. */
static double round_to(double value, double unit)
{
    return round(value * unit) / unit + 0.0;
}

static void try_shift(Patches *patches, Sentence *out)
{
    enum { STEPS = 6 };
    double d[2] = {0, 0}, before = squares(patches, patches->before, patches->to);
    for (int i = 0; i < STEPS; i++) {
        move(patches, d);
        if (!improve(patches, d))
            return;
    }
    move(patches, d);
    double dx = patches->start.dx + d[0], dy = patches->start.dy + d[1], blurred;
    int digits = fmax(fabs(dx), fabs(dy)) < 0.25 ? 2 : 1;
    double unit = digits == 2 ? 100 : 10;
    double after = squares(patches, patches->moved, patches->to);
    bool alone = explains(patches, before, after);
    if (alone || (2 * after < before && explains(patches, before, left_by_blur(patches, &blurred))))
        snprintf(out->text, out->size,
                 "B is nearly A moved by (%.*f, %.*f) pixels%s, right and down being positive",
                 digits, round_to(dx, unit), digits, round_to(dy, unit),
                 alone         ? ""
                 : blurred > 0 ? " and blurred a little"
                               : " and sharpened a little");
}

/* ---- blurred --------------------------------------------------------------------------------- */

static const double most_sigma = 2.5;

static void blur(Patches *patches, const float *side, double sigma)
{
    enum { REACH = 8 };
    float taps[2 * REACH + 1], sum = 0;
    for (int i = -REACH; i <= REACH; i++)
        sum += taps[i + REACH] = (float)elementary_exp(-i * i / (2 * sigma * sigma));
    for (int i = 0; i <= 2 * REACH; i++)
        taps[i] /= sum;
    for (int i = 0; i < patches->n; i++)
        filter(side + (size_t)i * CELLS, patches->moved + (size_t)i * CELLS, taps, -REACH,
               2 * REACH + 1);
}

static double off_when_blurred(Patches *patches, const float *side, const float *other,
                               double sigma)
{
    blur(patches, side, sigma);
    return squares(patches, patches->moved, other);
}

/* The standard deviation that brings `side` nearest to `other`, what is left in *after. */
static double best_sigma(Patches *patches, const float *side, const float *other, double *after)
{
    enum { STEPS = 11 };
    const double golden = 0.6180339887498949;
    double low = 0.05, high = most_sigma;
    double x[2] = {high - golden * (high - low), low + golden * (high - low)};
    double off[2] = {off_when_blurred(patches, side, other, x[0]),
                     off_when_blurred(patches, side, other, x[1])};
    for (int i = 0; i < STEPS; i++) {
        int worse = off[0] < off[1];
        *(worse ? &high : &low) = x[worse];
        x[worse] = x[!worse];
        off[worse] = off[!worse];
        x[!worse] = worse ? high - golden * (high - low) : low + golden * (high - low);
        off[!worse] = off_when_blurred(patches, side, other, x[!worse]);
    }
    *after = fmin(off[0], off[1]);
    return (low + high) / 2;
}

/* Smoothing goes the way of the differences: whether `other` is nearer to `side` when that is
 * blurred a little. */
static bool is_blurrier(Patches *patches, const float *side, const float *other, double before)
{
    return 1.1 * off_when_blurred(patches, side, other, 0.5) < before;
}

static void try_blur(Patches *patches, Sentence *out)
{
    const float *sides[2] = {patches->before, patches->to};
    double before = squares(patches, sides[0], sides[1]), after;
    for (int sharper = 0; sharper < 2; sharper++) {
        if (!is_blurrier(patches, sides[sharper], sides[!sharper], before))
            continue;
        double sigma = best_sigma(patches, sides[sharper], sides[!sharper], &after);
        if (sigma < 0.98 * most_sigma && explains(patches, before, after))
            snprintf(out->text, out->size,
                     "%s is nearly %s blurred, by as much as a Gaussian of standard deviation "
                     "%.2g pixels",
                     sharper ? "A" : "B", sharper ? "B" : "A", sigma);
    }
}

/* The level, in [0, 1], of every code of `bits` bits: linear light, or code / greatest code. */
static Status list_levels(int bits, bool linear, float **levels, Err *err)
{
    int n = 1 << bits;
    TRY(mem_calloc(levels, (size_t)n, sizeof **levels, "codes", err));
    for (int i = 0; i < n; i++) {
        float level = (float)i / (float)(n - 1);
        (*levels)[i] = linear ? srgb_decode(level) : level;
    }
    return STATUS_OK;
}

static Status try_warp(const Picture *a, const Picture *b, const Samples *samples, Shift start,
                       bool linear, double *left, Sentence *out, Err *err)
{
    float *levels;
    TRY(list_levels(a->bits, linear, &levels, err));
    Patches patches = {.a = a, .b = b, .start = start, .levels = levels, .left = 1};
    Status status = patches_init(&patches, samples, err);
    if (status == STATUS_OK)
        try_shift(&patches, out);
    patches.start = (Shift){0};
    if (status == STATUS_OK && !*out->text)
        try_blur(&patches, out);
    *left = patches.left;
    free(patches.before);
    free(levels);
    return status;
}

/* In light only where the same in codes leaves no more than half: the two are not so different. */
Status cause_warp(const Picture *a, const Picture *b, const Samples *samples, const Shift *start,
                  Sentence *out, Err *err)
{
    double left;
    TRY(try_warp(a, b, samples, *start, false, &left, out, err));
    return *out->text || a->gamma != 0 || left > 0.5
               ? STATUS_OK
               : try_warp(a, b, samples, *start, true, &left, out, err);
}
