#include "base/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

double clock_cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

void progress_start(Progress *progress, const char *what, bool quiet)
{
    *progress = (Progress){.what = what, .enabled = !quiet && isatty(STDERR_FILENO)};
}

void progress_show(Progress *progress, double fraction)
{
    if (!progress->enabled)
        return;
    double now = clock_seconds();
    if (now - progress->last_s < 0.1)
        return;
    progress->last_s = now;
    progress->shown = true;
    fprintf(stderr, "\r%s %3.0f %%", progress->what, 100 * fraction);
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
