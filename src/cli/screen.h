/* What an operation tells while it works, on standard error: sentences, and how far it is. Progress
 * is one line that changes on a terminal, and a line every ten seconds elsewhere, so that the log
 * of a long run shows that the run goes on. Sentences are held back until the command ends or its
 * progress is shown, and a command that fails drops them, so that it prints its error alone. */
#ifndef CORCAST_CLI_SCREEN_H
#define CORCAST_CLI_SCREEN_H

#include "options/talk.h"

/* A sentence that is held back. */
typedef struct HeldSentence {
    struct HeldSentence *next; /* NULL: the last one */
    char text[];
} HeldSentence;

typedef struct Screen {
    const char *what;       /* the step that is under way; NULL: none; borrowed */
    bool quiet;             /* notes and progress are left out */
    bool terminal;          /* standard error is one */
    bool prompt;            /* sentences are printed at once */
    bool shown;             /* progress stands on the terminal's last line */
    HeldSentence *held;     /* sentences in the order in which they came; owned */
    bool catches;           /* SIGINT asks the step that is under way for its result */
    double start_s, last_s; /* when the step began and was last shown, by clock_seconds */
} Screen;

/* Makes a Talk that prints to standard error; `screen` is borrowed as long as the Talk is used. */
Talk screen_talk(Screen *screen, bool quiet);
/* Prints the sentences that are held back. Later sentences are printed at once. */
void screen_print_held(Screen *screen);
/* Drops the sentences that are held back. */
void screen_drop_held(Screen *screen);

#endif
