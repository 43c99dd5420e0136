/* What of a picture's plane, or of its tiles, something may be seen in. */
#ifndef CORCAST_RENDER_INTERVAL_H
#define CORCAST_RENDER_INTERVAL_H

#include "render/tile/tile.h"
#include <math.h>
#include <stdbool.h>

/* Empty if low > high. */
typedef struct Interval {
    double low, high;
} Interval;

/* Rows or columns of tiles; none if first > last. */
typedef struct TileSpan {
    int first, last;
} TileSpan;

static const TileSpan NO_TILES = {1, 0};

/* The tiles of both. */
static inline TileSpan tilespan_intersection(TileSpan a, TileSpan b)
{
    TileSpan both = {a.first > b.first ? a.first : b.first, a.last < b.last ? a.last : b.last};
    return both.first <= both.last ? both : NO_TILES;
}

/* Covers rounding where pixels and tiles are told apart, in pixels. */
#define SLACK_PIXELS 1e-3

static inline double min_of(double a, double b)
{
    return a < b ? a : b;
}

static inline double max_of(double a, double b)
{
    return a > b ? a : b;
}

static inline Interval interval_union(Interval a, Interval b)
{
    return (Interval){min_of(a.low, b.low), max_of(a.high, b.high)};
}

/* What a ball at coordinate c in one direction of a perspective view's plane, and at depth z >
 * radius, covers there. */
static inline Interval ball_extent(double c, double z, double radius)
{
    double half = radius * sqrt(max_of(c * c + z * z - radius * radius, 0));
    double per = 1 / ((z - radius) * (z + radius));
    return (Interval){(c * z - half) * per, (c * z + half) * per};
}

/* What a capsule covers there, or in a view of parallel lines, whose ends are at c0 and c1; in
 * perspective at depths z0, z1 > radius. */
static inline Interval capsule_extent(bool perspective, double c0, double z0, double c1, double z1,
                                      double radius)
{
    if (!perspective)
        return (Interval){min_of(c0, c1) - radius, max_of(c0, c1) + radius};
    return interval_union(ball_extent(c0, z0, radius), ball_extent(c1, z1, radius));
}

/* An interval of a view's plane in samples, the middle of one a whole number; sample 0 is at
 * `first`, and `per` samples follow in a unit, below 0 where they run against it. */
static inline Interval interval_in_samples(Interval range, double first, double per)
{
    double from = (range.low - first) * per, to = (range.high - first) * per;
    return (Interval){min_of(from, to) - SLACK_PIXELS, max_of(from, to) + SLACK_PIXELS};
}

/* The tiles that those of `count` samples lie in which are, up to `stray` off their middles, within
 * an interval of samples. */
static inline TileSpan tilespan_of_samples(Interval samples, double max_offset, int count)
{
    double low = max_of(samples.low - max_offset, 0),
           high = min_of(samples.high + max_offset, count - 1);
    if (!(low <= high))
        return NO_TILES;
    int first = (int)low, last = (int)high;
    first += first < low; /* rounds up */
    return first <= last ? (TileSpan){first / TILE_SIDE, last / TILE_SIDE} : NO_TILES;
}

/* The part [*from, *to] of the way where something that is at_a at its beginning and at_b at its
 * end is not below 0. */
static inline void clip_part(double at_a, double at_b, double *from, double *to)
{
    if (at_a < 0)
        *from = at_b < 0 ? HUGE_VAL : max_of(*from, at_a / (at_a - at_b));
    else if (at_b < 0)
        *to = min_of(*to, at_a / (at_a - at_b));
}

#endif
