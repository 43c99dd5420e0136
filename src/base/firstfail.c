/* Records which call of a parallel loop failed first in the order of the indices, not of time.
 *
 * Failures are rare, so a spin lock is enough to record them. Indices are handed out in
 * rising order [threads.h]: when a call fails, all lower indices have been handed out before, so
 * the lowest failure does not depend on the threads. */
#include "base/firstfail.h"

void firstfail_note(FirstFail *fail, size_t index, Status status, const Err *err)
{
    if (status == STATUS_OK)
        return;
    while (atomic_exchange(&fail->is_locked, true))
        ;
    if (!firstfail_stops(fail, index)) {
        fail->status = status;
        fail->err.text[0] = '\0';
        if (err)
            fail->err = *err;
        atomic_store(&fail->rank, SIZE_MAX - index);
    }
    atomic_store(&fail->is_locked, false);
}

Status firstfail_status(const FirstFail *fail, Err *err)
{
    return fail->status == STATUS_OK ? STATUS_OK : err_set(err, fail->status, "%s", fail->err.text);
}

typedef struct TriedLoop {
    Status (*body)(size_t index, int worker, void *context, Err *err);
    void *context;
    FirstFail fail;
} TriedLoop;

static void try_index(size_t index, int worker, void *context)
{
    TriedLoop *loop = context;
    Err err = {{0}};
    if (!firstfail_stops(&loop->fail, index))
        firstfail_note(&loop->fail, index, loop->body(index, worker, loop->context, &err), &err);
}

Status threads_try(size_t count, int threads,
                   Status (*body)(size_t index, int worker, void *context, Err *err), void *context,
                   Err *err)
{
    TriedLoop loop = {.body = body, .context = context};
    threads_for(count, threads, try_index, &loop);
    return firstfail_status(&loop.fail, err);
}
