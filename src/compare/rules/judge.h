/* Judges a result by its tolerance. Private to the module compare. */
#ifndef CORCAST_COMPARE_RULES_JUDGE_H
#define CORCAST_COMPARE_RULES_JUDGE_H

#include "compare/result.h"

/* Completes a result: sets rules, agrees and reason, and the ids of the places that were found. The
 * id planes are both or neither NULL. */
void result_finish(CompareResult *result, const IdPlane *a, const IdPlane *b);

/* Writes a sentence about a rule, as if it were broken. */
void rule_sentence(const CompareResult *result, const Rule *rule, char *out, size_t size);

#endif
