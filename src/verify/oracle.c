/* POV-Ray writes all it has to say to standard error: progress as "Rendered 120 of 400 pixels (30%)"
 * ended by carriage returns, a banner with its version, and the reason of a failure somewhere between
 * statistics. All of it is read through a pipe; the picture and POV-Ray's restart file go to temporary
 * names. The child dies with this process, so that an interrupted verification leaves no renderer
 * behind. */
#include "verify/oracle.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_ARGUMENTS = 24, ARGUMENT_SIZE = 64, STATUS_NOT_STARTED = 127 };

typedef struct Arguments {
    char *list[MAX_ARGUMENTS + 1];
    int n;
} Arguments;

static void release_arguments(Arguments *arguments)
{
    for (int i = 0; i < arguments->n; i++)
        free(arguments->list[i]);
}

static Status add_argument(Arguments *arguments, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);
static Status add_argument(Arguments *arguments, Err *err, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    char *text = NULL;
    int length = vasprintf(&text, format, values);
    va_end(values);
    if (length < 0)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for POV-Ray's arguments");
    arguments->list[arguments->n++] = text;
    return STATUS_OK;
}

/* A switch with a path; POV-Ray wants quotes around one with blanks, of the kind it does not hold. */
static Status add_path(Arguments *arguments, const char *name, const char *path, Err *err)
{
    if (!strpbrk(path, " \t\"'"))
        return add_argument(arguments, err, "%s%s", name, path);
    char quote = strchr(path, '"') ? '\'' : '"';
    if (strchr(path, quote))
        return err_set(err, STATUS_INPUT,
                       "%s: POV-Ray cannot be given a path with both kinds of quotes", path);
    return add_argument(arguments, err, "%s%c%s%c", name, quote, path, quote);
}

/* Every switch that a user's povray.ini could have set otherwise is given. */
static Status make_arguments(const OracleParams *params, const char *scene, const char *output,
                             Arguments *arguments, Err *err)
{
    bool color = params->plane == ORACLE_COLOR,
         deep = color ? params->bits == 16
                      : params->plane == ORACLE_DEPTH || params->plane == ORACLE_NORMAL;
    TRY(add_argument(arguments, err, "%s", params->program ? params->program : "povray"));
    TRY(add_path(arguments, "+I", scene, err));
    TRY(add_path(arguments, "+O", output, err));
    TRY(add_argument(arguments, err, "+W%d", params->width));
    TRY(add_argument(arguments, err, "+H%d", params->height));
    TRY(add_argument(arguments, err, "+FN%d", deep ? 16 : 8));
    TRY(add_argument(arguments, err, "File_Gamma=%s", color && !deep ? "srgb" : "1.0"));
    TRY(add_argument(arguments, err, "Declare=Corcast_Plane=%d", (int)params->plane));
    if (color && params->antialias > 1) {
        TRY(add_argument(arguments, err, "+A0.0"));
        TRY(add_argument(arguments, err, "+AM1"));
        TRY(add_argument(arguments, err, "+R%d", params->antialias));
        TRY(add_argument(arguments, err, "-J"));
    } else {
        TRY(add_argument(arguments, err, "-A"));
    }
    if (params->threads > 0)
        TRY(add_argument(arguments, err, "+WT%d", params->threads));
    TRY(add_argument(arguments, err, "+Q9"));
    TRY(add_argument(arguments, err, "-UA"));
    TRY(add_argument(arguments, err, "-TH"));
    TRY(add_argument(arguments, err, "-C"));
    TRY(add_argument(arguments, err, "-D"));
    TRY(add_argument(arguments, err, "+GW"));
    TRY(add_argument(arguments, err, "+V"));
    return STATUS_OK;
}

Status oracle_command(const OracleParams *params, char **out, Err *err)
{
    Arguments arguments = {0};
    Text line = TEXT_INIT;
    Status status = make_arguments(params, file_name(params->scene), file_name(params->output),
                                   &arguments, err);
    for (int i = 0; i < arguments.n; i++)
        text_printf(&line, "%s%s", i ? " " : "", arguments.list[i]);
    release_arguments(&arguments);
    if (status == STATUS_OK)
        status = text_check(&line, err);
    if (status == STATUS_OK)
        *out = line.chars;
    else
        text_release(&line);
    return status;
}

/* The folder of `path`, so that POV-Ray finds what the scene includes; in *out (owned). */
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

static void become_povray(char *const *arguments, const char *folder, int log)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    signal(SIGPIPE, SIG_DFL);
    dup2(log, STDERR_FILENO);
    dup2(log, STDOUT_FILENO);
    if (chdir(folder) == 0)
        execvp(arguments[0], arguments);
    dprintf(log, "cannot be started: %s\n", strerror(errno));
    _exit(STATUS_NOT_STARTED);
}

static void report_progress(const OracleParams *params, const Text *log)
{
    if (!params->progress)
        return;
    /* The last "(30%)". */
    for (size_t i = log->length; i > 0; i--)
        if (log->chars[i - 1] == '(') {
            int percent;
            if (sscanf(log->chars + i, "%d%%)", &percent) == 1)
                params->progress(percent / 100.0, params->progress_context);
            return;
        }
}

static Status read_log(const OracleParams *params, int handle, Text *log, Err *err)
{
    char block[4096];
    ssize_t count;
    while ((count = read(handle, block, sizeof block)) > 0 || (count < 0 && errno == EINTR))
        if (count > 0) {
            text_append(log, block, (size_t)count);
            report_progress(params, log);
        }
    for (size_t i = 0; i < log->length; i++)
        if (log->chars[i] == '\r' || log->chars[i] == '\0')
            log->chars[i] = '\n';
    text_puts(log, "");
    return text_check(log, err);
}

/* What POV-Ray said of a failure: from its first line with "Error", "rror:" or "Fatal" on, as one
 * sentence. */
static void reason_of_failure(const Text *log, char *reason, size_t size)
{
    const char *start = strstr(log->chars, "Error");
    if (!start)
        start = strstr(log->chars, "rror:");
    if (!start)
        start = strstr(log->chars, "Fatal error");
    if (!start)
        start = strstr(log->chars, "cannot");
    while (start && start > log->chars && start[-1] != '\n')
        start--;
    size_t length = 0;
    for (; start && *start && length + 1 < size; start++) {
        if (*start == '\n') {
            if (strncmp(start + 1, "Fatal error", 11) == 0 ||
                strncmp(start + 1, "Render failed", 13) == 0 || start[1] == '\0')
                break;
            if (length > 0 && reason[length - 1] != ' ')
                reason[length++] = ' ';
        } else {
            reason[length++] = *start;
        }
    }
    reason[length] = '\0';
}

static void read_version(const Text *log, char *version, size_t size)
{
    static const char mark[] = "Ray Tracer Version ";
    const char *start = strstr(log->chars, mark);
    snprintf(version, size, "unknown");
    if (start) {
        start += sizeof mark - 1;
        snprintf(version, size, "%.*s", (int)strcspn(start, " \n"), start);
    }
}

/* Starts POV-Ray and waits for it; *log holds what it said. */
static Status run_program(const OracleParams *params, char *const *arguments, const char *folder,
                          Text *log, int *exit_status, Err *err)
{
    int pipe_ends[2];
    if (pipe2(pipe_ends, O_CLOEXEC) != 0)
        return err_set(err, STATUS_TOOL, "POV-Ray cannot be started: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0)
        become_povray(arguments, folder, pipe_ends[1]);
    close(pipe_ends[1]);
    Status status = STATUS_OK;
    if (child < 0)
        status = err_set(err, STATUS_TOOL, "POV-Ray cannot be started: %s", strerror(errno));
    else
        status = read_log(params, pipe_ends[0], log, err);
    close(pipe_ends[0]);
    int ended = 0;
    while (child > 0 && waitpid(child, &ended, 0) < 0 && errno == EINTR)
        ;
    *exit_status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    return status;
}

static Status judge(const OracleParams *params, const Text *log, int exit_status,
                    const char *output, Err *err)
{
    const char *program = params->program ? params->program : "povray";
    char reason[700];
    if (exit_status == STATUS_NOT_STARTED)
        return err_set(
            err, STATUS_TOOL,
            "POV-Ray is needed and '%s' cannot be started; on Debian: apt install povray", program);
    struct stat about;
    if (exit_status == 0 && stat(output, &about) == 0 && about.st_size > 0)
        return STATUS_OK;
    if (exit_status == 0)
        return err_set(err, STATUS_TOOL, "POV-Ray ended without a picture of %s", params->scene);
    reason_of_failure(log, reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "POV-Ray failed on %s (exit status %d): %s", params->scene,
                   exit_status, reason[0] ? reason : "it gave no reason");
}

Status oracle_run(const OracleParams *params, OracleRun *run, Err *err)
{
    Arguments arguments = {0};
    Text log = TEXT_INIT;
    char *scene = NULL, *folder = NULL, *temporary = NULL, *absolute = NULL, *state = NULL;
    double start_s = clock_seconds();
    int exit_status = 0;
    Status status = STATUS_OK;
    scene = realpath(params->scene, NULL);
    if (!scene)
        return err_set(err, STATUS_INPUT, "%s: cannot be read: %s", params->scene, strerror(errno));
    TRY_GOTO(file_temporary(params->output, &temporary, err));
    absolute = realpath(temporary, NULL);
    if (!absolute) {
        status =
            err_set(err, STATUS_IO, "%s: cannot be written: %s", params->output, strerror(errno));
        goto done;
    }
    TRY_GOTO(folder_of(scene, &folder, err));
    TRY_GOTO(file_with_suffix(absolute, ".pov-state", &state, err));
    TRY_GOTO(file_remove_on_signal(state, err));
    TRY_GOTO(make_arguments(params, scene, absolute, &arguments, err));
    TRY_GOTO(run_program(params, arguments.list, folder, &log, &exit_status, err));
    TRY_GOTO(judge(params, &log, exit_status, absolute, err));
    status = file_rename(temporary, params->output, err);
    temporary = NULL;
    if (status == STATUS_OK && run) {
        run->seconds = clock_seconds() - start_s;
        read_version(&log, run->version, sizeof run->version);
    }
done:
    file_forget(temporary);
    file_forget(state);
    release_arguments(&arguments);
    text_release(&log);
    free(absolute);
    free(folder);
    free(scene);
    return status;
}

/* ---- planes ------------------------------------------------------------------------------------ */

static Status read_deep(Picture *picture, const char *path, Err *err)
{
    TRY(picture_read(picture, path, err));
    if (picture->channels == 3 && picture->bits == 16)
        return STATUS_OK;
    picture_release(picture);
    return err_set(err, STATUS_INPUT, "%s: is not a plane of POV-Ray's: it has not 3 x 16 bits",
                   path);
}

Status oracle_read_depth(Plane *depth, const char *path, double near_mm, double far_mm, Err *err)
{
    Picture picture;
    TRY(read_deep(&picture, path, err));
    Status status = plane_init(depth, picture.width, picture.height, 1, err);
    size_t pixels = (size_t)picture.width * (size_t)picture.height;
    for (size_t i = 0; status == STATUS_OK && i < pixels; i++) {
        const uint16_t *code = &picture.codes16[3 * i];
        double fraction = (code[0] + code[1] / 65535.0) / 65535.0;
        depth->values[i] =
            code[2] > 32767 ? (float)(near_mm + fraction * (far_mm - near_mm)) : HUGE_VALF;
    }
    picture_release(&picture);
    return status;
}

Status oracle_read_normal(Plane *normal, const char *path, Err *err)
{
    Picture picture;
    TRY(read_deep(&picture, path, err));
    Status status = plane_init(normal, picture.width, picture.height, 3, err);
    size_t pixels = (size_t)picture.width * (size_t)picture.height;
    for (size_t i = 0; status == STATUS_OK && i < pixels; i++) {
        const uint16_t *code = &picture.codes16[3 * i];
        if (code[0] == 0 && code[1] == 0 && code[2] == 0)
            continue; /* nothing seen: no unit vector is (-1, -1, -1) */
        double xyz[3], square = 0;
        for (int c = 0; c < 3; c++) {
            xyz[c] = 2 * code[c] / 65535.0 - 1;
            square += xyz[c] * xyz[c];
        }
        for (int c = 0; c < 3; c++)
            normal->values[3 * i + (size_t)c] = (float)(xyz[c] / sqrt(square));
    }
    picture_release(&picture);
    return status;
}

Status oracle_read_ids(IdPlane *ids, const char *path, Err *err)
{
    Picture picture;
    TRY(picture_read(&picture, path, err));
    Status status = ids_take_picture(ids, &picture, err);
    picture_release(&picture);
    return status;
}
