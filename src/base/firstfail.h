/* Parallel loops whose calls can fail: threads_try, and FirstFail for calls that cannot return a
 * Status.
 *
 * Several calls of a parallel loop may fail. The result is the failure of the lowest index, as in a
 * serial loop, for any number of threads. After a failure, calls of higher indices do not start any
 * more, or stop early if they ask. Calls of lower indices continue, because one of them may fail,
 * too. */
#ifndef CORCAST_BASE_FIRSTFAIL_H
#define CORCAST_BASE_FIRSTFAIL_H

#include "base/threads.h"
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Calls body(index, worker, context, err) for each index below `count`, as threads_for does, until
 * a call fails. Returns the status of the failed call with the lowest index, and its sentence in
 * *err; STATUS_OK if no call failed. `err` may be NULL. */
MUST_CHECK Status threads_try(size_t count, int threads,
                              Status (*body)(size_t index, int worker, void *context, Err *err),
                              void *context, Err *err);

/* The failure of the lowest index so far. All workers share it. Zeroed: no failure. */
typedef struct FirstFail {
    atomic_size_t rank; /* SIZE_MAX - index of the lowest failed call; 0: none failed */
    atomic_bool is_locked;
    Status status;
    Err err;
} FirstFail;

/* Returns true if the call of `index` need not continue: a call of this or a lower index failed. */
static inline bool firstfail_stops(const FirstFail *fail, size_t index)
{
    return SIZE_MAX - index <= atomic_load_explicit(&fail->rank, memory_order_relaxed);
}

/* Records the status of the call of `index` < SIZE_MAX; STATUS_OK changes nothing. *err has the
 * sentence of the failure and is copied; NULL: no sentence. */
void firstfail_note(FirstFail *fail, size_t index, Status status, const Err *err);

/* Returns the status of the failed call with the lowest index, and its sentence in *err; STATUS_OK
 * if no call failed. All workers must have ended. `err` may be NULL. */
MUST_CHECK Status firstfail_status(const FirstFail *fail, Err *err);

#endif
