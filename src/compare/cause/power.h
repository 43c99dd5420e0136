/* How much a rule sees: faults of every kind and size are planted in a renderer's picture, and the
 * rule is asked about each, beside rules that others have published. Part of the room's door. */
#ifndef CORCAST_COMPARE_CAUSE_POWER_H
#define CORCAST_COMPARE_CAUSE_POWER_H

#include "compare/cause/picture_fault.h"
#include <jansson.h>

/* A rule that a project publishes for its own tests. */
typedef struct PublishedRule {
    const char *name;   /* "Blender" */
    const char *says;   /* the rule in words */
    double pixelmatch;  /* no pixel may differ by pixelmatch at this threshold; or NAN and: */
    double levels, ppm; /* at most `ppm` of the pixels may be off by more than `levels` ... */
    double most_levels; /* ... and none by more than `most_levels` */
} PublishedRule;

enum { PUBLISHED_RULES = 5, POWER_RULES = 1 + PUBLISHED_RULES };
extern const PublishedRule published_rules[PUBLISHED_RULES];

/* The rule that is asked first: whether it calls a picture different from the reference. Threads
 * ask it at once. */
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
    bool exists;             /* the codes hold it: some pixel changes */
    bool found[POWER_RULES]; /* by the rule asked, and by those published */
} PowerCase;

typedef struct Power {
    const char *name;  /* of the rule asked; borrowed */
    PowerCase *cases;  /* owned; in the order of the faults, sizes rising */
    size_t n, planted; /* of these exist */
    size_t missed[POWER_RULES];
    bool alarm[POWER_RULES]; /* calls the two drawings without a fault different */
    bool repeats;            /* these are the same */
    int width, height, bits;
} Power;

/* Plants every fault in `drawn` and asks all rules about it and `reference`, another drawing of the
 * same scene: two pictures in sRGB of one shape. `keep`, unless NULL, is given each picture whose
 * fault the rule misses. STATUS_INPUT when shapes differ, and all that the rule returns. */
MUST_CHECK Status power_measure(const Picture *reference, const Picture *drawn,
                                const PowerRule *rule, int threads,
                                Status (*keep)(void *context, const PowerCase *missed,
                                               const Picture *picture, Err *err),
                                void *keep_context, Power *power, Err *err);
void power_release(Power *power);

/* Appends a table: of each fault the smallest size from which on a rule finds it. */
void power_text(const Power *power, Text *out);
/* New reference, NULL when memory runs out. */
json_t *power_json(const Power *power);

#endif
