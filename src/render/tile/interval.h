/* Intervals of a view's plane along one axis, and the ranges of samples and tiles that they cover.
 * Engines use them to find the tiles that a vessel may touch:
 *
 *     Interval x = capsule_extent(perspective, a.x, a.z, b.x, b.z, radius);
 *     TileSpan columns = tilespan_of_samples(interval_in_samples(x, left, per_x), 0, n_columns);
 *
 * The view's plane is the plane z = 1 of a perspective view, in mm per mm of depth, or the plane z
 * = 0 of a parallel view, in mm [tile.h]. No function has state. */
#ifndef CORCAST_RENDER_TILE_INTERVAL_H
#define CORCAST_RENDER_TILE_INTERVAL_H

#include "render/tile/tile.h"
#include <math.h>
#include <stdbool.h>

/* A range of numbers, both ends included; empty if low > high. */
typedef struct Interval {
    double low, high;
} Interval;

/* A range of rows or of columns of tiles, both ends included; empty if first > last. */
typedef struct TileSpan {
    int first, last;
} TileSpan;

/* An empty range. */
static const TileSpan NO_TILES = {1, 0};

/* Returns the tiles that are in both ranges. */
static inline TileSpan tilespan_intersection(TileSpan a, TileSpan b)
{
    TileSpan both = {a.first > b.first ? a.first : b.first, a.last < b.last ? a.last : b.last};
    return both.first <= both.last ? both : NO_TILES;
}

/* Tolerance for rounding when positions are converted to samples and tiles, in samples. The kernels
 * place items with an error below 1e-3 samples [raster/rasteritem.c]. A larger value only lists
 * more items. */
#define SLACK_SAMPLES 1e-3

static inline double min_of(double a, double b)
{
    return a < b ? a : b;
}

static inline double max_of(double a, double b)
{
    return a > b ? a : b;
}

/* Returns the smallest interval that contains both. */
static inline Interval interval_union(Interval a, Interval b)
{
    return (Interval){min_of(a.low, b.low), max_of(a.high, b.high)};
}

/* Returns the extent of a ball in the plane of a perspective view, along one axis. The ball's
 * center has the coordinate `c` (mm) along this axis and the depth z > radius (mm). */
static inline Interval ball_extent(double c, double z, double radius)
{
    double half = radius * sqrt(max_of(c * c + z * z - radius * radius, 0));
    double per = 1 / ((z - radius) * (z + radius));
    return (Interval){(c * z - half) * per, (c * z + half) * per};
}

/* Returns the extent of a capsule in the view's plane, along one axis. The ends of the capsule's
 * axis have the coordinates c0 and c1 along this axis, mm. In perspective, their depths are z0 and
 * z1, both greater than `radius`; a parallel view ignores z0 and z1. */
static inline Interval capsule_extent(bool perspective, double c0, double z0, double c1, double z1,
                                      double radius)
{
    if (!perspective)
        return (Interval){min_of(c0, c1) - radius, max_of(c0, c1) + radius};
    return interval_union(ball_extent(c0, z0, radius), ball_extent(c1, z1, radius));
}

/* Converts an interval of the view's plane to sample indices, widened by SLACK_SAMPLES. Integers
 * are the centres of samples.
 *
 * first    position of sample 0.
 * per      samples per unit; negative if samples run against the axis. */
static inline Interval interval_in_samples(Interval range, double first, double per)
{
    double from = (range.low - first) * per, to = (range.high - first) * per;
    return (Interval){min_of(from, to) - SLACK_SAMPLES, max_of(from, to) + SLACK_SAMPLES};
}

/* A range of columns or of rows of samples, both ends included; empty if first > last. */
typedef struct SampleSpan {
    int first, last;
} SampleSpan;

/* Returns the samples that may be in an interval of sample indices. Samples have the indices 0 to
 * count - 1; each may be up to `max_offset` samples from its grid position. */
static inline SampleSpan samplespan_within(Interval samples, double max_offset, int count)
{
    double low = max_of(samples.low - max_offset, 0),
           high = min_of(samples.high + max_offset, count - 1);
    int first = low < count ? (int)low : count;
    first += first < low; /* rounds up */
    return (SampleSpan){first, high < 0 ? -1 : (int)high};
}

/* Returns the tiles of the samples that samplespan_within returns. */
static inline TileSpan tilespan_of_samples(Interval samples, double max_offset, int count)
{
    SampleSpan span = samplespan_within(samples, max_offset, count);
    return span.first <= span.last ? (TileSpan){span.first / TILE_SIDE, span.last / TILE_SIDE}
                                   : NO_TILES;
}

/* Clips the parameter range [*from, *to] of a line to the part where a linear function is at least
 * 0. The function has the value at_a at parameter 0 and at_b at parameter 1. If both are below 0,
 * sets *from to infinity; the range is then empty. */
static inline void clip_parameters(double at_a, double at_b, double *from, double *to)
{
    if (at_a < 0)
        *from = at_b < 0 ? HUGE_VAL : max_of(*from, at_a / (at_a - at_b));
    else if (at_b < 0)
        *to = min_of(*to, at_a / (at_a - at_b));
}

#endif
