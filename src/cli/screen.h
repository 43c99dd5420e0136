/* Prints the messages and the progress of a command on standard error.
 *
 * On a terminal, progress is one line that is overwritten. Otherwise, for example in a log file,
 * one line is printed every ten seconds: often enough to show that the run continues, and rarely
 * enough for a log of hours. Messages are held back until progress is first shown or the command
 * ends. If a command fails, its held messages are dropped, so that only the error is printed.
 *
 *     Screen screen;
 *     Talk talk = screen_talk(&screen, quiet);
 *     Status status = work(&talk);
 *     (status == STATUS_OK ? screen_print_held : screen_drop_held)(&screen); */
#ifndef CORCAST_CLI_SCREEN_H
#define CORCAST_CLI_SCREEN_H

#include "options/talk.h"

/* A message that is held back. */
typedef struct HeldMessage {
    struct HeldMessage *next; /* NULL: the last one */
    char text[];
} HeldMessage;

typedef struct Screen {
    const char *what;  /* name of the current step; NULL: none; borrowed */
    bool quiet;        /* notes and progress are not printed; warnings are */
    bool terminal;     /* standard error is a terminal */
    bool prompt;       /* messages are printed at once, not held back */
    bool shown;        /* the last line of the terminal shows progress */
    HeldMessage *held; /* messages in the order in which they came; owned */
    bool catches; /* a handler of SIGINT is installed [interrupt.h]: SIGINT makes the current step
                   * stop and return what it has computed so far */
    /* times of clock_seconds: start of the step, and last output of progress */
    double start_s, last_s;
} Screen;

/* Initializes *screen and returns a Talk that prints to standard error. The Talk borrows `screen`.
 */
Talk screen_talk(Screen *screen, bool quiet);
/* Prints and frees the messages that are held back. Later messages are printed at once. Call this
 * function or screen_drop_held at the end, as the Screen has no release. */
void screen_print_held(Screen *screen);
/* Frees the messages that are held back without printing them. */
void screen_drop_held(Screen *screen);

#endif
