/* A scene as POV-Ray and corcast draw it, and how the two compare. */
#ifndef CORCAST_JOB_VERIFY_VERIFICATION_H
#define CORCAST_JOB_VERIFY_VERIFICATION_H

#include "compare/compare.h"
#include "job/picture/picture.h"
#include "options/options.h"
#include "oracle/oracle.h"
#include "render/render.h"

typedef struct Verification {
    const PictureOptions *picture;
    const Common *common;
    const char *tree, *folder;
    char *name; /* of the tree, for the report; owned */
    Scene scene;
    Appearance frames; /* owned; of all moments, where scene.appearance is one of them */
    int frame;         /* its number, from 1 on */
    CellParams cells;
    Frame native, povray,
        exact; /* `exact` of an isosurface, whose `native` is POV-Ray's view of it */
    int bits;  /* of the colours that are compared */
    RenderKernels kernels;
    Picture native_picture, povray_picture; /* sRGB of 8 bits, or linear of 16 */
    Picture native_shown, povray_shown;     /* of 16 bits, in sRGB of 8 bits */
    RenderStats stats;                      /* of the exact frame, where there is one */
    OracleRun run;                          /* of the colour plane; of its tiles, all together */
    int least_tiles;                        /* that POV-Ray draws the picture in */
    size_t n_tiles;                         /* that it did: 1 is the whole picture */
    CompareResult results[PLANE_KINDS];
    Settled settled;
    bool asked; /* whether anything was settled, or nothing had to be */
    SurfaceCheck surface;
    CompareResult exact_color;
    bool has_alpha;                     /* the picture is transparent, and alpha is judged */
    Picture native_alpha, povray_alpha; /* grey, of 8 bits */
    CompareResult alpha;
    bool asks_witness; /* Tachyon draws the scene, too */
    Frame tachyon;     /* depth and ids of it */
    Witness witness;
    char **commands; /* how to repeat it; owned */
    size_t n_commands, command_room;
} Verification;

void verification_release(Verification *v);

/* Room for one command more, at the end: *command. */
MUST_CHECK Status verification_add_command(Verification *v, char ***command, Err *err);

/* Whether the model is an implicit surface, of which `exact` and `surface` are, too. */
bool verification_takes_two_steps(const Verification *v);

/* Of a scene whose colours change with time, the moment that is verified, 0 for the first; the
 * scene for POV-Ray has all. STATUS_USAGE when there is no such frame. */
MUST_CHECK Status verification_pick_frame(Verification *v, int frame, Err *err);

/* Draws the scene with POV-Ray and natively, asks the witness, and writes scene and planes to the
 * folder, which is there; the first of the commands is in them. Errors as oracle_run, render and
 * frames_write have them. */
MUST_CHECK Status verification_draw(Verification *v, Err *err);

/* Compares what is drawn: results, settled, where there are two steps surface and exact_color, and
 * where one is asked, witness. */
MUST_CHECK Status verification_compare(Verification *v, Err *err);

/* A side's colours as a screen shows them. */
const Picture *verification_shown_by_povray(const Verification *v);
const Picture *verification_shown_natively(const Verification *v);

#endif
