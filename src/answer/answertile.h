/* The pixels of a tile: what both kinds of answers share. */
#ifndef CORCAST_ANSWER_ANSWERTILE_H
#define CORCAST_ANSWER_ANSWERTILE_H

#include "answer/light.h"

enum {
    TILE_SIDE = 16, /* pixels */
    MAX_HITS = 48   /* most hits of a beam that are looked at; with more, the color is unknown */
};

/* Part of a pixel: the points of the rectangle that are in the square of `clip`. Pixels from the
 * pixel's center. */
typedef struct AreaLeaf {
    double x, y, across[2], along[2]; /* centre and half sides; ey is across a vessel */
    double clip[4];                   /* left, right, top, bottom */
    double low[3], high[3];           /* of the integral, in pixels */
    double turn[2];                   /* unit, across the wall that it shows alone; 0: none */
    bool turned;
    bool is_mixed; /* shows other faces than one wall, or is wide because of strips along cuts */
} AreaLeaf;

/* The blockers of a face for a light, as seen from a pixel: blockers.faces[begin..begin + n). */
typedef struct CachedBlockers {
    const Face *face;
    size_t light, begin, n;
} CachedBlockers;

enum { MAX_CACHED = 32, CACHE_FACES = 4096 };

/* The workspace of a thread. */
typedef struct AnswerWork {
    const AnswerPlan *plan;
    FaceList tile, pixel; /* faces in the tile, and in the pixel */
    FaceList blockers;
    CachedBlockers cached[MAX_CACHED]; /* of the present pixel's area answer */
    size_t n_cached, n_cached_faces;
    uint32_t cached_faces[CACHE_FACES];
    Beam whole; /* of the present pixel's area answer: all its rays */
    FaceHit hits[MAX_HITS];
    LightBlocker blocker;
    size_t beams, undecided;
    ARRAY(AreaLeaf) leaves; /* of a pixel; owned */
    Text *record;           /* receives the parts of leaves; NULL: nobody; borrowed */
    Heap heap;              /* of leaves, the widest first */
} AnswerWork;

/* A proven interval of colors. */
typedef struct ColorSpan {
    double low[3], high[3];
} ColorSpan;

/* Returns the span of every color of the scene. */
ColorSpan span_any(const AnswerPlan *plan);
/* Returns the span of a form's values, cut to the colors of the scene. */
ColorSpan span_of(const AnswerPlan *plan, const FormColor *color);
void span_include(ColorSpan *span, const ColorSpan *other);
/* Returns the largest width of a channel in sRGB, in plain doubles: widths choose what is refined
 * and what counts as decided, and are not part of what is proven. */
double span_width(const ColorSpan *span);
/* Sets the slopes of the sRGB curve at the middle of each channel. */
void span_slopes(const ColorSpan *span, double slopes[3]);

/* The first hits of a beam: work->hits[0..n) may be visible. */
typedef struct Seen {
    size_t n;
    bool crowded; /* there are more than MAX_HITS; nothing is known */
    bool covered; /* all rays hit one of them */
} Seen;

/* Finds the hits that may be the first of a ray, among the faces of `list`. */
Seen tile_look(AnswerWork *work, const Beam *beam, const FaceList *list);

/* What a ray finds at the center of a pixel. */
typedef struct Center {
    uint32_t face;    /* index of the face; UINT32_MAX: none, or not decided */
    double near, far; /* bounds of its depth, mm; infinite: no vessel is hit */
} Center;

/* Finds what a ray hits first. */
void find_center(AnswerWork *work, const Beam *ray, Center *center);

/* Computes the answer of a pixel by the pattern. */
ColorSpan pattern_answer(AnswerWork *work, int i, int j);
/* Computes the area answer of a pixel. Errors: STATUS_MEMORY. */
MUST_CHECK Status area_answer(AnswerWork *work, int i, int j, ColorSpan *out, Err *err);

#endif
