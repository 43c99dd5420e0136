/* Installs a handler of SIGINT (Ctrl-C) that sets a flag. The handler also restores the action from
 * before interrupt_catch. A second SIGINT therefore ends a program that does not read the flag
 * soon. */
#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>

/* Globals, because a signal handler receives no other data. */
static volatile sig_atomic_t asked;
static struct sigaction before;

static void on_interrupt(int signal_number)
{
    asked = 1;
    sigaction(signal_number, &before, NULL);
}

void interrupt_catch(void)
{
    struct sigaction action = {.sa_handler = on_interrupt};
    sigemptyset(&action.sa_mask);
    asked = 0;
    sigaction(SIGINT, &action, &before);
    if (before.sa_handler == SIG_IGN)
        sigaction(SIGINT, &before, NULL);
}

void interrupt_release(void)
{
    sigaction(SIGINT, &before, NULL);
}

bool interrupt_asked(void)
{
    return asked != 0;
}
