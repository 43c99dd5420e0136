/* Chooses a tolerance from repeated renderings of one scene, which differ because they were drawn
 * by different machines, drivers or seeds.
 *
 * The tolerance is a rule with two numbers: a level L and a number of pixels m. The rule rejects a
 * picture if more than m pixels differ from the reference by more than L levels. For each L, m is
 * the k-th smallest of the pixel counts of the n repeats, where k follows from the accepted false
 * alarm rate. Among the rules for all L, the rule is chosen that misses the fewest planted faults:
 * synthetic faults that are inserted into a picture [picture_fault.h]. */
#ifndef CORCAST_COMPARE_CAUSE_CHOOSE_H
#define CORCAST_COMPARE_CAUSE_CHOOSE_H

#include "compare/cause/power.h"
#include "compare/result.h"

typedef struct Choice {
    int levels;    /* L, in 8-bit levels */
    size_t pixels; /* m */
    /* limit of the tolerance in parts per million, which allows m pixels and not m + 1 */
    double ppm;
    size_t n;    /* number of repeats besides the reference */
    size_t rank; /* k: m is the k-th smallest of the n counts */
    /* Two bounds of the false alarm rate, the probability that the rule rejects a further rendering
     * without a fault. Both hold for each level L if the repeats and the further rendering are
     * exchangeable. But L is chosen by means of the same repeats, so the true rate may be higher;
     * `alarms` includes the effect of this choice.
     *
     * rate = 1 - k / (n + 1) is an upper bound of the mean false alarm rate over all sets of n
     * repeats. `bound` is an upper bound for these n repeats with 95 % confidence (one-sided
     * tolerance limit, Beta(k, n - k + 1)). */
    double rate, bound;
    size_t alarms; /* leave-one-out count: number of repeats that are rejected by the rule chosen
                    * from the other n - 1 repeats */
    /* numbers of planted faults, and of faults that the rule does not detect */
    size_t planted, missed;
} Choice;

/* Chooses a tolerance.
 *
 * pictures   the reference, then n >= 2 repeats, in sRGB, of one size, depth and number of
 *            channels.
 * rate       highest accepted Choice.rate; 0: the lowest that n repeats can guarantee, 1 / (n + 1).
 * threads    0: all processors. The choice does not depend on their number.
 * choice     set on success only.
 * Errors     STATUS_INPUT if the pictures differ in form, or n repeats cannot guarantee `rate`;
 *            STATUS_MEMORY. */
MUST_CHECK Status choose_tolerance(const Picture *pictures, size_t n_pictures, double rate,
                                   int threads, Choice *choice, Err *err);

/* Returns the tolerance of the rule; its name is "chosen". It owns and borrows nothing. */
Tolerance choice_tolerance(const Choice *choice);
/* Appends the tolerance of the choice as a tolerance file [tolerance_read]. If memory runs out,
 * `out` records it. */
void choice_ini(const Choice *choice, Text *out);
/* Appends sentences about the choice. If memory runs out, `out` records it. */
void choice_text(const Choice *choice, Text *out);
/* Returns the choice as JSON: a new reference, NULL if memory runs out. */
json_t *choice_json(const Choice *choice);

#endif
