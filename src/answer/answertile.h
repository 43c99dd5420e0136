/* The computation of one pixel: workspace, color intervals and visibility, which pattern answers
 * and area answers [answer.h] share. Pixels are computed in tiles, because all pixels of a tile
 * search one list of faces. These tiles are not the tiles of the renderer.
 *
 * A beam is the set of the camera rays through a rectangle of the picture, or a single ray
 * [faces.h]. A form encloses a quantity that varies over that rectangle, with a proven error
 * [affine.h]. An area answer divides its pixel into leaves, one beam each, until the sum of their
 * intervals is narrow enough or there are AnswerParams.leaves of them. A pixel is decided if its
 * interval is at most AnswerParams.width wide; an edge of a face is decided in a beam if all its
 * rays pass on the same side. */
#ifndef CORCAST_ANSWER_ANSWERTILE_H
#define CORCAST_ANSWER_ANSWERTILE_H

#include "answer/light.h"

enum {
    TILE_SIDE = 16, /* pixels along a side of a tile */
    MAX_HITS = 48   /* capacity for the hits of a beam. The interval of a beam with more hits
                     * contains all colors of the scene. */
};

/* A part of a pixel: a rectangle that may be turned, clipped to an upright square. All positions
 * are in pixels from the pixel's center. */
typedef struct AreaLeaf {
    /* Center of the rectangle, and its half sides. In the forms of the leaf's beam, ex grows along
     * `along`, and ey along `across`. */
    double x, y, across[2], along[2];
    double clip[4];         /* the square: left, right, top, bottom; unused unless `turned` */
    double low[3], high[3]; /* per channel: bounds of the integral of the color over the leaf, in
                             * color times square pixels */
    /* A square leaf that shows only the wall of one vessel is replaced by a turned leaf, because
     * color varies across a vessel and hardly along it. `turn` is the unit vector in the picture
     * across that vessel; (0, 0): the leaf is not replaced. */
    double turn[2];
    bool turned; /* `across` is across a vessel in the picture, and `along` along it */
    /* What makes the interval of the leaf wide. false: the shading of one wall. true: the leaf
     * shows several faces, or a face that is no wall, or strips along undecided edges cause more
     * than half of the width. */
    bool is_mixed;
} AreaLeaf;

/* Faces that may block a light on the part of a face that is visible in the present pixel:
 * AnswerWorkspace.cached_faces[begin] to [begin + n - 1]. */
typedef struct BlockerCacheEntry {
    const Face *face;
    size_t light, begin, n;
} BlockerCacheEntry;

/* Capacities of the cache. If it is full, blockers are searched again for each leaf. */
enum { MAX_CACHED = 32, CACHE_FACES = 4096 };

/* The workspace of a thread. */
typedef struct AnswerWorkspace {
    const AnswerPlan *plan;
    FaceList tile, pixel; /* faces in the present tile, and in the present pixel; owned */
    FaceList blockers;    /* result of the last answerplan_blockers; owned */
    BlockerCacheEntry cached[MAX_CACHED]; /* area answers: valid in the present pixel */
    size_t n_cached, n_cached_faces;
    uint32_t cached_faces[CACHE_FACES];
    Beam whole;             /* area answers: all rays of the present pixel */
    FaceHit hits[MAX_HITS]; /* result of the last beam_hits */
    LightBlocker blocker;
    size_t beams, undecided; /* counts of this thread, for Answer */
    ARRAY(AreaLeaf) leaves;  /* area answers: leaves of the present pixel; owned */
    json_t **record;         /* array that receives the parts of a leaf for a certificate; NULL: no
                              * certificate; borrowed */
    Heap heap; /* indices in `leaves`; the leaf with the widest interval first; owned */
} AnswerWorkspace;

/* A proven interval of linear colors: bounds per channel. */
typedef struct ColorInterval {
    double low[3], high[3];
} ColorInterval;

/* Returns the interval that contains every color of the scene. */
ColorInterval interval_of_scene(const AnswerPlan *plan);
ColorInterval interval_of_background(const AnswerPlan *plan);
/* Returns the interval of all values of a form, clamped to interval_of_scene. */
ColorInterval interval_of_form(const AnswerPlan *plan, const FormColor *color);
/* Extends *interval so that it contains *other. */
void interval_include(ColorInterval *interval, const ColorInterval *other);
/* Returns the width of the widest channel, in sRGB from 0 to 1. Rounding errors are ignored,
 * because the width only chooses which leaf is divided and which pixel counts as decided. The proof
 * does not depend on it. */
double interval_width(const ColorInterval *interval);
/* Sets slopes[c] to the slope of the sRGB curve at the middle of channel c. */
void interval_slopes(const ColorInterval *interval, double slopes[3]);

/* The faces that may be visible in a beam: work->hits[0] to work->hits[n - 1]. */
typedef struct BeamHits {
    size_t n;
    bool overflows; /* there are more than MAX_HITS; the beam may have any color of the scene */
    bool covered;   /* all rays of the beam hit one of the faces: the background is not visible */
} BeamHits;

/* Intersects a beam with the faces of `list`. Sets work->hits to the hits that may be the first hit
 * of any ray of the beam. */
BeamHits beam_hits(AnswerWorkspace *work, const Beam *beam, const FaceList *list);

/* The vessel at the center of a pixel. */
typedef struct Center {
    uint32_t face; /* index of a face of the first vessel; UINT32_MAX: no vessel, or not decided */
    double near, far; /* bounds of its depth, mm; both infinite: no vessel is hit; `far` alone
                       * infinite: not decided */
} Center;

/* Finds the vessel that a ray hits first, among the faces in work->pixel. */
void find_center(AnswerWorkspace *work, const Beam *ray, Center *center);

/* Computes the pattern answer of the pixel in column i and row j, from the faces in work->pixel. */
ColorInterval pattern_answer(AnswerWorkspace *work, int i, int j);
/* Computes the area answer of the pixel in column i and row j, from the faces in work->pixel.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status area_answer(AnswerWorkspace *work, int i, int j, ColorInterval *out, Err *err);

#endif
