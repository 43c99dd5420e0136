/* The options of `compare`, and what it does besides holding two files against each other. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H
#define CORCAST_JOB_VERIFY_COMPARE_OPTIONS_H

#include "compare/compare.h"
#include "options/options.h"

typedef enum Tier { TIER_A, TIER_B, TIER_SURFACE, TIER_NONE } Tier;

/* What is still agreement of two pictures. */
typedef struct JudgeOptions {
    Tier tier;
    const char *tolerance;
    bool has_tier, has_levels, has_ppm, has_pixelmatch;
    double levels, ppm, pixelmatch;
} JudgeOptions;

extern const OptionTable judge_options;

typedef struct CompareOptions {
    PlaneKind kind; /* PLANE_KINDS: by the files' names */
    JudgeOptions judge;
    const char *ids_a, *ids_b;
    const char *junit, *layer;
    int bits; /* index of bit_counts */
    const char *heat, *difference, *flicker, *ledger, *page, *report;
    const char *reference, *accept, *reason, *noise, *variance;
    double alarms;
    char *line; /* owned; the command */
    bool json, metrics, has_metrics;
    double depth_mm;
    Vec3 background; /* sRGB in [0, 1] */
} CompareOptions;

extern const OptionTable compare_options;
void compare_set_defaults(void *options);
/* Returns the conditions of options that do not hold for two files of this kind. */
ConditionSet compare_unmet(PlaneKind kind);

/* The tier, then the file, then single limits, each over the one before; depth_mm, of depth planes,
 * 0 where it is not given. *name owns the tier's name
 * when that comes from a file. */
MUST_CHECK Status compare_tolerance(const JudgeOptions *options, double depth_mm,
                                    Tolerance *tolerance, char **name, Err *err);

/* Tests whether two noisy pictures have one mean, and says so; STATUS_DIFFERS when not. */
MUST_CHECK Status compare_noisy(const CompareOptions *options, const Parsed *parsed, Err *err);

/* Holds a folder of pictures against that of references, or accepts a picture as one;
 * STATUS_DIFFERS when they disagree. */
MUST_CHECK Status compare_folders(const CompareOptions *options, const Parsed *parsed, Err *err);

#endif
