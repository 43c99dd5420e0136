/* What of a picture's plane, or of its tiles, something may be seen in. */
#ifndef CORCAST_RENDER_INTERVAL_H
#define CORCAST_RENDER_INTERVAL_H

#include <math.h>

/* Empty if low > high. */
typedef struct Interval {
    double low, high;
} Interval;

/* Rows or columns of tiles; none if first > last. */
typedef struct TileSpan {
    int first, last;
} TileSpan;

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
static inline Interval ball_shadow(double c, double z, double radius)
{
    double half = radius * sqrt(max_of(c * c + z * z - radius * radius, 0));
    double per = 1 / ((z - radius) * (z + radius));
    return (Interval){(c * z - half) * per, (c * z + half) * per};
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
