/* Data-parallel loops. Results must not depend on the number of threads: the call for an index may
 * write only what no other call reads or writes, or what belongs to its worker. */
#ifndef CORCAST_BASE_THREADS_H
#define CORCAST_BASE_THREADS_H

#include "base/status.h"

#include <stddef.h>

/* The number of processors this process may run on, at least 1. */
int threads_available(void);

/* Calls body(index, worker, context) for every index below `count`, in any order, on at most
 * `threads` threads (0: all processors), the calling one among them. `worker` in [0, threads) tells
 * the threads apart, for workspaces. Uses fewer threads when the system refuses to start one;
 * cannot fail. Returns when all calls have returned. */
void threads_for(size_t count, int threads, void (*body)(size_t index, int worker, void *context),
                 void *context);

/* What a call of such a loop ended with, where calls can fail. */
typedef struct CallResult {
    Status status;
    Err err; /* of a call that failed */
} CallResult;

/* Fails as the call of the lowest index did that failed, with its sentence in *err; STATUS_OK when
 * all `count` calls did their work. `err` may be NULL. */
MUST_CHECK Status calls_status(const CallResult *results, size_t count, Err *err);

#endif
