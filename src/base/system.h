/* Interfaces that differ between operating systems: paths of programs, processors, memory, pipes
 * and streams. Only system.c calls interfaces of Linux or of the GNU C library that other systems
 * lack, so a port to another system begins there. A function that gives the system advice about
 * memory or processors has no effect on a system that cannot follow the advice. */
#ifndef CORCAST_BASE_SYSTEM_H
#define CORCAST_BASE_SYSTEM_H

#ifndef __wasi__ /* WASI has no threads: its sys/types.h declares pthread_t, and                   \
                  * system_start_thread returns false */
#include <pthread.h>
#endif
#include <sched.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* Writes to `path` the absolute path, zero-terminated, of the file that contains this code: the
 * program or the shared library. Returns false, and sets an empty path, if the path is not known or
 * has `size` or more bytes. */
bool system_own_file(char *path, size_t size);

/* Writes the absolute path of the running program to `path`. Fails as system_own_file does. */
bool system_program(char *path, size_t size);

/* Writes the path of the executable of another process of this user to `path`. Fails as
 * system_own_file does. */
bool system_program_of(pid_t process, char *path, size_t size);

/* A set of processors. */
#ifdef __linux__
typedef cpu_set_t ProcessorSet;
#else
typedef struct ProcessorSet {
    int count;
} ProcessorSet;
#endif

/* Sets *allowed to the processors that the calling thread may run on. Returns their number, at
 * least 1. */
int system_processors(ProcessorSet *allowed);

/* Starts a thread that runs `run(argument)`. Where threads can be bound to processors, the thread
 * is bound to the processor that comes `offset` places after the caller's in the cyclic order of
 * the allowed processors, until it calls system_allow_processors. Returns false if no thread can be
 * started. */
bool system_start_thread(pthread_t *thread, const ProcessorSet *allowed, int offset,
                         void *(*run)(void *), void *argument);
/* Waits until a thread that system_start_thread has started has ended. */
void system_join_thread(pthread_t thread);

/* Allows the calling thread to run on all processors of `allowed`. */
void system_allow_processors(const ProcessorSet *allowed);

/* Advises the system to back `size` bytes at `memory` with huge pages. */
void system_prefer_huge_pages(void *memory, size_t size);

/* Makes the GNU C library keep all freed memory from now on, also large blocks. For programs that
 * draw many pictures: the buffers of each picture then reuse pages, and the system need not provide
 * and clear new ones. */
void system_keep_memory(void);

/* Returns freed memory to the system. Without this call, the GNU C library keeps freed pages that
 * lie between small blocks in use. Costs milliseconds. */
void system_return_memory(void);

/* Makes a pipe: ends[0] is for reading, ends[1] for writing. Both ends are close-on-exec. Returns
 * false, with errno set, on failure. */
bool system_pipe(int ends[2]);

/* Removes all files in the folder with this file descriptor, but no folders. Files that cannot be
 * removed stay. On Linux a signal handler may call it. */
void system_unlink_files(int folder);

/* Returns a stream that passes all bytes written to it to write(context, bytes, n). `write` returns
 * the number of bytes that it accepted. The caller closes the stream with fclose. Returns NULL if
 * memory runs out. */
FILE *system_stream(void *context, ssize_t (*write)(void *context, const char *bytes, size_t n));

/* Makes the kernel kill the calling process when its parent process ends, if the kernel can. */
void system_die_with_parent(void);

#endif
