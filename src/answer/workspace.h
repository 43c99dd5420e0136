/* The workspace in which one thread computes the answers of pixels, one pixel after the other, and
 * the functions that do it.
 *
 * For each pixel, the caller sets AnswerWorkspace.pixel to the faces that the pixel may show, then
 * calls pattern_answer or area_answer. Both intersect beams [faces.h] with these faces by
 * beam_hits. A pattern answer uses one single ray per sample position. An area answer divides the
 * pixel into leaves [region.h], with one beam per leaf, until the interval of the pixel is at most
 * AnswerParams.width wide, or there are AnswerParams.leaves of them. */
#ifndef CORCAST_ANSWER_WORKSPACE_H
#define CORCAST_ANSWER_WORKSPACE_H

#include "answer/interval.h"
#include "answer/isosurface.h"

/* Capacities. If one is exceeded, the answer stays proven.
 * MAX_HITS: hits of a beam. The interval of a beam with more hits contains all colors of the scene.
 * MAX_CACHED, CACHE_FACES: entries of the cache of blockers, and faces in all entries. If the cache
 * is full, blockers are searched again for each leaf.
 * Reasons for the numbers are not recorded. */
enum { MAX_HITS = 48, MAX_CACHED = 32, CACHE_FACES = 4096 };

/* The faces that may block a light anywhere on the part of `face` that the present pixel shows:
 * AnswerWorkspace.cached_faces[begin] to [begin + n - 1]. */
typedef struct BlockerCacheEntry {
    const Face *face;
    size_t light, begin, n; /* light: index of the light */
} BlockerCacheEntry;

/* The workspace of a thread. Zeroed, then `plan` and the arrays of the lists are set. */
typedef struct AnswerWorkspace {
    const AnswerPlan *plan; /* borrowed */
    FaceList tile,
        pixel;         /* the faces that the present tile, and the present pixel, may show; owned */
    FaceList blockers; /* result of the last light_blockers; owned */
    LevelWorkspace levels;   /* for isosurfaces; owned */
    FaceHit hits[MAX_HITS];  /* result of the last beam_hits */
    LightBlocker blocker;    /* result of the last blocker_at */
    size_t beams, undecided; /* counts of this thread, for Answer */
    /* For area answers, about the present pixel: */
    Beam whole; /* all rays through the pixel */
    BlockerCacheEntry cached[MAX_CACHED];
    size_t n_cached, n_cached_faces;
    uint32_t cached_faces[CACHE_FACES];
    ARRAY(struct AreaLeaf) leaves; /* owned */
    Heap heap;       /* indices in `leaves`; the leaf with the widest interval is first; owned */
    json_t **record; /* JSON array that receives the parts of a leaf [certificate.h]; NULL: no
                      * certificate; borrowed */
} AnswerWorkspace;

/* The faces that may be visible in a beam: work->hits[0] to work->hits[n - 1]. */
typedef struct BeamHits {
    size_t n;
    bool overflows; /* there are more than MAX_HITS: the beam may have any color of the scene */
    bool covered;   /* all rays of the beam hit one of the faces: the background is not visible */
} BeamHits;

/* Intersects a beam with the faces of `list`. Sets work->hits to the hits that may be the first hit
 * of any ray of the beam. */
BeamHits beam_hits(AnswerWorkspace *work, const Beam *beam, const FaceList *list);

/* The vessel at the center of a pixel. */
typedef struct Center {
    uint32_t face; /* index of a face of the vessel; UINT32_MAX: no vessel, or not decided */
    /* Bounds of the vessel's depth, mm. Both infinite: no vessel. Only `far` infinite: it is not
     * decided which vessel is visible. */
    double near, far;
} Center;

/* Finds the vessel that a ray hits first, among the faces in work->pixel. Overwrites work->hits. */
void find_center(AnswerWorkspace *work, const Beam *ray, Center *center);

/* Computes the pattern answer of the pixel in column i and row j, from the faces in work->pixel. */
ColorInterval pattern_answer(AnswerWorkspace *work, int i, int j);
/* Computes the area answer of the pixel in column i and row j, from the faces in work->pixel.
 * Leaves the leaves of the pixel in work->leaves and work->heap. Errors: STATUS_MEMORY. */
MUST_CHECK Status area_answer(AnswerWorkspace *work, int i, int j, ColorInterval *out, Err *err);

#endif
