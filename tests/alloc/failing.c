/* Makes allocations of a program fail, one after another, and checks that the program handles
 * each failure. This library is loaded before the program's own libraries. It runs the
 * program's main many times, each time in a new process with another failing allocation.
 *
 *   LD_PRELOAD=failing.so [FAILING_STEP=K] [FAILING_LASTING=1] [FAILING_OUTPUTS=many] PROGRAM ...
 *
 * The first run is undisturbed and counts the allocations. Then every K-th allocation fails
 * (default: each), and with FAILING_LASTING also all that follow it. The current folder of each
 * run is an empty folder ./run; the files of the first run stay in ./undisturbed. A run must
 * never be ended by a signal or take a minute. It must end in one of two ways:
 *
 * - As the undisturbed run: with the same bytes on standard output, on standard error and in
 *   the same files.
 * - With exit status 3 and one message on standard error, and without files. With
 *   FAILING_OUTPUTS=many, for commands that write several files, it may leave files with the
 *   same bytes as those of the undisturbed run.
 *
 * The clock stands still, because some outputs contain seconds. Memory is filled with arbitrary
 * bytes when it is allocated and when it is freed. Programs that the program runs are not
 * disturbed.
 *
 * FAILING_ONLY=N runs the program once, in this process and folder, with the N-th allocation
 * failing, for use in a debugger.
 *
 * Prints a line for each violation and the number of allocations; exit status 1 if there is a
 * violation. */
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <malloc.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* -------------------------------------------------------------------------------- allocations */

/* What glibc's own functions are called beneath. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static atomic_ulong allocations;
static unsigned long failing; /* the number of the one that fails, from 1; 0: none */
static bool lasting;
static bool counting;
static atomic_ulong *count_of_run; /* shared with the run */

/* A process that the program forks counts on from where it was forked, beside the program itself.
 */
static void raise_to(atomic_ulong *count, unsigned long number)
{
    unsigned long before = atomic_load(count);
    while (before < number && !atomic_compare_exchange_weak(count, &before, number))
        ;
}

static bool fails(void)
{
    if (!counting)
        return false;
    unsigned long number = atomic_fetch_add(&allocations, 1) + 1;
    raise_to(count_of_run, number);
    if (!failing || (lasting ? number < failing : number != failing))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    return fails() ? NULL : __libc_realloc(memory, size);
}

void *reallocarray(void *memory, size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) {
        errno = ENOMEM;
        return NULL;
    }
    return realloc(memory, bytes);
}

void *memalign(size_t alignment, size_t size)
{
    return fails() ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    void *made = memalign(alignment, size);
    if (made)
        *memory = made;
    return made ? 0 : ENOMEM;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    (void)clock;
    *now = (struct timespec){0};
    return 0;
}

time_t time(time_t *now)
{
    if (now)
        *now = 0;
    return 0;
}

/* ------------------------------------------------------------------------------------ one run */

typedef int Main(int argc, char **argv, char **environment);
static Main *program;

static void redirect(int descriptor, const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(99);
    close(file);
}

/* Runs the program in the new folder `name`, its output in the files name.stdout and name.stderr:
 * how it ended, as waitpid says. */
static int run(const char *name, unsigned long fail, int argc, char **argv, char **environment)
{
    char path[2][64];
    snprintf(path[0], sizeof path[0], "%s.stdout", name);
    snprintf(path[1], sizeof path[1], "%s.stderr", name);
    pid_t child = fork();
    if (child == 0) {
        redirect(STDOUT_FILENO, path[0]);
        redirect(STDERR_FILENO, path[1]);
        if (mkdir(name, 0777) != 0 || chdir(name) != 0)
            _exit(99);
        lseek(STDIN_FILENO, 0, SEEK_SET);
        alarm(60);
        failing = fail;
        counting = true;
        exit(program(argc, argv, environment));
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
}

/* -------------------------------------------------------------------------------- its promise */

static bool many_outputs;
static int files; /* found by a walk */
static char broken[200];

static void break_promise(const char *what, const char *of)
{
    if (!*broken)
        snprintf(broken, sizeof broken, "%s%s", what, of);
}

/* The whole of a file, NULL when it is not there; free with free. */
static char *read_all(const char *path, size_t *size)
{
    struct stat about;
    int file = open(path, O_RDONLY);
    if (file < 0 || fstat(file, &about) != 0)
        return NULL;
    char *bytes = malloc((size_t)about.st_size + 1);
    ssize_t got = read(file, bytes, (size_t)about.st_size);
    close(file);
    *size = got < 0 ? 0 : (size_t)got;
    bytes[*size] = '\0';
    return bytes;
}

static bool same(const char *a, const char *b)
{
    size_t sizes[2] = {0, 0};
    char *bytes[2] = {read_all(a, &sizes[0]), read_all(b, &sizes[1])};
    bool equal =
        bytes[0] && bytes[1] && sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0;
    free(bytes[0]);
    free(bytes[1]);
    return equal;
}

static int hold_against_undisturbed(const char *path, const struct stat *about, int type,
                                    struct FTW *walk)
{
    (void)about;
    (void)walk;
    char other[4096];
    if (type == FTW_D)
        return 0;
    files++;
    snprintf(other, sizeof other, "undisturbed%s", path + strlen("run"));
    if (!same(path, other))
        break_promise("leaves other bytes in ", path);
    return 0;
}

static int count_file(const char *path, const struct stat *about, int type, struct FTW *walk)
{
    (void)path;
    (void)about;
    (void)walk;
    files += type != FTW_D;
    return 0;
}

static int remove_one(const char *path, const struct stat *about, int type, struct FTW *walk)
{
    (void)about;
    (void)type;
    (void)walk;
    return remove(path);
}

/* The first line that is not a library's own: the NIfTI library's begin with two stars. */
static char *past_library(char *text)
{
    while (text && strncmp(text, "** ", 3) == 0)
        text += strcspn(text, "\n") + 1;
    return text;
}

/* One line after as much of what the undisturbed run says, line by line, as there may be. */
static void expect_one_sentence(void)
{
    size_t size = 0, other_size = 0;
    char *text = read_all("run.stderr", &size), *sentence = past_library(text);
    char *other = read_all("undisturbed.stderr", &other_size), *line = other;
    for (size_t length;
         (length = strcspn(line, "\n") + 1) <= strlen(line) && strncmp(sentence, line, length) == 0;
         line += length)
        sentence += length;
    if (!*sentence)
        break_promise("says nothing", "");
    else if (strchr(sentence, '\n') != text + size - 1)
        break_promise("says more than one line: ", sentence);
    else if (strstr(text, "(null)"))
        break_promise("says ", text);
    free(text);
    free(other);
}

/* Fills `broken`. */
static void judge(int status, int undisturbed)
{
    char number[32];
    *broken = '\0';
    files = 0;
    nftw("run", hold_against_undisturbed, 16, FTW_PHYS);
    int left = files;
    files = 0;
    nftw("undisturbed", count_file, 16, FTW_PHYS);
    if (WIFSIGNALED(status)) {
        *broken = '\0';
        snprintf(number, sizeof number, "%d", WTERMSIG(status));
        break_promise("ended by signal ", number);
    } else if (status == undisturbed) {
        if (left != files)
            break_promise("does not write all files", "");
        if (!same("run.stdout", "undisturbed.stdout"))
            break_promise("differs on standard output", "");
        size_t size;
        char *texts[2] = {read_all("run.stderr", &size), read_all("undisturbed.stderr", &size)};
        if (strcmp(past_library(texts[0]), texts[1]) != 0)
            break_promise("differs on standard error", "");
        free(texts[0]);
        free(texts[1]);
    } else if (WEXITSTATUS(status) == 3) {
        expect_one_sentence();
        if (left > 0 && !many_outputs)
            break_promise("leaves a file", "");
    } else {
        size_t size = 0;
        char *text = read_all("run.stderr", &size);
        snprintf(broken, sizeof broken, "ends with exit status %d: %s", WEXITSTATUS(status),
                 text ? text : "");
        free(text);
    }
}

/* ----------------------------------------------------------------------------------- the loop */

static void remove_folder(const char *name)
{
    nftw(name, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* One run in this process, for a debugger. */
static int run_only(unsigned long fail, int argc, char **argv, char **environment)
{
    failing = fail;
    counting = true;
    return program(argc, argv, environment);
}

static int loop(int argc, char **argv, char **environment)
{
    const char *only = getenv("FAILING_ONLY"), *step_text = getenv("FAILING_STEP"),
               *outputs = getenv("FAILING_OUTPUTS");
    unsigned long step = step_text ? strtoul(step_text, NULL, 10) : 1;
    int failures = 0;
    many_outputs = outputs && strcmp(outputs, "many") == 0;
    unsetenv("LD_PRELOAD");
    mallopt(M_PERTURB, 0xA5);
    count_of_run =
        mmap(NULL, sizeof *count_of_run, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    lasting = getenv("FAILING_LASTING") != NULL;
    if (only)
        return run_only(strtoul(only, NULL, 10), argc, argv, environment);
    remove_folder("undisturbed");
    int undisturbed = run("undisturbed", 0, argc, argv, environment);
    unsigned long n = atomic_load(count_of_run), tried = 0;
    for (unsigned long i = 1; i <= n; i += step, tried++) {
        remove_folder("run");
        judge(run("run", i, argc, argv, environment), undisturbed);
        if (*broken) {
            size_t length = strcspn(broken, "\n");
            printf("allocation %lu: %.*s\n", i, (int)length, broken);
            fflush(stdout); /* or the runs that follow say it, too */
            failures++;
        }
    }
    printf("%d of %lu broken; %lu allocations, exit status %d undisturbed\n", failures, tried, n,
           WIFEXITED(undisturbed) ? WEXITSTATUS(undisturbed) : -WTERMSIG(undisturbed));
    return failures > 0;
}

int __libc_start_main(Main *main, int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end);
typedef int StartMain(Main *main, int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end);
extern void *dlsym(void *handle, const char *name);

int __libc_start_main(Main *main, int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end)
{
    StartMain *start;
    void *found = dlsym((void *)-1L, "__libc_start_main"); /* RTLD_NEXT */
    memcpy(&start, &found, sizeof start);
    program = main;
    return start(loop, argc, argv, init, fini, rtld_fini, stack_end);
}
