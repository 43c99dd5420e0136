/* The options of `compare`, and the tolerance that they state. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H
#define CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H

#include "compare/compare.h"
#include "image/image.h"
#include "options/options.h"

/* Tolerances that are built in. */
typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

/* The options that state a tolerance. A member `has_X` says whether X is stated. */
typedef struct JudgeOptions {
    Tier tier;
    const char *tolerance; /* file that changes the tier; NULL: none */
    bool has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels;     /* 8-bit levels that a pixel may be off */
    double ppm;        /* pixels per million that may be off by more */
    double pixelmatch; /* threshold of pixelmatch, 0..1 */
} JudgeOptions;

extern const OptionTable judge_options; /* sets a JudgeOptions */

/* An image in memory that stands in for a file. The pointers are borrowed; NULL: there is none. */
typedef struct GivenImage {
    const Image *image; /* codes or floats, with or without alpha */
    const IdPlane *ids;
} GivenImage;

/* What the options of `compare` set. Files and texts that are not given are NULL. */
typedef struct CompareOptions {
    PlaneKind kind; /* what the files hold; PLANE_KINDS: decided by their names */
    JudgeOptions judge;
    const char *ids_a, *ids_b; /* id planes of both sides */
    const char *layer;         /* layer or part of OpenEXR files that is read */
    int bits; /* pictures are converted to sRGB of 8 * bits bits; 0: they are not */
    const char *heat, *difference, *flicker, *ledger, *page, *junit; /* files that are written */
    const char *report;                                              /* folder that is written */
    const char *reference;        /* folder of reference images; the operand is a folder, too */
    const char *accept, *reason;  /* the image that becomes its reference, and why */
    const char *noise, *variance; /* noisy images: other renderings, or a file of variances */
    double alarms;                /* rate of false alarms of the noise test, 0..1 */
    bool json;                    /* for the command line: the result is printed as JSON */
    bool metrics, has_metrics;    /* perceptual measures are computed; whether this is stated */
    double depth_mm;              /* maximum difference of depths; 0: not stated */
    Vec3 background;              /* transparent images are composited over it; sRGB in [0, 1] */
    GivenImage given[2];          /* stand in for the operands; set by the caller; zeroed: none */
} CompareOptions;

extern const OptionTable compare_options; /* sets a CompareOptions, except `judge` */
void compare_set_defaults(void *options);
/* Returns the conditions of options that do not hold for two files of this kind. */
ConditionSet compare_unmet(PlaneKind kind);

/* Finds the tolerance: the tier, changed by the tolerance file, changed by single limits.
 *
 * depth_mm   maximum difference of depths; 0: not specified.
 * name       receives the tier's name if the file states one (owned); the tolerance borrows it.
 * Errors     STATUS_INPUT if the file is bad, STATUS_MEMORY. */
MUST_CHECK Status compare_tolerance(const JudgeOptions *options, double depth_mm,
                                    Tolerance *tolerance, char **name, Err *err);

#endif
