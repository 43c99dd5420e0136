/* CIEDE2000 [Sharma, Wu, Dalal 2005], in degrees as there, and CIELAB of sRGB pictures under D65 as
 * scikit-image has it. Equal pixels are 0 without computing. */
#include "verify/verify.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static double hue_deg(double b, double a)
{
    if (a == 0 && b == 0)
        return 0;
    double hue = atan2(b, a) * 180 / pi;
    return hue < 0 ? hue + 360 : hue;
}

static double sin_deg(double x)
{
    return sin(x * pi / 180);
}

static double cos_deg(double x)
{
    return cos(x * pi / 180);
}

/* c^7 / (c^7 + 25^7), rooted. */
static double chroma_root(double c)
{
    double c7 = c * c * c * c * c * c * c;
    return sqrt(c7 / (c7 + 6103515625.0));
}

/* The mean of two hues, of chromas whose product is not 0 unless `plain`. */
static double mean_hue(double h1, double h2, bool plain)
{
    if (plain)
        return h1 + h2;
    if (fabs(h1 - h2) <= 180)
        return (h1 + h2) / 2;
    return h1 + h2 < 360 ? (h1 + h2 + 360) / 2 : (h1 + h2 - 360) / 2;
}

double de2000(const double lab_a[3], const double lab_b[3])
{
    double c1 = hypot(lab_a[1], lab_a[2]), c2 = hypot(lab_b[1], lab_b[2]);
    double g = 0.5 * (1 - chroma_root((c1 + c2) / 2));
    double a1 = (1 + g) * lab_a[1], a2 = (1 + g) * lab_b[1];
    c1 = hypot(a1, lab_a[2]);
    c2 = hypot(a2, lab_b[2]);
    double h1 = hue_deg(lab_a[2], a1), h2 = hue_deg(lab_b[2], a2);
    bool grey = c1 * c2 == 0;
    double dh = grey ? 0 : h2 - h1;
    dh = dh > 180 ? dh - 360 : dh < -180 ? dh + 360 : dh;
    double dl = lab_b[0] - lab_a[0], dc = c2 - c1;
    double dbig_h = 2 * sqrt(c1 * c2) * sin_deg(dh / 2);
    double l = (lab_a[0] + lab_b[0]) / 2, c = (c1 + c2) / 2, h = mean_hue(h1, h2, grey);
    double t = 1 - 0.17 * cos_deg(h - 30) + 0.24 * cos_deg(2 * h) + 0.32 * cos_deg(3 * h + 6) -
               0.20 * cos_deg(4 * h - 63);
    double around = (h - 275) / 25, l50 = (l - 50) * (l - 50);
    double rotation = -2 * chroma_root(c) * sin_deg(60 * exp(-around * around));
    double sl = dl / (1 + 0.015 * l50 / sqrt(20 + l50));
    double sc = dc / (1 + 0.045 * c), sh = dbig_h / (1 + 0.015 * c * t);
    return sqrt(sl * sl + sc * sc + sh * sh + rotation * sc * sh);
}

static double lab_curve(double t)
{
    return t > 0.008856 ? cbrt(t) : 7.787 * t + 16 / 116.0;
}

/* Of linear RGB of sRGB's primaries. */
static void lab_of(const double rgb[3], double lab[3])
{
    double x = 0.412453 * rgb[0] + 0.357580 * rgb[1] + 0.180423 * rgb[2];
    double y = 0.212671 * rgb[0] + 0.715160 * rgb[1] + 0.072169 * rgb[2];
    double z = 0.019334 * rgb[0] + 0.119193 * rgb[1] + 0.950227 * rgb[2];
    x = lab_curve(x / 0.95047);
    y = lab_curve(y);
    z = lab_curve(z / 1.08883);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

typedef struct De2000 {
    const Picture *pictures[2];
    double *linear;      /* owned; of each code */
    double *sums, *maxs; /* owned; of each row */
} De2000;

static double pixel_difference(const De2000 *self, size_t first, int channels)
{
    double lab[2][3];
    for (int side = 0; side < 2; side++) {
        double rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = self->linear[picture_code(self->pictures[side],
                                               first + (channels == 1 ? 0 : (size_t)c))];
        lab_of(rgb, lab[side]);
    }
    return de2000(lab[0], lab[1]);
}

static void do_row(size_t y, int worker, void *context)
{
    (void)worker;
    De2000 *self = context;
    const Picture *a = self->pictures[0], *b = self->pictures[1];
    if (picture_rows_equal(a, b, (int)y, 0, a->width))
        return;
    for (int x = 0; x < a->width; x++) {
        if (picture_rows_equal(a, b, (int)y, x, 1))
            continue;
        size_t first = y * picture_stride(a) + (size_t)x * (size_t)a->channels;
        double difference = pixel_difference(self, first, a->channels);
        self->sums[y] += difference;
        self->maxs[y] = fmax(self->maxs[y], difference);
    }
}

static double decode(double encoded)
{
    return encoded > 0.04045 ? pow((encoded + 0.055) / 1.055, 2.4) : encoded / 12.92;
}

Status de2000_compute(const Picture *a, const Picture *b, double *mean, double *max, Err *err)
{
    De2000 self = {.pictures = {a, b}};
    size_t height = (size_t)a->height, levels = (size_t)1 << a->bits;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&self.linear, levels, sizeof *self.linear, "decoded levels", err));
    TRY_GOTO(mem_calloc(&self.sums, 2 * height, sizeof *self.sums, "sums of rows", err));
    self.maxs = self.sums + height;
    for (size_t i = 0; i < levels; i++)
        self.linear[i] = decode((double)i / (double)(levels - 1));
    threads_for(height, 0, do_row, &self);
    double sum = 0, largest = 0;
    for (size_t y = 0; y < height; y++) {
        sum += self.sums[y];
        largest = fmax(largest, self.maxs[y]);
    }
    *mean = sum / ((double)height * a->width);
    *max = largest;
done:
    free(self.linear);
    free(self.sums);
    return status;
}
