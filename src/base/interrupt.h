/* Work that a user may cut short with SIGINT and keep the result of. */
#ifndef CORCAST_BASE_INTERRUPT_H
#define CORCAST_BASE_INTERRUPT_H

#include <stdbool.h>

/* From here on the first SIGINT only makes interrupt_asked() true; a second one ends the program as
 * usual. A SIGINT that the caller ignores stays ignored. */
void interrupt_catch(void);
/* Ends what interrupt_catch began: SIGINT does again what it did before. */
void interrupt_release(void);

/* Whether SIGINT came since interrupt_catch. `context` is unused: the form of a stop callback. */
bool interrupt_asked(void *context);

#endif
