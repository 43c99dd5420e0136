/* Lets a user's renderer draw scene files: one shell command for each scene, several at a time.
 *
 * For each scene, call drawing_name, write the scene file, and set ShellDrawing.command by
 * drawing_command. Then call drawings_run once, and drawing_read for each drawing. */
#ifndef CORCAST_ORACLE_DRAWING_H
#define CORCAST_ORACLE_DRAWING_H

#include "image/image.h"

/* The user's renderer. Strings are borrowed. */
typedef struct ShellRenderer {
    const char *command; /* shell command with the placeholders of drawing_command */
    double timeout_s;    /* a command that runs longer is killed */
    int jobs;            /* maximum number of commands at the same time, from 1 to DRAWING_JOBS */
} ShellRenderer;

/* Maximum of ShellRenderer.jobs. Reason of the number not recorded. */
enum { DRAWING_JOBS = 32 };

/* The texts that replace the placeholders of a command. Strings are borrowed. */
typedef struct DrawingMarks {
    const char *scene, *picture; /* paths */
    const char *camera; /* command line options that state the camera, quoted for the shell */
    int width, height;  /* size of the picture, pixels */
    bool needs_camera;  /* the scene file does not state the camera */
} DrawingMarks;

/* Appends the shell command that draws a scene.
 *
 * Replaces the placeholders {scene}, {picture}, {camera}, {width} and {height} in the user's
 * `command`. If `command` does not contain {scene}, appends the scene, the picture and, if
 * needs_camera is true, the camera. If memory runs out, `out` records it. */
void drawing_command(const char *command, const DrawingMarks *marks, Text *out);

/* The files and the command of one drawing. Zeroed: none. All strings are owned. */
typedef struct ShellDrawing {
    char *scene, *picture, *log; /* paths */
    char *command;
    bool is_drawn;    /* the renderer ended in time with exit status 0, and wrote a file */
    char reason[400]; /* why there is no picture: "exit status 1: no such file"; "" if there is */
} ShellDrawing;

/* Sets the paths of scene and picture to folder/NAME with these extensions, and the path of the log
 * to folder/NAME.log. Errors: STATUS_MEMORY. */
MUST_CHECK Status drawing_name(ShellDrawing *drawing, const char *folder, const char *name,
                               const char *scene_extension, const char *picture_extension,
                               Err *err);
void drawing_release(ShellDrawing *drawing);

/* Runs the commands of all drawings that have not been run before, and waits for them. Removes old
 * pictures first. Sets is_drawn and reason. A command that exceeds the time limit is killed, with
 * all processes that it started. A renderer that draws nothing is not an error. Errors: STATUS_TOOL
 * if no process can be started. */
MUST_CHECK Status drawings_run(const ShellRenderer *renderer, ShellDrawing *drawings, size_t n,
                               Err *err);
/* Reads the picture of a drawing and composites it over black. If there is no picture or it cannot
 * be read, sets is_drawn to false and the reason, and leaves *image empty; this is not an error.
 * The caller releases *image. Errors: STATUS_MEMORY. */
MUST_CHECK Status drawing_read(ShellDrawing *drawing, Image *image, Err *err);
/* Records in *drawing that its picture cannot be used, so that the other drawings can continue:
 * sets is_drawn to false, and `reason` to the sentence of *why. `status` is the error that came
 * with *why. If it is STATUS_MEMORY, returns STATUS_MEMORY and sets *err; else returns STATUS_OK.
 */
MUST_CHECK Status drawing_refuse(ShellDrawing *drawing, Status status, const Err *why, Err *err);

#endif
