/* Draws pairs of scenes with the renderer under test, several at a time, and compares the pictures
 * of each pair. */
#ifndef CORCAST_METAMORPH_JUDGING_H
#define CORCAST_METAMORPH_JUDGING_H

#include "image/image.h"
#include "metamorph/relations.h"

/* The renderer that is tested. */
typedef struct TrialRenderer {
    ShellRenderer shell;
    TrialFormat format;
    const char *folder; /* an existing folder for scenes and pictures; absolute; borrowed */
} TrialRenderer;

/* Size of a reason in bytes. */
enum { TRIAL_REASON = 400 };

/* The result of drawing one scene. */
typedef struct TrialDrawing {
    Picture picture;           /* 8-bit sRGB of three channels; zeroed if the renderer drew none;
                                * owned */
    char reason[TRIAL_REASON]; /* why it drew none: ShellDrawing.reason */
} TrialDrawing;

/* Releases the pictures of `n` drawings, not the array. */
void drawings_release(TrialDrawing *drawings, size_t n);

/* Draws `n` scenes. If the renderer does not draw a scene, this is not an error: the drawing has a
 * reason instead of a picture.
 *
 * drawings  array of n, zeroed before; release it with drawings_release even after an error.
 * Errors    STATUS_TOOL if no process can be started; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status trials_draw(const TrialRenderer *renderer, const TrialScene *scenes, size_t n,
                              TrialDrawing *drawings, Err *err);

typedef enum VerdictKind {
    VERDICT_NONE,    /* not judged: the relation does not apply to the first scene, or the renderer
                      * did not draw the first scene */
    VERDICT_HOLDS,   /* no pixel differs by more than the relation allows */
    VERDICT_EDGE,    /* some pixel shows the background in one picture and not in the other */
    VERDICT_SHADE,   /* pixels differ, but none of them shows the background */
    VERDICT_REFUSED, /* the renderer drew the first scene but not the second one */
    VERDICT_KINDS
} VerdictKind;

/* Per VerdictKind: its name, "edge". */
extern const char *const verdict_names[VERDICT_KINDS];

/* The result of comparing a pair. */
typedef struct PairVerdict {
    VerdictKind kind;
    int pixels;                /* number of pixels that differ by more than Relation.codes */
    int codes;                 /* largest difference of two 8-bit codes */
    PixelRect box;             /* bounding box of these pixels in the first picture */
    bool is_empty;             /* all pixels of the first picture are equal */
    char reason[TRIAL_REASON]; /* why a scene was not drawn; "" if both were drawn, or the relation
                                * does not apply */
} PairVerdict;

/* Returns true if the renderer breaks the relation: VERDICT_EDGE, VERDICT_SHADE or VERDICT_REFUSED.
 */
static inline bool verdict_fails(const PairVerdict *verdict)
{
    return verdict->kind >= VERDICT_EDGE;
}

/* Compares the drawings of the first and of the second scene of a pair. */
void pair_compare(const Relation *relation, const TrialDrawing drawings[2], PairVerdict *verdict);

/* Draws and compares `n` pairs. Sets verdicts[i] for pair i. Errors: those of trials_draw. */
MUST_CHECK Status pairs_judge(const TrialRenderer *renderer, const TrialPair *pairs, size_t n,
                              PairVerdict *verdicts, Err *err);

#endif
