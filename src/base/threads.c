/* Runs the calls of a loop on several threads.
 *
 * Threads are started for each loop and take indices off a shared counter, so that a slow index
 * delays no others. The calling thread is worker 0.
 *
 * Each thread is started on a processor of its own, and may then run on all. Some kernels put a new
 * thread on the processor of the thread that started it. It would wait there for milliseconds until
 * that thread is preempted, which is longer than many loops take. */
#include "base/threads.h"

#include "base/system.h"

#include <locale.h>
#include <stdatomic.h>

/* Bounds arrays on the stack, here and in callers that have one element per thread. */
enum { MAX_THREADS = 256 };

int threads_available(void)
{
    ProcessorSet allowed;
    const int count = system_processors(&allowed);
    return count > MAX_THREADS ? MAX_THREADS : count;
}

typedef struct Loop {
    atomic_size_t next;
    size_t count;
    void (*body)(size_t index, int worker, void *context);
    void *context;
    locale_t locale; /* the locale of the calling thread, which all threads use */
    /* Threads start on different processors; then they may run on any of these. */
    ProcessorSet allowed;
} Loop;

typedef struct LoopWorker {
    Loop *loop;
    int number;
} LoopWorker;

static void run(const LoopWorker *worker)
{
    Loop *loop = worker->loop;
    size_t index;
    while ((index = atomic_fetch_add(&loop->next, 1)) < loop->count)
        loop->body(index, worker->number, loop->context);
}

static void *run_thread(void *argument)
{
    const LoopWorker *worker = argument;
    system_allow_processors(&worker->loop->allowed);
    uselocale(worker->loop->locale);
    run(worker);
    return NULL;
}

void threads_for(size_t count, int threads, void (*body)(size_t index, int worker, void *context),
                 void *context)
{
    if (threads <= 0)
        threads = threads_available();
    if (threads > MAX_THREADS)
        threads = MAX_THREADS;
    if ((size_t)threads > count)
        threads = count ? (int)count : 1;
    Loop loop = {.count = count, .body = body, .context = context};
    loop.locale = uselocale((locale_t)0);
    system_processors(&loop.allowed);
    LoopWorker workers[MAX_THREADS];
    pthread_t handles[MAX_THREADS];
    int started = 1;
    for (; started < threads; started++) {
        workers[started] = (LoopWorker){&loop, started};
        if (!system_start_thread(&handles[started], &loop.allowed, started, run_thread,
                                 &workers[started]))
            break;
    }
    workers[0] = (LoopWorker){&loop, 0};
    run(&workers[0]);
    for (int i = 1; i < started; i++)
        system_join_thread(handles[i]);
}
