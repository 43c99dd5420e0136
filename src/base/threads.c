/* Threads are started for each loop and take indices off a shared counter, so that a slow index
 * delays no others. The calling thread is worker 0.
 *
 * Each thread is started on a processor of its own and then allowed on all: some kernels put a new
 * thread on the processor of the one that started it, where it would wait for milliseconds until
 * that one is preempted, longer than many loops take. */
#include "base/threads.h"

#include <locale.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>

enum { MAX_THREADS = 256 };

static bool allowed_processors(cpu_set_t *allowed)
{
    return sched_getaffinity(0, sizeof *allowed, allowed) == 0 && CPU_COUNT(allowed) > 0;
}

int threads_available(void)
{
    cpu_set_t allowed;
    if (!allowed_processors(&allowed))
        return 1;
    int count = CPU_COUNT(&allowed);
    return count > MAX_THREADS ? MAX_THREADS : count;
}

typedef struct Loop {
    atomic_size_t next;
    size_t count;
    void (*body)(size_t index, int worker, void *context);
    void *context;
    locale_t locale; /* of the calling thread, for all */
    bool spread; /* threads start on different processors; later they may run on any in `allowed` */
    cpu_set_t allowed;
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
    if (worker->loop->spread)
        (void)sched_setaffinity(0, sizeof worker->loop->allowed, &worker->loop->allowed);
    uselocale(worker->loop->locale);
    run(worker);
    return NULL;
}

/* The allowed processor that is `number` allowed ones after the present one, cyclically. */
static int another_processor(const cpu_set_t *allowed, int number)
{
    int processor = sched_getcpu();
    for (int left = number % CPU_COUNT(allowed); left > 0; left--)
        do
            processor = (processor + 1) % CPU_SETSIZE;
        while (!CPU_ISSET(processor, allowed));
    return processor;
}

static bool start(pthread_t *thread, LoopWorker *worker)
{
    pthread_attr_t attributes;
    cpu_set_t one;
    if (worker->loop->spread && pthread_attr_init(&attributes) == 0) {
        CPU_ZERO(&one);
        CPU_SET(another_processor(&worker->loop->allowed, worker->number), &one);
        bool started = pthread_attr_setaffinity_np(&attributes, sizeof one, &one) == 0 &&
                       pthread_create(thread, &attributes, run_thread, worker) == 0;
        pthread_attr_destroy(&attributes);
        if (started)
            return true;
    }
    return pthread_create(thread, NULL, run_thread, worker) == 0;
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
    loop.spread = threads > 1 && allowed_processors(&loop.allowed) && sched_getcpu() >= 0;
    LoopWorker workers[MAX_THREADS];
    pthread_t handles[MAX_THREADS];
    int started = 1;
    for (; started < threads; started++) {
        workers[started] = (LoopWorker){&loop, started};
        if (!start(&handles[started], &workers[started]))
            break;
    }
    workers[0] = (LoopWorker){&loop, 0};
    run(&workers[0]);
    for (int i = 1; i < started; i++)
        pthread_join(handles[i], NULL);
}
