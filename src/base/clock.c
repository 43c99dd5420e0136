/* Measures durations and processor time, and gives the date that is written to files.
 *
 * Durations come from CLOCK_MONOTONIC, because the time of day may be set while the program runs.
 */
#include "base/clock.h"

#include "base/number.h"

#include <time.h>

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

double clock_seconds(void)
{
    return seconds_of(CLOCK_MONOTONIC);
}

double clock_cpu_seconds(void)
{
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

/* The date that clock_set_date has set for this thread, in seconds since 1970; -1: the present
 * time. */
static _Thread_local long long chosen = -1;

bool clock_set_date(const char *seconds)
{
    long long value = -1;
    if (seconds && !integer_parse(seconds, 0, 253402300799, &value)) /* the end of the year 9999 */
        return false;
    chosen = value;
    return true;
}

const char *clock_date(char out[DATE_TEXT_SIZE])
{
    const time_t now = chosen >= 0 ? (time_t)chosen : time(NULL);
    struct tm utc;
    if (!gmtime_r(&now, &utc) || strftime(out, DATE_TEXT_SIZE, "%Y-%m-%d %H:%M UTC", &utc) == 0)
        out[0] = '\0';
    return out;
}
