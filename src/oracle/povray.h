/* Runs POV-Ray on a scene file that corcast has written, and reads the planes that POV-Ray has
 * drawn. Call povray_draw for each plane, read its picture [image/image.h], and call
 * povray_decode_plane. */
#ifndef CORCAST_ORACLE_POVRAY_H
#define CORCAST_ORACLE_POVRAY_H

#include "oracle/planes.h"
#include "oracle/program.h"

/* The plane that a run of POV-Ray draws. The value is passed to POV-Ray as Corcast_Plane. The
 * include file PovrayParams.planes reads it. */
typedef enum PovrayPlane {
    POVRAY_COLOR,
    POVRAY_DEPTH,
    POVRAY_NORMAL,
    POVRAY_ID,
    POVRAY_DEPTH_ID, /* depth and ids in one picture; requires ids of at most POVRAY_MAX_ID */
    POVRAY_ALPHA,    /* 8-bit colors with alpha in front of a transparent background */
    POVRAY_PLANES
} PovrayPlane;

enum { POVRAY_MAX_ID = 65535 };

/* The name of the copy of the template povray/planes.inc in the folder of a scene. */
#define POVRAY_PLANES_FILE "corcast_planes.inc"

/* One run of POV-Ray. All pointers are borrowed. */
typedef struct PovrayParams {
    ProgramChoice program; /* default: "povray" */
    const char *scene;     /* a .pov file */
    const char *planes;    /* the template povray/planes.inc, or a copy; not used for
                            * POVRAY_COLOR and POVRAY_ALPHA */
    const char *output;    /* the .png file that is written */
    int width, height;     /* pixels of the whole picture */
    PixelRect part;        /* the pixels that are drawn; the others are black; width 0: all
                            * pixels are drawn */
    int antialias; /* samples of POVRAY_COLOR and POVRAY_ALPHA: 1, or N for POV-Ray's options +A0.0
                    * +AM1 +RN -J, which draw N x N samples */
    int threads;   /* 0: POV-Ray's own default */
    PovrayPlane plane;         /* POVRAY_ID is 8-bit linear; depth and normals are 16-bit linear */
    int bits;                  /* bits of POVRAY_COLOR: 8 (sRGB) or 16 (linear) */
    bool alpha;                /* POVRAY_COLOR is transparent where the scene's background is */
    double clock;              /* the scene's clock, in [0, 1] */
    ProgramProgress *progress; /* may be NULL */
    void *progress_context;
} PovrayParams;

/* The facts about a run. */
typedef struct PovrayRun {
    char version[64]; /* "3.7.0.10.unofficial" */
    double seconds;   /* wall-clock time, including parsing */
} PovrayRun;

/* Runs POV-Ray in the scene's folder, without a window. The picture gets its final name only if it
 * is a complete PNG of the requested size and bit depth.
 *
 * run     receives version and duration; NULL: not wanted.
 * Errors  those of program_draw [program.h]. If POV-Ray fails, the sentence quotes POV-Ray's
 *         message. */
MUST_CHECK Status povray_draw(const PovrayParams *params, PovrayRun *run, Err *err);

/* Formats the command line of a run, for reports and scripts. File names have no folders. The
 * caller frees *out. Errors: STATUS_MEMORY. */
MUST_CHECK Status povray_command(const PovrayParams *params, char **out, Err *err);

/* Decodes the picture of a run into new members of `planes`: the colors; depth in mm along the ray,
 * INFINITY where nothing is visible; unit normals, 0 0 0 where nothing is visible; ids; or alpha.
 *
 * picture  POVRAY_COLOR: its codes are moved to `planes`, and *picture is left empty. The caller
 *          releases it in every case.
 * scene    determines the depths that the codes 0 and 65535 represent.
 * planes   the caller releases them with planes_release even after an error.
 * Errors   STATUS_INPUT if the picture is not one of this plane; STATUS_MEMORY. The message does
 *          not name the file. */
MUST_CHECK Status povray_decode_plane(PovrayPlane plane, Picture *picture, const Scene *scene,
                                      OraclePlanes *planes, Err *err);

/* Makes a grey 8-bit picture of the alpha of an 8-bit picture. It is white if the picture has no
 * alpha. The caller releases *alpha. Errors: STATUS_MEMORY. */
MUST_CHECK Status picture_take_alpha(Picture *alpha, const Picture *picture, Err *err);

#endif
