/* Runs an external renderer, such as POV-Ray, on a scene file. A renderer that makes no progress is
 * ended, and a picture is accepted only if it is complete.
 *
 * A Program describes the executable, its arguments, and the test whether its picture is complete.
 * Fill in a Program, then call program_draw(&program, &output, &seconds, err). Needs Linux (/proc).
 * Private to the module oracle, except ProgramChoice. */
#ifndef CORCAST_ORACLE_PROGRAM_H
#define CORCAST_ORACLE_PROGRAM_H

#include "base/base.h"

/* The executable that is run, and the time limit. All strings are borrowed. */
typedef struct ProgramChoice {
    const char *path;  /* executable, searched in PATH if it has no slash; NULL: the default of the
                        * function that receives the choice, such as "povray" */
    double patience_s; /* the program is ended after this many seconds without output, and after
                        * five times as many seconds without progress; 0: never */
    const char *patience_name; /* name of the setting by which users change patience_s, for error
                                * sentences; NULL: "patience" */
} ProgramChoice;

/* Default of patience_s, in seconds. POV-Ray prints nothing while it parses a large scene, which
 * takes minutes; a smaller value would end such runs. */
#define PROGRAM_PATIENCE_S 600

/* Receives the fraction of the picture that has been drawn, in [0, 1]. If it returns false, the
 * program is ended, and program_draw fails with STATUS_CANCELLED. */
typedef bool ProgramProgress(double fraction, void *context);

/* The path by which the program's arguments refer to a private folder with links to the scene and
 * its header. program_draw opens the folder as file descriptor 3. */
#define PROGRAM_FOLDER "/proc/self/fd/3/"
/* The names of the scene and of its header in that folder. */
#define PROGRAM_SCENE "scene.pov"
#define PROGRAM_HEADER "header.inc"

/* Paths of the files of a run, in the form in which they stand on the command line. All strings are
 * borrowed. */
typedef struct ProgramPaths {
    const char *scene, *header, *picture; /* header: NULL if the program has none */
} ProgramPaths;

enum { MAX_ARGUMENTS = 28 }; /* enough for POV-Ray with all options */

/* The words of a command line. The first word is the executable. Zeroed: no words. */
typedef struct Arguments {
    char *list[MAX_ARGUMENTS + 1]; /* the words; owned; NULL ends the list */
    int n;
} Arguments;

/* Appends one formatted word; `arguments` must have fewer than MAX_ARGUMENTS. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status arguments_add(Arguments *arguments, Err *err, const char *format, ...)
    PRINTF_LIKE(3, 4);
void arguments_release(Arguments *arguments);

/* A program, and the picture that it draws. All pointers are borrowed. */
typedef struct Program {
    const char *name;    /* name in messages: "POV-Ray" */
    const char *package; /* the Debian package that contains it */
    ProgramChoice choice;
    const char *scene;         /* path of the scene, a regular file with any name */
    const char *header;        /* path of a file that is read before the scene; NULL: none */
    const char *output;        /* path of the picture, with any name */
    ProgramProgress *progress; /* called for each "(30%)" in the printed output; may be NULL */
    void *progress_context;
    /* Appends the executable and its arguments. `paths` has the paths by which the program finds
     * its files. An error ends program_draw with the same status. */
    Status (*add_arguments)(const void *context, const ProgramPaths *paths, Arguments *arguments,
                            Err *err);
    /* In the next two functions, `output` is the text that the program has printed. Checks, after
     * the program has ended, that the file `picture` is the complete picture. Errors: STATUS_TOOL,
     * with the reason found in `output`, if it is not. */
    Status (*judge)(const void *context, const Text *output, int exit_status, const char *picture,
                    Err *err);
    /* Returns true if the picture is complete, so that the program only has to exit. The program is
     * then killed if the file that runs has the name Program.executable. A file with another name
     * may be a script that has more to do, so program_draw waits for it. May be NULL. */
    bool (*is_done)(const void *context, const Text *output, const char *picture);
    const char *executable; /* "povray"; not read if is_done is NULL */
    const void *context;    /* passed to the three functions */
} Program;

/* Runs the program with the scene's folder as working folder, where it finds files that the scene
 * includes. The picture gets its final name only if `judge` accepts it.
 * output   receives the text that the program prints, appended, with line feeds as line ends.
 * seconds  receives the wall-clock time of the run, s; unchanged after an error.
 * Errors   STATUS_TOOL if the program is not installed, fails, prints nothing or makes no progress
 *          for too long, or prints more than 1 GB. STATUS_INPUT if the scene is not a regular file.
 *          STATUS_IO if the picture cannot be written. STATUS_CANCELLED if `progress` returns
 *          false. STATUS_MEMORY. The errors of add_arguments. */
MUST_CHECK Status program_draw(const Program *program, Text *output, double *seconds, Err *err);

#endif
