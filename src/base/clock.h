/* Two clocks that measure durations, and the date that is written to files. Only the difference
 * between two readings of a clock has a meaning. */
#ifndef CORCAST_BASE_CLOCK_H
#define CORCAST_BASE_CLOCK_H

#include <stdbool.h>

/* Returns the reading, in seconds, of a monotonic clock: it never runs backwards, even if the time
 * of day is changed. */
double clock_seconds(void);
/* Returns the processor time, in seconds, that this process has used in all its threads. */
double clock_cpu_seconds(void);

enum { DATE_TEXT_SIZE = 40 };

/* Sets the date that clock_date writes in the calling thread. `seconds` is the text of an integer:
 * seconds since 1970-01-01 UTC, 0 to 253402300799 (the year 9999). NULL, the initial value:
 * clock_date writes the present time. Returns false, and sets nothing, for any other text. Source:
 * SOURCE_DATE_EPOCH of reproducible-builds.org. */
bool clock_set_date(const char *seconds);
/* Writes a date and a time of day in UTC, such as "2026-11-28 09:00 UTC". Returns `out`. */
const char *clock_date(char out[DATE_TEXT_SIZE]);

#endif
