/* Data-parallel loops. Results must not depend on the number of threads: the call for an index
 * writes only what no other call reads or writes, or what belongs to its worker. Loops whose calls
 * can fail are in base/firstfail.h. */
#ifndef CORCAST_BASE_THREADS_H
#define CORCAST_BASE_THREADS_H

#include "base/status.h"

#include <stddef.h>

/* Returns the number of processors that this process may run on, at least 1. */
int threads_available(void);

/* Calls body(index, worker, context) for every index below `count`, in any order, and returns when
 * all calls have returned. Indices are handed out in rising order.
 *
 * threads  maximum number of threads, the calling thread included; 0: all processors. There are
 *          fewer if the system refuses to start one.
 * worker   in [0, threads): tells the threads apart, for workspaces. */
void threads_for(size_t count, int threads, void (*body)(size_t index, int worker, void *context),
                 void *context);

#endif
