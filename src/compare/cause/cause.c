/* Finds the change that turned A into B. The hypotheses are tested one after the other, until one
 * explains the pictures: exact changes come before approximate ones, and changes of position before
 * changes of color. A hypothesis must leave nearly no difference; a mere resemblance is not named,
 * because a wrong cause misleads. So two changes at once have no cause, unless one makes less than
 * a fiftieth of the differences. To save time, each hypothesis is first tested on a few hundred of
 * the pixels that differ, and on all pixels only if it fits those.
 *
 * This file has the order of the tests [compare_cause], and tests the exact changes: mirrored,
 * channels exchanged, translated by whole pixels. */
#include "compare/cause/cause.h"

#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* REACH: translations up to this many pixels in each direction are tried; the cost is O(REACH^2).
 * A larger translation stays without a name. BLOCK: pixels that are compared at once; it affects
 * the speed only. */
enum { REACH = 48, BLOCK = 64 };

/* Adds every `step`-th differing pixel of a row to the samples. *seen counts the differing pixels
 * of all rows so far. Equal blocks are skipped at once. */
static void take_row(const Picture *a, const Picture *b, int y, size_t step, size_t *seen,
                     Samples *samples)
{
    for (int x = 0, end; x < a->width; x = end) {
        end = x + BLOCK < a->width ? x + BLOCK : a->width;
        if (picture_rows_equal(a, b, y, x, end - x))
            continue;
        for (; x < end && samples->n < CAUSE_SAMPLES; x++)
            if (!picture_rows_equal(a, b, y, x, 1) && (*seen)++ % step == 0)
                samples->at[samples->n++] = (PixelPlace){.x = x, .y = y};
    }
}

/* Finds the bounding box of all pixels that differ. */
static PixelRect find_box(const Picture *a, const Picture *b)
{
    PixelRect box = {0};
    for (int y = 0; y < a->height; y++) {
        int left = 0, right = a->width - 1;
        if (picture_rows_equal(a, b, y, 0, a->width))
            continue;
        while (picture_rows_equal(a, b, y, left, 1))
            left++;
        while (picture_rows_equal(a, b, y, right, 1))
            right--;
        pixelrect_include(&box, left, y);
        pixelrect_include(&box, right, y);
    }
    return box;
}

/* Takes every step-th of the differing pixels, at most CAUSE_SAMPLES of them. */
static void choose_samples(const Picture *a, const Picture *b, size_t differing, Samples *samples)
{
    size_t step = (differing + CAUSE_SAMPLES - 1) / CAUSE_SAMPLES, seen = 0;
    samples->n = 0;
    for (int y = 0; y < a->height; y++)
        if (!picture_rows_equal(a, b, y, 0, a->width))
            take_row(a, b, y, step, &seen, samples);
}

/* Returns true if the differences `after` a change are at most the fraction `part` of those before.
 */
static bool leaves(double before, double after, double part)
{
    return before > 0 && after <= part * before;
}

/* ---- turned, or with other channels ---------------------------------------------------------- */

/* A rotation or reflection of the picture, or an exchange of channels. */
typedef struct Turn {
    bool mirrored, upended; /* left and right, or top and bottom, are exchanged */
    int from[3];            /* per channel of B: the channel of A that it shows */
    const char *sentence;
} Turn;

/* Adds the difference of pixel (x, y) of B from A to sums[0], and from the turned A to sums[1]. */
static void add_turned(const Picture *a, const Picture *b, const Turn *turn, int x, int y,
                       double sums[2])
{
    int u = turn->mirrored ? a->width - 1 - x : x, v = turn->upended ? a->height - 1 - y : y;
    sums[0] += pixels_apart(a, x, y, b, x, y);
    for (int c = 0; c < a->channels; c++)
        sums[1] += abs(code_at(b, x, y, c) - code_at(a, u, v, turn->from[c]));
}

/* Returns true if pixel (x, y) has another color than pixel (0, 0), which usually shows the
 * background. */
static bool is_foreground(const Picture *picture, int x, int y)
{
    for (int c = 0; c < picture->channels; c++)
        if (code_at(picture, x, y, c) != code_at(picture, 0, 0, c))
            return true;
    return false;
}

/* Returns true if the turn leaves at most 2 % of the differences, in all pixels and in those of the
 * foreground alone. A large background of one color could hide that the foreground still differs.
 * The samples decide at 5 %, since they are few. */
static bool is_turned(const Picture *a, const Picture *b, const Samples *samples, const Turn *turn)
{
    double few[2] = {0}, all[2] = {0}, foreground[2] = {0};
    if (a->channels == 1 && turn->from[0] != 0)
        return false;
    for (int i = 0; i < samples->n; i++)
        add_turned(a, b, turn, samples->at[i].x, samples->at[i].y, few);
    if (!leaves(few[0], few[1], 0.05))
        return false;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            add_turned(a, b, turn, x, y, all);
            if (is_foreground(b, x, y))
                add_turned(a, b, turn, x, y, foreground);
        }
    return leaves(all[0], all[1], 0.02) && foreground[1] <= 0.02 * foreground[0];
}

/* Tests the turns: mirrored or rotated pictures, and exchanged channels. */
static void find_turn(const Picture *a, const Picture *b, const Samples *samples, Sentence *out)
{
    static const Turn turns[] = {
        {true, false, {0, 1, 2}, "mirrored left to right"},
        {false, true, {0, 1, 2}, "flipped top to bottom"},
        {true, true, {0, 1, 2}, "rotated by 180 degrees"},
        {false, false, {2, 1, 0}, "with red and blue exchanged"},
        {false, false, {1, 0, 2}, "with red and green exchanged"},
        {false, false, {0, 2, 1}, "with green and blue exchanged"},
        {false, false, {1, 2, 0}, "with channels in the order green, blue, red"},
        {false, false, {2, 0, 1}, "with channels in the order blue, red, green"},
    };
    for (size_t i = 0; i < sizeof turns / sizeof *turns && !*out->text; i++)
        if (is_turned(a, b, samples, &turns[i]))
            snprintf(out->text, out->size, "B is A %s", turns[i].sentence);
}

/* ---- translated by whole pixels -------------------------------------------------------------- */

/* A sampled pixel of A, with its codes. */
typedef struct ShiftSample {
    int x, y, codes[3];
    double off; /* pixels_apart from B without a shift */
} ShiftSample;

/* Compares samples for qsort; the largest difference is first. */
static int most_off_first(const void *left, const void *right)
{
    const ShiftSample *a = left, *b = right;
    return (a->off < b->off) - (a->off > b->off);
}

/* Copies the codes of A at the samples, and sorts the samples by their differences. */
static void take_samples(const Picture *a, const Picture *b, const Samples *samples,
                         ShiftSample *out)
{
    for (int i = 0; i < samples->n; i++) {
        int x = samples->at[i].x, y = samples->at[i].y;
        out[i] = (ShiftSample){.x = x, .y = y, .off = pixels_apart(a, x, y, b, x, y)};
        for (int c = 0; c < a->channels; c++)
            out[i].codes[c] = code_at(a, x, y, c);
    }
    qsort(out, (size_t)samples->n, sizeof *out, most_off_first);
}

/* Returns the mean difference over the samples that a shift keeps within the picture. Returns
 * infinity if it keeps fewer than three in four, and as soon as the sum exceeds `limit`. */
static double off_when_shifted(const Picture *b, const ShiftSample *samples, int n, int dx, int dy,
                               double limit)
{
    double sum = 0;
    int inside = 0;
    for (int i = 0; i < n; i++) {
        int u = samples[i].x + dx, v = samples[i].y + dy;
        if (!has_pixel(b, u, v))
            continue;
        for (int c = 0; c < b->channels; c++)
            sum += abs(code_at(b, u, v, c) - samples[i].codes[c]);
        inside++;
        if (sum > limit)
            return (double)INFINITY;
    }
    return 4 * inside >= 3 * n && inside > 0 ? sum / inside : (double)INFINITY;
}

/* Tries all shifts up to REACH. Of equally good shifts, returns the shortest. */
static Shift search_shifts(const Picture *b, const ShiftSample *samples, int n)
{
    Shift best = {.off = off_when_shifted(b, samples, n, 0, 0, (double)INFINITY)};
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            double off = off_when_shifted(b, samples, n, dx, dy, best.off * n);
            bool nearer = dx * dx + dy * dy < best.dx * best.dx + best.dy * best.dy;
            if (off < best.off || (off == best.off && nearer))
                best = (Shift){.dx = dx, .dy = dy, .off = off};
        }
    return best;
}

/* Returns the shift that leaves the smallest mean difference of the samples; no shift if it removes
 * less than 30 % of the difference. Samples that differ most come first, because they exceed the
 * limit of a wrong shift soonest. FEW samples, a quarter of all, are tried before all, since most
 * pictures are not moved: a larger FEW costs more for these, a smaller one misses more shifts. */
static Shift best_shift(const Picture *a, const Picture *b, const Samples *samples)
{
    enum { FEW = 64 };
    ShiftSample taken[CAUSE_SAMPLES], few[FEW];
    take_samples(a, b, samples, taken);
    const Shift none = {.off = off_when_shifted(b, taken, samples->n, 0, 0, (double)INFINITY)};
    if (samples->n <= FEW)
        return search_shifts(b, taken, samples->n);
    for (int i = 0; i < FEW; i++)
        few[i] = taken[i * samples->n / FEW];
    double before = off_when_shifted(b, few, FEW, 0, 0, (double)INFINITY);
    bool moved = leaves(before, search_shifts(b, few, FEW).off, 0.7);
    return moved ? search_shifts(b, taken, samples->n) : none;
}

/* Sums of |b - a| over the pixels that both pictures have with a shift and without. */
typedef struct ShiftTrial {
    double before, after; /* without the shift, and with it */
    double made;          /* with the shift, of pixels that are equal without it */
} ShiftTrial;

/* Sums the differences over all pixels, with and without a shift. */
static ShiftTrial try_shift(const Picture *a, const Picture *b, const Shift *shift)
{
    ShiftTrial trial = {0};
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const int u = x + shift->dx, v = y + shift->dy;
            if (!has_pixel(b, u, v))
                continue;
            const int after = pixels_apart(a, x, y, b, u, v);
            trial.before += pixels_apart(a, x, y, b, x, y);
            trial.after += after;
            trial.made += pixels_apart(a, u, v, b, u, v) == 0 ? after : 0;
        }
    return trial;
}

bool cause_is_same_saturation(double aa, double ab)
{
    const double enough = 1e4; /* rounding of codes changes the quotient by at most 0.5 % then */
    return aa < enough || fabs(ab / aa - 1) <= 0.03;
}

/* Returns true if the shifted A has the saturation of B. */
static bool keeps_saturation(const Picture *a, const Picture *b, const Shift *shift)
{
    const double level = codes_per_level(a);
    double aa = 0, ab = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            int u = x + shift->dx, v = y + shift->dy, sum_a = 0, sum_b = 0;
            if (!has_pixel(b, u, v))
                continue;
            for (int c = 0; c < a->channels; c++) {
                int in_a = code_at(a, x, y, c), in_b = code_at(b, u, v, c);
                sum_a += in_a;
                sum_b += in_b;
                aa += (double)in_a * in_a;
                ab += (double)in_a * in_b;
            }
            aa -= (double)sum_a * sum_a / a->channels;
            ab -= (double)sum_a * sum_b / a->channels;
        }
    return cause_is_same_saturation(aa / (level * level), ab / (level * level));
}

/* Tests whether B is A moved by the best shift: it must leave at most 2 % of the differences where
 * both pictures are. Returns true, and writes no sentence, if a part of the picture did not move.
 *
 * A part of the picture that was not moved contradicts a shift, however little the part shows:
 * there the pictures are equal without the shift, and the shift makes them differ. So at most half
 * of the differences that are left may be made by the shift. */
static bool find_shift(const Picture *a, const Picture *b, const Samples *samples,
                       const Shift *shift, Sentence *out)
{
    double before = 0;
    for (int i = 0; i < samples->n; i++) {
        const PixelPlace *at = &samples->at[i];
        before += pixels_apart(a, at->x, at->y, b, at->x, at->y);
    }
    if (!leaves(before, shift->off * samples->n, 0.05))
        return false;
    const ShiftTrial trial = try_shift(a, b, shift);
    if (!leaves(trial.before, trial.after, 0.02))
        return false;
    if (trial.made > trial.after / 2)
        return true;
    if (trial.after == 0 || keeps_saturation(a, b, shift))
        snprintf(out->text, out->size,
                 "B is %sA moved by (%d, %d) pixels (right and down are positive)",
                 trial.after > 0 ? "nearly " : "", shift->dx, shift->dy);
    return false;
}

/* ---- functions that several guesses use ------------------------------------------------------ */

double golden_section(double (*f)(void *context, double x), void *context, double low, double high,
                      int steps, double *least)
{
    const double golden = 0.6180339887498949;
    double x[2] = {high - golden * (high - low), low + golden * (high - low)};
    double value[2] = {f(context, x[0]), f(context, x[1])};
    for (int i = 0; i < steps; i++) {
        const int worse = value[0] < value[1];
        *(worse ? &high : &low) = x[worse];
        x[worse] = x[!worse];
        value[worse] = value[!worse];
        x[!worse] = worse ? high - golden * (high - low) : low + golden * (high - low);
        value[!worse] = f(context, x[!worse]);
    }
    *least = fmin(value[0], value[1]);
    return (low + high) / 2;
}

Status linear_of_codes(const Picture *picture, Plane *lights, Err *err)
{
    Picture codes;
    TRY(picture_init(&codes, 1 << picture->bits, 1, 1, picture->bits, err));
    codes.gamma = picture->gamma;
    for (int i = 0; i < codes.width; i++)
        picture_set(&codes, (size_t)i, (uint16_t)i);
    Status status = plane_from_picture(lights, &codes, err);
    picture_release(&codes);
    return status;
}

/* ---- the order of the tests ------------------------------------------------------------------ */

Status compare_cause(const Picture *a, const Picture *b, CompareResult *result, Err *err)
{
    Sentence out = {result->cause, sizeof result->cause};
    if (result->values[MEASURE_DIFFERING_PIXELS] == 0)
        return STATUS_OK;
    Samples samples;
    result->box = find_box(a, b);
    choose_samples(a, b, result_count(result, MEASURE_DIFFERING_PIXELS), &samples);
    find_turn(a, b, &samples, &out);
    if (!*out.text)
        TRY(cause_background(a, b, &samples, &out, err));
    const Shift shift = *out.text ? (Shift){0} : best_shift(a, b, &samples);
    const bool partly_moved = !*out.text && find_shift(a, b, &samples, &shift, &out);
    if (!*out.text && result->values[MEASURE_MAX_CODE] <= 1)
        snprintf(out.text, out.size,
                 "only rounding differs: no 8- or 16-bit value is off by more than 1");
    if (!*out.text)
        TRY(cause_tone(a, b, &samples, &out, err));
    if (!*out.text && !partly_moved)
        TRY(cause_warp(a, b, &samples, &shift, &out, err));
    if (!*out.text)
        cause_hue(a, b, &samples, &out);
    if (!*out.text && !partly_moved)
        TRY(cause_affine(a, b, &out, err));
    if (!*out.text)
        TRY(cause_jpeg(a, b, &out, err));
    if (!*out.text)
        cause_noise(a, b, &out);
    return *out.text ? STATUS_OK : cause_place(a, b, &samples, result, &out, err);
}
