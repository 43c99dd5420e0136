/* The pixels of a tile: what both kinds of answers share. */
#ifndef CORCAST_ANSWER_ANSWERTILE_H
#define CORCAST_ANSWER_ANSWERTILE_H

#include "answer/light.h"

enum {
    TILE_SIDE = 16, /* pixels */
    MAX_HITS = 48   /* most hits of a beam that are looked at; with more, the color is unknown */
};

/* The workspace of a thread. */
typedef struct AnswerWork {
    const AnswerPlan *plan;
    FaceList tile, pixel; /* faces in the tile, and in the pixel */
    FaceList blockers;
    FaceHit hits[MAX_HITS];
    LightBlocker blocker;
    size_t beams, undecided;
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

/* Returns the color of a single ray, and what it finds if `center` is not NULL. */
ColorSpan ray_answer(AnswerWork *work, const Beam *beam, const FaceList *list, Center *center);

/* Computes the answer of a pixel by the pattern. */
ColorSpan pattern_answer(AnswerWork *work, int i, int j, Center *center);

#endif
