/* The operation `info`: counts and measures a tree, and compares it with published tables. */
#ifndef CORCAST_JOB_TREE_INFO_H
#define CORCAST_JOB_TREE_INFO_H

#include "derive/derive.h"
#include "options/options.h"
#include "tree/tree.h"

extern const Command command_info;

/* The facts about a tree. Release with inforeport_release. */
typedef struct InfoReport {
    const char *name; /* name of the tree in messages; borrowed from the Parsed */
    Tree tree;
    TreeReading reading;
    TreeSummary summary;
    bool has_statistics, has_morphometry; /* the user asked for them */
    TreeStatistics statistics;
    Morphometry table;                /* the published table; zeroed without has_morphometry */
    MorphometryComparison comparison; /* of the tree with the table; zeroed without it */
    json_t *bound;                    /* bound_json [certify.h]; owned; NULL: not asked for */
} InfoReport;

/* Measures the tree that is the first operand.
 *
 * options  parsed->options.
 * report   the caller releases it even after an error.
 * Errors   STATUS_USAGE for options without effect; as reading_tree, blood_settle, template_file,
 *          morphometry_read and bound_tree. */
MUST_CHECK Status info_make(void *options, Parsed *parsed, InfoReport *report, Err *err);
void inforeport_release(InfoReport *report);

/* Returns the report as JSON. New reference, or NULL if memory runs out. */
json_t *inforeport_json(const InfoReport *report);

#endif
