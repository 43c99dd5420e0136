/* One progress line on standard error, and only when that is a terminal. */
#ifndef CORCAST_BASE_PROGRESS_H
#define CORCAST_BASE_PROGRESS_H

#include <stdbool.h>

typedef struct Progress {
    const char *what; /* "growing" */
    double last_s;    /* when it was last shown */
    bool shown;
    bool enabled;
} Progress;

/* Shows nothing when `quiet` or when standard error is not a terminal. `what` is borrowed. */
void progress_start(Progress *progress, const char *what, bool quiet);
/* Shows `fraction` in [0, 1], at most ten times a second. */
void progress_show(Progress *progress, double fraction);
/* progress_show for a library's callback, whose context is the Progress. */
void progress_report(double fraction, void *progress);
/* Clears the line. */
void progress_end(Progress *progress);

/* Seconds of a monotonic clock. */
double clock_seconds(void);
/* Seconds that processors have spent on this program, all threads together. */
double clock_cpu_seconds(void);

#endif
