/* Words a range of numbers for messages.
 *
 * A range that excludes 0 begins at the smallest double above 0, and a range without an end ends at
 * the largest double. All ranges are therefore closed; only their text shows the difference. */
#include "base/range.h"

#include "base/number.h"
#include <stdio.h>

const char *range_text(Range range, char out[RANGE_TEXT_SIZE])
{
    char low[NUMBER_TEXT_SIZE], high[NUMBER_TEXT_SIZE];
    bool ends = range.high < RANGE_NO_END, above_0 = range.low <= RANGE_ABOVE_0 && range.low > 0;
    number_text(range.low, low);
    number_text(range.high, high);
    if (above_0)
        snprintf(out, RANGE_TEXT_SIZE, ends ? "above 0 and at most %s" : "above 0", high);
    else if (range.low <= -RANGE_NO_END)
        snprintf(out, RANGE_TEXT_SIZE, ends ? "of at most %s" : "%s", ends ? high : "");
    else if (ends)
        snprintf(out, RANGE_TEXT_SIZE, "from %s to %s", low, high);
    else
        snprintf(out, RANGE_TEXT_SIZE, "of at least %s", low);
    return out;
}
