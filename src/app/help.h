/* The options of a command as text for people. */
#ifndef CORCAST_APP_HELP_H
#define CORCAST_APP_HELP_H

#include "app/options.h"

/* Prints what `corcast COMMAND --help` does. */
MUST_CHECK Status help_print(const Command *command, Err *err);

/* Appends what the option means, which values it takes, and what holds without it; `plain` has its
 * default. */
void help_put_meaning(const Setting *plain, Text *text);

#endif
