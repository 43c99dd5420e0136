/* Judges the measures of a result by its tolerance. Each row of the table of measures [measure.h]
 * that has a limit becomes a Rule. Private to the module compare. */
#ifndef CORCAST_COMPARE_RULES_JUDGE_H
#define CORCAST_COMPARE_RULES_JUDGE_H

#include "compare/result.h"

/* Completes a result whose measures are set: sets rules, n_rules, agrees and reason, and the ids in
 * result->places. `a` and `b` are the id planes of both images; both NULL: no ids. */
void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b);

/* Writes the sentence that reports a rule as not met: "21.3 % of the pixels are off by more than 0
 * levels (allowed: 0.0002 %); the worst, 155 levels, is at (312, 140)". Cuts it at `size` bytes. */
void rule_sentence(const CompareResult *result, const Rule *rule, char *out, size_t size);

#endif
