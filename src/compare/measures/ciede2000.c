/* Computes color differences by the formula CIEDE2000 [Sharma, Wu, Dalal 2005] in single precision,
 * with errors below 1e-4. CIELAB of sRGB
 * under D65 is computed as in scikit-image. Equal pixels are skipped.
 *
 * Hues are unit vectors here, not angles: sums and multiples of angles then need only products. The
 * one exception is a distance of hues that is squared under an exponential, which has a series. So
 * no step branches or calls a function, and the compiler vectorises stretches of a row. */
#include "compare/measures/perception.h"

#include "compare/measures/wide.h"
#include <math.h>
#include <stdlib.h>

/* ---- one difference -------------------------------------------------------------------------- */

typedef struct Lab {
    float l, a, b;
} Lab;

/* A hue as a vector of length 1; (0, 0): grey. */
typedef struct Hue {
    float x, y;
} Hue;

/* Returns the direction of (x, y) as a unit vector. */
static inline Hue hue_of(float x, float y)
{
    float scale = 1 / larger(sqrtf(x * x + y * y), 1e-30f);
    return (Hue){x * scale, y * scale};
}

/* Returns the hue whose angle is the sum of two angles. */
static inline Hue hue_turned(Hue a, Hue b)
{
    return (Hue){a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}

/* Returns the hue in the middle of two hues: the direction of the sum of both vectors. If the sum
 * is short (dot < 0), a vector perpendicular to their difference has the same direction and is more
 * accurate. For opposite hues, the formula wants the hue 90 degrees behind the hue whose angle is
 * less than 180 degrees. */
static inline Hue hue_between(Hue a, Hue b)
{
    float dot = a.x * b.x + a.y * b.y, cross = a.x * b.y - a.y * b.x, low = a.y == 0 ? a.x : a.y;
    float side = copysignf(1, cross == 0 ? low : cross);
    float x = dot < 0 ? side * (b.y - a.y) : a.x + b.x;
    float y = dot < 0 ? side * (a.x - b.x) : a.y + b.y;
    return hue_of(x, y);
}

/* Returns sqrt(c^7 / (c^7 + 25^7)). */
static inline float chroma_root(float c)
{
    float part = c * (1 / 25.0f), cube = part * part * part, seventh = cube * cube * part;
    return sqrtf(seventh / (seventh + 1));
}

/* Returns exp(-((h - 275) / 25)^2), h in degrees. The distance of two hues is twice the arcsine of
 * half their chord; the code has its series, which is inaccurate only where the exponential is
 * nearly 0. */
static inline float near_blue(Hue hue)
{
    float x = hue.x - 0.0871557427f, y = hue.y + 0.996194698f, square = (x * x + y * y) / 4;
    float series =
        1 + square * (1 / 6.0f +
                      square * (3 / 40.0f + square * (15 / 336.0f + square * (105 / 3456.0f))));
    const float distance = 2 * 57.2957795f / 25 * series;
    return exp_2(-1.44269504f * square * distance * distance);
}

/* Returns the sine of an angle in [0, 2.1]. */
static inline float sine(float x)
{
    float x2 = x * x;
    return x * (1 - x2 / 6 *
                        (1 - x2 / 20 *
                                 (1 - x2 / 42 * (1 - x2 / 72 * (1 - x2 / 110 * (1 - x2 / 156))))));
}

/* Returns the weight T of the paper. */
static inline float hue_weight(Hue h)
{
    Hue h2 = hue_turned(h, h), h3 = hue_turned(h2, h), h4 = hue_turned(h2, h2);
    return 1 - 0.17f * (h.x * 0.866025404f + h.y * 0.5f) + 0.24f * h2.x +
           0.32f * (h3.x * 0.994521895f - h3.y * 0.104528463f) -
           0.20f * (h4.x * 0.453990500f + h4.y * 0.891006524f);
}

/* Returns CIEDE2000 of two colors. The names are those of the paper: c1 and c2 are chromas after a
 * and b, h1 and h2 hues, dh is the hue difference, sl, sc and sh are the weighted differences of
 * lightness, chroma and hue. */
static inline float difference_of(Lab a, Lab b)
{
    float plain = sqrtf(a.a * a.a + a.b * a.b) + sqrtf(b.a * b.a + b.b * b.b);
    float wider = 1.5f - 0.5f * chroma_root(plain / 2);
    a.a *= wider;
    b.a *= wider;
    float c1 = sqrtf(a.a * a.a + a.b * a.b), c2 = sqrtf(b.a * b.a + b.b * b.b);
    Hue h1 = hue_of(a.a, a.b), h2 = hue_of(b.a, b.b), h = hue_between(h1, h2);
    float x = h2.x - h1.x, y = h2.y - h1.y; /* as long as twice the sine of half the angle */
    float dh = sqrtf(c1 * c2 * (x * x + y * y));
    dh = copysignf(dh, h1.x * h2.y - h1.y * h2.x);
    float l50 = (a.l + b.l) / 2 - 50, c = (c1 + c2) / 2;
    float rotation = -2 * chroma_root(c) * sine(2.09439510f * near_blue(h) / 2);
    float sl = (b.l - a.l) / (1 + 0.015f * l50 * l50 / sqrtf(20 + l50 * l50));
    float sc = (c2 - c1) / (1 + 0.045f * c), sh = dh / (1 + 0.015f * c * hue_weight(h));
    return sqrtf(larger(0, sl * sl + sc * sc + sh * sh + rotation * sc * sh));
}

double de2000(const double lab_a[3], const double lab_b[3])
{
    const Lab a = {(float)lab_a[0], (float)lab_a[1], (float)lab_a[2]};
    const Lab b = {(float)lab_b[0], (float)lab_b[1], (float)lab_b[2]};
    return (double)difference_of(a, b);
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Number of pixels of a row whose differences are computed at once; a multiple of the lanes of a
 * vector. */
enum { STRETCH = 64 };

/* Linear colors of a stretch of a row. */
typedef struct LinearStretch {
    float red[STRETCH], green[STRETCH], blue[STRETCH];
} LinearStretch;

typedef struct De2000 {
    const Picture *pictures[2];
    float *linear;       /* owned; of each code */
    double *sums, *maxs; /* owned; of each row */
} De2000;

static inline float lab_curve(float t)
{
    float root = cube_root(larger(t, 0.008856f));
    return t > 0.008856f ? root : 7.787f * t + 16 / 116.0f;
}

/* Converts linear RGB with the primaries of sRGB. */
static inline Lab lab_of(float red, float green, float blue)
{
    float x = lab_curve((0.412453f * red + 0.357580f * green + 0.180423f * blue) / 0.95047f);
    float y = lab_curve(0.212671f * red + 0.715160f * green + 0.072169f * blue);
    float z = lab_curve((0.019334f * red + 0.119193f * green + 0.950227f * blue) / 1.08883f);
    return (Lab){116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/* Loads n pixels of a row as linear channels; a grey picture has one channel for all three. */
static inline void load(const De2000 *self, int side, size_t y, int x, int n, LinearStretch *out)
{
    const Picture *picture = self->pictures[side];
    size_t channels = (size_t)picture->channels, green = channels == 1 ? 0 : 1;
    size_t at = y * picture_stride(picture) + (size_t)x * channels;
    for (int i = 0; i < n; i++, at += channels) {
        out->red[i] = self->linear[picture_code(picture, at)];
        out->green[i] = self->linear[picture_code(picture, at + green)];
        out->blue[i] = self->linear[picture_code(picture, at + 2 * green)];
    }
}

static inline void find_differences(const LinearStretch *restrict a,
                                    const LinearStretch *restrict b, float *restrict differences)
{
    for (int i = 0; i < STRETCH; i++)
        differences[i] = difference_of(lab_of(a->red[i], a->green[i], a->blue[i]),
                                       lab_of(b->red[i], b->green[i], b->blue[i]));
}

FLAT static void do_row(size_t y, int worker, void *context)
{
    (void)worker;
    De2000 *self = context;
    const Picture *a = self->pictures[0], *b = self->pictures[1];
    LinearStretch colors[2] = {0};
    float differences[STRETCH];
    if (picture_rows_equal(a, b, (int)y, 0, a->width))
        return;
    for (int x = 0; x < a->width; x += STRETCH) {
        int n = x + STRETCH < a->width ? STRETCH : a->width - x;
        if (picture_rows_equal(a, b, (int)y, x, n))
            continue;
        load(self, 0, y, x, n, &colors[0]);
        load(self, 1, y, x, n, &colors[1]);
        find_differences(&colors[0], &colors[1], differences);
        for (int i = 0; i < n; i++) {
            self->sums[y] += (double)differences[i];
            self->maxs[y] = fmax(self->maxs[y], (double)differences[i]);
        }
    }
}

WIDE static void do_row_wide(size_t y, int worker, void *context)
{
    do_row(y, worker, context);
}

static float decode(double encoded)
{
    return (float)(encoded > 0.04045 ? elementary_pow((encoded + 0.055) / 1.055, 2.4)
                                     : encoded / 12.92);
}

Status de2000_find(const Picture *a, const Picture *b, double values[MEASURES], Err *err)
{
    De2000 self = {.pictures = {a, b}};
    size_t height = (size_t)a->height, levels = (size_t)1 << a->bits;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&self.linear, levels, sizeof *self.linear, "decoded levels", err));
    TRY_GOTO(mem_calloc(&self.sums, 2 * height, sizeof *self.sums, "sums of rows", err));
    self.maxs = self.sums + height;
    for (size_t i = 0; i < levels; i++)
        self.linear[i] = decode((double)i / (double)(levels - 1));
    threads_for(height, 0, wide_usable() ? do_row_wide : do_row, &self);
    double sum = 0, largest = 0;
    for (size_t y = 0; y < height; y++) {
        sum += self.sums[y];
        largest = fmax(largest, self.maxs[y]);
    }
    values[MEASURE_DE2000_MEAN] = sum / ((double)height * a->width);
    values[MEASURE_DE2000_MAX] = largest;
done:
    free(self.linear);
    free(self.sums);
    return status;
}
