/* The operation `info`: counts and measures a tree, and compares it with a published morphometric
 * table. Call info_make, then inforeport_json or read the report, then inforeport_release. */
#ifndef CORCAST_JOB_TREE_INFO_H
#define CORCAST_JOB_TREE_INFO_H

#include "derive/derive.h"
#include "options/options.h"
#include "tree/tree.h"

extern const Command command_info;

/* The facts about a tree. All members are owned unless noted. Release it with inforeport_release.
 */
typedef struct InfoReport {
    const char *name; /* name of the tree in messages; borrowed from the Parsed */
    Tree tree;
    TreeReading reading;
    TreeSummary summary;
    bool has_statistics;       /* the options request the statistics */
    bool has_morphometry;      /* the options request the comparison */
    TreeStatistics statistics; /* set if has_statistics */
    Morphometry table;         /* the published table; set if has_morphometry */
    MorphometryComparison comparison[MORPHOMETRY_ORDERS]; /* set if has_morphometry */
    /* which of the two comparisons is reported in full, vessel order by vessel order */
    MorphometryOrders orders;
    json_t *bound; /* lower bound of the tree's target, as JSON [bound_json, certify.h]; owned;
                    * NULL: not requested */
} InfoReport;

/* Measures the tree that is the first operand.
 *
 * options  must be parsed->options.
 * report   is overwritten; the caller releases it even after an error. It borrows from `parsed`.
 * Errors   STATUS_USAGE for an option without effect; STATUS_INPUT for a tree, a file of flows or a
 *          published table that cannot be used; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status info_make(void *options, Parsed *parsed, InfoReport *report, Err *err);
void inforeport_release(InfoReport *report);

/* Returns the report as a JSON object: a new reference, or NULL if memory runs out. The key of a
 * number ends with its unit, such as _mm3. */
json_t *inforeport_json(const InfoReport *report);

#endif
