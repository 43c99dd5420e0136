/* The workspace in which one thread computes the answers of pixels, one after the other, and the
 * functions that compute them. Private to the module answer.
 *
 * For each pixel, the caller sets AnswerWorkspace.pixel to the faces that the pixel may show, then
 * calls pattern_answer or area_answer. Both intersect beams [faces.h] with these faces by
 * beam_hits. A pattern answer bounds the mean color at given sample positions, with one single ray
 * per position. An area answer bounds the mean color over the pixel. It divides the pixel into
 * leaves [region.h], with one beam per leaf, until the interval of the pixel is at most
 * AnswerParams.width wide, or until there are AnswerParams.leaves leaves. */
#ifndef CORCAST_ANSWER_WORKSPACE_H
#define CORCAST_ANSWER_WORKSPACE_H

#include "answer/interval.h"
#include "answer/isosurface.h"

/* Capacities. If one is exceeded, the answer is still proven.
 *
 * MAX_HITS                 hits of a beam. The interval of a beam with more hits contains all
 *                          colors of the scene.
 * MAX_CACHED, CACHE_FACES  entries of the cache of blockers, and faces in all entries. If the cache
 *                          is full, blockers are searched again for each leaf.
 *
 * Reasons for the numbers are not recorded. */
enum { MAX_HITS = 48, MAX_CACHED = 32, CACHE_FACES = 4096 };

/* An entry of the cache of blockers: the faces that may block a light anywhere on the part of
 * `face` that the current pixel shows. They are AnswerWorkspace.cached_faces[begin] to [begin + n -
 * 1]. */
typedef struct BlockerCacheEntry {
    const Face *face;
    size_t light, begin, n; /* light: index of the light */
} BlockerCacheEntry;

/* The workspace of a thread. The caller zeroes it and sets `plan`. It then allocates the arrays of
 * `tile`, `pixel` and `blockers`, each for all faces of the plan, and calls levelworkspace_make.
 * In the end it frees these three, `leaves` and `heap`, and calls levelworkspace_release. */
typedef struct AnswerWorkspace {
    const AnswerPlan *plan; /* borrowed */
    /* the faces that the present tile, and the present pixel, may show; owned */
    FaceList tile, pixel;
    FaceList blockers;       /* result of the last light_blockers; owned */
    LevelWorkspace levels;   /* for isosurfaces; owned */
    FaceHit hits[MAX_HITS];  /* result of the last beam_hits */
    LightBlocker blocker;    /* result of the last blocker_at */
    size_t beams, undecided; /* Answer.beams and Answer.undecided, counted by this thread */
    /* For area answers, about the present pixel: */
    Beam whole; /* all rays through the pixel */
    BlockerCacheEntry cached[MAX_CACHED];
    size_t n_cached, n_cached_faces;
    uint32_t cached_faces[CACHE_FACES];
    ARRAY(struct AreaLeaf) leaves; /* owned */
    Heap heap;       /* indices in `leaves`; the leaf with the widest interval is first; owned */
    json_t **record; /* JSON array that receives the parts of each leaf [certificate.h]; NULL: no
                      * certificate; borrowed */
} AnswerWorkspace;

/* The faces that may be visible in a beam: work->hits[0] to work->hits[n - 1]. */
typedef struct BeamHits {
    size_t n;
    bool overflows; /* true: there are more than MAX_HITS hits, and the beam may have any color of
                     * the scene */
    bool covered;   /* all rays of the beam hit one of the faces: the background is not visible */
} BeamHits;

/* Intersects a beam with the faces of `list`. Sets work->hits to the hits that may be the first hit
 * of any ray of the beam. */
BeamHits beam_hits(AnswerWorkspace *work, const Beam *beam, const FaceList *list);

/* The vessel at the center of a pixel. */
typedef struct Center {
    uint32_t face; /* index of a face of the vessel; UINT32_MAX: no vessel is visible, or it is not
                    * decided which one */
    /* Bounds of the vessel's depth, mm. Both infinite: no vessel. Only `far` infinite: it is not
     * decided which vessel is visible. */
    double near, far;
} Center;

/* Finds the vessel that a ray hits first, among the faces in work->pixel. Overwrites work->hits. */
void find_center(AnswerWorkspace *work, const Beam *ray, Center *center);

/* Computes the pattern answer of the pixel in column i and row j, from the faces in work->pixel. */
ColorInterval pattern_answer(AnswerWorkspace *work, int i, int j);
/* Computes the area answer of the pixel in column i and row j, from the faces in work->pixel.
 * Afterwards, work->leaves and work->heap contain the leaves of the pixel. Errors: STATUS_MEMORY.
 */
MUST_CHECK Status area_answer(AnswerWorkspace *work, int i, int j, ColorInterval *out, Err *err);

#endif
