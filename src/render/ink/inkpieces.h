/* Pieces of lines on paper, which are joined to strokes. */
#ifndef CORCAST_RENDER_INKPIECES_H
#define CORCAST_RENDER_INKPIECES_H

#include "base/base.h"
#include "scene/scene.h"

/* A growing list of pieces; zeroed, it is empty. Release it with inkpieces_release. */
typedef struct InkPieces {
    Strokes list; /* its width_mm and height_mm are not used */
    size_t points_capacity, strokes_capacity;
} InkPieces;

/* Begins a piece of this width, without points. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_begin(InkPieces *pieces, double width_mm, Err *err);
/* Adds a point, in mm on paper, to the last piece. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_add(InkPieces *pieces, const double point[2], Err *err);
/* Appends the pieces of `more`, clipped to the paper. `paper` is its width and height, mm.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_append(InkPieces *pieces, const InkPieces *more, const double paper[2],
                                   Err *err);
void inkpieces_release(InkPieces *pieces);

/* Joins pieces of equal width whose ends lie within 0.02 mm of each other. Each end is joined to at
 * most one other.
 *
 * strokes   receives the strokes, in the order of their first pieces; owned by the caller.
 * Errors    STATUS_MEMORY.
 * Cost      O(n log n). */
MUST_CHECK Status inkpieces_join(const InkPieces *pieces, Strokes *strokes, Err *err);

#endif
