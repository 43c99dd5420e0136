/* The options of `compare`, and the tolerance that they state. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H
#define CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H

#include "compare/compare.h"
#include "image/image.h"
#include "options/options.h"

typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

/* The options that state a tolerance. */
typedef struct JudgeOptions {
    Tier tier;
    const char *tolerance;
    bool has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels, ppm, pixelmatch;
} JudgeOptions;

extern const OptionTable judge_options;

/* An image in memory that stands in for a file. The pointers are borrowed; NULL: there is none. */
typedef struct GivenImage {
    const Image *image; /* codes or floats, with or without alpha */
    const IdPlane *ids;
} GivenImage;

typedef struct CompareOptions {
    PlaneKind kind; /* PLANE_KINDS: by the files' names */
    JudgeOptions judge;
    const char *ids_a, *ids_b;
    const char *junit, *layer;
    int bits; /* index of bit_counts */
    const char *heat, *difference, *flicker, *ledger, *page, *report;
    const char *reference, *accept, *reason, *noise, *variance;
    double alarms;
    bool json, metrics, has_metrics;
    double depth_mm;
    Vec3 background;     /* sRGB in [0, 1] */
    GivenImage given[2]; /* stand in for the operands; set by the caller; zeroed: none */
} CompareOptions;

extern const OptionTable compare_options;
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
