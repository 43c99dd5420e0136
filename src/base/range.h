/* Closed ranges of numbers, and what is in them in words. */
#ifndef CORCAST_BASE_RANGE_H
#define CORCAST_BASE_RANGE_H

#include <float.h>
#include <stdbool.h>

/* From low to high, both included. */
typedef struct Range {
    double low, high;
} Range;

/* The least number above 0, for ranges that 0 is not in. */
#define RANGE_ABOVE_0 4.9406564584124654e-324
/* For ranges that have no end: the greatest number. */
#define RANGE_NO_END DBL_MAX

/* False for a NAN. */
static inline bool range_has(Range range, double value)
{
    return value >= range.low && value <= range.high;
}

enum { RANGE_TEXT_SIZE = 96 };

/* What a number in the range is: "from 0 to 0.95", "above 0 and at most 10", "of at least 3"; ""
 * where any finite number is. Writes to `out` and returns it. */
const char *range_text(Range range, char out[RANGE_TEXT_SIZE]);

#endif
