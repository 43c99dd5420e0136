/* All that the program has to say is read through a pipe, of which the beginning and the end are
 * kept.
 *
 * Programs take only some paths on their command lines: POV-Ray no letter beyond ASCII and no line
 * end, Tachyon no long ones. So they are given fixed names in a private folder beside the picture,
 * which they reach through an open handle: a link to the scene, the picture, and POV-Ray's restart
 * file. They run in the scene's folder, where they find what the scene includes. The picture takes
 * its final name when it is whole.
 *
 * A program that takes its time to end is ended once its picture is whole, if it is the program
 * itself: a script that stands for it may have more to do.
 *
 * The program is a process group of its own, a script that stands for it included. It is killed
 * when a signal ends this process, before its files are removed, when it falls silent, and when it
 * reports no progress for long; if this process is killed, the program itself dies with it. */
#include "oracle/tool.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { STATUS_NOT_STARTED = 127, PRIVATE_HANDLE = 3 };
#define PRIVATE_PICTURE "picture.png"
#define PRIVATE_STATE "picture.pov-state"

void arguments_release(Arguments *arguments)
{
    for (int i = 0; i < arguments->n; i++)
        free(arguments->list[i]);
}

Status arguments_add(Arguments *arguments, Err *err, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    Status status =
        mem_vprintf(&arguments->list[arguments->n], "a program's arguments", err, format, values);
    va_end(values);
    arguments->n += status == STATUS_OK;
    return status;
}

/* The folder of `path`, where a program finds what the scene includes; in *out (owned). */
static Status folder_of(const char *path, char **out, Err *err)
{
    TRY(mem_strdup(out, path, err));
    size_t length = (size_t)(file_name(path) - path);
    if (length == 0)
        strcpy(*out, "."); /* `path` has at least one character */
    else
        (*out)[length] = '\0';
    return STATUS_OK;
}

/* ---- the private folder ---------------------------------------------------------------------- */

/* All names are owned and removed by file_forget or by a signal. */
typedef struct Workplace {
    char *folder, *scene, *picture, *state;
    int handle; /* of the folder, or -1 */
} Workplace;

static Status add_name(Workplace *place, const char *name, char **out, Err *err)
{
    char *path = NULL;
    TRY(file_join(place->folder, name, &path, err));
    Status status = file_remove_on_signal(path, err);
    if (status == STATUS_OK)
        *out = path;
    else
        free(path);
    return status;
}

/* `scene` is absolute, `picture` the final name. */
static Status open_workplace(Workplace *place, const char *scene, const char *picture, Err *err)
{
    TRY(file_temporary_folder(picture, &place->folder, err));
    TRY(add_name(place, TOOL_SCENE, &place->scene, err));
    TRY(add_name(place, PRIVATE_PICTURE, &place->picture, err));
    TRY(add_name(place, PRIVATE_STATE, &place->state, err));
    place->handle = open(place->folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (place->handle < 0 || symlink(scene, place->scene) != 0)
        return err_set(err, STATUS_IO, "%s: cannot be written: %s", picture, strerror(errno));
    return STATUS_OK;
}

static void close_workplace(Workplace *place)
{
    if (place->handle >= 0)
        close(place->handle);
    file_forget(place->scene);
    file_forget(place->picture);
    file_forget(place->state);
    file_forget(place->folder);
}

/* ---- the process ----------------------------------------------------------------------------- */

static void become_program(char *const *arguments, const char *folder, int private_folder, int log)
{
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    signal(SIGPIPE, SIG_DFL);
    dup2(log, STDERR_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(nothing, STDIN_FILENO);
    dup2(private_folder, PRIVATE_HANDLE);
    fcntl(PRIVATE_HANDLE, F_SETFD, 0); /* also where the numbers are the same */
    if (chdir(folder) == 0)
        execvp(arguments[0], arguments);
    _exit(STATUS_NOT_STARTED);
}

/* The beginning of what a program says and the end, so that no flood of warnings fills the memory.
 */
enum { LOG_BEGIN = 1 << 16, LOG_END = 1 << 20 };
static const double log_most = 1e9; /* bytes, after which it is ended */

typedef struct Log {
    Text text;         /* lines end in line feeds */
    double bytes;      /* number of bytes read so far */
    double heard_s;    /* time of the last output */
    double progress_s; /* time at which `progress` changed, or the program began */
    bool cancelled;    /* the progress callback asked to stop */
    char progress[80]; /* the last line with a percentage, up to the percentage */
} Log;

static void add_to_log(Log *log, char *block, size_t size)
{
    Text *text = &log->text;
    for (size_t i = 0; i < size; i++)
        if (block[i] == '\r' || block[i] == '\0')
            block[i] = '\n';
    text_append(text, block, size);
    log->bytes += (double)size;
    if (text->length >= LOG_BEGIN + 2 * LOG_END)
        text_cut(text, LOG_BEGIN, text->length - LOG_BEGIN - LOG_END);
}

/* Notes whether the line that ends in the percentage at `at` is another one than the last. It also
 * holds the number of pixels, which changes in pictures that take hours for a percent. */
static void note_progress(Log *log, const char *at)
{
    const char *start = at, *said = text_chars(&log->text);
    while (start > said && start[-1] != '\n' && at - start < (ptrdiff_t)sizeof log->progress - 1)
        start--;
    size_t length = (size_t)(at - start);
    if (strncmp(log->progress, start, length) != 0 || log->progress[length])
        log->progress_s = clock_seconds();
    memcpy(log->progress, start, length);
    log->progress[length] = '\0';
}

/* Reports the last "(30%)" among the `size` bytes that came last, or a little before them. */
static void report_progress(const Tool *tool, Log *log, size_t size)
{
    enum { LONGEST = 8 };
    const char *chars = text_chars(&log->text);
    size_t length = log->text.length, first = length > size + LONGEST ? length - size - LONGEST : 0;
    size_t at = chars ? length : first;
    while (at > first && chars[at - 1] != '(')
        at--;
    int percent;
    if (at == first || sscanf(chars + at, "%d%%)", &percent) != 1)
        return;
    note_progress(log, chars + at);
    if (tool->progress && !tool->progress(percent / 100.0, tool->progress_context))
        log->cancelled = true;
}

/* Reads once if there is something within `wait_ms`; false at the end of all. */
static bool hear(const Tool *tool, int handle, int wait_ms, Log *log)
{
    char block[1 << 14];
    struct pollfd event = {.fd = handle, .events = POLLIN};
    if (poll(&event, 1, wait_ms) <= 0)
        return true;
    ssize_t count = read(handle, block, sizeof block);
    if (count < 0)
        return errno == EINTR;
    add_to_log(log, block, (size_t)count);
    report_progress(tool, log, (size_t)count);
    log->heard_s = clock_seconds();
    return count > 0;
}

static Status end_program(pid_t child, Status status)
{
    kill(-child, SIGKILL);
    while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
        ;
    return status;
}

/* Whether the process is the program itself, and has only to end. */
static bool is_done(const Tool *tool, pid_t child, const Text *said, const char *picture)
{
    char link[40], path[4096];
    if (!tool->is_done || !tool->is_done(tool->context, said, picture))
        return false;
    snprintf(link, sizeof link, "/proc/%d/exe", (int)child);
    ssize_t length = readlink(link, path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    return strcmp(file_name(path), tool->process) == 0;
}

/* Returns an error for a program that has said too much, nothing for too long, or much that is no
 * progress for longer yet: a program that hangs may go on to talk. */
static Status check_life(const Tool *tool, const Log *log, Err *err)
{
    enum { PATIENCE_WITHOUT_PROGRESS = 5 }; /* POV-Ray reports no progress while it parses */
    double now_s = clock_seconds(), patience_s = tool->patience_s;
    if (log->cancelled)
        return err_cancelled(err);
    if (log->bytes > log_most)
        return err_set(err, STATUS_TOOL, "%s was ended: it has said more than %.0f MB about %s",
                       tool->name, log_most * 1e-6, tool->scene);
    if (patience_s > 0 && now_s - log->heard_s > patience_s)
        return err_set(err, STATUS_TOOL,
                       "%s was ended: it has said nothing for %g s about %s; "
                       "%s=SECONDS gives it longer, 0 for ever",
                       tool->name, patience_s, tool->scene, tool->patience);
    if (patience_s > 0 && now_s - log->progress_s > PATIENCE_WITHOUT_PROGRESS * patience_s)
        return err_set(err, STATUS_TOOL,
                       "%s was ended: it has reported no progress for %g s on %s, although it goes "
                       "on to write; %s=SECONDS gives it %d times as many seconds, 0 for ever",
                       tool->name, PATIENCE_WITHOUT_PROGRESS * patience_s, tool->scene,
                       tool->patience, PATIENCE_WITHOUT_PROGRESS);
    return STATUS_OK;
}

/* Waits for the program itself: what it has started may live on and keep the pipe open, and it may
 * close the pipe and live on. What is in the pipe when it ends is still read. */
static Status attend(const Tool *tool, pid_t child, int handle, const char *picture, Log *log,
                     int *ended, Err *err)
{
    enum { WAIT_MS = 100, SHORT_WAIT_MS = 2, LAST_READS = 8 };
    bool open = true;
    log->heard_s = log->progress_s = clock_seconds();
    while (waitpid(child, ended, WNOHANG) == 0) {
        if (open)
            open = hear(tool, handle, WAIT_MS, log);
        else
            poll(NULL, 0, SHORT_WAIT_MS);
        if (is_done(tool, child, &log->text, picture)) {
            *ended = 0;
            return end_program(child, text_check(&log->text, err));
        }
        Status status = check_life(tool, log, err);
        if (status != STATUS_OK)
            return end_program(child, status);
    }
    for (int i = 0; open && i < LAST_READS; i++)
        open = hear(tool, handle, 0, log);
    return text_check(&log->text, err);
}

/* Starts the program and waits for it; *log holds what it said. */
static Status run_program(const Tool *tool, char *const *arguments, const char *folder,
                          const Workplace *place, Log *log, int *exit_status, Err *err)
{
    int pipe_ends[2], ended = 0;
    if (pipe2(pipe_ends, O_CLOEXEC) != 0)
        return err_set(err, STATUS_TOOL, "%s cannot be started: %s", tool->name, strerror(errno));
    pid_t child = fork();
    if (child == 0)
        become_program(arguments, folder, place->handle, pipe_ends[1]);
    if (child > 0) {
        setpgid(child, child); /* here as in the child: whoever comes first */
        file_kill_on_signal(child);
    }
    close(pipe_ends[1]);
    Status status = child < 0 ? err_set(err, STATUS_TOOL, "%s cannot be started: %s", tool->name,
                                        strerror(errno))
                              : attend(tool, child, pipe_ends[0], place->picture, log, &ended, err);
    if (child > 0)
        file_spare_on_signal(child);
    close(pipe_ends[0]);
    *exit_status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    return status;
}

/* The final name of the picture, links followed; a device or pipe cannot take its place. */
static Status find_output(const Tool *tool, char **output, Err *err)
{
    struct stat about;
    TRY(outfile_check(tool->output, err));
    if (stat(tool->output, &about) == 0 && !S_ISREG(about.st_mode))
        return err_set(err, STATUS_IO, "%s: cannot be written: it is no file", tool->output);
    return file_resolve(tool->output, output, err);
}

Status tool_draw(const Tool *tool, Text *said, double *seconds, Err *err)
{
    Arguments arguments = {0};
    Log log = {.text = TEXT_INIT};
    Workplace place = {.handle = -1};
    char *scene = NULL, *folder = NULL, *output = NULL;
    double start_s = clock_seconds();
    int exit_status = 0;
    TRY(file_check_regular(tool->scene, err));
    scene = realpath(tool->scene, NULL);
    if (!scene)
        return err_set(err, errno == ENOMEM ? STATUS_MEMORY : STATUS_INPUT,
                       "%s: cannot be read: %s", tool->scene, strerror(errno));
    Status status = STATUS_OK;
    TRY_GOTO(folder_of(scene, &folder, err));
    TRY_GOTO(find_output(tool, &output, err));
    TRY_GOTO(open_workplace(&place, scene, output, err));
    TRY_GOTO(tool->add_arguments(tool->context, TOOL_FOLDER TOOL_SCENE, TOOL_FOLDER PRIVATE_PICTURE,
                                 &arguments, err));
    TRY_GOTO(run_program(tool, arguments.list, folder, &place, &log, &exit_status, err));
    if (exit_status == STATUS_NOT_STARTED)
        TRY_GOTO(err_set(err, STATUS_TOOL,
                         "%s is needed and '%s' cannot be started; on Debian: apt install %s",
                         tool->name, arguments.list[0], tool->package));
    TRY_GOTO(tool->judge(tool->context, &log.text, exit_status, place.picture, err));
    text_add(said, &log.text);
    TRY_GOTO(text_check(said, err));
    status = file_rename(place.picture, output, err);
    place.picture = NULL;
    *seconds = clock_seconds() - start_s;
done:
    close_workplace(&place);
    arguments_release(&arguments);
    text_release(&log.text);
    free(output);
    free(folder);
    free(scene);
    return status;
}
