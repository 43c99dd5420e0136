/* Makes the calls of the operating system that differ between systems: paths of programs,
 * processors, memory, streams and processes.
 *
 * Each function has its Linux form first, and the form of other systems after #else. The forms for
 * other systems use POSIX alone, except for streams and for the path of the program, which the BSDs
 * and macOS have in their own forms. */
#include "base/system.h"

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#ifdef __linux__
#include <link.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#elif defined(__APPLE__)
#include <mach-o/dyld.h>
#elif defined(__FreeBSD__)
#include <sys/sysctl.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

/* ---- paths of programs ------------------------------------------------------------------------
 */

#ifdef __linux__
static bool read_link(const char *link, char *path, size_t size)
{
    const ssize_t length = readlink(link, path, size);
    const bool fits = length > 0 && (size_t)length < size;
    path[fits ? length : 0] = '\0';
    return fits;
}
#endif

bool system_program(char *path, size_t size)
{
#ifdef __linux__
    return read_link("/proc/self/exe", path, size);
#elif defined(__APPLE__)
    uint32_t room = (uint32_t)size;
    if (_NSGetExecutablePath(path, &room) == 0)
        return true;
#elif defined(__FreeBSD__)
    int name[] = {CTL_KERN, KERN_PROC, KERN_PROC_PATHNAME, -1};
    if (sysctl(name, 4, path, &size, NULL, 0) == 0)
        return true;
#endif
    path[0] = '\0';
    return false;
}

bool system_program_of(pid_t process, char *path, size_t size)
{
#ifdef __linux__
    char link[40];
    snprintf(link, sizeof link, "/proc/%d/exe", (int)process);
    return read_link(link, path, size);
#else
    (void)process;
    path[0] = '\0';
    return size == 0;
#endif
}

/* The loader knows the path of a library. It knows the name of the program only as it was called,
 * and the GNU loader gives it no name at all. */
bool system_own_file(char *path, size_t size)
{
    Dl_info info;
    char full[PATH_MAX];
#if defined(__linux__) && defined(RTLD_DL_LINKMAP)
    struct link_map *map = NULL;
    const bool is_library =
        dladdr1((const void *)(uintptr_t)&system_own_file, &info, (void **)&map, RTLD_DL_LINKMAP) &&
        map && map->l_name[0] == '/' && realpath(map->l_name, full);
#else
    char program[PATH_MAX];
    const bool is_library = dladdr((const void *)(uintptr_t)&system_own_file, &info) &&
                            info.dli_fname[0] == '/' && realpath(info.dli_fname, full) &&
                            !(system_program(program, sizeof program) && !strcmp(program, full));
#endif
    if (!is_library || strlen(full) >= size)
        return system_program(path, size);
    strcpy(path, full);
    return true;
}

/* ---- processors -------------------------------------------------------------------------------
 */

#ifdef __linux__

int system_processors(ProcessorSet *allowed)
{
    CPU_ZERO(allowed);
    if (sched_getaffinity(0, sizeof *allowed, allowed) != 0 || CPU_COUNT(allowed) == 0)
        CPU_SET(0, allowed);
    return CPU_COUNT(allowed);
}

static int another_processor(const ProcessorSet *allowed, int present, int offset)
{
    int processor = present;
    for (int left = offset % CPU_COUNT(allowed); left > 0; left--)
        do
            processor = (processor + 1) % CPU_SETSIZE;
        while (!CPU_ISSET(processor, allowed));
    return processor;
}

bool system_start_thread(pthread_t *thread, const ProcessorSet *allowed, int offset,
                         void *(*run)(void *), void *argument)
{
    const int present = sched_getcpu();
    bool started = false;
#ifdef __GLIBC__
    pthread_attr_t attributes;
    if (present >= 0 && pthread_attr_init(&attributes) == 0) {
        ProcessorSet one;
        CPU_ZERO(&one);
        CPU_SET(another_processor(allowed, present, offset), &one);
        started = pthread_attr_setaffinity_np(&attributes, sizeof one, &one) == 0 &&
                  pthread_create(thread, &attributes, run, argument) == 0;
        pthread_attr_destroy(&attributes);
    }
#endif
    return started || pthread_create(thread, NULL, run, argument) == 0;
}

void system_allow_processors(const ProcessorSet *allowed)
{
    (void)sched_setaffinity(0, sizeof *allowed, allowed);
}

#else

int system_processors(ProcessorSet *allowed)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return allowed->count = count > 0 ? (int)count : 1;
}

bool system_start_thread(pthread_t *thread, const ProcessorSet *allowed, int offset,
                         void *(*run)(void *), void *argument)
{
    (void)allowed, (void)offset;
    return pthread_create(thread, NULL, run, argument) == 0;
}

void system_allow_processors(const ProcessorSet *allowed)
{
    (void)allowed;
}

#endif

void system_join_thread(pthread_t thread)
{
    pthread_join(thread, NULL);
}

/* ---- memory -----------------------------------------------------------------------------------
 */

void system_prefer_huge_pages(void *memory, size_t size)
{
#ifdef MADV_HUGEPAGE
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), skip = (uintptr_t)memory % page;
    (void)madvise((char *)memory - skip, size + skip, MADV_HUGEPAGE);
#else
    (void)memory, (void)size;
#endif
}

void system_keep_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

void system_return_memory(void)
{
#ifdef __GLIBC__
    (void)malloc_trim(0);
#endif
}

/* ---- files ------------------------------------------------------------------------------------
 */

void system_unlink_files(int folder)
{
#ifdef __linux__
    /* readdir must not be called by a signal handler; the system call that it makes may be. */
    char block[4096] __attribute__((aligned(8)));
    for (long size; (size = syscall(SYS_getdents64, folder, block, sizeof block)) > 0;)
        for (long at = 0; at < size;) {
            const struct dirent64 *entry = (const struct dirent64 *)(block + at);
            unlinkat(folder, entry->d_name, 0);
            at += entry->d_reclen;
        }
#else
    DIR *stream = fdopendir(dup(folder));
    for (const struct dirent *entry; stream && (entry = readdir(stream));)
        unlinkat(folder, entry->d_name, 0);
    if (stream)
        closedir(stream);
#endif
}

FILE *system_stream(void *context, ssize_t (*write)(void *context, const char *bytes, size_t n))
{
#ifdef __linux__
    return fopencookie(context, "w", (cookie_io_functions_t){.write = write});
#else
    return funopen(context, NULL, (int (*)(void *, const char *, int))(void (*)(void))write, NULL,
                   NULL);
#endif
}

/* ---- processes --------------------------------------------------------------------------------
 */

bool system_pipe(int ends[2])
{
#ifdef __linux__
    return pipe2(ends, O_CLOEXEC) == 0;
#else
    return pipe(ends) == 0 && fcntl(ends[0], F_SETFD, FD_CLOEXEC) != -1 &&
           fcntl(ends[1], F_SETFD, FD_CLOEXEC) != -1;
#endif
}

void system_die_with_parent(void)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}
