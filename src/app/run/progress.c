/* One line of standard error, written over where that is a terminal. The time left is what the rest
 * takes at the speed so far. */
#include "app/run/progress.h"

#include "base/base.h"
#include <stdio.h>
#include <unistd.h>

void progress_start(Progress *progress, const char *what, bool quiet)
{
    double now_s = clock_seconds();
    *progress = (Progress){.what = what, .start_s = now_s, .quiet = quiet};
    progress->terminal = isatty(STDERR_FILENO);
    progress->last_s = progress->terminal ? 0 : now_s;
}

/* ", 12 s left" once there is something to tell it by, else nothing: after a hundredth of the work,
 * or ten seconds of it. */
static const char *time_left(double elapsed_s, double fraction, char out[32])
{
    double left_s = elapsed_s * (1 - fraction) / fraction;
    out[0] = '\0';
    if (elapsed_s < 1 || !(fraction >= (elapsed_s < 10 ? 0.01 : 1e-6)))
        return out;
    if (left_s < 100)
        snprintf(out, 32, ", %.0f s left", left_s);
    else if (left_s < 6000)
        snprintf(out, 32, ", %.0f min left", left_s / 60);
    else
        snprintf(out, 32, ", %.0f h left", left_s / 3600);
    return out;
}

void progress_show(Progress *progress, double fraction)
{
    char left[32];
    double now_s = clock_seconds();
    if (progress->quiet || now_s - progress->last_s < (progress->terminal ? 0.1 : 10))
        return;
    progress->last_s = now_s;
    progress->shown = progress->terminal;
    fprintf(stderr, progress->terminal ? "\r%s %3.0f %%%s\033[K" : "%s: %.0f %%%s\n",
            progress->what, 100 * fraction, time_left(now_s - progress->start_s, fraction, left));
    fflush(stderr);
}

void progress_report(double fraction, void *progress)
{
    progress_show(progress, fraction);
}

void progress_end(Progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = false;
}
