/* What a comparison of two images finds, and the tolerance that it is judged by.
 *
 * Of two images the first, A, is the reference. The second, B, is judged. Differences are B - A.
 * A level is 1/255 of the range of 8-bit codes, for images of all depths. */
#ifndef CORCAST_COMPARE_RESULT_H
#define CORCAST_COMPARE_RESULT_H

#include "base/base.h"
#include "image/image.h"

typedef enum PlaneKind { PLANE_COLOR, PLANE_DEPTH, PLANE_NORMAL, PLANE_ID, PLANE_KINDS } PlaneKind;

/* Returns "color", "depth", "normal" or "id". */
const char *plane_kind_name(PlaneKind kind);

/* One rendering of a scene. All planes have one size. All members are borrowed; a comparison looks
 * at those that its contract names. */
typedef struct Rendering {
    const Picture *picture;
    const Plane *color;          /* linear colours in floats, which may exceed 1 */
    const IdPlane *ids;          /* NULL, in both renderings: unknown. The background is then the
                                  * colour that three corners of each picture share. */
    const Plane *depth, *normal; /* NULL, in both renderings: unknown */
    const Picture *transparent;  /* The picture before it was composited over a background, for
                                  * pixelmatch; NULL or without codes: the picture was opaque. */
} Rendering;

/* ---- tolerance ------------------------------------------------------------------------------- */

/* The numbers of a tolerance. The limits come first, in the order in which they are judged. Limits
 * in ppm are parts per million of the pixels that are judged. */
typedef enum Limit {
    LIMIT_NONE,              /* of a measure that is reported and not judged */
    LIMIT_NAN,               /* pixels with a value that is not a number; always 0 */
    LIMIT_REGION_PIXELS,     /* largest 8-connected region of missing, or of extra, pixels */
    LIMIT_COVERAGE_PPM,      /* depth and normal: pixels that show a surface in one image only */
    LIMIT_SEGMENTS_MISSING,  /* segments of more than 2 pixels in one image only */
    LIMIT_SILHOUETTE_PX,     /* shift of the outline of all that is seen */
    LIMIT_COLOR_PPM,         /* pixels off by more than LIMIT_COLOR_LEVELS */
    LIMIT_INTERIOR_LEVELS,   /* largest difference of a pixel off the edges */
    LIMIT_INTERIOR_PPM,      /* of the pixels off the edges: off by more than LIMIT_COLOR_LEVELS */
    LIMIT_BAND_PPM,          /* of the pixels at edges: off by more than LIMIT_COLOR_LEVELS */
    LIMIT_SEGMENT_PX,        /* shift of the outline of one segment */
    LIMIT_SEGMENT_LEVELS,    /* mean difference of one segment, in the worst channel */
    LIMIT_GAIN,              /* |1 - g| of B = g A + o, minus two standard errors of g */
    LIMIT_OFFSET_LEVELS,     /* |o| of B = g A + o, minus two standard errors of o */
    LIMIT_BIAS_LEVELS,       /* mean difference of all pixels, in the worst channel */
    LIMIT_SIGN_SIGMA,        /* |m - n| / sqrt(m + n) of m pixels brighter and n darker in B */
    LIMIT_PIXELMATCH_PPM,    /* pixels that pixelmatch finds different at LIMIT_PIXELMATCH */
    LIMIT_ID_PPM,            /* pixels with different ids */
    LIMIT_ID_INTERIOR_PPM,   /* of the pixels off the edges: with different ids */
    LIMIT_ID_BAND_PPM,       /* of the pixels at edges: with different ids */
    LIMIT_DEPTH_PPM,         /* pixels off by more than LIMIT_DEPTH_MAX_MM */
    LIMIT_DEPTH_P99_MM,      /* 99th percentile of depth differences */
    LIMIT_DEPTH_P99_PART,    /* 99th percentile of depth differences over the depth in A */
    LIMIT_NORMAL_PPM,        /* pixels off by more than LIMIT_NORMAL_MAX_DEG */
    LIMIT_NORMAL_MEDIAN_DEG, /* median angle between normals */
    /* Settings of measures. */
    LIMIT_COLOR_LEVELS,      /* a pixel that is off by at most this many levels is the same */
    LIMIT_COLOR_COMMON_ONLY, /* 1: LIMIT_COLOR_PPM counts only pixels seen in both images; or 0 */
    LIMIT_DEPTH_MAX_MM,      /* a depth that is off by at most this is the same */
    LIMIT_NORMAL_MAX_DEG,    /* a normal that is off by at most this is the same */
    LIMIT_PIXELMATCH,        /* threshold of pixelmatch, in [0, 1]; NAN: pixelmatch does not run */
    LIMITS
} Limit;

/* What still counts as agreement. Perceptual measures are in no tier: they judge nothing. */
typedef struct Tolerance {
    const char *tier;      /* name in verdicts: "A", "B", "surface", "none", "given"; borrowed */
    double limits[LIMITS]; /* INFINITY: not judged */
    /* One pixel of a picture of at least SPARE_OF pixels may be off by up to this many levels and
     * is not counted in LIMIT_COLOR_PPM. 0: no pixel. Files of tolerances cannot set it. */
    double spare_levels;
    const char *title;      /* name of what is compared; NULL: the plane's name. Borrowed. */
    const uint8_t *settled; /* per pixel: a SettledCause; no limit counts settled pixels. NULL: no
                             * pixel is settled. Borrowed. */
} Tolerance;

enum { SPARE_OF = 1000 };

/* ---- what is found --------------------------------------------------------------------------- */

/* The numbers that a comparison finds. compare/measure.c has a row for each use of each of them:
 * its key in JSON, its words and unit in texts, and the limit that judges it. */
typedef enum MeasureId {
    MEASURE_NONE,
    MEASURE_PIXELS,
    MEASURE_WIDTH,
    MEASURE_HEIGHT,
    MEASURE_BITS,             /* 8 or 16; 32: floats; 24: ids */
    MEASURE_DIFFERING_PIXELS, /* not equal in some channel */
    /* Coverage, where it is known which pixels show something. */
    MEASURE_MISSING_PIXELS, /* show something in A only */
    MEASURE_EXTRA_PIXELS,   /* show something in B only */
    MEASURE_COMMON_PIXELS,  /* show something in both */
    MEASURE_UNCOMMON_PIXELS,
    MEASURE_LARGEST_REGION, /* pixels of the largest 8-connected region missing or extra */
    MEASURE_NAN_PIXELS,     /* pixels with a value that is not a number, the sum of both images */
    MEASURE_NOT_FINITE,     /* MEASURE_NAN_PIXELS of float colours */
    /* Pixels that limits count. */
    MEASURE_JUDGED_PIXELS, /* pixels that limits in ppm refer to */
    MEASURE_BEYOND_PIXELS, /* off by more than the tolerance allows for one pixel, not settled */
    MEASURE_SETTLED_PIXELS,
    MEASURE_BAND_PIXELS,     /* at edges: they touch a pixel of another label in either image */
    MEASURE_INTERIOR_PIXELS, /* off the edges */
    MEASURE_BAND_BEYOND,
    MEASURE_INTERIOR_BEYOND,
    MEASURE_UNSETTLED_MAX_ABS, /* levels; largest difference of a pixel that is not settled */
    /* Sizes of colour differences, in levels; MEASURE_MAX_CODE in codes. */
    MEASURE_MAX_ABS,
    MEASURE_MAX_CODE,
    MEASURE_MEAN_ABS,
    MEASURE_RMSE,
    MEASURE_PSNR_DB, /* INFINITY: equal pictures */
    MEASURE_INTERIOR_MAX_ABS,
    MEASURE_EDGE_MISMATCH, /* of the pixels at edges, the fraction whose labels differ */
    MEASURE_EDGE_MISMATCH_PERCENT,
    /* Signed colour differences. */
    MEASURE_BIAS_LEVELS,
    MEASURE_SIGN_SIGMA, /* positive: B is brighter more often than darker */
    MEASURE_GAIN,       /* g of the least squares fit B = g A + o over pixels seen in both */
    MEASURE_OFFSET_LEVELS,
    MEASURE_GAIN_ERROR, /* standard errors of the two */
    MEASURE_OFFSET_ERROR,
    MEASURE_GAIN_EXCESS, /* distance from 1 beyond two standard errors */
    MEASURE_OFFSET_EXCESS,
    MEASURE_SILHOUETTE_PX, /* shift of the outline; positive: outwards */
    /* Segments, where ids are known. */
    MEASURE_SEGMENTS,
    MEASURE_SEGMENTS_MISSING,
    MEASURE_SEGMENT_LEVELS, /* of the worst segment with at least 64 common pixels */
    MEASURE_SEGMENT_PX,     /* of the worst segment with an outline of at least 8 px */
    /* Perception; reported only. FLIP 1.6 at 67.02 pixels per degree. */
    MEASURE_FLIP_MEAN,
    MEASURE_FLIP_P95,
    MEASURE_FLIP_MAX,
    MEASURE_FLIP_WEIGHTED_MEAN, /* each pixel's weight is its error */
    MEASURE_FLIP_WEIGHTED_MEDIAN,
    MEASURE_FLIP_WEIGHTED_P95,
    MEASURE_HDR_FLIP_MEAN, /* of float colours */
    MEASURE_SSIM,          /* of luma; NAN below 11 x 11 pixels */
    MEASURE_DE2000_MEAN,
    MEASURE_DE2000_MAX,
    MEASURE_PIXELMATCH_PIXELS, /* NAN unless the tolerance has LIMIT_PIXELMATCH */
    /* Depth in mm, normals in degrees; over common pixels, percentiles by nearest rank. */
    MEASURE_MEDIAN,
    MEASURE_P99,
    MEASURE_MAX,
    MEASURE_P99_PART, /* of depth differences over the depth in A */
    MEASURE_MISMATCH_FRACTION,
    MEASURES
} MeasureId;

typedef struct PixelPlace {
    int x, y;            /* from the top left; -1: there is no such pixel */
    uint32_t id_a, id_b; /* the segments that it shows; 0: none */
} PixelPlace;

/* Pixels to look at. */
typedef enum PlaceId {
    PLACE_WORST,  /* the first pixel with the largest difference */
    PLACE_REGION, /* the first pixel of the largest region */
    PLACE_NAN,    /* the first pixel that is not a number */
    PLACE_SEGMENT_LEVELS,
    PLACE_SEGMENT_PX,
    PLACE_SEGMENT_MISSING,
    PLACES
} PlaceId;

/* One limit, and the measured value that it judges. */
typedef struct Rule {
    char name[64];    /* "pixels off by more than 2 levels" */
    const char *unit; /* "ppm", "mm", "pixels" */
    double measured, allowed;
    bool met;
    PixelPlace at;    /* a pixel to look at; x is -1 if none stands out */
    char at_what[48]; /* what is there: "the worst, 155 levels, is" */
} Rule;

enum { RULES_MAX = 16 };

/* Every pixel of a picture is in exactly one class, the first that fits. */
typedef enum PixelClass {
    PIXEL_SETTLED,       /* differs, and the difference is known to be A's fault */
    PIXEL_MISSING,       /* seen in A only, off the edges */
    PIXEL_EXTRA,         /* seen in B only, off the edges */
    PIXEL_WRONG_SEGMENT, /* seen in both with different ids, off the edges */
    PIXEL_EDGE,          /* ids differ, at an edge */
    PIXEL_SHADOW,        /* ids and geometry agree, one is over 1.5 times as bright as the other */
    PIXEL_GEOMETRY,      /* ids agree, depth or normal does not */
    PIXEL_SHADING,  /* ids agree, and geometry where known; colour is off by more than a code */
    PIXEL_ROUNDING, /* as PIXEL_SHADING, but off by one code */
    PIXEL_IDENTICAL,
    PIXEL_CLASSES
} PixelClass;

/* Returns "missing", "extra", "wrong_segment", "edge" and so on. */
const char *pixel_class_name(PixelClass pixel_class);

/* What is known of one segment in two images. */
typedef struct LedgerEntry {
    uint32_t id;
    size_t area_a, area_b;        /* pixels */
    size_t common;                /* pixels that show the segment in both images */
    size_t differing;             /* pixels that show it in either and differ in colour or id */
    double outline_px;            /* length of its outline in A; in B if A does not show it */
    double signed_levels[3];      /* per channel: mean difference of the common pixels */
    double gain;                  /* g of the least squares fit B = g A; NAN if A is black */
    double moved_px;              /* (area_b - area_a) / outline_px; positive: outwards */
    double max_levels;            /* largest difference of a common pixel */
    int left, top, right, bottom; /* box of its pixels in either image, inclusive */
} LedgerEntry;

typedef struct Ledger {
    LedgerEntry *entries; /* owned; ids ascend */
    size_t n;
} Ledger;

void ledger_release(Ledger *ledger);
/* Returns the mean difference of the worst channel. */
double ledger_entry_levels(const LedgerEntry *entry);
/* Appends the ledger as CSV with a header line. */
void ledger_csv(const Ledger *ledger, Text *out);

enum { WORST_SEGMENTS = 6 };

/* The result of comparing two planes of one kind. Holds no memory. */
typedef struct CompareResult {
    PlaneKind kind;
    Tolerance tolerance;
    bool agrees;
    char reason[400]; /* a sentence about the first broken rule; "" if the planes agree */
    char cause[200];  /* what made B of A, where compare_cause found it; else "" */
    Rule rules[RULES_MAX];
    int n_rules;
    bool has_ids;            /* id planes were given: places carry ids */
    bool has_mask;           /* it is known which pixels show something */
    double values[MEASURES]; /* by MeasureId; NAN: has no meaning, or was not measured */
    PixelPlace places[PLACES];
    size_t classes[PIXEL_CLASSES];              /* pixels in each class */
    LedgerEntry worst_segments[WORST_SEGMENTS]; /* by differing pixels, most first */
    int n_worst_segments;
} CompareResult;

/* Returns a measure that is a count. It must have been measured. */
static inline size_t result_count(const CompareResult *result, MeasureId id)
{
    return (size_t)result->values[id];
}

/* Returns the name of what is compared: the tolerance's title or the plane's name. */
const char *result_title(const CompareResult *result);

#endif
