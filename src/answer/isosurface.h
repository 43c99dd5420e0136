/* Hits and shadows of single rays in the isosurface model: the surface where the potential of the
 * vessel segments [field/field.h] equals FIELD_LEVEL.
 *
 * Each segment is a face of kind FACE_SEGMENT. The potential is the sum of the terms of all
 * segments, with the true exp and erf, and without any cut-off. If the geometry has blend groups,
 * the solid is the union of the solids of all groups. Terms below ISOSURFACE_CUTOFF are left out,
 * and bounds of what they add are included in all errors. */
#ifndef CORCAST_ANSWER_ISOSURFACE_H
#define CORCAST_ANSWER_ISOSURFACE_H

#include "answer/answerplan.h"
#include "answer/levelray.h"
#include "field/field.h"

/* The workspace of one thread. All arrays are owned; each has an entry per segment. */
typedef struct LevelWorkspace {
    LevelTerm *terms;         /* terms near the present ray */
    size_t n;                 /* number of terms */
    const LevelTerm **chosen; /* terms of the present blend group */
    uint32_t *segments;       /* per term: index of its segment */
    LocalGroups *groups;      /* NULL if all segments blend */
} LevelWorkspace;

/* Allocates the workspace. Does nothing if the plan has no isosurface. Release it with
 * levelworkspace_release, even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status levelworkspace_make(const AnswerPlan *plan, LevelWorkspace *work, Err *err);
void levelworkspace_release(LevelWorkspace *work);

/* The hits of a ray with an isosurface. */
typedef struct LevelHits {
    size_t n;       /* number of hits; more than one if rounding errors hide which segment has the
                     * largest term at the hit, or which blend group is hit first */
    bool undecided; /* the ray may hit the surface anywhere; `n` is 0 */
} LevelHits;

/* Finds the first hit of a single ray with the isosurface. Only the faces of `list` may have terms
 * near the ray; faces of other kinds are ignored. Sets hits[0] to hits[n - 1], n <= capacity: their
 * faces are those of the segments that may have the largest term at the hit, which determines the
 * color. FaceHit.v is the normal. */
LevelHits isosurface_hits(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                          const FaceList *list, FaceHit *hits, size_t capacity);

/* Tests whether the isosurface blocks a shadow ray. `ray` starts on a visible surface, and `list`
 * has the faces that the ray may meet. Its direction leads to the light: the light is at depth 1,
 * or at infinity if `parallel`. Returns 1 if the ray is blocked, 0 if it is not, and -1 if this is
 * not decided. */
int isosurface_blocks(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                      const FaceList *list, bool parallel);

#endif
