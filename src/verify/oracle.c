/* POV-Ray writes all it has to say to standard error: progress as "Rendered 120 of 400 pixels
 * (30%)" ended by carriage returns, a banner with its version, and the reason of a failure
 * somewhere between statistics. All of it is read through a pipe, of which the beginning and the
 * end are kept.
 *
 * POV-Ray takes only some paths on its command line: no letter beyond ASCII, no line end. So it is
 * given fixed names in a private folder beside the picture, which it reaches through an open
 * handle: a link to the scene, the picture, and its restart file. It runs in the scene's folder,
 * where it finds what the scene includes. The picture takes its final name when it is whole.
 *
 * POV-Ray is a process group of its own, a script that stands for it included. It is killed when a
 * signal ends this process, before its files are removed, and when it falls silent; if this process
 * is killed, POV-Ray itself dies with it. */
#include "verify/oracle.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_ARGUMENTS = 24, STATUS_NOT_STARTED = 127, PRIVATE_HANDLE = 3 };
#define PRIVATE_FOLDER "/proc/self/fd/3/" /* PRIVATE_HANDLE */
#define PRIVATE_SCENE "scene.pov"
#define PRIVATE_PICTURE "picture.png"
#define PRIVATE_STATE "picture.pov-state"

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

static int bits_of(const OracleParams *params)
{
    if (params->plane == ORACLE_COLOR)
        return params->bits;
    return params->plane == ORACLE_ID ? 8 : 16;
}

/* Every switch that a user's povray.ini could have set otherwise is given. */
static Status make_arguments(const OracleParams *params, const char *scene, const char *output,
                             Arguments *arguments, Err *err)
{
    bool color = params->plane == ORACLE_COLOR, deep = bits_of(params) == 16;
    TRY(add_argument(arguments, err, "%s", params->program ? params->program : "povray"));
    TRY(add_argument(arguments, err, "+I%s", scene));
    TRY(add_argument(arguments, err, "+O%s", output));
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
    TRY(add_argument(arguments, err, color && params->alpha ? "+UA" : "-UA"));
    if (params->clock > 0) {
        char clock[NUMBER_TEXT_SIZE];
        TRY(add_argument(arguments, err, "+K%s", number_text(params->clock, clock)));
    }
    if (params->threads > 0)
        TRY(add_argument(arguments, err, "+WT%d", params->threads));
    static const char *const always[] = {"+Q9", "-TH", "-C", "-D", "+GW", "+V"};
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        TRY(add_argument(arguments, err, "%s", always[i]));
    return STATUS_OK;
}

Status oracle_command(const OracleParams *params, char **out, Err *err)
{
    Arguments arguments = {0};
    Text line = TEXT_INIT;
    Status status = make_arguments(params, file_name(params->scene), file_name(params->output),
                                   &arguments, err);
    for (int i = 0; i < arguments.n; i++) {
        text_puts(&line, i ? " " : "");
        text_put_shell_word(&line, arguments.list[i]);
    }
    release_arguments(&arguments);
    if (status == STATUS_OK)
        status = text_take(&line, out, err);
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
    TRY(add_name(place, PRIVATE_SCENE, &place->scene, err));
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

static void become_povray(char *const *arguments, const char *folder, int private_folder, int log)
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

/* The beginning of what POV-Ray says and the end, so that no flood of warnings fills the memory. */
enum { LOG_BEGIN = 1 << 16, LOG_END = 1 << 20 };
static const double log_most = 1e9; /* bytes, after which POV-Ray is ended */

typedef struct Log {
    Text text;    /* lines end in line feeds */
    double bytes; /* heard in all */
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

/* The last "(30%)" among the `size` bytes that came last, or a little before them. */
static void report_progress(const OracleParams *params, const Text *log, size_t size)
{
    enum { LONGEST = 8 };
    const char *chars = text_chars(log);
    if (!params->progress || !chars)
        return;
    size_t first = log->length > size + LONGEST ? log->length - size - LONGEST : 0;
    for (size_t i = log->length; i > first; i--)
        if (chars[i - 1] == '(') {
            int percent;
            if (sscanf(chars + i, "%d%%)", &percent) == 1)
                params->progress(percent / 100.0, params->progress_context);
            return;
        }
}

/* Reads once if there is something within `wait_ms`; false at the end of all. */
static bool hear(const OracleParams *params, int handle, int wait_ms, Log *log, double *heard_s)
{
    char block[1 << 14];
    struct pollfd event = {.fd = handle, .events = POLLIN};
    if (poll(&event, 1, wait_ms) <= 0)
        return true;
    ssize_t count = read(handle, block, sizeof block);
    if (count < 0)
        return errno == EINTR;
    add_to_log(log, block, (size_t)count);
    report_progress(params, &log->text, (size_t)count);
    *heard_s = clock_seconds();
    return count > 0;
}

static Status end_povray(pid_t child, Status status)
{
    kill(-child, SIGKILL);
    while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
        ;
    return status;
}

/* Waits for POV-Ray itself: what it has started may live on and keep the pipe open, and it may
 * close the pipe and live on. What is in the pipe when it ends is still read. */
static Status attend(const OracleParams *params, pid_t child, int handle, Log *log, int *ended,
                     Err *err)
{
    enum { WAIT_MS = 100, SHORT_WAIT_MS = 2, LAST_READS = 8 };
    double heard_s = clock_seconds();
    bool open = true;
    while (waitpid(child, ended, WNOHANG) == 0) {
        if (open)
            open = hear(params, handle, WAIT_MS, log, &heard_s);
        else
            poll(NULL, 0, SHORT_WAIT_MS);
        if (log->bytes > log_most)
            return end_povray(child, err_set(err, STATUS_TOOL,
                                             "POV-Ray was ended: it has said more than %.0f MB "
                                             "about %s",
                                             log_most * 1e-6, params->scene));
        if (params->patience_s > 0 && clock_seconds() - heard_s > params->patience_s)
            return end_povray(child,
                              err_set(err, STATUS_TOOL,
                                      "POV-Ray was ended: it has said nothing for %g s about %s; "
                                      "CORCAST_POVRAY_PATIENCE=SECONDS gives it longer, 0 for ever",
                                      params->patience_s, params->scene));
    }
    for (int i = 0; open && i < LAST_READS; i++)
        open = hear(params, handle, 0, log, &heard_s);
    return text_check(&log->text, err);
}

/* What POV-Ray said of a failure: from its first line with one of the marks on, as one
 * sentence, with `scene` in the place of the name that POV-Ray was given for it. */
static void reason_of_failure(const Text *log, const char *scene, char *reason, size_t size)
{
    static const char given[] = PRIVATE_FOLDER PRIVATE_SCENE;
    static const char *const marks[] = {"Error", "rror:", "Fatal error", "cannot"};
    const char *said = text_chars(log), *start = NULL;
    for (size_t i = 0; !start && i < sizeof marks / sizeof *marks; i++)
        start = strstr(said, marks[i]);
    while (start && start > said && start[-1] != '\n')
        start--;
    size_t length = 0;
    for (; start && *start && length + 1 < size; start++) {
        if (*start == '\n') {
            if (strncmp(start + 1, "Fatal error", 11) == 0 ||
                strncmp(start + 1, "Render failed", 13) == 0 || start[1] == '\0')
                break;
            if (length > 0 && reason[length - 1] != ' ')
                reason[length++] = ' ';
        } else if (strncmp(start, given, sizeof given - 1) == 0) {
            length += (size_t)snprintf(reason + length, size - length, "%s", scene);
            length = length < size ? length : size - 1;
            start += sizeof given - 2;
        } else {
            reason[length++] = *start;
        }
    }
    reason[length] = '\0';
}

static void read_version(const Text *log, char *version, size_t size)
{
    static const char mark[] = "Ray Tracer Version ";
    const char *start = strstr(text_chars(log), mark);
    snprintf(version, size, "unknown");
    if (start) {
        start += sizeof mark - 1;
        size_t length =
            strspn(start, "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-_+");
        snprintf(version, size, "%.*s", (int)length, start);
    }
}

/* Starts POV-Ray and waits for it; *log holds what it said. */
static Status run_program(const OracleParams *params, char *const *arguments, const char *folder,
                          int private_folder, Log *log, int *exit_status, Err *err)
{
    int pipe_ends[2], ended = 0;
    if (pipe2(pipe_ends, O_CLOEXEC) != 0)
        return err_set(err, STATUS_TOOL, "POV-Ray cannot be started: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0)
        become_povray(arguments, folder, private_folder, pipe_ends[1]);
    if (child > 0) {
        setpgid(child, child); /* here as in the child: whoever comes first */
        file_kill_on_signal(child);
    }
    close(pipe_ends[1]);
    Status status =
        child < 0 ? err_set(err, STATUS_TOOL, "POV-Ray cannot be started: %s", strerror(errno))
                  : attend(params, child, pipe_ends[0], log, &ended, err);
    file_kill_on_signal(0);
    close(pipe_ends[0]);
    *exit_status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    return status;
}

/* Whether a file is a PNG from signature to end mark, with colours of so many bits. */
static bool is_whole_picture(const char *path, const OracleParams *params)
{
    static const unsigned char begin[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    static const unsigned char end[] = "\0\0\0\0IEND\xae\x42\x60\x82";
    enum { BEGIN = sizeof begin - 1, HEADER = BEGIN + 10, END = sizeof end - 1, RGB = 2, RGBA = 6 };
    unsigned char header[HEADER] = {0}, tail[END] = {0};
    struct stat about;
    FILE *file = lstat(path, &about) == 0 && S_ISREG(about.st_mode) ? fopen(path, "rb") : NULL;
    if (!file)
        return false;
    bool read = fread(header, HEADER, 1, file) == 1 && fseeko(file, -END, SEEK_END) == 0 &&
                fread(tail, END, 1, file) == 1;
    fclose(file);
    const uint32_t sides[] = {(uint32_t)params->width, (uint32_t)params->height};
    for (int i = 0; i < 8; i++)
        read = read && header[BEGIN + i] == (sides[i / 4] >> (24 - 8 * (i % 4)) & 255);
    return read && memcmp(header, begin, BEGIN) == 0 && header[BEGIN + 8] == bits_of(params) &&
           header[BEGIN + 9] == (params->alpha ? RGBA : RGB) && memcmp(tail, end, END) == 0;
}

static Status judge(const OracleParams *params, const Text *log, int exit_status,
                    const char *picture, Err *err)
{
    const char *program = params->program ? params->program : "povray";
    char reason[700];
    if (exit_status == STATUS_NOT_STARTED)
        return err_set(
            err, STATUS_TOOL,
            "POV-Ray is needed and '%s' cannot be started; on Debian: apt install povray", program);
    if (exit_status == 0 && is_whole_picture(picture, params))
        return STATUS_OK;
    if (exit_status == 0)
        return err_set(err, STATUS_TOOL,
                       "POV-Ray ended without a picture of %s: no whole PNG of %d x %d pixels of "
                       "%d x %d bits",
                       params->scene, params->width, params->height, params->alpha ? 4 : 3,
                       bits_of(params));
    reason_of_failure(log, file_name(params->scene), reason, sizeof reason);
    return err_set(err, STATUS_TOOL, "POV-Ray failed on %s (exit status %d): %s", params->scene,
                   exit_status, reason[0] ? reason : "it gave no reason");
}

/* The final name of the picture, links followed; a device or pipe cannot take its place. */
static Status find_output(const OracleParams *params, char **output, Err *err)
{
    struct stat about;
    TRY(outfile_check(params->output, err));
    if (stat(params->output, &about) == 0 && !S_ISREG(about.st_mode))
        return err_set(err, STATUS_IO, "%s: cannot be written: it is no file", params->output);
    return file_resolve(params->output, output, err);
}

Status oracle_run(const OracleParams *params, OracleRun *run, Err *err)
{
    Arguments arguments = {0};
    Log log = {.text = TEXT_INIT};
    Workplace place = {.handle = -1};
    char *scene = NULL, *folder = NULL, *output = NULL;
    double start_s = clock_seconds();
    int exit_status = 0;
    TRY(file_check_regular(params->scene, err));
    scene = realpath(params->scene, NULL);
    if (!scene)
        return err_set(err, errno == ENOMEM ? STATUS_MEMORY : STATUS_INPUT,
                       "%s: cannot be read: %s", params->scene, strerror(errno));
    Status status = STATUS_OK;
    TRY_GOTO(folder_of(scene, &folder, err));
    TRY_GOTO(find_output(params, &output, err));
    TRY_GOTO(open_workplace(&place, scene, output, err));
    TRY_GOTO(make_arguments(params, PRIVATE_FOLDER PRIVATE_SCENE, PRIVATE_FOLDER PRIVATE_PICTURE,
                            &arguments, err));
    TRY_GOTO(run_program(params, arguments.list, folder, place.handle, &log, &exit_status, err));
    TRY_GOTO(judge(params, &log.text, exit_status, place.picture, err));
    status = file_rename(place.picture, output, err);
    place.picture = NULL;
    if (status == STATUS_OK && run) {
        run->seconds = clock_seconds() - start_s;
        read_version(&log.text, run->version, sizeof run->version);
    }
done:
    close_workplace(&place);
    release_arguments(&arguments);
    text_release(&log.text);
    free(output);
    free(folder);
    free(scene);
    return status;
}

/* ---- planes ---------------------------------------------------------------------------------- */

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
