/* One scene, drawn by POV-Ray and by corcast, and how the two pictures compare.
 *
 * Use, for a Verification whose options, common, tree and scene are set:
 *
 *     TRY(verification_add_command(&v, command, err));   (corcast's own command line)
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

/* The third program that draws the scene. */
typedef enum WitnessChoice { WITNESS_NONE, WITNESS_TACHYON } WitnessChoice;

/* What the options of `verify` set. */
typedef struct VerifyOptions {
    const char *folder;
    int bits;              /* bits per channel of the compared colors: 8 (sRGB) or 16 (linear) */
    RenderKernels kernels; /* instruction set that corcast draws with */
    WitnessChoice witness;
    int tiles; /* minimum number of tiles that POV-Ray draws the picture in */
    bool json; /* for the command line: the report is printed as JSON */
    PictureOptions picture;
    ProgramChoice povray, tachyon; /* set by the caller; zeroed: the programs in PATH */
} VerifyOptions;

/* What the comparison found. Members that do not apply to the scene are zero. */
typedef struct VerifyFindings {
    CompareResult planes[PLANE_KINDS];
    CompareResult alpha;  /* of a transparent picture */
    CompareResult exact;  /* isosurfaces: POV-Ray's colors against those of the exact surface */
    SurfaceCheck surface; /* isosurfaces: where POV-Ray's root finder puts the surface */
    Settled settled;      /* differing pixels at which POV-Ray is known to be wrong */
    bool examined;        /* `settled` applies to the scene */
    Witness witness;      /* what Tachyon drew, if options->witness is set */
} VerifyFindings;

/* Zeroed except options, common and tree, which are borrowed. All other members are owned. */
typedef struct Verification {
    const VerifyOptions *options;
    const Common *common;
    const char *tree;    /* path of the tree, for sentences */
    char *name;          /* name of the tree, for the report */
    char *description;   /* of the scene, in scene files; set by verification_draw */
    char *templates;     /* path of the folder of templates; set by verification_draw */
    Scene scene;         /* the scene at the time step that is compared */
    Geometry resting;    /* geometry of the vessels at rest, if they beat; the scene's geometry is
                          * then that at the time step */
    Appearance moments;  /* appearance at all moments if the colors change with time; the scene's
                          * appearance is then a view of it */
    int frame;           /* number of the moment, from 1 on */
    OraclePlanes povray; /* POV-Ray's planes */
    OraclePlanes native; /* corcast's planes; of an isosurface with POV-Ray's root finder */
    Frame exact;         /* of an isosurface: corcast's planes of the exact surface */
    Frame tachyon;       /* depth and ids */
    Picture shown[2];    /* 16-bit colors of POV-Ray and corcast as 8-bit sRGB; empty for 8 bits */
    RenderStats stats;   /* of corcast's last frame */
    PovrayRun run;
    size_t n_tiles;         /* in which POV-Ray drew the picture; 1: the whole picture */
    bool has_alpha;         /* the picture is transparent, and alpha is compared */
    ARRAY(char *) commands; /* command lines that repeat the verification; the first: corcast's */
    VerifyFindings found;
    bool agrees; /* everything agrees */
} Verification;

void verification_release(Verification *v);

/* Appends a command line, which is copied. Errors: STATUS_MEMORY. */
MUST_CHECK Status verification_add_command(Verification *v, const char *command, Err *err);

/* Returns true if the model is an isosurface. It is compared in two steps: corcast repeats
 * POV-Ray's root finder, and then the surface that this finds is compared with the exact surface.
 */
bool verification_takes_two_steps(const Verification *v);

/* Selects moment number `frame`, counted from 1, of a scene whose colors change with time; 0
 * selects the first. POV-Ray's scene still contains all moments. Must be called once. Errors:
 * STATUS_USAGE if there is no such moment; STATUS_MEMORY. */
MUST_CHECK Status verification_pick_frame(Verification *v, int frame, Err *err);

/* Draws the scene with POV-Ray, corcast and, if asked, Tachyon. Writes scenes and planes into the
 * existing folder. v->commands.items[0] must be set. Errors: as povraytiles_prepare,
 * povraytiles_draw, tachyon_draw, render and frames_write. */
MUST_CHECK Status verification_draw(Verification *v, Err *err);

/* Compares what was drawn. Sets v->found. Errors: STATUS_MEMORY. */
MUST_CHECK Status verification_compare(Verification *v, Err *err);

/* Returns the colors of a side (0: POV-Ray, 1: corcast) as a screen shows them; borrowed. */
const Picture *verification_shown(const Verification *v, int side);

/* Returns everything that was found, as a report; borrowed from `v`. */
ReportCase verification_report(const Verification *v);

#endif
