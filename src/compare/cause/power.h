/* Measures what a rule finds: plants faults of every kind and size in a renderer's picture, and
 * asks the rule about each, beside rules that other projects publish. */
#ifndef CORCAST_COMPARE_CAUSE_POWER_H
#define CORCAST_COMPARE_CAUSE_POWER_H

#include "compare/cause/picture_fault.h"
#include <jansson.h>

/* A rule that a project publishes for its own tests. Either pixelmatch decides, or levels. */
typedef struct PublishedRule {
    const char *name;  /* "Blender" */
    const char *says;  /* the rule in words */
    double pixelmatch; /* no pixel may differ at this threshold of pixelmatch; NAN: levels decide */
    double levels, ppm; /* at most `ppm` of the pixels may be off by more than `levels` */
    double most_levels; /* no pixel may be off by more than this */
} PublishedRule;

enum { PUBLISHED_RULES = 5, POWER_RULES = 1 + PUBLISHED_RULES };
extern const PublishedRule published_rules[PUBLISHED_RULES];

/* The rule that is measured. `differs` sets *differs if the rule calls a picture different from the
 * reference; several threads call it at once. */
typedef struct PowerRule {
    const char *name;
    Status (*differs)(void *context, const Picture *reference, const Picture *picture,
                      bool *differs, Err *err);
    void *context;
} PowerRule;

/* A fault of one size. */
typedef struct PowerCase {
    const PictureFault *fault;
    double size;
    bool exists;             /* the fault changes some pixel's codes */
    bool found[POWER_RULES]; /* by the measured rule, then by the published rules */
} PowerCase;

typedef struct Power {
    const char *name;           /* of the measured rule; borrowed */
    PowerCase *cases;           /* owned; in the order of the faults, sizes rising */
    size_t n;                   /* number of cases */
    size_t planted;             /* number of cases that exist */
    size_t missed[POWER_RULES]; /* number of these that the rule does not find */
    bool alarm[POWER_RULES];    /* the rule calls the two drawings without a fault different */
    bool repeats;               /* the two drawings are equal */
    int width, height, bits;
} Power;

/* What power_measure plants faults in. All members are borrowed. */
typedef struct PowerInput {
    const Picture *reference, *drawn; /* two drawings of one scene, of one shape, in sRGB */
    const PowerRule *rule;
    /* Receives each picture whose fault the rule misses. NULL: nobody wants them. */
    Status (*keep)(void *context, const PowerCase *missed, const Picture *picture, Err *err);
    void *keep_context;
} PowerInput;

/* Plants every fault in `drawn`, and asks all rules whether each picture differs from `reference`.
 *
 * power     is set on success; release it with power_release.
 * threads   0: all processors.
 * Errors    STATUS_INPUT if shapes differ; STATUS_MEMORY; those of the rule and of `keep`. */
MUST_CHECK Status power_measure(const PowerInput *input, int threads, Power *power, Err *err);
void power_release(Power *power);

/* Appends a table: the smallest size from which on each rule finds each fault. */
void power_text(const Power *power, Text *out);
/* Returns the result as JSON. The caller releases it. Returns NULL if memory runs out. */
json_t *power_json(const Power *power);

#endif
