/* Declares the options of the command `compare`, and computes the tolerance from them.
 *
 * The command compares A, the reference, with B, the image that is judged. All strings in the
 * option structs are borrowed from the parsed command line. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H
#define CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H

#include "compare/compare.h"
#include "image/image.h"
#include "options/options.h"

/* The built-in tolerances, called tiers: A (identity), B (single precision), surface (implicit
 * surfaces) and none (nothing is judged). See compare/rules/tolerance.h. */
typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

/* The options that define the tolerance. A member `has_X` is true if X is specified. */
typedef struct JudgeOptions {
    Tier tier;
    const char *tolerance; /* file with limits that replace limits of the tier; NULL: none. With a
                            * file and without --tier, only NaNs are judged otherwise. */
    bool has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels;     /* maximum difference of a pixel, in levels of 1/255 */
    double ppm;        /* parts per million of the pixels that may differ by more */
    double pixelmatch; /* threshold of pixelmatch, in [0, 1] */
} JudgeOptions;

extern const OptionTable judge_options; /* sets a JudgeOptions */

/* An image in memory that is compared instead of a file. The pointers are borrowed. Both are NULL
 * if there is no such image. */
typedef struct GivenImage {
    const Image *image; /* integer codes or floats, with or without alpha */
    const IdPlane *ids; /* id of the visible segment per pixel; NULL: unknown */
} GivenImage;

/* The options of `compare`. Paths and texts that are not specified are NULL. */
typedef struct CompareOptions {
    PlaneKind kind; /* what the files contain; PLANE_KINDS: derived from the name of file A */
    JudgeOptions judge;
    const char *ids_a, *ids_b; /* files of the id planes of A and B */
    const char *layer;         /* layer or part that is read from OpenEXR files */
    int bits; /* 1, 2: pictures are converted to sRGB of 8 or 16 bits before they are compared;
               * 0: they are compared as stored */
    const char *heat, *difference, *flicker, *ledger, *page, *junit; /* output files */
    const char *report;                                              /* output folder */
    const char *reference; /* folder of reference images; the operand is then the folder of the
                            * images that are judged */
    const char *only;      /* pattern of the cases that are compared; NULL: all */
    const char *accept, *reason;  /* pattern of the cases that are accepted, and the reason */
    const char *label;            /* with `accept`: label of a further reference */
    const char *machine;          /* with `accept`: the machine that is stored with a reference */
    const char *expires;          /* with `accept`: the last day that is stored with a reference */
    const char *noise, *variance; /* test of noisy images: paths of other renderings, separated by
                                   * commas, or a file of variances per pixel */
    double alarms;                /* false alarm rate of the noise test, in (0, 1) */
    bool serve;                   /* the command line answers questions from standard input */
    bool json;                    /* the command line prints the result as JSON */
    bool metrics, has_metrics;    /* perceptual measures are computed; `metrics` is specified */
    double depth_mm;              /* maximum difference of depths; 0: not specified */
    Vec3 background;     /* color over which transparent images are composited; sRGB in [0, 1] */
    GivenImage given[2]; /* A and B in memory, used instead of the operands; set by the caller;
                          * zeroed: A and B are files */
} CompareOptions;

extern const OptionTable compare_options; /* sets a CompareOptions, except `judge` */
/* Sets the defaults of a zeroed CompareOptions. */
void compare_set_defaults(void *options);
/* Returns the set of option conditions (options/conditions.h) that are not met if two files of this
 * kind are compared. */
ConditionSet compare_unmet(PlaneKind kind);

/* Computes the tolerance. Starts with the limits of the tier. Limits from the tolerance file
 * replace them, and limits from other options replace those.
 *
 * depth_mm    maximum difference of depths; 0: not specified.
 * tolerance   borrows *name.
 * name        set only if there is a tolerance file: receives the name that the file
 *             specifies, or "given"; the caller frees it after the last use of the tolerance.
 * Errors      the errors of tolerance_read: STATUS_INPUT, STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_tolerance(const JudgeOptions *options, double depth_mm,
                                    Tolerance *tolerance, char **name, Err *err);

#endif
