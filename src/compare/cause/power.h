/* Measures the statistical power of a comparison rule: how many faults of a renderer the rule
 * detects.
 *
 * Plants synthetic faults of every kind and size in a picture and applies the rule to each faulty
 * picture. Applies rules that other projects publish to the same pictures, for reference. */
#ifndef CORCAST_COMPARE_CAUSE_POWER_H
#define CORCAST_COMPARE_CAUSE_POWER_H

#include "compare/cause/picture_fault.h"
#include <jansson.h>

/* PUBLISHED_RULES is the number of rules that other projects publish for their own tests.
 * POWER_RULES is the number of all rules, including the measured one. */
enum { PUBLISHED_RULES = 5, POWER_RULES = 1 + PUBLISHED_RULES };

/* The rule whose power is measured. */
typedef struct PowerRule {
    const char *name; /* borrowed */
    /* Sets *differs to true if the rule rejects `picture` as different from `reference`. Must be
     * thread-safe: several threads call it at the same time. */
    Status (*differs)(void *context, const Picture *reference, const Picture *picture,
                      bool *differs, Err *err);
    void *context; /* passed to `differs`; borrowed */
} PowerRule;

/* One planted fault: a kind of fault and its size. */
typedef struct PowerCase {
    const PictureFault *fault;
    double size; /* in the unit of the fault; ignored if the fault has no size */
    bool exists; /* the fault changes at least one stored value of the picture; else the case is not
                  * counted */
    bool found[POWER_RULES]; /* per rule: the rule detects the fault. The measured rule is first,
                              * then the published rules follow in their order */
} PowerCase;

/* Lists every fault in every size, ordered by fault, then by rising size. The caller frees *cases.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status powercases_list(PowerCase **cases, size_t *n, Err *err);

/* The result of power_measure. Arrays of POWER_RULES are per rule, in the order of
 * PowerCase.found. */
typedef struct Power {
    const char *name;           /* name of the measured rule; borrowed from the PowerRule */
    PowerCase *cases;           /* owned; ordered by fault, then by rising size */
    size_t n;                   /* number of cases */
    size_t planted;             /* number of cases with PowerCase.exists */
    size_t missed[POWER_RULES]; /* number of planted cases that the rule does not detect */
    bool alarm[POWER_RULES];    /* false alarm: the rule rejects `drawn`, which has no fault */
    bool repeats;               /* PowerInput.reference and PowerInput.drawn have equal codes */
    int width, height, bits;    /* of the pictures */
} Power;

/* The input of power_measure. All members are borrowed. */
typedef struct PowerInput {
    /* Two drawings of one scene, both without planted faults. They have equal size, channels and
     * bit depth, and are in sRGB. Faults are planted in copies of `drawn`. */
    const Picture *reference, *drawn;
    const PowerRule *rule;
    /* Receives each faulty picture that the measured rule does not detect. The picture is valid
     * during the call only. Must be thread-safe. NULL: not called. */
    Status (*keep)(void *context, const PowerCase *missed, const Picture *picture, Err *err);
    void *keep_context; /* passed to `keep` */
} PowerInput;

/* Plants every fault in every size in copies of input->drawn, and applies all rules to each faulty
 * picture and input->reference.
 *
 * threads   number of threads; 0: all processors.
 * power     release it with power_release. It borrows the name of the rule.
 * Errors    STATUS_INPUT if the two drawings differ in size, channels or bit depth; STATUS_MEMORY;
 *           any error of the rule and of `keep`. */
MUST_CHECK Status power_measure(const PowerInput *input, int threads, Power *power, Err *err);
void power_release(Power *power);

/* Appends a table with a row per fault and a column per rule.
 *
 * A cell contains the smallest size such that the rule detects the fault at this and all larger
 * sizes, or "never". For a fault without a size it contains "found" or "missed". It contains "-" if
 * no size of the fault changes the picture. The last rows contain the counts of missed cases, and
 * the false alarms. */
void power_text(const Power *power, Text *out);
/* Returns the result as JSON: a new reference, which the caller releases. Returns NULL if memory
 * runs out. */
json_t *power_json(const Power *power);

#endif
