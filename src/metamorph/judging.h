/* Draws pairs of scenes with the renderer, several at a time, and compares the pictures. */
#ifndef CORCAST_METAMORPH_JUDGING_H
#define CORCAST_METAMORPH_JUDGING_H

#include "image/image.h"
#include "metamorph/relations.h"

/* The renderer that is tested. All strings are borrowed. */
typedef struct TrialRenderer {
    const char *command; /* shell command; trial_command lists its marks */
    TrialFormat format;
    const char *folder; /* an existing folder for scenes and pictures; absolute */
    double timeout_s;   /* a drawing that takes longer is ended */
    int jobs;           /* drawings at the same time, from 1 to TRIAL_JOBS */
} TrialRenderer;

enum { TRIAL_JOBS = 32, TRIAL_REASON = 400 };

/* What one drawing gave. */
typedef struct TrialDrawing {
    Picture picture;           /* 8-bit sRGB of three channels; owned; without codes if none was
                                * drawn */
    char reason[TRIAL_REASON]; /* why none was drawn, as a clause: "exit status 1: no such file" */
} TrialDrawing;

void drawings_release(TrialDrawing *drawings, size_t n);

/* Draws `n` scenes. `drawings` is zeroed before; release it in any case. A scene that the renderer
 * does not draw is no error. Errors: STATUS_IO, STATUS_MEMORY, STATUS_TOOL if no process starts. */
MUST_CHECK Status trials_draw(const TrialRenderer *renderer, const TrialScene *scenes, size_t n,
                              TrialDrawing *drawings, Err *err);

typedef enum VerdictKind {
    VERDICT_NONE, /* the relation makes no promise about the first scene, or it is not drawn */
    VERDICT_HOLDS,
    VERDICT_EDGE,    /* a shape appears or vanishes in a pixel */
    VERDICT_SHADE,   /* only colors of shapes differ */
    VERDICT_REFUSED, /* the second scene is not drawn */
    VERDICT_KINDS
} VerdictKind;

/* The names of the kinds: "edge". */
extern const char *const verdict_names[VERDICT_KINDS];

/* What the comparison of a pair found. */
typedef struct PairVerdict {
    VerdictKind kind;
    int pixels;                /* differ by more than the relation allows */
    int codes;                 /* the largest difference of two 8-bit codes */
    PixelRect box;             /* of these pixels, in the first picture */
    bool is_empty;             /* all pixels of the first picture are equal */
    char reason[TRIAL_REASON]; /* of VERDICT_NONE and VERDICT_REFUSED: why; "": no promise */
} PairVerdict;

/* Returns true if the relation is broken. */
static inline bool verdict_fails(const PairVerdict *verdict)
{
    return verdict->kind >= VERDICT_EDGE;
}

/* Compares the pictures of a pair. */
void pair_compare(const Relation *relation, const TrialDrawing drawings[2], PairVerdict *verdict);

/* Draws and compares `n` pairs. Errors: those of trials_draw. */
MUST_CHECK Status pairs_judge(const TrialRenderer *renderer, const TrialPair *pairs, size_t n,
                              PairVerdict *verdicts, Err *err);

#endif
