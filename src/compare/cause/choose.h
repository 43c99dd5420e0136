/* Chooses a tolerance from repeated renderings of one scene, which differ because they were drawn
 * by different machines, drivers or seeds.
 *
 * A rule has two numbers: a level L and a number of pixels m. It rejects a picture if more than m
 * pixels differ from the reference by more than L levels. For each L, m is an order statistic of
 * the counts of the repeats: the largest, or the k-th smallest. Among these rules, the tightest one
 * is the one that misses the fewest planted faults (picture_fault.h). */
#ifndef CORCAST_COMPARE_CAUSE_CHOOSE_H
#define CORCAST_COMPARE_CAUSE_CHOOSE_H

#include "compare/cause/power.h"
#include "compare/result.h"

typedef struct Choice {
    int levels;    /* L, in 8-bit levels */
    size_t pixels; /* m */
    double ppm;    /* the limit of the tolerance: admits m of the pixels, and not m + 1 */
    size_t n;      /* number of repeats besides the reference */
    size_t rank;   /* k: m is the k-th smallest of the n counts */
    /* If the repeats and a further rendering are exchangeable, the further rendering is rejected
     * with a probability of at most `rate` = 1 - k / (n + 1). This is the mean over all sets of
     * repeats. With 95 % confidence, these n repeats are such that at most a fraction `bound` of
     * further renderings is rejected (one-sided tolerance limit, Beta(k, n - k + 1)). Both hold for
     * each level L. The choice of L uses the same repeats, which `alarms` accounts for. */
    double rate, bound;
    size_t alarms;          /* of n trials: the rule chosen without a repeat rejects this repeat */
    size_t planted, missed; /* counts: planted faults, and faults that the rule does not detect */
} Choice;

/* Chooses a tolerance.
 *
 * pictures   the reference, then n >= 2 repeats, in sRGB, of one size, depth and number of
 *            channels.
 * rate       highest accepted `rate`; 0: the lowest that n repeats can guarantee, 1 / (n + 1).
 * Errors     STATUS_INPUT if the pictures differ in form, or n repeats cannot guarantee `rate`;
 *            STATUS_MEMORY. */
MUST_CHECK Status choose_tolerance(const Picture *pictures, size_t n_pictures, double rate,
                                   int threads, Choice *choice, Err *err);

/* Returns the tolerance of the rule; its name is "chosen". */
Tolerance choice_tolerance(const Choice *choice);
/* Append the lines of a tolerance file, or sentences about the choice. */
void choice_ini(const Choice *choice, Text *out);
void choice_text(const Choice *choice, Text *out);
/* Returns the choice as JSON: a new reference, NULL if memory runs out. */
json_t *choice_json(const Choice *choice);

#endif
