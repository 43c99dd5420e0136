/* What an operation tells while it works, on standard error: sentences, and how far it is. Progress
 * is one line that changes on a terminal, and a line every ten seconds elsewhere, so that the log
 * of a long run shows that the run goes on. */
#ifndef CORCAST_CLI_SCREEN_H
#define CORCAST_CLI_SCREEN_H

#include "options/talk.h"

typedef struct Screen {
    const char *what;       /* the step that is under way; NULL: none; borrowed */
    bool quiet;             /* notes and progress are left out */
    bool terminal;          /* standard error is one */
    bool shown;             /* progress stands on the terminal's last line */
    bool catches;           /* SIGINT asks the step that is under way for its result */
    double start_s, last_s; /* when the step began and was last shown, by clock_seconds */
} Screen;

/* Makes a Talk that prints to standard error; `screen` is borrowed as long as the Talk is used. */
Talk screen_talk(Screen *screen, bool quiet);

#endif
