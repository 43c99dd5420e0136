/* Pieces of lines on paper, joined to strokes. */
#ifndef CORCAST_RENDER_INKPIECES_H
#define CORCAST_RENDER_INKPIECES_H

#include "base/base.h"
#include "scene/scene.h"

/* A growing list; zeroed: empty. Its size on paper is not used. */
typedef struct InkPieces {
    Strokes list;
    size_t points_capacity, strokes_capacity;
} InkPieces;

/* Begins a piece of this width, without points. STATUS_MEMORY. */
MUST_CHECK Status inkpieces_begin(InkPieces *pieces, double width_mm, Err *err);
/* Adds a point to the last piece. STATUS_MEMORY. */
MUST_CHECK Status inkpieces_add(InkPieces *pieces, const double point[2], Err *err);
/* Appends the parts of all of `more` that lie on a paper of this size, mm. STATUS_MEMORY. */
MUST_CHECK Status inkpieces_append(InkPieces *pieces, const InkPieces *more, const double paper[2],
                                   Err *err);
void inkpieces_release(InkPieces *pieces);

/* Joins pieces of one width that end within 0.02 mm of each other, each end with one other at most,
 * in *strokes (owned), in the order of the first piece of each. STATUS_MEMORY. O(n log n). */
MUST_CHECK Status inkpieces_join(const InkPieces *pieces, Strokes *strokes, Err *err);

#endif
