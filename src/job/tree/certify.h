/* The operation `certify`: proves a lower bound of the target of a tree, and divides the gap
 * between target and bound into parts that have different causes. The target is the objective
 * function that growth minimizes: the sum over all segments of length * radius^lambda, in mm^(1 +
 * lambda).
 *
 *     Status status = certify_make(parsed->options, parsed, &found, err);
 *     if (status == STATUS_OK)
 *         json = certified_json(&found);
 *     certified_release(&found); */
#ifndef CORCAST_JOB_TREE_CERTIFY_H
#define CORCAST_JOB_TREE_CERTIFY_H

#include "grow/grow.h"
#include "options/options.h"

extern const Command command_certify;

/* The parts of the gap between target and bound, in the target's unit. Each is the target of one
 * solution minus the target of another, which need not keep some rule that the first one keeps. */
enum {
    GAP_SEARCH,   /* gain of refining the geometry while all rules are kept */
    GAP_RULES,    /* further gain if vessels may be shorter, and nearer to each other, than growth
                   * allows */
    GAP_RADII,    /* further gain if radii need not follow Murray's law */
    GAP_UNPROVED, /* target of the best geometry found without these rules, minus the bound */
    GAP_PARTS
};

/* Per part: its key in JSON, and a phrase for users that explains it. Both are static strings. */
extern const struct GapPartRow {
    const char *key, *meaning;
} gap_part_rows[GAP_PARTS];

typedef struct Certified {
    Bound bound;      /* owned */
    Text certificate; /* the proof as text; owned; empty without --certificate */
    double refined;   /* target of the tree after its geometry was refined; NAN without
                       * --explain-gap */
    /* per part: its size, 0 or more; NAN: it is included in the next part */
    double part[GAP_PARTS];
    double seconds; /* wall clock time of the bound */
} Certified;

/* Computes a lower bound of the target of the tree that is the first operand.
 *
 * options  parsed->options.
 * found    is overwritten; release it with certified_release even after an error.
 * Errors   STATUS_USAGE for options that have no effect in this combination; STATUS_INPUT if the
 *          tree cannot be used, if its lambda is unknown or out of range, or if its viscosity
 *          depends on the radius; with --explain-gap also the errors of refine_tree [grow/grow.h];
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status certify_make(void *options, Parsed *parsed, Certified *found, Err *err);
void certified_release(Certified *found);

/* Returns the result as a JSON object: a new reference, or NULL if memory runs out. */
json_t *certified_json(const Certified *found);

/* Computes a lower bound of the target of a tree, for the reports of other operations.
 *
 * said    values of the blood that the user specified; they take precedence over the tree's.
 * out     receives a new reference, which the caller releases: a JSON object with the members
 *         `target`, `bound` and `above`, which is (target - bound) / bound. If the viscosity
 *         depends on the radius, or lambda is unknown or out of range, *out is JSON null and the
 *         function succeeds.
 * Errors  STATUS_INPUT if no blood flows, if blood flows through a segment of radius 0, or if the
 *         pressure does not drop along the path to an outlet; STATUS_MEMORY. */
MUST_CHECK Status bound_json(const Tree *tree, const TreeMeta *said, json_t **out, Err *err);

#endif
