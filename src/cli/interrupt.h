/* Lets a user end a long operation by SIGINT (Ctrl-C) and keep the result so far. */
#ifndef CORCAST_CLI_INTERRUPT_H
#define CORCAST_CLI_INTERRUPT_H

#include <stdbool.h>

/* Installs a handler of SIGINT, and makes interrupt_asked return false. The first SIGINT makes
 * interrupt_asked return true. The second SIGINT ends the program. If the process ignored SIGINT
 * before, as under nohup, nothing changes.
 */
void interrupt_catch(void);
/* Restores the handling of SIGINT from before interrupt_catch. */
void interrupt_release(void);

/* Returns true if a SIGINT has arrived since interrupt_catch. */
bool interrupt_asked(void);

#endif
