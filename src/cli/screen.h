/* Prints the messages and the progress of a command on standard error.
 *
 * On a terminal, progress is one line that is overwritten. Otherwise, for example in a log file,
 * one line is printed every ten seconds, so that the log of a long run shows that the run
 * continues. Messages are held back until progress is first shown or the command ends. If a command
 * fails, its held messages are dropped, so that only the error is printed.
 *
 *     Screen screen;
 *     Talk talk = screen_talk(&screen, quiet);
 *     Status status = work(&talk);
 *     (status == STATUS_OK ? screen_print_held : screen_drop_held)(&screen); */
#ifndef CORCAST_CLI_SCREEN_H
#define CORCAST_CLI_SCREEN_H

#include "options/talk.h"

/* A sentence that is held back. */
typedef struct HeldSentence {
    struct HeldSentence *next; /* NULL: the last one */
    char text[];
} HeldSentence;

typedef struct Screen {
    const char *what;   /* name of the current step; NULL: none; borrowed */
    bool quiet;         /* notes and progress are not printed */
    bool terminal;      /* standard error is a terminal */
    bool prompt;        /* sentences are printed at once */
    bool shown;         /* the last line of the terminal shows progress */
    HeldSentence *held; /* sentences in the order in which they came; owned */
    bool catches; /* a handler of SIGINT is installed [interrupt.h]; SIGINT ends the current step
                   * with its result so far */
    /* times of clock_seconds: start of the step, and last output of progress */
    double start_s, last_s;
} Screen;

/* Initializes *screen and returns a Talk that prints to standard error. The Talk borrows `screen`.
 */
Talk screen_talk(Screen *screen, bool quiet);
/* Prints the sentences that are held back. Later sentences are printed at once. */
void screen_print_held(Screen *screen);
/* Drops the sentences that are held back. */
void screen_drop_held(Screen *screen);

#endif
