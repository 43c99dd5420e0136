/* POV-Ray as the oracle: the program run, and its planes read back. */
#ifndef CORCAST_ORACLE_ORACLE_H
#define CORCAST_ORACLE_ORACLE_H

#include "base/base.h"
#include "image/image.h"

/* What the scene's Corcast_Plane selects. */
typedef enum OraclePlane {
    ORACLE_COLOR,
    ORACLE_DEPTH,
    ORACLE_NORMAL,
    ORACLE_ID,
    ORACLE_DEPTH_ID, /* both of these, for ids up to ORACLE_MOST_ID */
    ORACLE_ALPHA,    /* colours of 8 bits with alpha, before a background that is transparent */
    ORACLE_PLANES
} OraclePlane;

enum { ORACLE_MOST_ID = 65535 };

typedef struct OracleParams {
    const char *program; /* NULL: povray */
    const char *scene;   /* .pov file, under any name */
    const char *output;  /* .png file, likewise */
    int width, height;   /* pixels */
    PixelRect part;      /* of the picture that is drawn, the rest is black; width 0: all of it */
    int antialias;       /* of colours and alpha: 1, or N for +A0.0 +AM1 +RN -J */
    int threads;         /* 0: POV-Ray's own choice */
    OraclePlane plane;   /* id alone is 8-bit linear, depth and normal are 16-bit linear */
    int bits;            /* of the colour plane: 8, sRGB, or 16, linear */
    bool alpha;          /* of the colour plane: transparent where the scene's background is */
    double clock;        /* of the scene, 0 to 1 */
    double patience_s;   /* POV-Ray is ended after this many seconds without output, and after five
                          * times as many without progress; 0: never */
    bool (*progress)(double fraction, void *context); /* false: stop; may be NULL */
    void *progress_context;
} OracleParams;

typedef struct OracleRun {
    char version[64]; /* "3.7.0.10.unofficial" */
    double seconds;   /* wall clock, parsing included */
} OracleRun;

/* Runs POV-Ray without a window, in the scene's folder. The picture appears under its name only
 * when it is a whole PNG of the size and depth asked for. STATUS_TOOL with POV-Ray's own words when
 * it is missing or fails, or when it falls silent or never stops talking; STATUS_INPUT when the
 * scene is no regular file. `run` may be NULL. */
MUST_CHECK Status oracle_run(const OracleParams *params, OracleRun *run, Err *err);

/* The switches of such a run as one line, for the report and for scripts; in *out (owned). */
MUST_CHECK Status oracle_command(const OracleParams *params, char **out, Err *err);

/* Reads the plane that oracle_run wrote as `output` into the frame: depth in mm between `near_mm`
 * and `far_mm` as the scene declares them, INFINITY where nothing is seen; unit normals; ids;
 * colour decoded to linear. */
MUST_CHECK Status oracle_read_depth(Plane *depth, const char *path, double near_mm, double far_mm,
                                    Err *err);
MUST_CHECK Status oracle_read_normal(Plane *normal, const char *path, Err *err);
MUST_CHECK Status oracle_read_ids(IdPlane *ids, const char *path, Err *err);
/* Makes a grey picture of 8 bits of the alpha of a picture of 8 bits; white where it has none. */
MUST_CHECK Status picture_take_alpha(Picture *alpha, const Picture *picture, Err *err);
/* Alpha of a picture file alone, as a grey picture of 8 bits. */
MUST_CHECK Status oracle_read_alpha(Picture *alpha, const char *path, Err *err);
/* Depth and ids of one picture, as the former two. */
MUST_CHECK Status oracle_read_depth_ids(Plane *depth, IdPlane *ids, const char *path,
                                        double near_mm, double far_mm, Err *err);

#endif
