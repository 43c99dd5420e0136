/* The channel through which an operation reports to its caller: messages and progress. The command
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
    TALK_NOTE,   /* a fact that --quiet leaves out */
    TALK_WARNING /* a fact that every user must know */
} TalkKind;

/* Each callback may be NULL. If not stated otherwise, the thread that started the
 * operation calls it. */
typedef struct Talk {
    /* Takes one sentence without a final newline; the sentence is borrowed during the call. */
    void (*say)(void *user, TalkKind kind, const char *sentence);
    /* Takes how much of the step `what` is done, in [0, 1]. A step begins with the fraction 0; a
     * call with `what` NULL says that the step has ended, whether it is complete or has failed.
     * Returns false to stop the operation, which then fails with STATUS_CANCELLED. */
    bool (*progress)(void *user, const char *what, double fraction);
    /* Returns true if the caller wants the best result so far of an operation that improves one
     * until it is stopped. The thread that started the operation calls it first, and any thread
     * after every move. */
    bool (*enough)(void *user);
    void *user; /* passed to all callbacks; borrowed */
} Talk;

/* Formats a sentence, of any length, and passes it to `talk`. If `talk` is NULL, does nothing. A
 * sentence of 1024 bytes or more is dropped if memory runs out. */
void talk_note(const Talk *talk, const char *format, ...) __attribute__((format(printf, 2, 3)));
void talk_warn(const Talk *talk, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* One step whose progress is reported. */
typedef struct Progress {
    const Talk *talk; /* may be NULL; borrowed */
    const char *what; /* "growing"; borrowed */
    bool stopped;     /* the caller asked to stop */
} Progress;

/* Begins a step. */
void progress_start(Progress *progress, const char *what, const Talk *talk);
/* Reports that `fraction` of the step, in [0, 1], is done. Returns false once the caller has asked
 * to stop. */
bool progress_show(Progress *progress, double fraction);
/* Does what progress_show does, for the callbacks of lower modules, whose context is a Progress. */
bool progress_report(double fraction, void *progress);
/* Returns what Talk.enough does, false without one. For the stop callbacks of lower modules, whose
 * context is a Progress. */
bool progress_enough(void *progress);
/* Ends a step. */
void progress_end(const Progress *progress);

#endif
