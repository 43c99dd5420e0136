/* Closed ranges of numbers, and their description in words. */
#ifndef CORCAST_BASE_RANGE_H
#define CORCAST_BASE_RANGE_H

#include <float.h>
#include <stdbool.h>

/* The numbers from low to high, both included. */
typedef struct Range {
    double low, high;
} Range;

/* The smallest double above 0, for the lower end of ranges that exclude 0. */
#define RANGE_ABOVE_0 4.9406564584124654e-324
/* The largest double, for the upper end of ranges without an upper bound. */
#define RANGE_NO_END DBL_MAX

/* Returns true if `value` is in the range; false for NaN. */
static inline bool range_has(Range range, double value)
{
    return value >= range.low && value <= range.high;
}

enum { RANGE_TEXT_SIZE = 96 };

/* Describes the range for help and error sentences: "from 0 to 0.95", "above 0 and at most 10", "of
 * at least 3"; "" for the range of all finite numbers. Writes to `out` and returns `out`. */
const char *range_text(Range range, char out[RANGE_TEXT_SIZE]);

#endif
