/* Data-parallel loops: threads_for. Results must not depend on the number of threads. The call for
 * an index may therefore write only data that no other call reads or writes, and the workspace of
 * its worker. Loops whose calls can fail are in base/firstfail.h. */
#ifndef CORCAST_BASE_THREADS_H
#define CORCAST_BASE_THREADS_H

#include "base/status.h"

#include <stddef.h>

/* Returns the number of processors that this process may run on, at least 1. */
int threads_available(void);

/* Calls body(index, worker, context) for every index below `count`, and returns when all calls have
 * returned. Calls start in rising order of the index, but may run at the same time and end in any
 * order.
 *
 * threads  maximum number of threads, including the calling thread; 0: threads_available(). If the
 *          system cannot start a thread, the other threads do its work.
 * worker   index of the thread, in [0, threads): selects a workspace. */
void threads_for(size_t count, int threads, void (*body)(size_t index, int worker, void *context),
                 void *context);

#endif
