/* Declares the options of the command `compare`, and computes the tolerance from them. Image A is
 * the reference, and image B is judged. All strings in the option structs are borrowed from the
 * parsed command line. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H
#define CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H

#include "compare/compare.h"
#include "image/image.h"
#include "options/options.h"

/* The built-in tolerances, called tiers: tier A for renderers with the same arithmetic, tier B for
 * single precision, `surface` for implicit surfaces, and `none`, which judges nothing. See
 * compare/rules/tolerance.h. */
typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

/* The options that define the tolerance. A member `has_X` is true if X is specified. */
typedef struct JudgeOptions {
    Tier tier;
    const char *tolerance; /* file with limits that replace limits of the tier; NULL: none. If a
                            * file is specified and `tier` is not, the file replaces limits of
                            * TIER_NONE, which judges only NaN values. */
    bool has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels;     /* maximum difference of a pixel, in levels of 1/255 */
    double ppm;        /* parts per million of the pixels that may differ by more than `levels` */
    double pixelmatch; /* threshold of pixelmatch, in [0, 1] */
} JudgeOptions;

extern const OptionTable judge_options; /* sets a JudgeOptions */

/* An image in memory that is compared instead of a file. Both pointers are borrowed. Both NULL:
 * there is no such image. */
typedef struct GivenImage {
    const Image *image; /* integer codes or floats, with or without alpha */
    const IdPlane *ids; /* id of the visible segment per pixel; NULL: unknown */
} GivenImage;

/* The options of `compare`. Texts and paths: NULL: not specified. */
typedef struct CompareOptions {
    PlaneKind kind; /* what the files contain; PLANE_KINDS: derived from the name of file A */
    JudgeOptions judge;
    const char *ids_a, *ids_b; /* files of the id planes of A and B */
    const char *layer;         /* name of the layer or part that is read from OpenEXR files */
    int bits; /* 0: pictures are compared as stored; 1: they are first converted to 8-bit sRGB; 2:
               * to 16-bit sRGB */
    const char *heat, *difference; /* output images: map of the differences; B - A */
    const char *flicker;           /* output animated PNG that alternates between A and B */
    const char *ledger;            /* output .csv: measures per segment */
    const char *page, *junit;      /* output .html report; output JUnit XML */
    const char *report;            /* output folder of a report with pictures */
    const char *reference; /* folder of reference images; the operand is then the folder of the
                            * images to judge */
    const char *only;   /* shell pattern of the names of the images that are compared; NULL: all */
    const char *accept; /* shell pattern of the names of the images that replace their references */
    const char *reason; /* with `accept`: the reason, which is recorded */
    /* with `accept`: label of an additional reference beside the existing ones */
    const char *label;
    const char *machine; /* with `accept`: name of the machine, recorded with a reference */
    /* with `accept`: last day on which the reference is valid, recorded with it */
    const char *expires;
    const char *noise, *variance; /* noisy images: paths of further renderings, separated by commas;
                                   * or the file of the variance per pixel */
    double alarms;                /* false alarm rate of the noise test, in (0, 1) */
    bool serve;                /* the caller answers requests from standard input; not used here */
    bool json;                 /* the caller prints the result as JSON; not used here */
    bool metrics, has_metrics; /* `metrics`: perceptual measures are computed; `has_metrics`:
                                * `metrics` is specified */
    double depth_mm;           /* maximum difference of depths; 0: not specified */
    Vec3 background;     /* color over which transparent images are composited; sRGB in [0, 1] */
    GivenImage given[2]; /* A and B in memory, used instead of the operands; set by the caller;
                          * zeroed: A and B are files */
} CompareOptions;

extern const OptionTable compare_options; /* sets a CompareOptions, except `judge` and `given` */
/* Sets the defaults of a zeroed CompareOptions. */
void compare_set_defaults(void *options);
/* Returns the conditions for options to have an effect [options/conditions.h] that two files of
 * this kind do not meet. */
ConditionSet compare_unmet(PlaneKind kind);

/* Computes the tolerance. Starts with the limits of the tier. The limits in the tolerance file
 * replace them. Limits from other options replace both.
 *
 * depth_mm   maximum difference of depths; 0: not specified.
 * tolerance  borrows *name.
 * name       receives the name that the tolerance file states, or "given". The caller frees it
 *            after the last use of the tolerance. Unchanged without a tolerance file.
 * Errors     STATUS_INPUT, with file and line, for a malformed file; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status compare_tolerance(const JudgeOptions *options, double depth_mm,
                                    Tolerance *tolerance, char **name, Err *err);

#endif
