/* A pixel is the mean of what it covers. Bars do not overlap, so that the parts that they cover and
 * the colours of these parts add up, in any order; what no bar covers is background. */
#include "diagram/diagram.h"

#include <math.h>

/* How many colours a pixel sums up, and the part that is covered. */
enum { COVERED = 3, SUMS = 4 };

typedef struct Raster {
    Plane *sums;      /* of SUMS channels */
    double scale;     /* pixels a mm */
    double offset[2]; /* pixels: where the diagram begins */
} Raster;

/* The part of pixel `at` between two places. */
static double covered(int at, double from, double to)
{
    return fmax(0, fmin(to, at + 1) - fmax(from, at));
}

static int first_pixel(double from)
{
    return (int)fmax(0, floor(from));
}

static int end_pixel(double to, int size)
{
    return (int)fmin(size, ceil(to));
}

static void add_bar(const Raster *raster, const DiagramBar *bar, const float color[3])
{
    double x[2], y[2];
    for (int i = 0; i < 2; i++) {
        x[i] = raster->offset[0] + raster->scale * bar->x[i];
        y[i] = raster->offset[1] + raster->scale * bar->y[i];
    }
    int width = raster->sums->width;
    for (int row = first_pixel(y[0]); row < end_pixel(y[1], raster->sums->height); row++)
        for (int at = first_pixel(x[0]); at < end_pixel(x[1], width); at++) {
            float *sum = &raster->sums->values[SUMS * ((size_t)row * (size_t)width + (size_t)at)];
            float part = (float)(covered(row, y[0], y[1]) * covered(at, x[0], x[1]));
            for (int c = 0; c < 3; c++)
                sum[c] += part * color[c];
            sum[COVERED] += part;
        }
}

/* The sums as colours; rounding may have covered a little more than all of a pixel. */
static void mix(const Plane *sums, const float background[3], Plane *color)
{
    size_t pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *sum = &sums->values[SUMS * i];
        float part = fmaxf(1, sum[COVERED]), rest = fmaxf(0, 1 - sum[COVERED]);
        for (int c = 0; c < 3; c++)
            color->values[3 * i + (size_t)c] = sum[c] / part + rest * background[c];
    }
}

Status diagram_draw(const Diagram *diagram, const DiagramPaint *paint, int width, int height,
                    Plane *color, Err *err)
{
    Plane sums = {0}, made = {0};
    Status status = STATUS_OK;
    double share = 1 - 2 * paint->margin;
    double scale = fmin(share * width / diagram->width_mm, share * height / diagram->height_mm);
    Raster raster = {.sums = &sums,
                     .scale = scale,
                     .offset = {(width - scale * diagram->width_mm) / 2,
                                (height - scale * diagram->height_mm) / 2}};
    TRY_GOTO(plane_init(&sums, width, height, SUMS, err));
    TRY_GOTO(plane_init(&made, width, height, 3, err));
    for (size_t i = 0; i < diagram->n; i++)
        add_bar(&raster, &diagram->bar[i], paint->color[diagram->bar[i].node]);
    mix(&sums, paint->background, &made);
    *color = made;
done:
    plane_release(&sums);
    return status;
}
