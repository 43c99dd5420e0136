/* Data-parallel loops. Results never depend on the number of threads: an index writes only what is
 * its own. */
#ifndef CORCAST_BASE_THREADS_H
#define CORCAST_BASE_THREADS_H

#include <stddef.h>

/* The number of processors this process may run on, at least 1. */
int threads_available(void);

/* Calls body(index, worker, context) for every index below `count`, on at most `threads` threads
 * (0: all processors). `worker` is in [0, threads), for workspaces. Falls back to fewer threads
 * when the system refuses to start one. Returns when all calls have. */
void threads_for(size_t count, int threads, void (*body)(size_t index, int worker, void *context),
                 void *context);

#endif
