/* The channel through which an operation reports messages and progress to its caller. The command
 * line prints them. A program that calls the library receives them by callbacks.
 *
 * Use, for one step of an operation:
 *
 *     progress_start(&progress, "growing", talk);
 *     while (work remains && progress_show(&progress, fraction)) ...
 *     progress_end(&progress); */
#ifndef CORCAST_OPTIONS_TALK_H
#define CORCAST_OPTIONS_TALK_H

#include <stdbool.h>

typedef enum TalkKind {
    TALK_NOTE,   /* a fact that is not printed with --quiet */
    TALK_WARNING /* a fact that is always printed */
} TalkKind;

/* The callbacks of the caller. Each may be NULL. The thread that started the operation calls them,
 * unless noted. */
typedef struct Talk {
    /* Receives one sentence without a final newline; the sentence is borrowed during the call. */
    void (*say)(void *user, TalkKind kind, const char *sentence);
    /* Receives the fraction of the step `what` that is done, in [0, 1]. A step begins with the
     * fraction 0. A call with `what` NULL means that the step has ended, by success or failure.
     * Returns false to stop the operation, which then fails with STATUS_CANCELLED. */
    bool (*progress)(void *user, const char *what, double fraction);
    /* For operations that improve a result until they are stopped: returns true to end with the
     * best result so far. Called at the beginning, by the thread that started the operation, and
     * after every change of the result, by any thread. */
    bool (*enough)(void *user);
    void *user; /* passed to all callbacks; borrowed */
} Talk;

/* Format a sentence and pass it to talk->say. They do nothing if `talk` is NULL. If memory runs
 * out, a sentence of 1024 bytes or more is dropped. */
void talk_note(const Talk *talk, const char *format, ...) __attribute__((format(printf, 2, 3)));
void talk_warn(const Talk *talk, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* One step whose progress is reported. */
typedef struct Progress {
    const Talk *talk; /* may be NULL; borrowed */
    const char *what; /* "growing"; borrowed */
    bool stopped;     /* Talk.progress has returned false */
} Progress;

/* Begins a step. */
void progress_start(Progress *progress, const char *what, const Talk *talk);
/* Reports that `fraction` of the step, in [0, 1], is done. Returns false from the time when the
 * caller requests a stop. */
bool progress_show(Progress *progress, double fraction);
/* Calls progress_show. Lower modules take it as their progress callback, with a Progress as
 * context. */
bool progress_report(double fraction, void *progress);
/* Returns the result of Talk.enough, or false if it is NULL. Lower modules take it as their stop
 * callback, with a Progress as context. */
bool progress_enough(void *progress);
/* Ends a step. The caller is informed by Talk.progress with `what` NULL. */
void progress_end(const Progress *progress);

#endif
