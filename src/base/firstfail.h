/* The first failure of several workers.
 *
 * Of the calls of a parallel loop, several may fail. The failure of the lowest index is the result,
 * as in a serial loop, for any number of threads. Calls of higher indices stop early; calls of
 * lower indices go on, because one of them may fail, too. */
#ifndef CORCAST_BASE_FIRSTFAIL_H
#define CORCAST_BASE_FIRSTFAIL_H

#include "base/threads.h"
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Calls body(index, worker, context, err) for each index below `count`, as threads_for does, until
 * a call fails. Fails as the call of the lowest index did that failed, with its sentence in *err,
 * which may be NULL. */
MUST_CHECK Status threads_try(size_t count, int threads,
                              Status (*body)(size_t index, int worker, void *context, Err *err),
                              void *context, Err *err);

/* The lowest failure so far, for calls that cannot return a Status, such as visitors. Zeroed, there
 * is none. All workers share it. */
typedef struct FirstFail {
    atomic_size_t rank; /* SIZE_MAX - index of the lowest failed call; 0: none failed */
    atomic_bool is_locked;
    Status status;
    Err err;
} FirstFail;

/* Returns true if the call of `index` need not go on: a call of this or a lower index failed. */
static inline bool firstfail_stops(const FirstFail *fail, size_t index)
{
    return SIZE_MAX - index <= atomic_load_explicit(&fail->rank, memory_order_relaxed);
}

/* Records how the call of `index` < SIZE_MAX ended; STATUS_OK changes nothing. `err` (borrowed) has
 * the sentence of the failure; NULL: there is none. */
void firstfail_note(FirstFail *fail, size_t index, Status status, const Err *err);

/* Fails as the lowest call did that failed, with its sentence in *err, which may be NULL. The
 * workers have ended. */
MUST_CHECK Status firstfail_status(const FirstFail *fail, Err *err);

#endif
