/* The door of the room verify: two images -> metrics, verdict, pictures, report. Of two images the
 * first, A, is the reference and the second, B, is judged against it. */
#ifndef CORCAST_VERIFY_VERIFY_H
#define CORCAST_VERIFY_VERIFY_H

#include "base/base.h"
#include "image/image.h"
#include "verify/oracle.h"        // IWYU pragma: export
#include "verify/surface_check.h" // IWYU pragma: export
#include <jansson.h>

typedef enum PlaneKind { PLANE_COLOR, PLANE_DEPTH, PLANE_NORMAL, PLANE_ID, PLANE_KINDS } PlaneKind;

/* "color", "depth", "normal", "id". */
const char *plane_kind_name(PlaneKind kind);

/* What is still agreement. A limit in parts per million is of the pixels judged; INFINITY (SIZE_MAX
 * for a count) leaves a rule unjudged. A NaN is never tolerated. */
typedef struct Tolerance {
    const char *tier;       /* its name in verdicts: "A", "surface" */
    double color_levels;    /* 8-bit levels a pixel may be off and count as the same ... */
    double color_ppm;       /* ... and how many may be off by more */
    bool color_common_only; /* judge the colour only of pixels seen in both */
    double id_ppm;          /* pixels with different ids */
    double depth_max_mm;    /* for one pixel ... */
    double depth_ppm;       /* ... and how many may exceed it */
    double depth_p99_mm;    /* 99th percentile */
    double normal_max_deg;  /* for one pixel ... */
    double normal_ppm;      /* ... and how many may exceed it */
    double coverage_ppm;    /* pixels seen in only one of the two, depth and normal planes */
    size_t region_pixels;   /* largest 8-connected region of missing, or of extra, pixels */
} Tolerance;

/* Tier A, identity: at most 5 pixels in a million differ in colour or id, and depth is nowhere off
 * by more than one step of the reference's quantisation. */
Tolerance tolerance_identity(double depth_step_mm);
/* Implicit surfaces, whose points both sides find by iteration: depth within 0.01 mm at the 99th
 * percentile, colour within 2 levels on 99.5 % of the pixels seen in both, no region of more than 2
 * pixels missing or extra. */
Tolerance tolerance_surface(void);

typedef struct PixelPlace {
    int x, y; /* from the top left; -1 when there is no such pixel */
    uint32_t id_a, id_b;
} PixelPlace;

/* One limit held against what was measured. */
typedef struct Rule {
    char name[64];    /* "pixels off by more than 2 levels" */
    const char *unit; /* "ppm", "mm", "pixels" */
    double measured, allowed;
    bool met;
    PixelPlace at;    /* a pixel to look at */
    char at_what[48]; /* what is there: "the worst, 155 levels," */
} Rule;

enum { RULES_MAX = 6 };

/* Every pixel of a picture in exactly one class, the first that fits. `edge` needs the band: pixels
 * that touch (8-neighbours) a pixel of another id in either image. */
typedef struct ClassCounts {
    size_t missing;       /* seen in A only, off the band */
    size_t extra;         /* seen in B only, off the band */
    size_t wrong_segment; /* seen in both with different ids, off the band */
    size_t edge;          /* ids differ, in the band */
    size_t shading;       /* ids agree, colour differs by more than one code */
    size_t rounding;      /* ids agree, colour differs by one code */
    size_t identical;
} ClassCounts;

/* What a comparison of two planes of one kind found. Numbers without meaning for the kind, or that
 * could not be measured, are NAN. */
typedef struct CompareResult {
    PlaneKind kind;
    Tolerance tolerance; /* its tier is borrowed from the caller */
    bool agrees;
    char reason[400]; /* a sentence about the first rule broken; "" when the planes agree */
    Rule rules[RULES_MAX];
    int n_rules;

    int width, height, bits;
    size_t pixels;
    bool has_ids;  /* id planes were given: places carry ids */
    bool has_mask; /* which pixels show something is known: from ids, from the values of a depth or
                    * normal plane, or, for pictures, from a background that fills the corners */
    size_t common_pixels, missing_pixels, extra_pixels; /* seen in both, in A only, in B only */
    size_t largest_region;                              /* pixels */
    PixelPlace largest_region_at;
    size_t nan_pixels_a, nan_pixels_b;
    PixelPlace nan_at;       /* the first */
    size_t differing_pixels; /* not equal in some channel */
    size_t beyond_pixels;    /* off by more than the tolerance lets one pixel be */
    size_t judged_pixels;    /* what ppm refers to */
    PixelPlace worst;        /* the first pixel with the largest difference */

    /* Colour, in 8-bit levels whatever the depth (a 16-bit code is 1/257 level). */
    double max_abs, mean_abs, rmse;
    double max_code;               /* in codes */
    double psnr_db;                /* INFINITY for equal pictures */
    double flip_mean;              /* LDR-FLIP 1.6 at 67.02 pixels per degree */
    double ssim;                   /* of luma, Wang 2004; NAN below 11 x 11 pixels */
    double interior_max_abs;       /* off the band */
    double edge_mismatch_fraction; /* of the band's pixels, those whose ids differ */
    ClassCounts classes;           /* when has_mask */

    /* Depth (mm) and normal (degrees), over common pixels; percentiles by nearest rank. */
    double median, p99, max;
} CompareResult;

/* Compares two pictures. The id planes, both or neither NULL, tell silhouettes from surfaces;
 * without them the background's colour does, where at least three corners of each picture share
 * one. STATUS_INPUT when sizes, channels or bits differ. */
MUST_CHECK Status compare_pictures(const Picture *a, const Picture *b, const IdPlane *id_a,
                                   const IdPlane *id_b, const Tolerance *tolerance,
                                   CompareResult *result, Err *err);
/* Compares two depth planes (1 channel, INFINITY where nothing is seen) or two normal planes (3
 * channels, 0 0 0 where nothing is seen). NaN, and for a depth minus infinity, is counted and never
 * averaged in. The id planes, both or neither NULL, only name segments. */
MUST_CHECK Status compare_planes(PlaneKind kind, const Plane *a, const Plane *b,
                                 const IdPlane *id_a, const IdPlane *id_b,
                                 const Tolerance *tolerance, CompareResult *result, Err *err);
/* Compares two id planes. STATUS_INPUT when sizes differ. */
MUST_CHECK Status compare_ids(const IdPlane *a, const IdPlane *b, const Tolerance *tolerance,
                              CompareResult *result, Err *err);

/* LDR-FLIP [Andersson et al. 2020, Proc. ACM CGIT 3(2), 15; version 1.6] of two pictures of the
 * same shape, taken as sRGB: the error of each pixel in [0, 1] in *map (owned; 1 channel). */
MUST_CHECK Status flip_compute(const Picture *a, const Picture *b, Plane *map, Err *err);
/* The mean of a plane of 1 channel, summed in double precision. */
double plane_mean(const Plane *plane);
/* Mean SSIM of luma [Wang et al. 2004, IEEE Trans. Image Process. 13, 600]: 11 x 11 Gaussian of
 * sigma 1.5, over the pixels whose window lies inside; NAN in *ssim when there are none. */
MUST_CHECK Status ssim_compute(const Picture *a, const Picture *b, double *ssim, Err *err);

/* The levels at which the heat map of the difference changes colour: 0, 1, 2, 4, 8, 16 and more,
 * never scaled to the picture, so that two maps can be compared. */
enum { HEAT_STEPS = 6 };
typedef struct HeatStep {
    int from_level; /* largest difference over the channels, in 8-bit levels */
    uint8_t red, green, blue;
} HeatStep;
extern const HeatStep heat_steps[HEAT_STEPS];
/* The heat map of two pictures of the same shape as an 8-bit RGB picture. A difference between two
 * levels has the colour of the lower one, but for 16-bit codes below one level, which have that of
 * level 1: only equal pixels have that of 0. */
MUST_CHECK Status difference_picture(Picture *out, const Picture *a, const Picture *b, Err *err);

/* A comparison as JSON, with the keys of `compare --json`; what is NAN or infinite is null. New
 * reference, NULL when memory runs out. */
json_t *compare_json(const CompareResult *result);

/* One of the two programs that rendered a scene. All is borrowed. */
typedef struct ReportSide {
    const char *name;    /* "POV-Ray" */
    const char *key;     /* in JSON: "povray", "native" */
    const char *version; /* "3.7.0.10" */
    double seconds;      /* wall-clock time of the colour picture */
    const Picture *picture;
    const IdPlane *ids; /* or NULL, then in both */
} ReportSide;

/* One scene rendered by both. All is borrowed. */
typedef struct ReportCase {
    const char *name;            /* of the scene: "demo" */
    const char *model;           /* "rounded" */
    ReportSide a, b;             /* reference and candidate */
    const char *const *commands; /* how to repeat it, one a line */
    size_t n_commands;
    const CompareResult *planes[PLANE_KINDS]; /* NULL where not compared; colour is required */
    const SurfaceCheck *surface;              /* of an implicit model; NULL: of no such model */
} ReportCase;

/* Whether every plane agrees, and the surface. */
bool report_agrees(const ReportCase *report);
/* The report as JSON, with the keys of `verify --json`. New reference, NULL when memory runs out.
 */
json_t *report_json(const ReportCase *report);
/* Writes report.html (from `template_path`), report.json, junit.xml and diff.png into `folder`,
 * which exists. The page holds its pictures and works from disk without a network. */
MUST_CHECK Status report_write(const ReportCase *report, const char *template_path,
                               const char *folder, Err *err);

#endif
