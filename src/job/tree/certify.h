/* The operation `certify`: proves a lower bound for the objective (the "target") of a tree, and
 * explains the gap between the target and the bound by parts.
 *
 * Use: certify_make(parsed->options, parsed, &found, err), then certified_json(&found), then
 * certified_release(&found), the last even after an error. */
#ifndef CORCAST_JOB_TREE_CERTIFY_H
#define CORCAST_JOB_TREE_CERTIFY_H

#include "grow/grow.h"
#include "options/options.h"

extern const Command command_certify;

/* The parts of the gap between target and bound. Each is a difference of targets, in the target's
 * unit. */
enum {
    PART_SEARCH,   /* what refinement of the geometry gains while all rules are kept */
    PART_RULES,    /* what the best geometry without rules of length and clearance gains */
    PART_RADII,    /* what radii gain that need not follow Murray's law */
    PART_UNPROVED, /* between the best geometry that was found and the bound */
    PARTS
};

/* Per part: its key in JSON, and a sentence for users that explains it. */
extern const struct PartRow {
    const char *key, *meaning;
} part_rows[PARTS];

typedef struct Certified {
    Bound bound;        /* owned */
    Text certificate;   /* the proof; owned; empty if the option certificate was not given */
    double refined;     /* target of the tree after its geometry was refined; NAN without
                         * --explain-gap */
    double part[PARTS]; /* per part: its size; NAN: included in the next part */
    double seconds;     /* wall clock time of the bound */
} Certified;

/* Computes a lower bound for the target of the tree that is the first operand.
 *
 * options  parsed->options.
 * found    the caller releases it with certified_release even after an error.
 * Errors   STATUS_INPUT if the exponent of the target is unknown or out of range, or if the
 *          viscosity depends on the radius; the errors of reading_tree, blood_settle and bound_tree
 *          and, with --explain-gap, of refine_tree and tree_domain. */
MUST_CHECK Status certify_make(void *options, Parsed *parsed, Certified *found, Err *err);
void certified_release(Certified *found);

/* Returns the result as a JSON object: a new reference, or NULL if memory runs out. */
json_t *certified_json(const Certified *found);

/* Computes a lower bound for the target of a tree, for the reports of other operations.
 *
 * said    values that the user specified; they take precedence over those of the tree.
 * out     receives a new reference, which the caller releases: a JSON object with `target`, `bound`
 * and `above`, the relative gap: (target
 *         - bound) / bound. It is JSON null if the viscosity depends on the radius, or if the
 *         exponent is unknown or out of range.
 * Errors  as bound_tree. */
MUST_CHECK Status bound_json(const Tree *tree, const TreeMeta *said, json_t **out, Err *err);

#endif
