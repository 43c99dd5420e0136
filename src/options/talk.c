/* Sends notes, warnings and progress to the caller of a command. A sentence needs memory only if it
 * is longer than 1 kB, so ordinary sentences arrive even when memory has run out. */
#include "options/talk.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

__attribute__((format(printf, 3, 0))) static void say(const Talk *talk, TalkKind kind,
                                                      const char *format, va_list values)
{
    char local[1024], *longer = NULL;
    va_list again;
    if (!talk || !talk->say)
        return;
    va_copy(again, values);
    const int length = vsnprintf(local, sizeof local, format, values);
    const bool fits = length >= 0 && (size_t)length < sizeof local;
    if (length >= 0 && !fits && (longer = malloc((size_t)length + 1)))
        vsnprintf(longer, (size_t)length + 1, format, again);
    if (fits || longer)
        talk->say(talk->user, kind, fits ? local : longer);
    va_end(again);
    free(longer);
}

void talk_note(const Talk *talk, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(talk, TALK_NOTE, format, values);
    va_end(values);
}

void talk_warn(const Talk *talk, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(talk, TALK_WARNING, format, values);
    va_end(values);
}

void progress_start(Progress *progress, const char *what, const Talk *talk)
{
    *progress = (Progress){.talk = talk, .what = what};
    progress_show(progress, 0);
}

bool progress_show(Progress *progress, double fraction)
{
    const Talk *talk = progress->talk;
    if (talk && talk->progress && !talk->progress(talk->user, progress->what, fraction))
        progress->stopped = true;
    return !progress->stopped;
}

bool progress_report(double fraction, void *progress)
{
    return progress_show(progress, fraction);
}

bool progress_enough(void *progress)
{
    const Talk *talk = ((const Progress *)progress)->talk;
    return talk && talk->enough && talk->enough(talk->user);
}

void progress_end(const Progress *progress)
{
    const Talk *talk = progress->talk;
    if (talk && talk->progress)
        (void)talk->progress(talk->user, NULL, 1);
}
