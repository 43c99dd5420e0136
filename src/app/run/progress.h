/* How far something is, on standard error: a line that changes on a terminal, a line every ten
 * seconds elsewhere, so that a log of a long run says that it goes on. */
#ifndef CORCAST_APP_PROGRESS_H
#define CORCAST_APP_PROGRESS_H

#include <stdbool.h>

typedef struct Progress {
    const char *what;       /* "growing" */
    double start_s, last_s; /* when it began and was last shown, by clock_seconds */
    bool quiet, terminal;
    bool shown; /* on the terminal's last line */
} Progress;

/* Shows nothing when `quiet`. `what` is borrowed. */
void progress_start(Progress *progress, const char *what, bool quiet);
/* Shows `fraction` in [0, 1] and, after a second, how long the rest takes if it goes on like this:
 * at most ten times a second on a terminal, once in ten seconds elsewhere. */
void progress_show(Progress *progress, double fraction);
/* progress_show for a library's callback, whose context is the Progress. */
void progress_report(double fraction, void *progress);
/* Clears the line. */
void progress_end(Progress *progress);

#endif
