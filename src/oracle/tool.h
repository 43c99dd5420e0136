/* Another program that draws a scene as a picture, without a window, and is watched while it does;
 * private to the room oracle. */
#ifndef CORCAST_ORACLE_TOOL_H
#define CORCAST_ORACLE_TOOL_H

#include "base/base.h"

/* Where a program finds the scene, and its name there. */
#define TOOL_FOLDER "/proc/self/fd/3/"
#define TOOL_SCENE "scene.pov"

enum { MAX_ARGUMENTS = 28 };

/* Zeroed: none. The program is the first. */
typedef struct Arguments {
    char *list[MAX_ARGUMENTS + 1]; /* owned; NULL ends them */
    int n;
} Arguments;

MUST_CHECK Status arguments_add(Arguments *arguments, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);
void arguments_release(Arguments *arguments);

/* All is borrowed. */
typedef struct Tool {
    const char *name;     /* in sentences: "POV-Ray" */
    const char *package;  /* of Debian */
    const char *scene;    /* a regular file, under any name */
    const char *output;   /* the picture, likewise */
    const char *patience; /* the variable that sets patience_s */
    double patience_s;    /* the program is ended after this many seconds without output, and after
                           * five times as many without progress; 0: never */
    bool (*progress)(double fraction, void *context); /* receives each "(30%)"; false: the program
                                                       * is ended; NULL: none */
    void *progress_context;
    /* Adds the program and its arguments; `scene` and `picture` are how it is to call them. */
    Status (*add_arguments)(const void *context, const char *scene, const char *picture,
                            Arguments *arguments, Err *err);
    /* STATUS_TOOL unless it has drawn a whole picture, which stands at `picture`. */
    Status (*judge)(const void *context, const Text *said, int exit_status, const char *picture,
                    Err *err);
    /* Whether it has drawn the picture and is only about to end: a process of the name `process`,
     * no script, is not waited for then, but ended. May be NULL. */
    bool (*is_done)(const void *context, const Text *said, const char *picture);
    const char *process;
    const void *context;
} Tool;

/* Has the program draw. The picture appears under its name only when it is whole. What the program
 * has said is appended to *said, its lines ended by line feeds; *seconds is the wall clock, parsing
 * included. STATUS_TOOL when it is missing or fails, falls silent, makes no
 * progress or never stops talking;
 * STATUS_INPUT when the scene is no regular file. */
MUST_CHECK Status tool_draw(const Tool *tool, Text *said, double *seconds, Err *err);

#endif
