/* The door of the room compare: two images -> metrics, verdict, pictures, report. Of two images the
 * first, A, is the reference and the second, B, is judged against it. */
#ifndef CORCAST_COMPARE_COMPARE_H
#define CORCAST_COMPARE_COMPARE_H

#include "base/base.h"
#include "compare/cause/picture_fault.h" // IWYU pragma: export
#include "compare/cause/power.h"         // IWYU pragma: export
#include "compare/rules/settled.h"       // IWYU pragma: export
#include "compare/suite/suite.h"         // IWYU pragma: export
#include "compare/rules/surface_check.h" // IWYU pragma: export
#include "compare/rules/witness.h"       // IWYU pragma: export
#include "image/image.h"

typedef enum PlaneKind { PLANE_COLOR, PLANE_DEPTH, PLANE_NORMAL, PLANE_ID, PLANE_KINDS } PlaneKind;

/* "color", "depth", "normal", "id". */
const char *plane_kind_name(PlaneKind kind);

/* What is still agreement. A limit in parts per million is of the pixels judged; INFINITY (SIZE_MAX
 * for a count) leaves a rule unjudged. A NaN is never tolerated. Tolerances name a tier:
 * A, identity: what two renderers that do the same arithmetic can keep. Where both round one value
 * exactly between two codes, one of them may round it the other way.
 * B, tolerant: what one keeps that does it in another precision; local faults cannot hide in it,
 * because it judges what lies on the edges apart from what lies within them, signed differences,
 * and every segment for itself.
 * Perceptual measures belong to no tier: they are reported and judge nothing. */
typedef struct Tolerance {
    const char *tier;       /* its name in verdicts: "A", "B", "surface"; borrowed */
    double color_levels;    /* 8-bit levels a pixel may be off and count as the same ... */
    double color_ppm;       /* ... and how many may be off by more */
    bool color_common_only; /* judge the colour only of pixels seen in both */
    double interior_levels; /* 8-bit levels a pixel off the band may be off at most */
    double interior_ppm;    /* of the pixels off the band, how many may be off by more than
                             * color_levels ... */
    double band_ppm;        /* ... and of those in it */
    double bias_levels;     /* mean of B - A over all pixels, the worst channel */
    double sign_sigma;      /* |m - n| / sqrt(m + n), of m pixels brighter and n darker in B: chance
                             * gives 1, an error of a shading model any number */
    double gain;            /* |1 - g| of b = g a + o, least squares over the pixels seen in both,
                             * less two standard errors of g; likewise |o| */
    double offset_levels;   /* |o| of it */
    double silhouette_px;   /* by how much the outline of what is seen has moved outwards */
    double segment_levels;  /* mean of B - A over one segment's pixels, the worst channel */
    double segment_px;      /* by how much the outline of one segment has moved outwards */
    size_t segments_missing; /* segments of more than 2 pixels seen in only one image */
    double id_ppm;           /* pixels with different ids ... */
    double id_interior_ppm;  /* ... off the band, of those off it ... */
    double id_band_ppm;      /* ... and in the band, of those in it */
    double depth_max_mm;     /* for one pixel ... */
    double depth_ppm;        /* ... and how many may exceed it */
    double depth_p99_mm;     /* 99th percentile */
    double depth_p99_part;   /* likewise, of differences over the depth in A */
    double normal_max_deg;   /* for one pixel ... */
    double normal_ppm;       /* ... and how many may exceed it */
    double normal_median_deg;
    double coverage_ppm;   /* pixels seen in only one of the two, depth and normal planes */
    size_t region_pixels;  /* largest 8-connected region of missing, or of extra, pixels */
    double pixelmatch;     /* threshold of pixelmatch, in [0, 1]; NAN: not counted */
    double pixelmatch_ppm; /* pixels that it finds different */
    /* In a picture of at least SPARE_OF pixels, one pixel may be off by up to this many 8-bit
     * levels and is not counted in color_ppm: 2 pixels in a million are less than one in most
     * pictures. 0: none. In no file. */
    double spare_levels;
    const char *title; /* of what is compared, in verdicts; NULL: the plane's name. Borrowed ... */
    /* SettledCause of each pixel; no limit counts those that are settled. NULL: none is. Borrowed,
     * and both in no file. */
    const uint8_t *settled;
} Tolerance;

enum { SPARE_OF = 1000 };

/* Nothing is judged but NaN; `tier` is "none". */
Tolerance tolerance_none(void);
/* Tier A, identity: except for 2 pixels in a million, and for one pixel that is off by one level
 * (spare_levels), colours are off by no code of 8 bits and by at most one of 16, ids are equal,
 * depth is within one step of the reference's quantisation and normals within 0.03 degrees; and off
 * the edges no colour is off by more than a level. */
Tolerance tolerance_identity(double depth_step_mm);
/* Tier B: what a renderer in single precision keeps, whatever the scene. */
Tolerance tolerance_tolerant(double depth_step_mm);
/* Implicit surfaces, whose points both sides find by iteration: colours within 2 levels but for
 * 2000 ppm of the pixels off the edges and 15,000 ppm of those at them, of one gain to 0.0005 and
 * one offset to 0.15 levels, no segment brighter or darker by more than a level on average, no
 * outline of one off by 0.15 px, no region of more than 2 pixels missing or extra; depth at the
 * 99th percentile within `depth_mm`, or, where that is 0, 10^-4 of the depth. */
Tolerance tolerance_surface(double depth_mm);
/* Changes what an INI file names: "color_ppm = 20", the keys being the fields of Tolerance, "inf"
 * leaving a rule unjudged; `tier = NAME` is optional, "given" otherwise, and kept in *name (owned),
 * its control characters as blanks. STATUS_INPUT naming file and line on an unknown key and on a
 * value below 0. */
MUST_CHECK Status tolerance_read(Tolerance *tolerance, char **name, const char *path, Err *err);

typedef struct PixelPlace {
    int x, y; /* from the top left; -1 when there is no such pixel */
    uint32_t id_a, id_b;
} PixelPlace;

/* One limit, and the measured value that it is for. */
typedef struct Rule {
    char name[64];    /* "pixels off by more than 2 levels" */
    const char *unit; /* "ppm", "mm", "pixels" */
    double measured, allowed;
    bool met;
    PixelPlace at;    /* a pixel to look at; x is -1 when none stands out */
    char at_what[48]; /* what is there: "the worst, 155 levels," */
} Rule;

enum { RULES_MAX = 16 };

/* Every pixel of a picture is in exactly one class, the first that fits. */
typedef enum PixelClass {
    PIXEL_SETTLED,       /* differs, and is known to be A's fault */
    PIXEL_MISSING,       /* seen in A only, off the band */
    PIXEL_EXTRA,         /* seen in B only, off the band */
    PIXEL_WRONG_SEGMENT, /* seen in both with different ids, off the band */
    PIXEL_EDGE,          /* ids differ, in the band: pixels that touch (8-neighbours) a pixel of
                          * another id in either image; the silhouette */
    PIXEL_SHADOW,        /* ids and geometry agree, one is over 1.5 times as bright as the other */
    PIXEL_GEOMETRY,      /* ids agree, depth or normal does not */
    PIXEL_SHADING,  /* ids agree, and geometry where known; colour is off by more than a code */
    PIXEL_ROUNDING, /* likewise, by one code */
    PIXEL_IDENTICAL,
    PIXEL_CLASSES
} PixelClass;

/* "missing", "extra", "wrong_segment", "edge", ... */
const char *pixel_class_name(PixelClass pixel_class);

/* What is known of one segment in two images; B against A. */
typedef struct LedgerEntry {
    uint32_t id;
    size_t area_a, area_b;        /* pixels */
    size_t common;                /* pixels that show it in both */
    size_t differing;             /* pixels that show it in either and differ in colour or id */
    double outline_px;            /* length of its outline in A, in B where A does not show it */
    double signed_levels[3];      /* mean of B - A over the common pixels, each channel */
    double gain;                  /* g of b = g a, least squares over them; NAN where a is black */
    double moved_px;              /* (area_b - area_a) / outline_px: outwards is positive */
    double max_levels;            /* largest difference of a common pixel */
    int left, top, right, bottom; /* box of its pixels in either image, inclusive */
} LedgerEntry;

typedef struct Ledger {
    LedgerEntry *entries; /* owned; ids ascend */
    size_t n;
} Ledger;

void ledger_release(Ledger *ledger);
/* The signed difference of the worst channel. */
double ledger_entry_levels(const LedgerEntry *entry);
/* Appends the ledger as CSV with a header line. */
void ledger_csv(const Ledger *ledger, Text *out);

enum { WORST_SEGMENTS = 6 };

/* What a comparison of two planes of one kind found. Numbers without meaning for the kind, or that
 * could not be measured, are NAN. */
typedef struct CompareResult {
    PlaneKind kind;
    Tolerance tolerance; /* its tier is borrowed from the caller */
    bool agrees;
    char reason[400]; /* a sentence about the first rule broken; "" when the planes agree */
    char cause[200];  /* what made B of A, where compare_cause found it; else "" */
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
    size_t nan_pixels_a, nan_pixels_b; /* values that are no number, or, of colours, not finite */
    PixelPlace nan_at;                 /* the first */
    size_t differing_pixels;           /* not equal in some channel */
    size_t beyond_pixels;              /* off by more than the tolerance lets one pixel be */
    size_t settled_pixels;             /* likewise, but settled, and so in no rule */
    size_t judged_pixels;              /* what ppm refers to */
    PixelPlace worst;                  /* the first pixel with the largest difference */

    /* Colour, in 8-bit levels whatever the depth (a 16-bit code is 1/257 level). */
    double max_abs, mean_abs, rmse;
    double unsettled_max_abs; /* largest difference of a pixel that is not settled */
    double max_code;          /* in codes */
    double psnr_db;           /* INFINITY for equal pictures */
    double bias_levels;
    double sign_sigma; /* signed: positive where B is brighter more often than darker */
    size_t classes[PIXEL_CLASSES];

    /* Where a mask is known. Lengths of outlines are counted as edges between pixels times pi / 4
     * [Cauchy-Crofton, two directions]. */
    size_t band_pixels;                  /* with different labels nearby, in either image */
    size_t band_beyond, interior_beyond; /* pixels beyond, in the band and off it */
    double interior_max_abs;             /* levels, off the band */
    double edge_mismatch_fraction;       /* of the band's pixels, those whose ids differ */
    double silhouette_px;                /* outline of what is seen, outwards; px */
    double gain, offset_levels;          /* b = gain a + offset over pixels seen in both */
    double gain_error, offset_error;     /* standard errors of both; levels of the offset */

    /* Where ids are known: of segments of at least 64 common pixels, or with outlines of at least 8
     * px, the one that is off most. */
    size_t segments, segments_missing;
    double segment_levels, segment_px;
    PixelPlace segment_levels_at, segment_px_at, segment_missing_at;
    LedgerEntry worst_segments[WORST_SEGMENTS]; /* by differing pixels, most first */
    int n_worst_segments;

    /* Perception: reported, never judged. */
    double flip_mean, flip_max; /* LDR-FLIP 1.6 at 67.02 pixels per degree */
    double hdr_flip_mean;       /* of float colours */
    double ssim;                /* of luma, Wang 2004; NAN below 11 x 11 pixels */
    double de2000_mean, de2000_max;
    double pixelmatch_pixels; /* NAN unless the tolerance asks for it */

    /* Depth (mm) and normal (degrees), over common pixels; percentiles by nearest rank. */
    double median, p99, max;
    double p99_part; /* of depths: the 99th percentile of differences over the depth in A */
} CompareResult;

/* One rendering of a scene, as far as it is known. All is borrowed. */
typedef struct Rendering {
    const Picture *picture;
    const IdPlane *ids;          /* NULL, then in both views: silhouettes are found by the colour of
                                  * the background, where three corners of each picture share one */
    const Plane *depth, *normal; /* NULL, then in both views: geometry is not told from shading */
    const Picture *transparent;  /* The same picture before it was laid on a background, for
                                  * pixelmatch alone; NULL or without codes: it was opaque. */
} Rendering;

/* What differs at a pixel by more than the tolerance allows for one pixel: its colour; its id,
 * depth or normal. */
enum { BEYOND_COLOR = 1, BEYOND_GEOMETRY = 2 };
/* These as bits, 0 where the pixel is within the tolerance. Both renderings have all planes, of one
 * shape. */
unsigned pixel_beyond(const Rendering *a, const Rendering *b, size_t pixel,
                      const Tolerance *tolerance);

/* Compares two pictures, perception left out. `ledger` takes a row for each segment (owned),
 * is empty without ids, and may be NULL. STATUS_INPUT when sizes, channels or bits differ. */
MUST_CHECK Status compare_pictures(const Rendering *a, const Rendering *b,
                                   const Tolerance *tolerance, CompareResult *result,
                                   Ledger *ledger, Err *err);
/* Takes alpha of an image that image_read_transparent read, as a grey picture of 16 bits; leaves
 * *alpha alone where the image is opaque. */
MUST_CHECK Status alpha_take(Picture *alpha, const Image *image, Err *err);
/* Judges alpha of two transparent pictures whose colours agree, by the tolerance of the colours:
 * where it differs by more the result differs, with a reason and a cause. Where one of them is
 * empty, an opaque picture is compared with one that was laid on a background, and alpha is not
 * judged. */
MUST_CHECK Status alpha_judge(const Picture *a, const Picture *b, CompareResult *result, Err *err);
/* Adds FLIP, SSIM and CIEDE2000 of the two pictures compared. */
MUST_CHECK Status compare_perception(const Picture *a, const Picture *b, CompareResult *result,
                                     Err *err);
/* The class of every pixel, a PixelClass, as a grey picture of 8 bits. */
MUST_CHECK Status class_picture(Picture *out, const Rendering *a, const Rendering *b,
                                const Tolerance *tolerance, Err *err);
/* Says in result->cause what made B of A, of the same gamma, where that is certain: turned,
 * mirrored or with other channels, moved by pixels and parts of them, blurred, brighter or darker
 * throughout, one thing missing, other outlines only, other highlights or shades only; "" where it
 * is unknown. */
MUST_CHECK Status compare_cause(const Picture *a, const Picture *b, CompareResult *result,
                                Err *err);
/* Whether two renderings with noise have one mean. */
typedef struct NoiseResult {
    bool agrees;
    double rate;          /* of false alarms, of the whole test */
    double sigmas, limit; /* of the whole picture, the worst channel or all; what chance allows */
    double gain;          /* of that channel: the mean of B over that of A, weighted */
    double tile_sigmas, tile_limit; /* of the worst tile of 32 x 32 pixels */
    PixelPlace tile;                /* its first pixel; no ids */
} NoiseResult;

/* Compares two planes of linear colours whose noise has the same variance, given for each value, of
 * one rendering. It calls pictures of one mean different at most at this rate, in (0, 1).
 * STATUS_INPUT when shapes differ, a value is not finite or a variance below 0. */
MUST_CHECK Status compare_noise(const Plane *a, const Plane *b, const Plane *variance, double rate,
                                NoiseResult *result, Err *err);
/* The variance of each value over n >= 2 renderings (new plane). STATUS_INPUT when sizes differ. */
MUST_CHECK Status noise_of_renderings(const Plane *renderings, size_t n, Plane *variance, Err *err);
/* Compares two planes of linear colours, which may exceed 1, in levels of their sRGB encoding,
 * continued beyond white and mirrored below black. Pixels with a value that is not finite are
 * counted and enter nothing else. The id planes, both or neither NULL, only name segments. Adds
 * HDR-FLIP when `perception`, and the other measures of perception, of colours clipped to white. */
MUST_CHECK Status compare_colors(const Plane *a, const Plane *b, const IdPlane *id_a,
                                 const IdPlane *id_b, const Tolerance *tolerance, bool perception,
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

typedef struct FlipSummary {
    double mean, max; /* over all pixels, in [0, 1] */
} FlipSummary;

/* LDR-FLIP [Andersson et al. 2020, Proc. ACM CGIT 3(2), 15; version 1.6] of two pictures of the
 * same shape, taken as sRGB. The error of each pixel in [0, 1] goes to *map (owned; 1 channel),
 * which may be NULL. */
MUST_CHECK Status flip_compute(const Picture *a, const Picture *b, Plane *map, FlipSummary *summary,
                               Err *err);
/* HDR-FLIP [Andersson et al. 2021, HPG short papers; version 1.6] of two planes of linear colours,
 * of finite values, of the same shape: the largest LDR-FLIP over exposures chosen by the luminance
 * of A, tone mapped by ACES. */
MUST_CHECK Status hdr_flip_compute(const Plane *a, const Plane *b, Plane *map, FlipSummary *summary,
                                   Err *err);
/* Mean SSIM of luma [Wang et al. 2004, IEEE Trans. Image Process. 13, 600]: 11 x 11 Gaussian of
 * sigma 1.5, over the pixels whose window lies inside; NAN in *ssim when there are none. */
MUST_CHECK Status ssim_compute(const Picture *a, const Picture *b, double *ssim, Err *err);
/* The colour difference CIEDE2000 [Sharma, Wu, Dalal 2005, Color Res. Appl. 30, 21] of two CIELAB
 * colours. */
double de2000(const double lab_a[3], const double lab_b[3]);
/* Its mean and largest value over two pictures of the same shape, taken as sRGB under D65. */
MUST_CHECK Status de2000_compute(const Picture *a, const Picture *b, double *mean, double *max,
                                 Err *err);
/* Counts the pixels that pixelmatch 7.2.0 finds different at a threshold in [0, 1] (its default is
 * 0.1), without those that it takes for antialiasing. The pictures have one size and 1, 3 or 4
 * channels each, the fourth alpha. 16-bit codes are rounded to 8 bits. */
size_t pixelmatch_count(const Picture *a, const Picture *b, double threshold);

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
MUST_CHECK Status heat_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* The signed difference as an 8-bit picture: 128 + 8 (B - A) in 8-bit levels, clipped; grey where
 * they are equal. */
MUST_CHECK Status difference_picture(Picture *out, const Picture *a, const Picture *b, Err *err);
/* Appends a PNG that shows A and B in turn for half a second each, for ever [APNG 1.0]; viewers
 * that do not know animations show A. */
MUST_CHECK Status flicker_png(const Picture *a, const Picture *b, Text *out, Err *err);

/* A comparison as JSON, with the keys of `compare --json`; what is NAN or infinite is null. New
 * reference, NULL when memory runs out. */
json_t *compare_json(const CompareResult *result);
/* Appends the JUnit XML of a comparison that took `seconds`: a test case for each rule, the time
 * shared among them. `name` is of the suite. */
void compare_junit(const CompareResult *result, const char *name, double seconds, Text *out);
/* Appends what was measured, for people: the verdict, the rules, the measures, one a line. */
void compare_text(const CompareResult *result, Text *out);

/* One of the two programs that rendered a scene. All is borrowed. */
typedef struct ReportSide {
    const char *name;    /* "POV-Ray" */
    const char *key;     /* in JSON: "povray", "native" */
    const char *version; /* "3.7.0.10" */
    double seconds;      /* wall-clock time of the colour picture; of its tiles, all together */
    size_t tiles;        /* that it was drawn in; 0: not said */
    const Picture *picture;
    const IdPlane *ids;          /* or NULL, then in both */
    const Plane *depth, *normal; /* likewise */
} ReportSide;

/* One scene rendered by both. All is borrowed. */
typedef struct ReportCase {
    const char *name;            /* of the scene: "demo"; one line of UTF-8 */
    const char *model;           /* "rounded" */
    ReportSide a, b;             /* reference and candidate */
    const char *const *commands; /* how to repeat it, one a line */
    size_t n_commands;
    const CompareResult *planes[PLANE_KINDS]; /* NULL where not compared; colour is required */
    const SurfaceCheck *surface;              /* of an implicit model; NULL: of no such model */
    const CompareResult *alpha;               /* of a transparent picture; NULL: of an opaque one */
    const CompareResult
        *exact; /* of an implicit model, the colours of the surface where it is against A's */
    const Settled *settled; /* NULL: nobody was asked */
    const Witness *witness; /* NULL: there is none */
} ReportCase;

/* Whether every plane agrees, and the surface, not too much is settled, and no witness differs. */
bool report_agrees(const ReportCase *report);
/* The report as JSON, with the keys of `verify --json`. New reference, NULL when memory runs out.
 */
json_t *report_json(const ReportCase *report);
/* Writes report.html (from the templates in the folder `templates`), report.json, junit.xml and
 * diff.png into `folder`, which exists. The page holds its pictures and works from disk without a
 * network. */
MUST_CHECK Status report_write(const ReportCase *report, const char *templates, const char *folder,
                               Err *err);
/* Writes the page alone, to `path`; the colours of the case were compared, its model may be "", and
 * a side may have no version (""), and no seconds (NAN). */
MUST_CHECK Status report_write_page(const ReportCase *report, const char *templates,
                                    const char *path, Err *err);
/* Writes one page about all cases that report_write wrote about, worst first, to `path`. `power` is
 * the file that `make power` leaves, or NULL; `all_agree` tells whether all of them do.
 * STATUS_INPUT when a folder has no report of this version. */
MUST_CHECK Status report_merge(const char *const *folders, size_t n, const char *power,
                               const char *templates, const char *path, bool *all_agree, Err *err);

#endif
