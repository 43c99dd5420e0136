/* Declares the result of comparing two images, and the tolerance that decides whether they agree.
 *
 * Terms of the module compare:
 *   A, B       the two images: A is the reference, B is judged. Differences are B - A.
 *   code       the integer that a pixel's channel is stored as, 0 to 255 or 65535.
 *   level      1/255 of the range of codes, for images of all bit depths. Linear float
 *              colors are converted to levels by the sRGB curve, extrapolated above 1.
 *   label      what a pixel shows: the id of a segment, or 0 for the background.
 *   edge       a pixel is at an edge if one of its 8 neighbours has another label in A or
 *              in B. The pixels at edges form the band; all other pixels are the interior.
 *   settled    a differing pixel is settled if a third computation has shown that A is wrong
 *              there and B is right (compare/checks/settled.h).
 *   tier       a named, built-in tolerance (compare/rules/tolerance.h). The names A and B of
 *              two tiers do not refer to the images.
 *   measure    a number that is computed from both images.
 *   limit      the largest value of a measure with which the images agree. */
#ifndef CORCAST_COMPARE_RESULT_H
#define CORCAST_COMPARE_RESULT_H

#include "base/base.h"
#include "image/image.h"

typedef enum PlaneKind { PLANE_COLOR, PLANE_DEPTH, PLANE_NORMAL, PLANE_ID, PLANE_KINDS } PlaneKind;

/* Returns "color", "depth", "normal" or "id". */
const char *plane_kind_name(PlaneKind kind);

/* One rendering of a scene. All planes have equal size. All members are borrowed. Each comparison
 * function reads only the members that its contract names. */
typedef struct Rendering {
    const Picture *picture; /* integer codes */
    const Plane *color;     /* linear colors in floats, which may exceed 1 */
    /* id of the visible segment per pixel. NULL in both renderings: unknown; the background of a
     * picture is then the color of at least three of its four corners. */
    const IdPlane *ids;
    const Plane *depth, *normal; /* distance from the camera, mm, and unit normals. NULL in both
                                  * renderings: unknown */
    const Picture *transparent;  /* The picture before it was composited over a background, for
                                  * pixelmatch; NULL or without codes: the picture was opaque. */
} Rendering;

/* ---- tolerance ------------------------------------------------------------------------------- */

/* The numbers of a tolerance: first limits, in the order in which they are judged, then settings.
 * Limits in ppm are parts per million of MEASURE_JUDGED_PIXELS. A pixel is "beyond" a setting if
 * its difference is larger than the setting. */
typedef enum Limit {
    LIMIT_NONE,              /* no limit: the measure is reported and not judged */
    LIMIT_NAN,               /* pixels with a value that is not a number; the limit is always 0 */
    LIMIT_REGION_PIXELS,     /* size of the largest 8-connected region of pixels that show a vessel
                              * only in A, or only in B */
    LIMIT_COVERAGE_PPM,      /* depth and normal: pixels that show a surface in one image only */
    LIMIT_SEGMENTS_MISSING,  /* segments that cover more than 2 pixels, in one image only */
    LIMIT_SILHOUETTE_PX,     /* shift of the outline of all vessels together */
    LIMIT_COLOR_PPM,         /* pixels beyond LIMIT_COLOR_LEVELS */
    LIMIT_INTERIOR_LEVELS,   /* largest difference of a pixel in the interior */
    LIMIT_INTERIOR_PPM,      /* of the interior: pixels beyond LIMIT_COLOR_LEVELS */
    LIMIT_BAND_PPM,          /* of the pixels at edges: pixels beyond LIMIT_COLOR_LEVELS */
    LIMIT_SEGMENT_PX,        /* shift of the outline of one segment */
    LIMIT_SEGMENT_LEVELS,    /* mean difference of one segment, in the worst channel */
    LIMIT_GAIN,              /* |1 - g| of B = g A + o, minus two standard errors of g */
    LIMIT_OFFSET_LEVELS,     /* |o| of B = g A + o, minus two standard errors of o */
    LIMIT_BIAS_LEVELS,       /* mean difference of all pixels, in the worst channel */
    LIMIT_SIGN_SIGMA,        /* |m - n| / sqrt(m + n); m pixels are brighter and n darker in B */
    LIMIT_PIXELMATCH_PPM,    /* pixels that pixelmatch marks at threshold LIMIT_PIXELMATCH */
    LIMIT_ID_PPM,            /* pixels with different ids */
    LIMIT_ID_INTERIOR_PPM,   /* of the interior: pixels with different ids */
    LIMIT_ID_BAND_PPM,       /* of the pixels at edges: pixels with different ids */
    LIMIT_DEPTH_PPM,         /* pixels beyond LIMIT_DEPTH_MAX_MM */
    LIMIT_DEPTH_P99_MM,      /* 99th percentile of depth differences */
    LIMIT_DEPTH_P99_PART,    /* 99th percentile of depth difference / depth in A */
    LIMIT_NORMAL_PPM,        /* pixels beyond LIMIT_NORMAL_MAX_DEG */
    LIMIT_NORMAL_MEDIAN_DEG, /* median angle between normals */
    /* Settings of measures: the maximum difference of a pixel that counts as equal, and others. */
    LIMIT_COLOR_LEVELS,      /* maximum difference of colors that count as equal */
    LIMIT_COLOR_COMMON_ONLY, /* 1: LIMIT_COLOR_PPM counts only pixels that show a vessel in both
                              * images; 0: it counts all pixels */
    LIMIT_DEPTH_MAX_MM,      /* maximum difference of depths that count as equal */
    LIMIT_NORMAL_MAX_DEG,    /* maximum angle between normals that count as equal */
    LIMIT_PIXELMATCH,        /* threshold of pixelmatch, in [0, 1]; NAN: pixelmatch does not run */
    LIMITS
} Limit;

/* The differences up to which two images agree. Perceptual measures (FLIP, SSIM, CIEDE2000) have no
 * limits. */
typedef struct Tolerance {
    const char *tier; /* name in verdicts: "A", "B", "surface" or "none" of a tier; else "given", or
                       * the name in a tolerance file; borrowed */
    double limits[LIMITS]; /* INFINITY: not judged */
    /* In a small picture a single pixel is more than LIMIT_COLOR_PPM. Therefore one pixel may be
     * beyond LIMIT_COLOR_LEVELS. Conditions: no unsettled pixel differs by more than spare_levels,
     * and at least SPARE_OF pixels are judged. 0: no exception, as in tolerance files. */
    double spare_levels;
    bool is_from_file;      /* two images that differ disagree if no limit applies to them */
    const char *title;      /* name of what is compared; NULL: the plane's name. Borrowed. */
    const uint8_t *settled; /* per pixel: a SettledCause; limits do not count settled pixels. NULL:
                             * no pixel is settled. Borrowed. */
} Tolerance;

/* Minimum number of judged pixels for the exception of Tolerance.spare_levels: one pixel is then at
 * most 0.1 % of them. */
enum { SPARE_OF = 1000 };

/* ---- measures -------------------------------------------------------------------------------- */

/* The measures of a comparison. The table in compare/measure.c contains, for each measure and kind
 * of plane, the key in JSON, the label and unit in texts, and the limit. */
typedef enum MeasureId {
    MEASURE_NONE,
    MEASURE_PIXELS,
    MEASURE_WIDTH,
    MEASURE_HEIGHT,
    MEASURE_BITS,             /* 8 or 16; 32: floats; 24: ids */
    MEASURE_DIFFERING_PIXELS, /* pixels that differ in some channel */
    /* Coverage, if it is known which pixels show a vessel. */
    MEASURE_MISSING_PIXELS,  /* show a vessel in A only */
    MEASURE_EXTRA_PIXELS,    /* show a vessel in B only */
    MEASURE_COMMON_PIXELS,   /* show a vessel in both images */
    MEASURE_UNCOMMON_PIXELS, /* missing and extra pixels */
    MEASURE_LARGEST_REGION,  /* pixels in the largest 8-connected region of missing, or of extra,
                              * pixels */
    MEASURE_NAN_PIXELS,      /* pixels with a value that is not a number, in A plus in B */
    MEASURE_NOT_FINITE,      /* as MEASURE_NAN_PIXELS, for float colors, infinities included */
    /* Pixels that limits count. */
    MEASURE_JUDGED_PIXELS, /* pixels that limits in ppm refer to */
    MEASURE_BEYOND_PIXELS, /* unsettled pixels that are beyond the setting of their plane:
                            * LIMIT_COLOR_LEVELS, LIMIT_DEPTH_MAX_MM or LIMIT_NORMAL_MAX_DEG; of id
                            * planes: unsettled pixels with different ids */
    MEASURE_SETTLED_PIXELS,
    MEASURE_BAND_PIXELS,       /* at edges */
    MEASURE_INTERIOR_PIXELS,   /* not at edges */
    MEASURE_BAND_BEYOND,       /* the part of MEASURE_BEYOND_PIXELS that is at edges */
    MEASURE_INTERIOR_BEYOND,   /* the part of MEASURE_BEYOND_PIXELS that is not at edges */
    MEASURE_UNSETTLED_MAX_ABS, /* levels; largest difference of a pixel that is not settled */
    /* Sizes of color differences, in levels; MEASURE_MAX_CODE in codes. */
    MEASURE_MAX_ABS,
    MEASURE_MAX_CODE,
    MEASURE_MEAN_ABS,
    MEASURE_RMSE,
    MEASURE_PSNR_DB, /* INFINITY: equal pictures */
    MEASURE_INTERIOR_MAX_ABS,
    MEASURE_EDGE_MISMATCH, /* fraction of the pixels at edges whose labels differ in A and B */
    MEASURE_EDGE_MISMATCH_PERCENT,
    /* Signed color differences. */
    MEASURE_BIAS_LEVELS,
    MEASURE_SIGN_SIGMA, /* positive: B is brighter more often than darker */
    MEASURE_GAIN,       /* g of the least squares fit B = g A + o over common pixels */
    MEASURE_OFFSET_LEVELS,
    MEASURE_GAIN_ERROR, /* standard errors of gain and offset */
    MEASURE_OFFSET_ERROR,
    MEASURE_GAIN_EXCESS,   /* max(0, |gain - 1| - 2 standard errors) */
    MEASURE_OFFSET_EXCESS, /* max(0, |offset| - 2 standard errors) */
    MEASURE_SILHOUETTE_PX, /* shift of the outline; positive: outwards */
    /* Segments, if ids are known. */
    MEASURE_SEGMENTS,
    MEASURE_SEGMENTS_MISSING,
    MEASURE_SEGMENT_LEVELS, /* of the worst segment with at least 64 common pixels; the mean of
                             * fewer pixels is too noisy */
    MEASURE_SEGMENT_PX, /* of the worst segment with an outline of at least 8 px; one pixel on it
                         * then counts as a shift of 0.125 px, below the limits of 0.15 px */
    /* Perception; reported only. FLIP 1.6 at its default of 67.02 pixels per degree: a 0.7 m wide
     * 4K screen seen from 0.7 m. */
    MEASURE_FLIP_MEAN,
    MEASURE_FLIP_P95,
    MEASURE_FLIP_MAX,
    MEASURE_FLIP_WEIGHTED_MEAN, /* the weight of each pixel is its FLIP error */
    MEASURE_FLIP_WEIGHTED_MEDIAN,
    MEASURE_FLIP_WEIGHTED_P95,
    MEASURE_HDR_FLIP_MEAN, /* of float colors */
    MEASURE_SSIM,          /* of luma; NAN below 11 x 11 pixels */
    MEASURE_DE2000_MEAN,
    MEASURE_DE2000_MAX,
    MEASURE_PIXELMATCH_PIXELS, /* NAN unless the tolerance has LIMIT_PIXELMATCH */
    /* Differences of depths in mm, angles between normals in degrees, over the common pixels.
     * Percentiles are by nearest rank. */
    MEASURE_MEDIAN,
    MEASURE_P99,
    MEASURE_MAX,
    MEASURE_P99_PART,          /* 99th percentile of depth difference / depth in A */
    MEASURE_MISMATCH_FRACTION, /* pixels with different ids / all pixels */
    MEASURES
} MeasureId;

typedef struct PixelPlace {
    int x, y;            /* from the top left; -1: there is no such pixel */
    uint32_t id_a, id_b; /* the segments that the pixel shows in A and in B; 0: none */
} PixelPlace;

/* Extends a rectangle so that it contains the pixel in column x and row y. A rectangle of width 0
 * is empty. */
void pixelrect_include(PixelRect *rect, int x, int y);

/* Pixels that a result reports as examples of the largest differences. */
typedef enum PlaceId {
    PLACE_WORST,           /* the first pixel with the largest difference */
    PLACE_REGION,          /* the first pixel of the largest region */
    PLACE_NAN,             /* the first pixel that is not a number */
    PLACE_SEGMENT_LEVELS,  /* center of the bounding box of the segment of MEASURE_SEGMENT_LEVELS */
    PLACE_SEGMENT_PX,      /* center of the bounding box of the segment of MEASURE_SEGMENT_PX */
    PLACE_SEGMENT_MISSING, /* center of the bounding box of a segment that is in one image only */
    PLACES
} PlaceId;

/* One limit, applied to one measure. */
typedef struct Rule {
    char name[64];    /* "pixels off by more than 2 levels" */
    const char *unit; /* "ppm", "mm", "pixels" */
    double measured, allowed;
    double of;        /* number of pixels that a limit in ppm refers to */
    bool met;         /* measured <= allowed */
    PixelPlace at;    /* an example of a pixel; x is -1 if there is none */
    char at_what[48]; /* description of `at`: "the worst, 155 levels, is" */
} Rule;

enum { RULES_MAX = 16 }; /* not less than the number of rules for any kind of plane */

/* The class of a pixel: the first of these whose condition holds. "Ids agree" means: A and B show
 * the same segment, or both the background. */
typedef enum PixelClass {
    PIXEL_SETTLED,       /* differs, and A is known to be wrong */
    PIXEL_MISSING,       /* shows a vessel in A only, not at an edge */
    PIXEL_EXTRA,         /* shows a vessel in B only, not at an edge */
    PIXEL_WRONG_SEGMENT, /* shows vessels with different ids, not at an edge */
    PIXEL_EDGE,          /* ids differ, at an edge */
    PIXEL_SHADOW,        /* ids and geometry agree; one is over 1.5 times as bright as the other */
    PIXEL_GEOMETRY,      /* ids agree; depth or normal differs */
    PIXEL_SHADING,       /* ids and geometry agree or are unknown; color differs by over one code */
    PIXEL_ROUNDING,      /* ids and geometry agree or are unknown; color differs by one code */
    PIXEL_IDENTICAL,
    PIXEL_CLASSES
} PixelClass;

/* Returns "missing", "extra", "wrong_segment", "edge" and so on. */
const char *pixel_class_name(PixelClass pixel_class);

/* The measures of one segment in two images. */
typedef struct LedgerEntry {
    uint32_t id;
    size_t area_a, area_b; /* pixels */
    size_t common;         /* pixels that show the segment in both images */
    size_t differing;  /* pixels that show the segment in either image, and differ in color or id */
    double outline_px; /* length of the segment's outline in A; in B if A does not show it */
    double signed_levels[3]; /* per channel: mean difference of the common pixels */
    double gain;             /* g of the least squares fit B = g A; NAN if A is black */
    double moved_px;         /* (area_b - area_a) / outline_px; positive: outwards */
    double max_levels;       /* largest difference of a common pixel */
    /* bounding box of the segment's pixels in both images, inclusive */
    int left, top, right, bottom;
} LedgerEntry;

/* The measures of all segments. Release it with ledger_release. */
typedef struct Ledger {
    LedgerEntry *entries; /* owned; ids ascend */
    size_t n;
} Ledger;

void ledger_release(Ledger *ledger); /* zeroes *ledger */
/* Returns the signed mean difference of the common pixels, in levels, in the channel in which its
 * magnitude is largest. */
double ledger_entry_levels(const LedgerEntry *entry);
/* Appends the ledger as CSV: a header line and one line per segment. If memory runs out, `out`
 * records it. */
void ledger_csv(const Ledger *ledger, Text *out);

/* Maximum number of segments that a result lists; keeps reports short. */
enum { WORST_SEGMENTS = 6 };

/* The result of comparing two planes of one kind. Owns nothing; `tolerance` has borrowed pointers.
 */
typedef struct CompareResult {
    PlaneKind kind;
    Tolerance tolerance;
    bool agrees;
    char reason[400]; /* a sentence about the first rule that is not met; "" if the planes agree */
    char cause[200];  /* sentence of compare_cause about the change that turned A into B; "" if
                       * unknown */
    PixelRect box;    /* bounding box of all pixels that differ, set by compare_cause; width 0:
                       * compare_cause was not called, or no pixel differs */
    Rule rules[RULES_MAX];
    int n_rules;
    bool has_ids;                  /* id planes were compared: `places` contain ids */
    bool has_mask;                 /* it is known which pixels show a vessel */
    double values[MEASURES];       /* by MeasureId; NAN: not defined, or not measured */
    PixelPlace places[PLACES];     /* by PlaceId */
    size_t classes[PIXEL_CLASSES]; /* pixels in each class */
    LedgerEntry worst_segments[WORST_SEGMENTS]; /* sorted by falling number of differing pixels */
    int n_worst_segments;
} CompareResult;

/* Returns a measure that is a count. The measure must not be NAN. */
static inline size_t result_count(const CompareResult *result, MeasureId id)
{
    return (size_t)result->values[id];
}

/* Returns the name of what is compared: the title of the tolerance, or else the name of the plane.
 * Borrowed from `result`. */
const char *result_title(const CompareResult *result);

enum { RESULT_SENTENCE = 700 }; /* a sufficient size for result_sentence, bytes */
/* Writes a sentence that states why two planes differ, the cause first: "likely cause: B is A moved
 * by (1, 0) pixels; 21.3 % of the pixels are off by more than 0 levels (allowed: 0.0002 %)". If the
 * cause of a difference of colors is unknown, it states the bounding box of all differences, unless
 * this box is most of the picture. Cuts the sentence at `size` bytes; RESULT_SENTENCE bytes hold
 * any sentence. */
void result_sentence(const CompareResult *result, char *out, size_t size);

#endif
