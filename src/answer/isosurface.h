/* Computes hits and shadows of single rays in the models of fields: the isosurface, where the
 * potential of the vessel segments [field/field.h] equals FIELD_LEVEL, and the blob, where the sum
 * of its components [field/blob.h] equals 1. Both are called isosurface below. Call
 * levelworkspace_make once per thread, then isosurface_hits and isosurface_blocks for each ray.
 *
 * Each segment is a face of kind FACE_SEGMENT. The potential is the sum of the terms of all
 * segments, with the true exp and erf; it is defined without a cut-off. The computation leaves out
 * terms below ISOSURFACE_CUTOFF, and adds bounds of their sum to the errors. If the geometry has
 * blend groups, the solid is the union of the solids of all groups. */
#ifndef CORCAST_ANSWER_ISOSURFACE_H
#define CORCAST_ANSWER_ISOSURFACE_H

#include "answer/answerplan.h"
#include "answer/levelterm.h"

/* The workspace of one thread. All members are owned; each array has an entry per term, of which
 * the first `n` are used. */
typedef struct LevelWorkspace {
    LevelTerm *terms;         /* terms near the present ray */
    size_t n;                 /* number of terms */
    const LevelTerm **chosen; /* terms of the present blend group */
    uint32_t *segments;       /* per term: index of its face, which is that of its segment */
    LocalGroups *groups;      /* NULL if all segments blend */
} LevelWorkspace;

/* Allocates the workspace, which must be zeroed. Does nothing if the plan has no isosurface.
 * Release it once with levelworkspace_release, even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status levelworkspace_make(const AnswerPlan *plan, LevelWorkspace *work, Err *err);
void levelworkspace_release(LevelWorkspace *work);

/* The hits of a ray with an isosurface. */
typedef struct LevelHits {
    size_t n;       /* number of hits; 0 if the ray misses the surface */
    bool undecided; /* the ray may hit the surface anywhere; `n` is 0 */
} LevelHits;

/* Finds where a single ray first hits the solid of each blend group; the caller takes the nearest
 * hit. The ray must start outside the solids. `list` must contain the faces of all segments whose
 * term reaches ISOSURFACE_CUTOFF anywhere on the ray; faces of other kinds are ignored.
 *
 * Sets face, depth and v, the normal, of hits[0] to hits[n - 1]. A group adds a hit for each
 * segment that may have the largest term there, because this segment determines the color. If there
 * are more than `capacity` hits, the ray is undecided. */
LevelHits isosurface_hits(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                          const FaceList *list, FaceHit *hits, size_t capacity);

/* Tests whether the isosurface blocks a shadow ray. `ray` starts on a visible surface, and `list`
 * has the faces that the ray may meet. Its direction leads to the light: the light is at depth 1,
 * or at infinity if `parallel`. Returns 1 if the ray is blocked, 0 if it is not, and -1 if this is
 * not decided, for example because the crossing may be behind the light, or is so near to the start
 * [AnswerPlan.shadow_from_mm] that renderers may ignore it.
 *
 * leaves  true: the ray is known to leave the surface at its start. false: it may start inwards. It
 *         is then blocked if, plan->shadow_from_mm from its start, the field exceeds the level by
 *         more than the errors of renderers; else the result is -1. */
int isosurface_blocks(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                      const FaceList *list, bool parallel, bool leaves);

#endif
