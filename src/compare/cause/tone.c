/* Tests whether one tone curve maps every code of A to the code of B: brighter, darker, another
 * gamma. A level is a code as a fraction of the largest code, encoded as sRGB.
 *
 * Each kind of curve except the last has at most one number, which follows from sums over the
 * pixels. The last kind is measured: the mean code in B of each code in A. The curve that fits the
 * samples best is the cause if it fits all pixels: for 50 codes that differ by more than a level,
 * it leaves at most one such code. White codes may be clipped, so they are left out. */
#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The kinds of curves. level_of computes them; `curves` has their sentences. */
typedef enum CurveKind {
    ENCODED_AGAIN,
    NOT_ENCODED,
    ENCODED_BY_POWER,
    ENCODED_AS_SRGB,
    NEGATIVE,
    TIMES_LIGHT,
    PLUS_LIGHT,
    TIMES_CODE,
    PLUS_CODE,
    POWER_OF_CODE,
    ANY_CURVE, /* is measured, not computed */
    KINDS
} CurveKind;

/* Sums over the codes that are neither black nor white, and so not clipped, in either picture.
 * Index 0 is A, index 1 is B. */
typedef struct ToneSums {
    double n, linear[2], level[2], log_ab, log_aa;
} ToneSums;

/* Tables over the codes of a picture: what each code means. All arrays are one block, which
 * `linear` owns. */
typedef struct Meaning {
    int n;
    float *linear;           /* linear color */
    float *level;            /* level in sRGB */
    float *log;              /* logarithm of the level */
    float *predicted[KINDS]; /* the level that each kind of curve gives */
} Meaning;

/* Computes the meanings of all codes: linear level, sRGB level and its logarithm. The logarithm
 * of 0 does not exist, so levels are at least 1e-6. */
static Status meaning_init(Meaning *meaning, const Picture *picture, Err *err)
{
    Plane linear;
    TRY(linear_of_codes(picture, &linear, err));
    const int n = linear.width;
    Status status =
        mem_calloc(&meaning->linear, (size_t)n * (3 + KINDS), sizeof(float), "codes", err);
    if (status == STATUS_OK) {
        meaning->n = n;
        meaning->level = meaning->linear + n;
        meaning->log = meaning->level + n;
        for (int i = 0; i < n; i++) {
            meaning->linear[i] = linear.values[i];
            meaning->level[i] = srgb_encode(linear.values[i]);
            meaning->log[i] = logf(fmaxf(meaning->level[i], 1e-6F));
        }
        for (int kind = 0; kind < KINDS; kind++)
            meaning->predicted[kind] = meaning->log + (kind + 1) * n;
    }
    plane_release(&linear);
    return status;
}

/* ---- curves ---------------------------------------------------------------------------------- */

/* Returns the number of a curve that fits the sums best; 1 for a curve without a number. Gains are
 * quotients of sums and offsets are differences of means. A gamma is the least squares fit of a
 * line through 0 to the logarithms. */
static double number_of(CurveKind kind, const ToneSums *sums)
{
    switch (kind) {
    case TIMES_LIGHT:
        return sums->linear[1] / sums->linear[0];
    case PLUS_LIGHT:
        return (sums->linear[1] - sums->linear[0]) / sums->n;
    case TIMES_CODE:
        return sums->level[1] / sums->level[0];
    case PLUS_CODE:
        return (sums->level[1] - sums->level[0]) / sums->n;
    case POWER_OF_CODE:
        return sums->log_ab / sums->log_aa;
    case ENCODED_BY_POWER:
    case ENCODED_AS_SRGB:
        return 2.2; /* the gamma of screens */
    default:
        return 1;
    }
}

/* Returns the level that a curve with the number `p` gives for a code of A. */
static float level_of(CurveKind kind, float linear, float level, float p)
{
    switch (kind) {
    case ENCODED_AGAIN:
        return srgb_encode(level);
    case NOT_ENCODED:
        return linear;
    case ENCODED_BY_POWER:
        return powf(linear, 1 / p);
    case ENCODED_AS_SRGB:
        return srgb_encode(powf(level, p));
    case NEGATIVE:
        return 1 - level;
    case TIMES_LIGHT:
        return srgb_encode(p * linear);
    case PLUS_LIGHT:
        return srgb_encode(fmaxf(0, linear + p));
    case TIMES_CODE:
        return p * level;
    case PLUS_CODE:
        return level + p;
    case POWER_OF_CODE:
        return powf(level, p);
    default:
        return level;
    }
}

/* How the number of a curve appears in its sentence. */
typedef enum Relation { ALONE, TIMES, PLUS, POWER } Relation;

/* "B is A `how`", of curves with a number "made brighter: its `what` are 1.2 times those of A". */
typedef struct Curve {
    Relation relation;
    const char *how, *what;
    double unit;
} Curve;

static const Curve curves[KINDS] = {
    [ENCODED_AGAIN] = {ALONE, "encoded as sRGB twice, which is too bright", NULL, 1},
    [NOT_ENCODED] = {ALONE, "not encoded as sRGB, which is too dark", NULL, 1},
    [ENCODED_BY_POWER] = {ALONE, "encoded with a gamma of 2.2 instead of sRGB", NULL, 1},
    [ENCODED_AS_SRGB] = {ALONE, "encoded as sRGB instead of a gamma of 2.2", NULL, 1},
    [NEGATIVE] = {ALONE, "as a negative (inverted)", NULL, 1},
    [TIMES_LIGHT] = {TIMES, "made", "linear colors", 1},
    [PLUS_LIGHT] = {PLUS, "made", "linear colors (0 to 1)", 1},
    [TIMES_CODE] = {TIMES, "made", "sRGB codes", 1},
    [PLUS_CODE] = {PLUS, "made", "sRGB codes, from 0 to 255,", 255},
    [POWER_OF_CODE] = {POWER, "with another gamma,", "sRGB codes, from 0 to 1,", 1},
    [ANY_CURVE] = {ALONE, "with another tone curve, the same everywhere", NULL, 1},
};

static void say(const Curve *curve, double number, Sentence *out)
{
    static const struct {
        const char *before, *after;
        double none; /* the number that changes nothing */
    } words[] = {
        [TIMES] = {"", " times those of A", 1},
        [PLUS] = {"those of A changed by ", "", 0},
        [POWER] = {"those of A to the power of ", "", 1},
    };
    Relation relation = curve->relation;
    bool brighter = (number > words[relation].none) != (relation == POWER);
    if (relation == ALONE)
        snprintf(out->text, out->size, "B is A %s", curve->how);
    else
        snprintf(out->text, out->size, "B is A %s %s: its %s are %s%.4g%s", curve->how,
                 brighter ? "brighter" : "darker", curve->what, words[relation].before,
                 number * curve->unit, words[relation].after);
}

/* ---- fit ------------------------------------------------------------------------------------- */

/* The codes that are compared: those of the samples, or all. */
typedef struct Codes {
    const Picture *a, *b;
    const Samples *samples; /* NULL: all */
    size_t n;
    int skipped[3]; /* per channel: a code of A that is left out; -1: none */
} Codes;

static Codes codes_of(const Picture *a, const Picture *b, const Samples *samples)
{
    return (Codes){a, b, samples, sampled_pixels(a, samples) * (size_t)a->channels, {-1, -1, -1}};
}

/* Sets code `i` of those that are compared, in both pictures. */
static void take(const Codes *codes, size_t i, int *in_a, int *in_b)
{
    const size_t channels = (size_t)codes->a->channels;
    const size_t at =
        codes->samples ? sampled_code(codes->a, codes->samples, i / channels) + i % channels : i;
    *in_a = picture_code(codes->a, at);
    *in_b = picture_code(codes->b, at);
}

/* Sums over the samples. The lowest and the highest code are left out, because clamping may have
 * changed them. */
static ToneSums sum_codes(const Meaning *meaning, const Codes *codes)
{
    ToneSums sums = {0};
    for (size_t i = 0; i < codes->n; i++) {
        int a, b;
        take(codes, i, &a, &b);
        if (a == 0 || b == 0 || a == meaning->n - 1 || b == meaning->n - 1)
            continue;
        sums.n++;
        sums.linear[0] += (double)meaning->linear[a];
        sums.linear[1] += (double)meaning->linear[b];
        sums.level[0] += (double)meaning->level[a];
        sums.level[1] += (double)meaning->level[b];
        /* Rounding changes the logarithm of a small code most. */
        double weight = (double)(meaning->level[a] * meaning->level[a]);
        sums.log_ab += weight * (double)(meaning->log[a] * meaning->log[b]);
        sums.log_aa += weight * (double)(meaning->log[a] * meaning->log[a]);
    }
    return sums;
}

/* Fills the table of levels that a kind of curve gives. Returns the number of the curve. */
static double predict(Meaning *meaning, CurveKind kind, const ToneSums *sums)
{
    double number = number_of(kind, sums);
    for (int i = 0; i < meaning->n; i++) {
        float level = level_of(kind, meaning->linear[i], meaning->level[i], (float)number);
        meaning->predicted[kind][i] = fminf(fmaxf(level, 0), 1);
    }
    return number;
}

/* Numbers of codes that differ by more than a level before and after a curve; sum of squared
 * differences after it. */
typedef struct Fit {
    size_t beyond, misfits;
    double squares;
} Fit;

/* Compares a curve's levels with those of B. A difference of one 8-bit level, with 1 % for rounding
 * of floats, counts as equal. */
static Fit fit_of(const Meaning *meaning, const Codes *codes, int kind)
{
    const float level = 1.01F / 255, *predicted = meaning->predicted[kind];
    Fit fit = {0};
    for (size_t i = 0; i < codes->n; i++) {
        int a, b;
        take(codes, i, &a, &b);
        if (a == meaning->n - 1 || b == meaning->n - 1 ||
            a == codes->skipped[i % (size_t)codes->a->channels])
            continue;
        float rest = predicted[a] - meaning->level[b];
        fit.beyond += fabsf(meaning->level[a] - meaning->level[b]) > level;
        fit.misfits += !(fabsf(rest) <= level);
        fit.squares += (double)(rest * rest);
    }
    return fit;
}

/* Returns true if the curve leaves at most 1/50 of the differing samples beyond rounding. */
static bool fits(const Fit *fit)
{
    return fit->beyond > 0 && 50 * fit->misfits <= fit->beyond;
}

/* Returns the kind of curve that fits the samples best, of those not in `tried`; -1 if none fits.
 */
static int best_curve(Meaning *meaning, const Codes *samples, const bool tried[KINDS])
{
    const ToneSums sums = sum_codes(meaning, samples);
    Fit least = {0};
    int best = -1;
    for (int kind = 0; kind < ANY_CURVE; kind++) {
        if (tried[kind] || !isfinite(predict(meaning, (CurveKind)kind, &sums)))
            continue;
        Fit fit = fit_of(meaning, samples, kind);
        if (!fits(&fit) || (best >= 0 && fit.squares >= least.squares))
            continue;
        least = fit;
        best = kind;
    }
    return best;
}

/* Measures the last curve: per code of A, the mean level in B. */
static Status measure_curve(Meaning *meaning, const Codes *all, Err *err)
{
    double *sum;
    size_t n = (size_t)meaning->n;
    TRY(mem_calloc(&sum, 2 * n, sizeof *sum, "codes", err));
    for (size_t i = 0; i < all->n; i++) {
        int a, b;
        take(all, i, &a, &b);
        sum[a] += (double)meaning->level[b];
        sum[n + (size_t)a]++;
    }
    for (size_t i = 0; i < n; i++)
        meaning->predicted[ANY_CURVE][i] = sum[n + i] > 0 ? (float)(sum[i] / sum[n + i]) : 0;
    free(sum);
    return STATUS_OK;
}

/* Returns true if enough samples are colored: ENOUGH samples, about 5 %, whose channels differ by
 * LEVELS codes. In a grey picture, another lighting of the surfaces looks like a tone curve. On
 * colored surfaces, it has another curve in each channel. */
static bool has_colors(const Picture *picture, const Samples *samples)
{
    enum { LEVELS = 32, ENOUGH = 12 };
    int colored = 0;
    for (int i = 0; i < samples->n && picture->channels == 3; i++) {
        const int x = samples->at[i].x, y = samples->at[i].y, red = code_at(picture, x, y, 0);
        const int green = code_at(picture, x, y, 1), blue = code_at(picture, x, y, 2);
        colored += abs(red - green) >= LEVELS || abs(green - blue) >= LEVELS;
    }
    return colored >= ENOUGH;
}

/* Returns true if samples with equal codes in A have nearly equal codes in B: for nine codes of
 * ten, those of B are less than APART levels apart. Rounding moves them by less, unless the curve
 * is steep. */
static bool may_be_curve(const Codes *few)
{
    enum { CODES = 256, APART = 4 };
    int low[CODES], high[CODES], a, b;
    size_t apart = 0;
    for (int i = 0; i < CODES; i++) {
        low[i] = CODES;
        high[i] = 0;
    }
    for (size_t i = 0; i < few->n; i++) {
        take(few, i, &a, &b);
        low[a] = b < low[a] ? b : low[a];
        high[a] = b > high[a] ? b : high[a];
    }
    for (size_t i = 0; i < few->n; i++) {
        take(few, i, &a, &b);
        apart += high[a] - low[a] >= APART;
    }
    return 10 * apart <= few->n;
}

/* Tests the measured curve. Only pictures of 8 bits have enough pixels of each code. The codes of
 * the first pixel are left out: they are those of a background, which may be most of the picture.
 */
static Status find_any_curve(Meaning *meaning, Codes *few, Codes *all, Sentence *out, Err *err)
{
    if (meaning->n > 256 || !has_colors(all->a, few->samples) ||
        !has_colors(all->b, few->samples) || !may_be_curve(few))
        return STATUS_OK;
    TRY(measure_curve(meaning, all, err));
    for (size_t c = 0; c < 3; c++)
        few->skipped[c] = all->skipped[c] = picture_code(all->a, c);
    Fit fit = fit_of(meaning, few, ANY_CURVE);
    if (fits(&fit))
        fit = fit_of(meaning, all, ANY_CURVE);
    if (fits(&fit))
        say(&curves[ANY_CURVE], 1, out);
    return STATUS_OK;
}

Status cause_tone(const Picture *a, const Picture *b, const Samples *samples, Sentence *out,
                  Err *err)
{
    Meaning meaning = {0};
    TRY(meaning_init(&meaning, a, err));
    Codes few = codes_of(a, b, samples), all = codes_of(a, b, NULL);
    bool tried[KINDS] = {false};
    for (int kind; !*out->text && (kind = best_curve(&meaning, &few, tried)) >= 0;) {
        const ToneSums sums = sum_codes(&meaning, &all);
        double number = predict(&meaning, (CurveKind)kind, &sums);
        Fit fit = fit_of(&meaning, &all, kind);
        if (fits(&fit))
            say(&curves[kind], number, out);
        tried[kind] = true;
    }
    Status status = STATUS_OK;
    if (!*out->text)
        status = find_any_curve(&meaning, &few, &all, out, err);
    free(meaning.linear);
    return status;
}
