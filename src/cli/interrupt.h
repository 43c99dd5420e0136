/* Lets a user stop long work with SIGINT and keep the result so far. */
#ifndef CORCAST_CLI_INTERRUPT_H
#define CORCAST_CLI_INTERRUPT_H

#include <stdbool.h>

/* Installs a handler of SIGINT. The first SIGINT makes interrupt_asked return true. The second one
 * ends the program. If the process ignored SIGINT before, nothing changes. */
void interrupt_catch(void);
/* Restores the handling of SIGINT from before interrupt_catch. */
void interrupt_release(void);

/* Returns true if a SIGINT came since interrupt_catch. */
bool interrupt_asked(void);

#endif
