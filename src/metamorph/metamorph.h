/* The public header of the module metamorph: tests a renderer without a reference picture.
 *
 * A metamorphic relation changes a scene in a way whose effect on the picture is known. For
 * example, if all lengths are doubled, including those of the camera, the picture must not change.
 * A renderer that breaks a relation has a defect. metamorph_run draws random scenes, each before
 * and after such a change: a pair. It confirms each failing pair with three cameras, reduces it to
 * a small pair, and writes one report for each cause.
 *
 *     Metamorph result = {0};
 *     Status status = metamorph_run(&params, &result, err);
 *     metamorph_text(&result, &out);
 *     metamorph_release(&result); */
#ifndef CORCAST_METAMORPH_METAMORPH_H
#define CORCAST_METAMORPH_METAMORPH_H

#include "metamorph/shrink.h"
#include "oracle/program.h"

/* The parameters of a search. All strings are borrowed. */
typedef struct MetamorphParams {
    TrialRenderer renderer; /* `folder` receives the scenes while they are tested */
    const char *relations;  /* names, separated by commas; NULL: all relations of the format */
    uint64_t seed;
    size_t max_pairs;          /* 0: no limit */
    double seconds;            /* the search starts no new batch of pairs after this time */
    const char *output;        /* existing folder that receives a folder for each cause */
    ProgramProgress *progress; /* receives the fraction of `seconds` that has passed, and returns
                                * false to stop; NULL: none */
    void *progress_context;
} MetamorphParams;

/* The counts of one relation. */
typedef struct RelationCount {
    size_t pairs;     /* number of pairs */
    size_t none;      /* number of pairs whose first scene the renderer did not draw */
    size_t failed;    /* number of pairs that break the relation [verdict_fails] */
    size_t confirmed; /* number of failed pairs that fail in the same way for at least two of three
                       * shifted cameras */
    double seconds;   /* time for all its pairs, including confirmation and reduction */
} RelationCount;

enum {
    CAUSE_NAME = 120,   /* capacity of a cause's name, bytes */
    MAX_RELATIONS = 32, /* not less than the rows of the table `relations` */
    SWEEP = 20          /* largest exponent of MetamorphCause.sweep: a factor of a million */
};

/* One cause. Two confirmed pairs have the same cause if, after reduction, these properties agree:
 * relation, kinds of shapes, shadows, perspective, kind of failure. */
typedef struct MetamorphCause {
    char name[CAUSE_NAME];    /* "scale-up-torus-edge"; also the name of its folder */
    TrialPair pair;           /* the smallest pair that still fails */
    PairVerdict verdict;      /* verdict of this pair */
    size_t confirmed;         /* number of confirmed pairs that this cause explains */
    int sweep[2 * SWEEP + 1]; /* relations that scale: sweep[k + SWEEP] is the number of pixels that
                               * differ if all lengths are multiplied by 2^k; -1: not drawn */
} MetamorphCause;

/* The result of a search. Zeroed: empty. Release with metamorph_release. */
typedef struct Metamorph {
    TrialFormat format;
    RelationCount counts[MAX_RELATIONS]; /* parallel to the table `relations` */
    ARRAY(MetamorphCause) causes;
    double seconds;
} Metamorph;

void metamorph_release(Metamorph *result);

/* Runs the search. Then writes the folder output/NAME/ for each cause, with both scenes, both
 * pictures, their difference (difference.png) and report.txt.
 *
 * result  zeroed before; release it even after an error.
 * Errors  STATUS_USAGE if params->relations names a relation that the format does not have;
 *         STATUS_TOOL if the renderer draws fewer than half of the first scenes, or if each picture
 *         has a single color, so that it shows nothing of the scenes; STATUS_IO; STATUS_CANCELLED;
 *         STATUS_MEMORY. */
MUST_CHECK Status metamorph_run(const MetamorphParams *params, Metamorph *result, Err *err);

/* Appends the counts and the causes as text. If memory runs out, `out` records it. */
void metamorph_text(const Metamorph *result, Text *out);
/* Returns the counts and the causes as JSON: a new reference; NULL if memory runs out. */
json_t *metamorph_json(const Metamorph *result);

#endif
