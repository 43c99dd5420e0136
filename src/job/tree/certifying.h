/* A bound of a tree's target, and what the target is above it by, told apart. */
#ifndef CORCAST_JOB_TREE_CERTIFYING_H
#define CORCAST_JOB_TREE_CERTIFYING_H

#include "grow/grow.h"
#include "job/tree/blood.h"

typedef struct Certifying {
    const char *certificate; /* a file to write it to; NULL: it is not made */
    bool parts, has_lambda;
    double lambda;
    BloodOptions blood; /* of which only law, flow of the terminals and gamma are set */
} Certifying;

extern const OptionTable certifying_table; /* sets a Certifying; zeroed: a bound alone */

/* The parts that a target is above the bound by, in its unit. */
enum { PART_SEARCH, PART_RULES, PART_RADII, PART_UNPROVED, PARTS };

extern const struct PartRow {
    const char *key, *meaning;
} part_rows[PARTS];

typedef struct Certified {
    Bound bound;        /* owned; bound_release */
    Text certificate;   /* owned, text_release; empty where none is asked for */
    double refined;     /* the target of the tree with its geometry refined; NAN: not asked for */
    double part[PARTS]; /* NAN: not told apart from the next */
    double seconds;     /* wall clock, of the bound */
} Certified;

/* Bounds the target of the tree that is the first operand; spoils the tree. *found is the caller's
 * to release, also on failure. Errors as blood_settle, bound_tree and, with `parts`, refine_tree
 * and tree_domain; STATUS_INPUT, too, where lambda is not known or out of range, and where
 * viscosity follows the radius. */
MUST_CHECK Status certifying_apply(const Certifying *certifying, const Parsed *parsed, Tree *tree,
                                   Certified *found, Err *err);

/* The bound of the target of a tree for JSON: an object of `target`, `bound` and `above` (the
 * distance over the bound); null where its viscosity follows the radius, or where lambda is out of
 * range or not known. What `said` knows counts before what the tree does. Errors as bound_tree. */
MUST_CHECK Status certified_json(const Tree *tree, const TreeMeta *said, json_t **out, Err *err);

#endif
