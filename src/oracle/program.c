/* Runs a renderer as a program of its own: starts it, watches it and ends it.
 *
 * Output: a pipe receives the program's output. Only the beginning and the end of the output are
 * stored.
 *
 * Names: some programs do not accept every path on their command line. POV-Ray rejects line feeds
 * and letters beyond ASCII, Tachyon rejects long paths. Therefore all files have fixed names in a
 * private folder beside the picture: links to the scene and its header, the picture, and POV-Ray's
 * restart file. The program reaches this folder through an open file descriptor. It runs in the
 * scene's folder, where it finds the files that the scene includes. The picture gets its final name
 * when it is complete.
 *
 * Ending: POV-Ray exits some time after its picture is complete, so it is killed then. A script
 * that replaces POV-Ray may do further work, so this module waits until a script exits.
 *
 * The program and all processes that it starts are one process group. If a signal ends this
 * process, the group is killed before the files are removed. The group is also killed if it prints
 * nothing, or reports no progress, for too long. If this process is killed, the kernel kills the
 * program itself, but not the processes that the program has started. */
#include "oracle/program.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* STATUS_NOT_STARTED: exit status of a child that could not become the program. PRIVATE_HANDLE:
 * file descriptor of the private folder in the program; PROGRAM_FOLDER names it. */
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

/* ---- the private folder ---------------------------------------------------------------------- */

/* The private folder and the paths in it. All strings are owned. The files are removed by
 * file_discard_temporary, or when a signal ends this process. */
typedef struct Workplace {
    char *folder, *scene, *header, *picture, *state;
    int handle; /* the open folder, or -1 */
} Workplace;

/* Sets *out (owned) to the path of a file in the folder, which a signal removes. */
static Status add_name(Workplace *place, const char *name, char **out, Err *err)
{
    char *path = NULL;
    Status status;
    TRY_GOTO(file_join(place->folder, name, &path, err));
    TRY_GOTO(file_remove_on_signal(path, err));
    *out = path;
    path = NULL;
done:
    free(path);
    return status;
}

/* Creates the folder. All paths are absolute; `picture` is the final path of the picture, and
 * `header` may be NULL. */
static Status open_workplace(Workplace *place, const char *scene, const char *header,
                             const char *picture, Err *err)
{
    TRY(file_temporary_folder(picture, &place->folder, err));
    if (header)
        TRY(add_name(place, PROGRAM_HEADER, &place->header, err));
    TRY(add_name(place, PROGRAM_SCENE, &place->scene, err));
    TRY(add_name(place, PRIVATE_PICTURE, &place->picture, err));
    TRY(add_name(place, PRIVATE_STATE, &place->state, err));
    place->handle = open(place->folder, O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (place->handle < 0 || symlink(scene, place->scene) != 0 ||
        (header && symlink(header, place->header) != 0))
        return err_set(err, STATUS_IO, "%s: cannot be written: %s", picture, strerror(errno));
    return STATUS_OK;
}

static void close_workplace(Workplace *place)
{
    if (place->handle >= 0)
        close(place->handle);
    file_discard_temporary(place->scene);
    file_discard_temporary(place->header);
    file_discard_temporary(place->picture);
    file_discard_temporary(place->state);
    file_discard_temporary(place->folder);
}

/* ---- the process ----------------------------------------------------------------------------- */

/* Replaces this process, a child, by the program. `log` receives its output. */
static void become_program(char *const *arguments, const char *folder, int private_folder, int log)
{
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    setpgid(0, 0);
    system_die_with_parent();
    signal(SIGPIPE, SIG_DFL);
    dup2(log, STDERR_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(nothing, STDIN_FILENO);
    dup2(private_folder, PRIVATE_HANDLE);
    fcntl(PRIVATE_HANDLE, F_SETFD, 0); /* needed if both numbers are equal */
    if (chdir(folder) == 0)
        execvp(arguments[0], arguments);
    _exit(STATUS_NOT_STARTED);
}

/* Numbers of bytes of output that are stored, from the beginning and from the end. The banner with
 * the version is at the beginning, and the reason of a failure is at the end. Both are a few kB;
 * the values bound the memory and leave space for warnings around them. */
enum { LOG_BEGIN = 1 << 16, LOG_END = 1 << 20 };
/* A program that prints more bytes than this is ended. A drawing prints far below 1 MB, so a
 * program that reaches 1 GB prints without end. */
static const double max_output_bytes = 1e9;

typedef struct Log {
    Text text;         /* lines end in line feeds */
    double bytes;      /* number of bytes read so far */
    double heard_s;    /* time of the last output */
    double progress_s; /* time at which `progress` changed, or the program began */
    bool cancelled;    /* the progress callback asked to stop */
    char progress[80]; /* the last line with a percentage, up to the percentage */
} Log;

/* Appends output. Cuts out the middle of a long log, rarely, so that the cost stays linear. */
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

/* Restarts the clock of progress if the line that ends in the percentage at `at` differs from the
 * line before. The line also contains the number of pixels, which changes more often than the
 * percentage. */
static void note_progress(Log *log, const char *at)
{
    const char *start = at, *printed = text_chars(&log->text);
    while (start > printed && start[-1] != '\n' && at - start < (ptrdiff_t)sizeof log->progress - 1)
        start--;
    size_t length = (size_t)(at - start);
    if (strncmp(log->progress, start, length) != 0 || log->progress[length])
        log->progress_s = clock_seconds();
    memcpy(log->progress, start, length);
    log->progress[length] = '\0';
}

/* Reports the last "(30%)" in the newest `size` bytes. It may begin up to LONGEST bytes before
 * them. */
static void report_progress(const Program *program, Log *log, size_t size)
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
    if (program->progress && !program->progress(percent / 100.0, program->progress_context))
        log->cancelled = true;
}

/* Waits up to `wait_ms` for output and reads it once. Returns false at the end of the output. */
static bool read_output(const Program *program, int handle, int wait_ms, Log *log)
{
    char block[1 << 14];
    struct pollfd event = {.fd = handle, .events = POLLIN};
    if (poll(&event, 1, wait_ms) <= 0)
        return true;
    ssize_t count = read(handle, block, sizeof block);
    if (count < 0)
        return errno == EINTR;
    add_to_log(log, block, (size_t)count);
    report_progress(program, log, (size_t)count);
    log->heard_s = clock_seconds();
    return count > 0;
}

/* Kills the program's process group, waits for the program, and returns `status`. */
static Status end_program(pid_t child, Status status)
{
    kill(-child, SIGKILL);
    while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
        ;
    return status;
}

/* Returns true if the process is the program itself, not a script, and its picture is complete. */
static bool is_done(const Program *program, pid_t child, const Text *printed, const char *picture)
{
    char path[PATH_MAX];
    if (!program->is_done || !program->is_done(program->context, printed, picture))
        return false;
    return system_program_of(child, path, sizeof path) &&
           strcmp(file_name(path), program->executable) == 0;
}

/* Returns an error for a program that has printed too much, has printed nothing for too long, or
 * has made no progress for even longer. The last rule is needed because a program that hangs may
 * continue to print. */
static Status check_life(const Program *program, const Log *log, Err *err)
{
    enum { PATIENCE_WITHOUT_PROGRESS = 5 }; /* POV-Ray reports no progress while it parses */
    double now_s = clock_seconds(), patience_s = program->choice.patience_s;
    const char *patience =
        program->choice.patience_name ? program->choice.patience_name : "patience";
    if (log->cancelled)
        return err_cancelled(err);
    if (log->bytes > max_output_bytes)
        return err_set(err, STATUS_TOOL, "%s was ended: it printed more than %.0f MB about %s",
                       program->name, max_output_bytes * 1e-6, program->scene);
    if (patience_s > 0 && now_s - log->heard_s > patience_s)
        return err_set(err, STATUS_TOOL,
                       "%s was ended: it printed nothing for %g s about %s; set the environment "
                       "variable %s to another number of seconds, or to 0 for no limit",
                       program->name, patience_s, program->scene, patience);
    if (patience_s > 0 && now_s - log->progress_s > PATIENCE_WITHOUT_PROGRESS * patience_s)
        return err_set(err, STATUS_TOOL,
                       "%s was ended: it printed text, but reported no progress for %g s on %s; "
                       "set the environment variable %s to another number of seconds, of which %d "
                       "times as many are the limit, or to 0 for no limit",
                       program->name, PATIENCE_WITHOUT_PROGRESS * patience_s, program->scene,
                       patience, PATIENCE_WITHOUT_PROGRESS);
    return STATUS_OK;
}

/* One run of the program. */
typedef struct ProgramProcess {
    const Program *program;
    char *const *arguments; /* ends with NULL */
    const char *folder;     /* the working folder */
    const Workplace *place;
    Log log;
    pid_t child;
    int ended; /* the status of waitpid; 0 if the program was killed after its picture was complete
                */
} ProgramProcess;

/* Waits until the program itself has ended, then reads the rest of its output. The end of the pipe
 * does not mark the end of the program: a process that the program has started may keep the pipe
 * open longer, and the program may close the pipe earlier.
 *
 * WAIT_MS bounds the delay until limits are checked; output ends the wait earlier. SHORT_WAIT_MS is
 * the delay after the program has closed the pipe. LAST_READS bounds how much output is read after
 * the end of the program, because a process that it left behind may print on. */
static Status watch_program(ProgramProcess *process, int handle, Err *err)
{
    enum { WAIT_MS = 100, SHORT_WAIT_MS = 2, LAST_READS = 8 };
    const Program *program = process->program;
    Log *log = &process->log;
    bool open = true;
    log->heard_s = log->progress_s = clock_seconds();
    while (waitpid(process->child, &process->ended, WNOHANG) == 0) {
        if (open)
            open = read_output(program, handle, WAIT_MS, log);
        else
            poll(NULL, 0, SHORT_WAIT_MS);
        if (is_done(program, process->child, &log->text, process->place->picture)) {
            process->ended = 0;
            return end_program(process->child, text_check(&log->text, err));
        }
        Status status = check_life(program, log, err);
        if (status != STATUS_OK)
            return end_program(process->child, status);
    }
    for (int i = 0; open && i < LAST_READS; i++)
        open = read_output(program, handle, 0, log);
    return text_check(&log->text, err);
}

static Status not_started(const Program *program, Err *err)
{
    return err_set(err, STATUS_TOOL, "%s cannot be started: %s", program->name, strerror(errno));
}

/* Starts the program and waits for it. */
static Status run_program(ProgramProcess *process, Err *err)
{
    int pipe_ends[2];
    if (!system_pipe(pipe_ends))
        return not_started(process->program, err);
    const pid_t child = process->child = fork();
    if (child == 0)
        become_program(process->arguments, process->folder, process->place->handle, pipe_ends[1]);
    if (child > 0) {
        setpgid(child, child); /* in both processes, because either may run first */
        file_kill_on_signal(child);
    }
    close(pipe_ends[1]);
    Status status =
        child < 0 ? not_started(process->program, err) : watch_program(process, pipe_ends[0], err);
    if (child > 0)
        file_spare_on_signal(child);
    close(pipe_ends[0]);
    return status;
}

/* Sets *output (owned) to the final path of the picture, with links followed. Refuses a device or a
 * pipe, because a file cannot replace it. */
static Status find_output(const Program *program, char **output, Err *err)
{
    struct stat about;
    TRY(outfile_check(program->output, err));
    if (stat(program->output, &about) == 0 && !S_ISREG(about.st_mode))
        return err_set(err, STATUS_IO, "%s: cannot be written: it is not a regular file",
                       program->output);
    return file_resolve(program->output, output, err);
}

/* Sets *absolute (owned) to the absolute path of a regular file. */
static Status find_input(const char *path, char **absolute, Err *err)
{
    TRY(file_check_regular(path, err));
    *absolute = realpath(path, NULL);
    if (*absolute)
        return STATUS_OK;
    return err_set(err, errno == ENOMEM ? STATUS_MEMORY : STATUS_INPUT, "%s: cannot be read: %s",
                   path, strerror(errno));
}

Status program_draw(const Program *program, Text *printed, double *seconds, Err *err)
{
    Arguments arguments = {0};
    Workplace place = {.handle = -1};
    ProgramProcess process = {
        .program = program, .arguments = arguments.list, .place = &place, .log.text = TEXT_INIT};
    const Text *log = &process.log.text;
    static const ProgramPaths paths = {PROGRAM_FOLDER PROGRAM_SCENE, PROGRAM_FOLDER PROGRAM_HEADER,
                                       PROGRAM_FOLDER PRIVATE_PICTURE};
    char *scene = NULL, *header = NULL, *folder = NULL, *output = NULL;
    const double start_s = clock_seconds();
    Status status;
    TRY_GOTO(find_input(program->scene, &scene, err));
    if (program->header)
        TRY_GOTO(find_input(program->header, &header, err));
    TRY_GOTO(file_beside(scene, "", &folder, err));
    TRY_GOTO(find_output(program, &output, err));
    TRY_GOTO(open_workplace(&place, scene, header, output, err));
    TRY_GOTO(program->add_arguments(program->context, &paths, &arguments, err));
    process.folder = folder;
    TRY_GOTO(run_program(&process, err));
    const int exit_status = WIFEXITED(process.ended) ? WEXITSTATUS(process.ended) : -1;
    if (exit_status == STATUS_NOT_STARTED)
        TRY_GOTO(err_set(err, STATUS_TOOL,
                         "%s is needed and '%s' cannot be started; on Debian: apt install %s",
                         program->name, arguments.list[0], program->package));
    TRY_GOTO(program->judge(program->context, log, exit_status, place.picture, err));
    text_add(printed, log);
    TRY_GOTO(text_check(printed, err));
    status = file_rename(place.picture, output, err);
    place.picture = NULL;
    *seconds = clock_seconds() - start_s;
done:
    close_workplace(&place);
    arguments_release(&arguments);
    text_release(&process.log.text);
    free(output);
    free(folder);
    free(header);
    free(scene);
    return status;
}
