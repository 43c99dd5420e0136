/* Draws scenes with a renderer that is given as a shell command. Runs up to DRAWING_JOBS commands
 * at the same time and polls them. A drawing without a picture is not an error: it is recorded with
 * a reason, and the caller decides what it means. */
#include "oracle/drawing.h"

#include "oracle/shell.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

void drawing_command(const char *command, const DrawingMarks *marks, Text *out)
{
    char width[16], height[16];
    snprintf(width, sizeof width, "%d", marks->width);
    snprintf(height, sizeof height, "%d", marks->height);
    const ShellMark all[] = {{"{scene}", marks->scene, false},
                             {"{picture}", marks->picture, false},
                             {"{camera}", marks->camera, true},
                             {"{width}", width, true},
                             {"{height}", height, true}};
    shell_fill(command, all, sizeof all / sizeof *all, marks->needs_camera ? 3 : 2, out);
}

Status drawing_name(ShellDrawing *drawing, const char *folder, const char *name,
                    const char *scene_extension, const char *picture_extension, Err *err)
{
    TRY(mem_printf(&drawing->scene, err, "%s/%s.%s", folder, name, scene_extension));
    TRY(mem_printf(&drawing->picture, err, "%s/%s.%s", folder, name, picture_extension));
    return mem_printf(&drawing->log, err, "%s/%s.log", folder, name);
}

void drawing_release(ShellDrawing *drawing)
{
    free(drawing->scene);
    free(drawing->picture);
    free(drawing->log);
    free(drawing->command);
}

/* Copies the last line of a log that is not empty, of its last 4095 bytes. */
static void last_line(const char *path, char *line, size_t size)
{
    char buffer[4096] = "";
    FILE *file = fopen(path, "rb");
    if (file) {
        if (fseek(file, -(long)(sizeof buffer - 1), SEEK_END) != 0)
            rewind(file);
        buffer[fread(buffer, 1, sizeof buffer - 1, file)] = '\0';
        fclose(file);
    }
    size_t end = strlen(buffer);
    while (end > 0 && strchr("\n\r ", buffer[end - 1]))
        buffer[--end] = '\0';
    const char *start = strrchr(buffer, '\n');
    snprintf(line, size, "%.300s", start ? start + 1 : buffer);
}

/* ---- running --------------------------------------------------------------------------------- */

/* A running command. */
typedef struct DrawingJob {
    pid_t child; /* 0: none */
    double start_s;
    ShellDrawing *drawing;
} DrawingJob;

/* Removes an old picture, so that it cannot be mistaken for the new one, and starts the command. */
static Status start_job(DrawingJob *job, ShellDrawing *drawing, Err *err)
{
    pid_t child;
    remove(drawing->picture);
    const int log = open(drawing->log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    Status status = shell_start(drawing->command, log, &child, err);
    if (log >= 0)
        close(log);
    TRY(status);
    *job = (DrawingJob){child, clock_seconds(), drawing};
    return STATUS_OK;
}

/* Records whether the command has drawn a picture. `timeout_s` is 0 if the command ended in time.
 */
static void take_end(ShellDrawing *drawing, int exit_status, double timeout_s)
{
    char line[320], *reason = drawing->reason;
    const size_t size = sizeof drawing->reason;
    last_line(drawing->log, line, sizeof line);
    if (timeout_s > 0)
        snprintf(reason, size, "it did not end within %g s", timeout_s);
    else if (exit_status != 0)
        snprintf(reason, size, "exit status %d%s%s", exit_status, *line ? ": " : "", line);
    else if (file_bytes(drawing->picture) > 0)
        drawing->is_drawn = true;
    else
        snprintf(reason, size, "it wrote no picture");
}

/* Ends a job whose command has exited or exceeds the timeout. Returns false if the command still
 * runs. */
static bool end_job(DrawingJob *job, double timeout_s)
{
    int ended = 0;
    const bool too_old = clock_seconds() - job->start_s > timeout_s;
    if (too_old)
        kill(-job->child, SIGKILL);
    const pid_t done = waitpid(job->child, &ended, too_old ? 0 : WNOHANG);
    if (done == 0 || (done < 0 && errno == EINTR))
        return false;
    kill(-job->child, SIGKILL); /* processes that the command started and left running */
    file_spare_on_signal(job->child);
    take_end(job->drawing, shell_exit_status(ended), too_old ? timeout_s : 0);
    job->child = 0;
    return true;
}

Status drawings_run(const ShellRenderer *renderer, ShellDrawing *drawings, size_t n, Err *err)
{
    /* Time between two polls: 0.5 ms, short against any drawing, and a small load on a processor.
     */
    static const struct timespec pause = {0, 500000};
    DrawingJob running[DRAWING_JOBS] = {{0}};
    Status status = STATUS_OK;
    size_t next = 0, ended = 0;
    while (ended < (status == STATUS_OK ? n : next)) {
        bool idle = true;
        for (int i = 0; i < renderer->jobs; i++) {
            if (!running[i].child && next < n && status == STATUS_OK) {
                status = start_job(&running[i], &drawings[next], err);
                next += status == STATUS_OK;
                idle = false;
            } else if (running[i].child && end_job(&running[i], renderer->timeout_s)) {
                ended++;
                idle = false;
            }
        }
        if (idle)
            nanosleep(&pause, NULL);
    }
    return status;
}

/* ---- pictures -------------------------------------------------------------------------------- */

Status drawing_refuse(ShellDrawing *drawing, Status status, const Err *why, Err *err)
{
    if (status == STATUS_MEMORY)
        return err_set(err, status, "%s", why->text);
    drawing->is_drawn = false;
    snprintf(drawing->reason, sizeof drawing->reason, "%.390s", why->text);
    return STATUS_OK;
}

Status drawing_read(ShellDrawing *drawing, Image *image, Err *err)
{
    static const float black[3] = {0, 0, 0};
    Err why = {""};
    *image = (Image){0};
    if (!drawing->is_drawn)
        return STATUS_OK;
    Status status = image_read(image, drawing->picture, ALPHA_KEPT, NULL, &why);
    if (status == STATUS_OK)
        status = image_composite(image, black, &why);
    if (status == STATUS_OK)
        return STATUS_OK;
    image_release(image);
    *image = (Image){0};
    return drawing_refuse(drawing, status, &why, err);
}
