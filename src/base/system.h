/* The system interfaces that are not the same everywhere: paths of programs, processors, memory,
 * pipes, streams. system.c is the only file that calls interfaces of Linux or of the GNU C library
 * which other systems lack or have in another form, so a port to another system begins there. Where
 * a system cannot follow an advice about memory or processors, the function has no effect. */
#ifndef CORCAST_BASE_SYSTEM_H
#define CORCAST_BASE_SYSTEM_H

#ifndef __wasi__ /* has no threads: system_start_thread fails */
#include <pthread.h>
#endif
#include <sched.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/* Writes the absolute path of the file that holds this code, the program or the shared library,
 * into `path`, and ends it with '\0'. Returns false, and an empty path, if the system does not tell
 * or the path has `size` or more bytes. */
bool system_own_file(char *path, size_t size);

/* Writes the absolute path of the running program, as system_own_file does for its file. */
bool system_program(char *path, size_t size);

/* Writes the path of the executable of another process of this user, as system_own_file does.
 * Where the system does not tell, returns false. */
bool system_program_of(pid_t process, char *path, size_t size);

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
 * starts on the processor that comes `number` places after the caller's in the cyclic order of the
 * allowed processors. Returns false if no thread can be started. */
bool system_start_thread(pthread_t *thread, const ProcessorSet *allowed, int number,
                         void *(*run)(void *), void *argument);
/* Waits until a thread that system_start_thread has started has ended. */
void system_join_thread(pthread_t thread);

/* Lets the calling thread run on all of `allowed` again. */
void system_run_anywhere(const ProcessorSet *allowed);

/* Advises the system to back `size` bytes at `memory` with huge pages. */
void system_prefer_huge_pages(void *memory, size_t size);

/* Makes the GNU C library keep all freed memory from now on, also large blocks. For programs that
 * draw picture after picture: buffers that are allocated for each picture then need no new pages,
 * which the system would clear. */
void system_keep_memory(void);

/* Returns freed memory to the system. Without this call, the GNU C library keeps freed pages that
 * lie between small blocks in use. Costs milliseconds. */
void system_return_memory(void);

/* Makes a pipe whose ends are closed when the process becomes another program. Returns false, with
 * errno set, if it cannot. */
bool system_pipe(int ends[2]);

/* Removes all files in an open folder, but no folders. On Linux a signal handler may call it. */
void system_unlink_files(int folder);

/* Returns a stream that hands all bytes written to it to `write(context, bytes, n)`, which returns
 * the number of bytes taken. The caller closes it with fclose. NULL if there is no memory. */
FILE *system_stream(void *context, ssize_t (*write)(void *context, const char *bytes, size_t n));

/* Has the kernel kill the calling process when its parent dies, where the kernel can. */
void system_die_with_parent(void);

#endif
