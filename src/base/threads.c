#include "base/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum { MAX_THREADS = 256 };

int threads_available(void)
{
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
        return 1;
    int count = CPU_COUNT(&allowed);
    return count < 1 ? 1 : count > MAX_THREADS ? MAX_THREADS : count;
}

typedef struct Loop {
    atomic_size_t next;
    size_t count;
    void (*body)(size_t index, int worker, void *context);
    void *context;
} Loop;

typedef struct Worker {
    Loop *loop;
    int number;
} Worker;

static void *run(void *argument)
{
    Worker *worker = argument;
    Loop *loop = worker->loop;
    size_t index;
    while ((index = atomic_fetch_add(&loop->next, 1)) < loop->count)
        loop->body(index, worker->number, loop->context);
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
    Worker workers[MAX_THREADS];
    pthread_t handles[MAX_THREADS];
    int started = 1;
    for (; started < threads; started++) {
        workers[started] = (Worker){&loop, started};
        if (pthread_create(&handles[started], NULL, run, &workers[started]) != 0)
            break;
    }
    workers[0] = (Worker){&loop, 0};
    run(&workers[0]);
    for (int i = 1; i < started; i++)
        pthread_join(handles[i], NULL);
}
