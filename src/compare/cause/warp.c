/* Tests whether B is A translated by fractions of a pixel, or blurred.
 *
 * Both changes are fitted to patches around pixels that differ, so the fit costs the same for
 * pictures of any size. Both pictures are first smoothed by a binomial filter of standard deviation
 * 1.4 pixels, because renderers filter an outline within a pixel in different ways.
 *
 * A translation is found by Gauss-Newton iterations that minimise the sum of squares of
 * B - (A translated by cubic interpolation) [Lucas and Kanade 1981]. A blur has one number, its
 * standard deviation, which golden section search finds. A change is the cause if it leaves less
 * than 1/25 of the sum of squares, and if nothing contradicts it: halves of the picture have the
 * same displacement, each channel keeps its tones, flat parts keep their codes, and every part of
 * the picture that the change affects has changed.
 *
 * A level is 1/255 of the range of codes, at any bit depth. Where a comment gives no reason for a
 * threshold, the threshold is strict on purpose: a wrong cause misleads more than no cause. */
#include "compare/cause/guesses.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Up to PATCHES squares of SIDE x SIDE pixels. Only the CORE x CORE pixels in the middle are
 * compared; the MARGIN holds the pixels that filters need: 8 for a blur and 4 for the smoothing.
 * PATCHES and CORE bound the cost: at most 65536 pixels are compared per step of a search. */
enum { PATCHES = 64, CORE = 32, MARGIN = 12, SIDE = CORE + 2 * MARGIN, CELLS = SIDE * SIDE };
/* The value of a pixel that is compared: the mean of its channels, a channel, or, from CHROMA on,
 * the channel minus this mean. */
enum { ALL_CHANNELS = -1, CHROMA = 3 };
/* Pixels this near to an edge of the picture are not compared, because filters mix them with values
 * beyond the edge: the smoothing reaches 4 pixels, cubic interpolation 2. */
enum { RIM = 6 };

/* The patches of both pictures. Those of A are translated by `start`. */
typedef struct Patches {
    const Picture *a, *b;
    Shift start;
    const float *levels; /* per code: its value in [0, 1], linear light or code / largest code */
    int channel; /* the value that is compared: ALL_CHANNELS, a channel, CHROMA + a channel */
    int n;
    double residue;         /* smallest fraction of the sum of squares that a change has left */
    PixelPlace at[PATCHES]; /* position in B of the first pixel of each patch */
    /* CELLS values per patch: A, A translated by `start`, B, and A or B after a change. `before` is
     * owned, the others point into it. */
    float *before, *from, *to, *moved;
} Patches;

/* Returns the value of a pixel that is compared, in levels. Pixels beyond an edge equal the nearest
 * pixel at the edge. */
static float level_at(const Picture *picture, int x, int y, int channel, const float *levels)
{
    x = x < 0 ? 0 : x < picture->width ? x : picture->width - 1;
    y = y < 0 ? 0 : y < picture->height ? y : picture->height - 1;
    const size_t channels = (size_t)picture->channels, i = first_code(picture, x, y);
    float sum = 0;
    if (channel >= 0 && channel < CHROMA)
        return 255 * levels[picture_code(picture, i + (size_t)channel)];
    for (size_t c = 0; c < channels; c++)
        sum += levels[picture_code(picture, i + c)];
    float mean = sum / (float)channels;
    if (channel == ALL_CHANNELS)
        return 255 * mean;
    return 255 * (levels[picture_code(picture, i + (size_t)(channel - CHROMA))] - mean);
}

/* Filters the rows of a patch, then the columns. taps[k] is the weight of the cell at distance
 * first + k. Cells whose filter would reach beyond the patch keep their values. */
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

/* Fills one patch with the smoothed values of a square of the picture. */
static void load(const Patches *patches, const Picture *picture, int left, int top, float *out)
{
    static const float binomial[9] = {1 / 256.0F,  8 / 256.0F,  28 / 256.0F,
                                      56 / 256.0F, 70 / 256.0F, 56 / 256.0F,
                                      28 / 256.0F, 8 / 256.0F,  1 / 256.0F};
    float levels[CELLS];
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            levels[y * SIDE + x] =
                level_at(picture, left + x, top + y, patches->channel, patches->levels);
    filter(levels, out, binomial, -4, 9);
}

/* Fills all patches with the smoothed values of patches->channel. */
static void load_patches(Patches *patches)
{
    const Shift *start = &patches->start;
    for (int i = 0; i < patches->n; i++) {
        int x = patches->at[i].x, y = patches->at[i].y;
        size_t first = (size_t)i * CELLS;
        load(patches, patches->a, x, y, patches->before + first);
        if (start->dx || start->dy)
            load(patches, patches->a, x - start->dx, y - start->dy, patches->from + first);
        else
            memcpy(patches->from + first, patches->before + first, CELLS * sizeof(float));
        load(patches, patches->b, x, y, patches->to + first);
    }
}

/* Puts a patch around each of up to PATCHES samples, evenly chosen, and fills the patches. */
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
    load_patches(patches);
    return STATUS_OK;
}

/* Returns true if a cell is compared: it is in the core, and away from the edges of both pictures.
 */
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

/* Moves *cell to the next cell that is compared. Returns false after the last one. Begin with
 * NO_CELL. */
enum { NO_CELL = -1 };

/* Moves *cell to the next cell that counts; false at the end. */
static bool next_cell(const Patches *patches, int *cell)
{
    while (++*cell < patches->n * CELLS) {
        int in_patch = *cell % CELLS;
        if (counts(patches, *cell / CELLS, in_patch % SIDE, in_patch / SIDE))
            return true;
    }
    return false;
}

/* Returns the sum of squared differences of two sets of patches. */
static double squares(const Patches *patches, const float *side, const float *other)
{
    double sum = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        double d = (double)(side[cell] - other[cell]);
        sum += d * d;
    }
    return sum;
}

/* ---- translated ------------------------------------------------------------------------------ */

/* Sets the four weights of cubic interpolation [Keys 1981] for a translation by d pixels, and the
 * distance of the first of them. d is in (-MARGIN / 2, MARGIN / 2). */
static void weigh_cubic(double d, float taps[4], int *first)
{
    double whole = floor(d), t = 1 - (d - whole);
    taps[0] = (float)(0.5 * (-t + 2 * t * t - t * t * t));
    taps[1] = (float)(0.5 * (2 - 5 * t * t + 3 * t * t * t));
    taps[2] = (float)(0.5 * (t + 4 * t * t - 3 * t * t * t));
    taps[3] = (float)(0.5 * (-t * t + t * t * t));
    *first = (int)-whole - 2;
}

/* Translates one patch: interpolates across and down with four weights each. Fills the core and the
 * pixels next to it, from which gradients are computed. */
static void translate_patch(const float *in, float *out, const float *across, int x_first,
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

/* Sets patches->moved to the patches of A translated by d pixels in addition to `start`. */
static void move(Patches *patches, const double d[2])
{
    float across[4], down[4];
    int x_first, y_first;
    weigh_cubic(d[0], across, &x_first);
    weigh_cubic(d[1], down, &y_first);
    for (int i = 0; i < patches->n; i++)
        translate_patch(patches->from + (size_t)i * CELLS, patches->moved + (size_t)i * CELLS,
                        across, x_first, down, y_first);
}

/* The parts of the picture whose displacements are compared. */
typedef enum Part { PART_ALL, PART_LEFT, PART_RIGHT, PART_TOP, PART_BOTTOM, PARTS } Part;

/* Returns true if a cell is in a half of the picture. */
static bool is_in_part(const Patches *patches, int cell, Part part)
{
    const PixelPlace *first = &patches->at[cell / CELLS];
    int x = first->x + cell % CELLS % SIDE, y = first->y + cell % CELLS / SIDE;
    bool left = 2 * x < patches->a->width, top = 2 * y < patches->a->height;
    return part == PART_ALL || (part == PART_LEFT && left) || (part == PART_RIGHT && !left) ||
           (part == PART_TOP && top) || (part == PART_BOTTOM && !top);
}

/* Computes a Gauss-Newton step for patches->moved, from the cells in a part of the picture. The
 * `ridge` keeps the step finite where all gradients have one direction: the step is then along it.
 * Returns false if these cells have no gradients. */
static bool find_step(const Patches *patches, Part part, double step[2])
{
    double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        if (!is_in_part(patches, cell, part))
            continue;
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
    step[0] = -((yy + ridge) * xr - xy * yr) / determinant;
    step[1] = -((xx + ridge) * yr - xy * xr) / determinant;
    return true;
}

/* Adds a Gauss-Newton step to the displacement. Returns false if there is no step, or if the
 * displacement leaves the range in which the margin holds the pixels of all filters. */
static bool improve(const Patches *patches, double d[2])
{
    double step[2];
    if (!find_step(patches, PART_ALL, step))
        return false;
    d[0] += step[0];
    d[1] += step[1];
    return fabs(d[0]) < MARGIN / 4.0 && fabs(d[1]) < MARGIN / 4.0;
}

/* Returns true if a change leaves less than 1/25 of the sum of squares. Records the fraction. */
static bool explains(Patches *patches, double before, double after)
{
    patches->residue = before > 0 ? fmin(patches->residue, after / before) : patches->residue;
    return before > 0 && 25 * after < before;
}

/* Returns the sum of squares that is left if the translated patches may also be blurred slightly. A
 * slight blur adds a multiple of the Laplacian. *blurred receives the best multiple; it is negative
 * if B is sharper. */
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

/* Rounds to multiples of 1 / unit. Adding 0 turns -0 into 0. */
static double round_to(double value, double unit)
{
    return round(value * unit) / unit + 0.0;
}

/* ---- blurred --------------------------------------------------------------------------------- */

/* Largest standard deviation of a blur, pixels: MARGIN holds three of them, and the smoothing. */
static const double max_sigma = 2.5;

/* Sets patches->moved to a side's patches blurred by a Gaussian. */
static void blur(Patches *patches, const float *side, double sigma)
{
    enum { REACH = 8 }; /* three times max_sigma */
    float taps[2 * REACH + 1], sum = 0;
    for (int i = -REACH; i <= REACH; i++)
        sum += taps[i + REACH] = (float)elementary_exp(-i * i / (2 * sigma * sigma));
    for (int i = 0; i <= 2 * REACH; i++)
        taps[i] /= sum;
    for (int i = 0; i < patches->n; i++)
        filter(side + (size_t)i * CELLS, patches->moved + (size_t)i * CELLS, taps, -REACH,
               2 * REACH + 1);
}

/* A side that is blurred, and the side that it is compared with. */
typedef struct BlurSearch {
    Patches *patches;
    const float *side, *other;
} BlurSearch;

/* Returns the sum of squares that is left when the side is blurred. */
static double squares_when_blurred(void *context, double sigma)
{
    const BlurSearch *search = context;
    blur(search->patches, search->side, sigma);
    return squares(search->patches, search->patches->moved, search->other);
}

/* ---- is the change the only one, and of the whole picture? ----------------------------------- */

/* A change that may have turned A into B. */
typedef struct Warp {
    double d[2];   /* displacement in addition to Patches.start, px */
    double dx, dy; /* displacement of the picture, px */
    double sigma;  /* standard deviation of a blur, px; 0: a displacement */
    bool sharper;  /* the blur turns B into A */
} Warp;

/* Sets patches->moved to the patches after the change. */
static void warp(Patches *patches, const Warp *what)
{
    if (what->sigma > 0)
        blur(patches, what->sharper ? patches->to : patches->before, what->sigma);
    else
        move(patches, what->d);
}

/* Returns true if the least squares fit B = gain A + offset of the changed patches is nearly the
 * identity. If the variance of A is below 1, the gain is not known and counts as 1. */
static bool has_same_tones(const Patches *patches, const float *other, double slack_gain)
{
    const double slack_levels = 0.75; /* of the mean; rounding changes it by up to 0.5 */
    double n = 0, a = 0, b = 0, aa = 0, ab = 0;
    for (int cell = NO_CELL; next_cell(patches, &cell);) {
        double in_a = (double)patches->moved[cell], in_b = (double)other[cell];
        n++;
        a += in_a;
        b += in_b;
        aa += in_a * in_a;
        ab += in_a * in_b;
    }
    double variance = n * aa - a * a;
    double gain = variance > n * n ? (n * ab - a * b) / variance : 1;
    return fabs(gain - 1) <= slack_gain && fabs(b - a) <= slack_levels * n;
}

/* Loads the patches of a channel, and applies the change. Returns the patches to compare with. */
static const float *load_changed(Patches *patches, int channel, const Warp *what)
{
    patches->channel = channel;
    load_patches(patches);
    warp(patches, what);
    return what->sharper ? patches->before : patches->to;
}

/* Returns true if the saturation is the same. The tones of single channels do not show this: in
 * nearly grey pictures, they hide another saturation. */
static bool has_same_saturation(Patches *patches, const Warp *what)
{
    double aa = 0, ab = 0;
    for (int c = 0; c < patches->a->channels; c++) {
        const float *other = load_changed(patches, CHROMA + c, what);
        for (int cell = NO_CELL; next_cell(patches, &cell);) {
            aa += (double)(patches->moved[cell] * patches->moved[cell]);
            ab += (double)(patches->moved[cell] * other[cell]);
        }
    }
    return cause_is_same_saturation(aa, ab);
}

/* Returns true if each channel keeps its tones. The slack of the gain, 2.2 %, covers two
 * interpolations, which change the contrast by up to 2 %, and blurs that are not exactly Gaussian.
 * A translation by whole pixels interpolates nothing, so its slack is 0.5 %. */
static bool keeps_tones(Patches *patches, const Warp *what)
{
    bool whole = what->sigma == 0 && fabs(what->d[0]) < 0.02 && fabs(what->d[1]) < 0.02;
    bool same = true;
    for (int c = 0; c < patches->a->channels && same; c++) {
        const float *other = load_changed(patches, c, what);
        same = has_same_tones(patches, other, whole ? 0.005 : 0.022);
    }
    same = same && has_same_saturation(patches, what);
    load_changed(patches, ALL_CHANNELS, what);
    return same;
}

/* Returns true if the halves of the picture have the same displacement. A picture that is scaled or
 * rotated has different ones. */
static bool is_one_displacement(const Patches *patches)
{
    const double slack_px = 0.1;
    for (Part part = PART_LEFT; part < PARTS; part++) {
        double step[2];
        if (find_step(patches, part, step) && !(elementary_hypot(step[0], step[1]) < slack_px))
            return false;
    }
    return true;
}

/* The picture is divided into GRID x GRID fields, each of which must have changed. More fields
 * would find smaller unchanged parts, but would have too few edges to decide. */
enum { GRID = 8 };

/* Sums over the pixels of each field of a grid over the picture. */
typedef struct Fields {
    double expected[GRID * GRID]; /* how much A changes over one pixel */
    double found[GRID * GRID];    /* how much B differs from A */
} Fields;

/* By how much B must differ from A where A changes: at least the fraction `part` of the difference
 * of A from A translated by n steps. Differences below `least`, codes summed over the channels, do
 * not count. */
typedef struct Expected {
    int steps[2][2], n, least;
    double part;
} Expected;

/* Sums expected and found differences over all pixels of each field. */
static void sum_fields(const Patches *patches, const Expected *expected, Fields *fields)
{
    const Picture *a = patches->a, *b = patches->b;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            int field = y * GRID / a->height * GRID + x * GRID / a->width;
            for (int k = 0; k < expected->n; k++) {
                const int *step = expected->steps[k];
                int apart = pixels_apart(a, x, y, a, x - step[0], y - step[1]);
                if (apart >= expected->least)
                    fields->expected[field] += apart / (double)expected->n;
            }
            fields->found[field] += pixels_apart(a, x, y, b, x, y);
        }
}

/* Returns true if B differs from A in every field in which A changes. An unchanged field
 * contradicts a change of the whole picture. */
static bool is_everywhere(const Patches *patches, const Expected *expected)
{
    const double enough = 0.25; /* of the mean, so that a few pixels of a field do not decide */
    Fields fields = {{0}, {0}};
    double sum = 0;
    sum_fields(patches, expected, &fields);
    for (int i = 0; i < GRID * GRID; i++)
        sum += fields.expected[i];
    for (int i = 0; i < GRID * GRID; i++)
        if (fields.expected[i] > enough * sum / (GRID * GRID) &&
            fields.found[i] < expected->part * fields.expected[i])
            return false;
    return true;
}

/* Returns true if the displacement changed every field. Expected is a tenth of what a step of one
 * pixel in the direction of the displacement changes, or less for a shorter displacement. */
static bool is_moved_everywhere(const Patches *patches, double dx, double dy)
{
    const double largest = fmax(fabs(dx), fabs(dy)), unit = fmin(largest, 1);
    const Expected expected = {
        .steps = {{(int)lround(dx / unit), (int)lround(dy / unit)}}, .n = 1, .part = 0.1 * unit};
    return is_everywhere(patches, &expected);
}

/* Returns the smallest difference of A at (x, y) from the pixels of A that a displacement by (dx,
 * dy) may bring there: those at the displacement rounded down and up. */
static int change_of_move(const Picture *a, int x, int y, double dx, double dy)
{
    const double slack = 0.1; /* error of the displacement found */
    int least = INT_MAX;
    for (int v = (int)floor(dy + slack); v <= (int)ceil(dy - slack); v++)
        for (int u = (int)floor(dx + slack); u <= (int)ceil(dx - slack); u++) {
            int apart = pixels_apart(a, x, y, a, x - u, y - v);
            least = apart < least ? apart : least;
        }
    return least;
}

/* Returns true if a part of the picture was not moved, however few pixels of it show something:
 * more than 0.5 % of the pixels that a displacement by (dx, dy) must change clearly are equal in A
 * and B. A change is clear from 48 codes on, summed over the channels: interpolation cannot undo
 * it. */
static bool has_unmoved_part(const Patches *patches, double dx, double dy)
{
    const Picture *a = patches->a;
    const int clear = 48 * codes_per_level(a);
    size_t moved = 0, equal = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            if (change_of_move(a, x, y, dx, dy) >= clear) {
                moved++;
                equal += pixels_apart(a, x, y, patches->b, x, y) == 0;
            }
    return (double)equal > 0.005 * (double)moved;
}

/* Returns true if the blur changed every field. Only edges count, steps of at least 96 levels
 * between neighbours, summed over the channels: a blur changes edges, not slopes. */
static bool is_blurred_everywhere(const Patches *patches)
{
    const int edge = 96 * codes_per_level(patches->a);
    const Expected expected = {.steps = {{1, 0}, {0, 1}}, .n = 2, .least = edge, .part = 0.02};
    return is_everywhere(patches, &expected);
}

/* Returns true if all pixels up to `reach` from (x, y) differ from it by at most a level. */
static bool is_flat(const Picture *picture, int x, int y, int reach)
{
    const int level = codes_per_level(picture);
    for (int v = y - reach; v <= y + reach; v++)
        for (int u = x - reach; u <= x + reach; u++)
            if (pixels_apart(picture, x, y, picture, u, v) > level)
                return false;
    return true;
}

/* Returns true if B has the codes of A where A is flat, except for 5 % of the flat pixels. Neither
 * a displacement by (dx, dy) nor a blur changes them, but noise and other tones do. Tests about
 * ASKED pixels, which bounds the cost; fewer than ENOUGH flat pixels among them decide nothing. */
static bool keeps_flat_parts(const Patches *patches, int dx, int dy, int reach)
{
    enum { ASKED = 20000, ENOUGH = 50 };
    const Picture *a = patches->a, *b = patches->b;
    const size_t pixels = (size_t)a->width * (size_t)a->height, step = pixels / ASKED + 1;
    const int level = codes_per_level(a);
    size_t flat = 0, changed = 0;
    for (size_t i = 0; i < pixels; i += step) {
        int x = (int)(i % (size_t)a->width), y = (int)(i / (size_t)a->width);
        if (x < reach || y < reach || x + reach >= a->width || y + reach >= a->height ||
            !is_flat(a, x, y, reach))
            continue;
        flat++;
        changed += pixels_apart(a, x, y, b, x + dx, y + dy) > 2 * level;
    }
    return flat < ENOUGH || 20 * changed <= flat;
}

/* Returns true if nothing contradicts a change that explains the patches. */
static bool is_only_change(Patches *patches, const Warp *what)
{
    if (what->sigma > 0)
        return keeps_tones(patches, what) && is_blurred_everywhere(patches) &&
               keeps_flat_parts(patches, 0, 0, (int)ceil(3 * what->sigma) + 1);
    return is_one_displacement(patches) && keeps_tones(patches, what) &&
           is_moved_everywhere(patches, what->dx, what->dy) &&
           !has_unmoved_part(patches, what->dx, what->dy) &&
           keeps_flat_parts(patches, (int)lround(what->dx), (int)lround(what->dy), 2);
}

/* ---- the two changes ------------------------------------------------------------------------- */

/* Fits a displacement and writes the sentence if it is the cause, alone or with a slight blur. The
 * iterations converge fast, so STEPS of them suffice from a start within a pixel. */
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
    const Warp found = {.d = {d[0], d[1]}, .dx = dx, .dy = dy};
    if ((alone ||
         (2 * after < before && explains(patches, before, left_by_blur(patches, &blurred)))) &&
        is_only_change(patches, &found))
        snprintf(out->text, out->size,
                 "B is nearly A moved by (%.*f, %.*f) pixels (right and down are positive)%s",
                 digits, round_to(dx, unit), digits, round_to(dy, unit),
                 alone         ? ""
                 : blurred > 0 ? " and blurred a little"
                               : " and sharpened a little");
}

/* Fits a blur of either side and writes the sentence if it is the cause. STEPS shrink the interval
 * of the standard deviation to 0.01 pixels. A result at the end of the range is no minimum. */
static void try_blur(Patches *patches, Sentence *out)
{
    enum { STEPS = 11 };
    const float *sides[2] = {patches->before, patches->to};
    double before = squares(patches, sides[0], sides[1]), after;
    for (int sharper = 0; sharper < 2; sharper++) {
        BlurSearch search = {patches, sides[sharper], sides[!sharper]};
        if (1.1 * squares_when_blurred(&search, 0.5) >= before)
            continue; /* the other side is the blurred one: a little blur does not help */
        double sigma =
            golden_section(squares_when_blurred, &search, 0.05, max_sigma, STEPS, &after);
        const Warp found = {.sigma = sigma, .sharper = sharper};
        if (sigma < 0.98 * max_sigma && explains(patches, before, after) &&
            is_only_change(patches, &found))
            snprintf(out->text, out->size,
                     "%s is nearly %s blurred (Gaussian, standard deviation %.2g pixels)",
                     sharper ? "A" : "B", sharper ? "B" : "A", sigma);
    }
}

/* Makes a table of the fraction code / largest code of each code of 8 or 16 bits. */
static Status code_table(int bits, float **table, Err *err)
{
    int n = 1 << bits;
    TRY(mem_calloc(table, (size_t)n, sizeof **table, "codes", err));
    for (int i = 0; i < n; i++)
        (*table)[i] = (float)i / (float)(n - 1);
    return STATUS_OK;
}

/* Tests both changes, in linear light or in codes. */
static Status try_warp(Patches *patches, const Samples *samples, const Shift *start, bool linear,
                       Sentence *out, Err *err)
{
    float *levels;
    TRY((linear ? srgb_table : code_table)(patches->a->bits, &levels, err));
    Status status = STATUS_OK;
    patches->start = *start;
    patches->levels = levels;
    patches->n = 0;
    TRY_GOTO(patches_init(patches, samples, err));
    try_shift(patches, out);
    patches->start = (Shift){0};
    if (!*out->text)
        try_blur(patches, out);
done:
    free(patches->before);
    free(levels);
    return status;
}

/* Linear light is tried only if the change in codes leaves at most half of the sum of squares: the
 * two do not differ by more. */
Status cause_warp(const Picture *a, const Picture *b, const Samples *samples, const Shift *start,
                  Sentence *out, Err *err)
{
    Patches patches = {.a = a, .b = b, .channel = ALL_CHANNELS, .residue = 1};
    TRY(try_warp(&patches, samples, start, false, out, err));
    if (*out->text || a->gamma != 0 || patches.residue > 0.5)
        return STATUS_OK;
    patches = (Patches){.a = a, .b = b, .channel = ALL_CHANNELS, .residue = 1};
    return try_warp(&patches, samples, start, true, out, err);
}
