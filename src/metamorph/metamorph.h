/* The public header of the module metamorph: tests a renderer without a reference picture.
 *
 * A metamorphic relation changes a scene in a way whose effect on the picture is known: all lengths
 * times 2, for example, the camera included. A renderer that breaks a relation has a defect. The
 * module draws pairs of random scenes, confirms each failure with three cameras, shrinks it, and
 * writes one report for each cause. */
#ifndef CORCAST_METAMORPH_METAMORPH_H
#define CORCAST_METAMORPH_METAMORPH_H

#include "metamorph/shrink.h"
#include "oracle/program.h"

/* What to test, and for how long. All strings are borrowed. */
typedef struct MetamorphParams {
    TrialRenderer renderer; /* `folder` receives the scenes while they are tested */
    const char *relations;  /* names, separated by commas; NULL: all that the format has */
    uint64_t seed;
    size_t max_pairs;          /* 0: no limit */
    double seconds;            /* no new pairs are drawn after this time */
    const char *output;        /* existing folder that receives a folder for each cause */
    ProgramProgress *progress; /* receives the fraction of `seconds` that has passed; may be NULL */
    void *progress_context;
} MetamorphParams;

/* The counts of one relation. */
typedef struct RelationCount {
    size_t pairs;     /* drawn and compared */
    size_t none;      /* the first scene was not drawn */
    size_t failed;    /* pictures differ by more than the relation allows */
    size_t confirmed; /* failed with two of three cameras */
    double seconds;   /* drawing time, with confirmation and shrinking */
} RelationCount;

enum { CAUSE_NAME = 120, MAX_RELATIONS = 32, SWEEP = 20 };

/* One cause: a relation, the kinds of shapes that are left, shadows, perspective, and the kind of
 * failure. */
typedef struct MetamorphCause {
    char name[CAUSE_NAME]; /* "scale-up-torus-edge"; also the name of its folder */
    TrialPair pair;        /* the smallest pair */
    PairVerdict verdict;
    size_t confirmed;         /* pairs with this cause */
    int sweep[2 * SWEEP + 1]; /* of a scaling relation: differing pixels at 2^k, k from -SWEEP to
                               * SWEEP; -1: the scene is not drawn */
} MetamorphCause;

/* What was found. Zeroed: nothing. Release with metamorph_release. */
typedef struct Metamorph {
    TrialFormat format;
    RelationCount counts[MAX_RELATIONS]; /* in the order of `relations` */
    ARRAY(MetamorphCause) causes;
    double seconds;
} Metamorph;

void metamorph_release(Metamorph *result);

/* Runs the search and writes output/CAUSE/ for each cause: first and second scene, both pictures,
 * the difference (difference.png) and report.txt.
 *
 * result  zeroed before; release it even after an error.
 * Errors  STATUS_USAGE if `relations` names none; STATUS_TOOL if the renderer draws none of the
 *         first scenes, or nothing is visible in any; STATUS_IO; STATUS_CANCELLED; STATUS_MEMORY.
 */
MUST_CHECK Status metamorph_run(const MetamorphParams *params, Metamorph *result, Err *err);

/* Appends the counts and the causes as text. */
void metamorph_text(const Metamorph *result, Text *out);
/* Returns them as JSON: a new reference; NULL if memory runs out. */
json_t *metamorph_json(const Metamorph *result);

#endif
