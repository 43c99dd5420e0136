/* Writes a comparison as text for a terminal: the verdict, the rules, then the measures, each table
 * under its heading. */
#include "compare/report/check.h"

static void put_segments(const CompareResult *result, Text *out)
{
    for (int i = 0; i < result->n_worst_segments; i++) {
        const LedgerEntry *entry = &result->worst_segments[i];
        text_printf(out,
                    "  segment %u: %zu pixels differ, mean %+.4g levels, outline %+.4g px, gain "
                    "%.6g; (%d, %d) to (%d, %d)\n",
                    entry->id, entry->differing, ledger_entry_levels(entry), entry->moved_px,
                    entry->gain, entry->left, entry->top, entry->right, entry->bottom);
    }
}

void compare_text(const CompareResult *result, Text *out)
{
    const Check check = check_plane(result);
    const char *table = NULL;
    char sentence[RESULT_SENTENCE];
    if (result->agrees) {
        text_printf(out, "agree (tier %s): %zu of %zu pixels differ\n", result->tolerance.tier,
                    result_count(result, MEASURE_DIFFERING_PIXELS),
                    result_count(result, MEASURE_PIXELS));
    } else {
        result_sentence(result, sentence, sizeof sentence);
        text_printf(out, "differ (tier %s): %s\n", result->tolerance.tier, sentence);
    }
    for (int i = 0; i < check.n_rules; i++) {
        const Rule *rule = &check.rules[i];
        text_printf(out, "  %-6s %-52s %.6g of %.6g %s\n", rule->met ? "met" : "broken", rule->name,
                    rule->measured, rule->allowed, rule->unit);
    }
    for (int i = 0; i < check.n_measures; i++) {
        const CheckMeasure *measure = &check.measures[i];
        if (measure->table != table)
            text_printf(out, "  %s\n", measure->table);
        table = measure->table;
        text_printf(out, "    %-48s %.6g%s%s\n", measure->name, measure->value,
                    *measure->unit ? " " : "", measure->unit);
    }
    put_segments(result, out);
}
