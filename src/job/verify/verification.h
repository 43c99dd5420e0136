/* Draws one scene with POV-Ray and with corcast, and compares the two pictures. An isosurface is
 * compared in two steps: POV-Ray's picture with a picture in which corcast repeats POV-Ray's root
 * finder, then this root finder's surface with the exact surface. verify_run [verify.h] sets
 * `options`, `common`, `tree`, `name` and `scene` of a Verification, and calls:
 *
 *     TRY(verification_add_command(&v, command, err));   // corcast's own command line
 *     TRY(verification_pick_frame(&v, frame, err));
 *     TRY(verification_draw(&v, err));
 *     TRY(verification_compare(&v, err));
 *     report = verification_report(&v); */
#ifndef CORCAST_JOB_VERIFY_VERIFICATION_H
#define CORCAST_JOB_VERIFY_VERIFICATION_H

#include "compare/compare.h"
#include "job/picture/picture.h"
#include "options/options.h"
#include "oracle/planes.h"
#include "oracle/povray.h"
#include "render/render.h"

/* A third program that draws the scene, to decide which of two differing pixels is wrong. */
typedef enum WitnessChoice { WITNESS_NONE, WITNESS_TACHYON } WitnessChoice;

/* What the options of `verify` set. */
typedef struct VerifyOptions {
    const char *folder;
    int bits;              /* bits per channel of the compared colors: 8 (sRGB) or 16 (linear) */
    RenderKernels kernels; /* instruction set that corcast draws with */
    WitnessChoice witness;
    int tiles; /* minimum number of tiles in which POV-Ray draws the picture */
    bool json; /* for the command line: the report is printed as JSON */
    PictureOptions picture;
    ProgramChoice povray, tachyon; /* set by the caller; zeroed: the programs in PATH */
} VerifyOptions;

/* The results of the comparison. Members that do not apply to the scene are zero. */
typedef struct VerifyFindings {
    CompareResult planes[PLANE_KINDS];
    CompareResult alpha; /* transparent pictures: the comparison of the alpha channels */
    /* isosurfaces: POV-Ray's colors compared with those of the exact surface */
    CompareResult exact;
    /* isosurfaces: position of the surface that POV-Ray's root finder finds */
    SurfaceCheck surface;
    Settled settled; /* differing pixels at which POV-Ray is known to be wrong
                      * [compare/checks/settled.h] */
    bool examined;   /* differing pixels were examined, and `settled` is set */
    Witness witness; /* comparison with Tachyon's picture, if options->witness is set */
} VerifyFindings;

/* A verification. `options`, `common` and `tree` are set by the caller and borrowed. `name` and
 * `scene` are set by the caller and owned. All other members are zeroed before, and owned. */
typedef struct Verification {
    const VerifyOptions *options;
    const Common *common;
    const char *tree;    /* path of the tree, for messages */
    char *name;          /* name of the tree, for the report */
    char *description;   /* description of the scene in scene files; set by verification_draw */
    char *templates;     /* path of the folder of templates; set by verification_draw */
    Scene scene;         /* the scene at the time step that is compared */
    Geometry resting;    /* if vessels beat: geometry of the vessels at rest; scene.geometry is then
                          * the geometry at the time step */
    Appearance moments;  /* if colors change with time: appearance at all time steps;
                          * scene.appearance then borrows from `moments` */
    int frame;           /* number of the time step, from 1 */
    OraclePlanes povray; /* POV-Ray's planes */
    OraclePlanes native; /* corcast's planes; isosurfaces: with POV-Ray's root finder */
    Frame exact;         /* isosurfaces: corcast's planes of the exact surface */
    Frame tachyon;       /* Tachyon's planes, depth and ids */
    Picture shown[2];  /* for 16 bits: the colors of POV-Ray and corcast converted to 8-bit sRGB for
                        * display */
    RenderStats stats; /* statistics of corcast's last frame */
    PovrayRun run;
    size_t n_tiles; /* number of tiles in which POV-Ray drew the picture; 1: the whole picture */
    bool has_alpha; /* the picture is transparent, and alpha is compared */
    ARRAY(char *)
    commands; /* command lines that repeat the verification; the first is corcast's own */
    VerifyFindings found;
    bool agrees; /* everything agrees */
} Verification;

void verification_release(Verification *verification);

/* Appends a command line, which is copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status verification_add_command(Verification *verification, const char *command,
                                           Err *err);

/* Returns true if the model is an isosurface, which is compared in two steps. */
bool verification_takes_two_steps(const Verification *verification);

/* Selects time step `frame`, counted from 1, of a scene whose colors change with time; 0 selects
 * the first. POV-Ray's scene file still contains all time steps. Call it once, also for other
 * scenes, with 0. Errors: STATUS_USAGE if there is no such time step; STATUS_MEMORY. */
MUST_CHECK Status verification_pick_frame(Verification *verification, int frame, Err *err);

/* Draws the scene with POV-Ray, corcast and, if options->witness is set, Tachyon. Writes scenes and
 * planes into options->folder, which must exist. verification->commands.items[0] must be set.
 * Errors: STATUS_TOOL if a program is missing or fails; STATUS_INFEASIBLE if POV-Ray cannot store
 * the scene; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status verification_draw(Verification *verification, Err *err);

/* Compares the planes that were drawn. Sets verification->found, verification->shown and
 * verification->agrees. Errors: STATUS_MEMORY. */
MUST_CHECK Status verification_compare(Verification *verification, Err *err);

/* Returns the colors of a side (0: POV-Ray, 1: corcast) as sRGB of 8 bits. Borrowed. */
const Picture *verification_shown(const Verification *verification, int side);

/* Returns the results as a case of a report [compare/report/report.h]. Borrowed from
 * `verification`. */
ReportCase verification_report(const Verification *verification);

#endif
