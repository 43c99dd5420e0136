/* What made B of A, where that can be said for certain: each guess is a map of one picture onto the
 * other, and it is named when it explains the pictures, not when it merely resembles them. Guesses
 * about places come before those about colours. Shifts and gains are tried on a few hundred of the
 * pixels that differ, and only the one that fits them on all. */
#include "verify/result.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 256, REACH = 48, BLOCK = 64 };

/* Pixels that differ, evenly spread over all that do. */
typedef struct Samples {
    PixelPlace at[SAMPLES];
    int n;
} Samples;

static void take_block(const Picture *a, const Picture *b, int x, int y, size_t step, size_t *seen,
                       Samples *samples)
{
    int end = x + BLOCK < a->width ? x + BLOCK : a->width;
    if (picture_rows_equal(a, b, y, x, end - x))
        return;
    for (; x < end && samples->n < SAMPLES; x++)
        if (!picture_rows_equal(a, b, y, x, 1) && (*seen)++ % step == 0)
            samples->at[samples->n++] = (PixelPlace){.x = x, .y = y};
}

static void choose_samples(const Picture *a, const Picture *b, size_t differing, Samples *samples)
{
    size_t step = (differing + SAMPLES - 1) / SAMPLES, seen = 0;
    samples->n = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width && !picture_rows_equal(a, b, y, 0, a->width); x += BLOCK)
            take_block(a, b, x, y, step, &seen, samples);
}

static int code_at(const Picture *picture, int x, int y, int c)
{
    size_t pixel = (size_t)y * (size_t)picture->width + (size_t)x;
    return picture_code(picture, pixel * (size_t)picture->channels + (size_t)c);
}

/* ---- turned, or with other channels ---------------------------------------------------------- */

typedef struct Turn {
    bool mirrored, upended, swapped; /* left and right, top and bottom, red and blue */
    const char *sentence;
} Turn;

static bool is_turned(const Picture *a, const Picture *b, const Turn *turn)
{
    int channels = a->channels;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < channels; c++)
                if (code_at(b, x, y, c) != code_at(a, turn->mirrored ? a->width - 1 - x : x,
                                                   turn->upended ? a->height - 1 - y : y,
                                                   turn->swapped ? channels - 1 - c : c))
                    return false;
    return true;
}

static const char *find_turn(const Picture *a, const Picture *b)
{
    static const Turn turns[] = {
        {true, false, false, "B is A mirrored, left for right"},
        {false, true, false, "B is A upside down, top for bottom"},
        {true, true, false, "B is A turned by 180 degrees"},
        {false, false, true, "B is A with red and blue exchanged"},
    };
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
        if (is_turned(a, b, &turns[i]))
            return turns[i].sentence;
    return NULL;
}

/* ---- moved ----------------------------------------------------------------------------------- */

typedef struct Shift {
    int dx, dy; /* pixel (x, y) of A is (x + dx, y + dy) of B */
    double off; /* the sum of all differences, codes */
} Shift;

/* Sum of |b - a| of one pixel of A; false where B has no such pixel. */
static bool differs_by(const Picture *a, const Picture *b, int x, int y, const Shift *shift,
                       double *sum)
{
    int u = x + shift->dx, v = y + shift->dy;
    if (u < 0 || u >= b->width || v < 0 || v >= b->height)
        return false;
    for (int c = 0; c < a->channels; c++)
        *sum += abs(code_at(b, u, v, c) - code_at(a, x, y, c));
    return true;
}

/* The shift with the smallest mean difference of the samples that stay within the picture, three in
 * four of which have to. */
static Shift best_shift(const Picture *a, const Picture *b, const Samples *samples)
{
    int n = samples->n;
    Shift best = {.off = (double)INFINITY};
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            Shift shift = {.dx = dx, .dy = dy};
            double sum = 0;
            int inside = 0;
            for (int i = 0; i < n && sum < best.off * n; i++)
                inside += differs_by(a, b, samples->at[i].x, samples->at[i].y, &shift, &sum);
            shift.off = sum / (inside ? inside : 1);
            bool nearer = dx * dx + dy * dy < best.dx * best.dx + best.dy * best.dy;
            if (4 * inside >= 3 * n && (shift.off < best.off || (shift.off == best.off && nearer)))
                best = shift;
        }
    return best;
}

static double off_by(const Picture *a, const Picture *b, const Shift *shift, const Shift *common)
{
    double sum = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            int u = x + common->dx, v = y + common->dy;
            if (u >= 0 && u < b->width && v >= 0 && v < b->height)
                differs_by(a, b, x, y, shift, &sum);
        }
    return sum;
}

/* A shift that leaves less than a fiftieth of the differences where both pictures have pixels. */
static bool find_shift(const Picture *a, const Picture *b, const Samples *samples, char *out,
                       size_t size)
{
    static const Shift none = {0};
    Shift shift = best_shift(a, b, samples);
    double before = 0;
    for (int i = 0; i < samples->n; i++)
        differs_by(a, b, samples->at[i].x, samples->at[i].y, &none, &before);
    if (shift.off * samples->n > before / 20)
        return false;
    before = off_by(a, b, &none, &shift);
    double after = off_by(a, b, &shift, &shift);
    if (after > before / 50)
        return false;
    snprintf(out, size, "B is %sA moved by (%d, %d) pixels, right and down being positive",
             after > 0 ? "nearly " : "", shift.dx, shift.dy);
    return true;
}

/* ---- brighter or darker ---------------------------------------------------------------------- */

/* Of each code of a picture, what it means. */
typedef struct Meaning {
    Plane linear;    /* owned; a value for each code */
    Plane levels;    /* owned; 8-bit levels of sRGB */
    Plane predicted; /* owned; the levels of a gain times its linear value */
} Meaning;

static void meaning_release(Meaning *meaning)
{
    plane_release(&meaning->linear);
    plane_release(&meaning->levels);
    plane_release(&meaning->predicted);
}

static Status meaning_init(Meaning *meaning, const Picture *picture, Err *err)
{
    Picture codes;
    int n = 1 << picture->bits;
    TRY(picture_init(&codes, n, 1, 1, picture->bits, err));
    codes.gamma = picture->gamma;
    for (int i = 0; i < n; i++)
        picture_set(&codes, (size_t)i, (uint16_t)i);
    Status status = plane_from_picture(&meaning->linear, &codes, err);
    picture_release(&codes);
    if (status == STATUS_OK)
        status = plane_init(&meaning->levels, n, 1, 1, err);
    if (status == STATUS_OK)
        status = plane_init(&meaning->predicted, n, 1, 1, err);
    for (int i = 0; status == STATUS_OK && i < n; i++)
        meaning->levels.values[i] = 255 * srgb_encode(meaning->linear.values[i]);
    return status;
}

/* Linear light, and codes that are off by more than a level, before and after the gain. */
typedef struct Light {
    double a, b;
    size_t beyond, misfits;
} Light;

/* Adds a sample, unless it is white in either picture, where it may be clipped. */
static void add_sample(const Meaning *meaning, const Picture *a, const Picture *b, size_t i,
                       Light *light)
{
    int in_a = picture_code(a, i), in_b = picture_code(b, i), white = meaning->linear.width - 1;
    if (in_a == white || in_b == white)
        return;
    float level = meaning->levels.values[in_b];
    light->a += (double)meaning->linear.values[in_a];
    light->b += (double)meaning->linear.values[in_b];
    light->beyond += fabsf(meaning->levels.values[in_a] - level) > 1.01F;
    light->misfits += fabsf(meaning->predicted.values[in_a] - level) > 1.01F;
}

static Light light_of_samples(const Meaning *meaning, const Picture *a, const Picture *b,
                              const Samples *samples)
{
    Light light = {0};
    size_t channels = (size_t)a->channels;
    for (int i = 0; i < samples->n; i++)
        for (size_t c = 0; c < channels; c++) {
            size_t pixel = (size_t)samples->at[i].y * (size_t)a->width + (size_t)samples->at[i].x;
            add_sample(meaning, a, b, pixel * channels + c, &light);
        }
    return light;
}

static Light light_of_all(const Meaning *meaning, const Picture *a, const Picture *b)
{
    Light light = {0};
    for (size_t i = 0; i < picture_stride(a) * (size_t)a->height; i++)
        add_sample(meaning, a, b, i, &light);
    return light;
}

static void predict(Meaning *meaning, double gain)
{
    for (int i = 0; i < meaning->linear.width; i++)
        meaning->predicted.values[i] = 255 * srgb_encode((float)gain * meaning->linear.values[i]);
}

/* Whether the gain brings 49 of 50 of the codes that are off by more than a level to within one. */
static bool fits(const Light *light)
{
    return light->beyond > 0 && 50 * light->misfits <= light->beyond;
}

static Status find_gain(const Picture *a, const Picture *b, const Samples *samples, char *out,
                        size_t size, Err *err)
{
    Meaning meaning = {0};
    Status status = meaning_init(&meaning, a, err);
    if (status == STATUS_OK) {
        Light light = light_of_samples(&meaning, a, b, samples);
        predict(&meaning, light.a > 0 ? light.b / light.a : 1);
        light = light_of_samples(&meaning, a, b, samples);
        if (fits(&light)) {
            light = light_of_all(&meaning, a, b);
            double gain = light.b / light.a;
            predict(&meaning, gain);
            light = light_of_all(&meaning, a, b);
            if (fits(&light))
                snprintf(out, size, "B is A made %s: its linear colours are %.4g times those of A",
                         gain > 1 ? "brighter" : "darker", gain);
        }
    }
    meaning_release(&meaning);
    return status;
}

/* ---- shading --------------------------------------------------------------------------------- */

static bool has_equal_outlines(const CompareResult *result)
{
    return result->has_mask && result->missing_pixels + result->extra_pixels == 0 &&
           !(result->edge_mismatch_fraction > 0) && result->classes[PIXEL_WRONG_SEGMENT] == 0;
}

static void explain_shading(CompareResult *result)
{
    double all = sqrt((double)result->differing_pixels); /* sigmas, if all go one way */
    snprintf(result->cause, sizeof result->cause,
             "only shading differs, by up to %.4g levels on %.3g %% of the pixels, B %s; the "
             "outlines %s",
             result->max_abs, 100.0 * (double)result->differing_pixels / (double)result->pixels,
             result->sign_sigma > 0.98 * all    ? "being brighter"
             : result->sign_sigma < -0.98 * all ? "being darker"
                                                : "being brighter here and darker there",
             result->has_ids ? "of all segments are equal" : "against the background are equal");
}

Status compare_cause(const Picture *a, const Picture *b, CompareResult *result, Err *err)
{
    size_t size = sizeof result->cause;
    if (result->differing_pixels == 0)
        return STATUS_OK;
    Samples samples;
    choose_samples(a, b, result->differing_pixels, &samples);
    const char *turn = find_turn(a, b);
    if (turn)
        snprintf(result->cause, size, "%s", turn);
    else if (find_shift(a, b, &samples, result->cause, size))
        return STATUS_OK;
    else if (result->max_code <= 1)
        snprintf(result->cause, size, "only rounding differs: no code is off by more than 1");
    else
        TRY(find_gain(a, b, &samples, result->cause, size, err));
    if (!*result->cause && has_equal_outlines(result))
        explain_shading(result);
    return STATUS_OK;
}
