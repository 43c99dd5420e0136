/* Judges pairs of scenes: draws both scenes with the renderer under test, several at a time, and
 * compares the pictures. */
#ifndef CORCAST_METAMORPH_JUDGING_H
#define CORCAST_METAMORPH_JUDGING_H

#include "image/image.h"
#include "metamorph/relations.h"

/* The renderer under test. */
typedef struct TrialRenderer {
    ShellRenderer shell; /* the shell command that draws a scene, and its timeout */
    TrialFormat format;  /* the format of scenes that the command reads */
    const char *folder;  /* an existing folder that receives scenes and pictures; an absolute path;
                          * borrowed */
} TrialRenderer;

/* Capacity of the texts `reason`, bytes. */
enum { TRIAL_REASON = 400 };

/* The result of drawing one scene. */
typedef struct TrialDrawing {
    Picture picture;           /* 8-bit sRGB of three channels; zeroed if the renderer drew none;
                                * owned */
    char reason[TRIAL_REASON]; /* why there is no picture, such as "it did not end within 20 s"
                                * [ShellDrawing.reason]; "" if there is one */
} TrialDrawing;

/* Releases the pictures of `n` drawings. Does not free the array. */
void drawings_release(TrialDrawing *drawings, size_t n);

/* Draws `n` scenes. A scene that the renderer does not draw is not an error: its drawing has a
 * reason instead of a picture.
 *
 * drawings  array of n, zeroed before. The caller calls drawings_release even after an error.
 * Errors    STATUS_TOOL if no process can be started; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status trials_draw(const TrialRenderer *renderer, const TrialScene *scenes, size_t n,
                              TrialDrawing *drawings, Err *err);

typedef enum VerdictKind {
    VERDICT_NONE,    /* not judged: the relation does not apply to the first scene, or the renderer
                      * did not draw the first scene */
    VERDICT_HOLDS,   /* no pixel differs by more than the relation allows */
    VERDICT_EDGE,    /* some pixel shows the background in one picture and not in the other */
    VERDICT_SHADE,   /* pixels differ, but none of them shows the background */
    VERDICT_UNDRAWN, /* the renderer drew the first scene but not the second one: it failed, wrote
                      * no picture, or reached its timeout. PairVerdict.reason states which */
    VERDICT_KINDS
} VerdictKind;

/* The names of verdicts, such as "edge", with a VerdictKind as index. */
extern const char *const verdict_names[VERDICT_KINDS];

/* The result of comparing a pair. */
typedef struct PairVerdict {
    VerdictKind kind;
    int pixels;    /* number of pixels that differ by more than Relation.codes */
    int codes;     /* largest difference of two 8-bit codes, of all pixels */
    PixelRect box; /* bounding box of the `pixels` pixels, in the first picture; width 0:
                    * none */
    bool is_empty; /* all pixels of the first picture are equal */
    char reason[TRIAL_REASON]; /* why a scene was not drawn; "" if both were drawn, or the relation
                                * does not apply */
} PairVerdict;

/* Returns true if the renderer breaks the relation: VERDICT_EDGE, VERDICT_SHADE or VERDICT_UNDRAWN.
 */
static inline bool verdict_fails(const PairVerdict *verdict)
{
    return verdict->kind >= VERDICT_EDGE;
}

/* Compares the drawings of the first and the second scene of a pair. Sets *verdict. */
void pair_compare(const Relation *relation, const TrialDrawing drawings[2], PairVerdict *verdict);

/* Draws and compares `n` pairs. Sets verdicts[i] for pair i; after an error the verdicts must not
 * be used. Errors: those of trials_draw. */
MUST_CHECK Status pairs_judge(const TrialRenderer *renderer, const TrialPair *pairs, size_t n,
                              PairVerdict *verdicts, Err *err);

#endif
