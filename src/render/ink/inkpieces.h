/* Collects pieces of lines on paper and joins them to strokes. A piece is a polyline as one vessel
 * contributes it; a stroke is a chain of pieces whose ends meet. */
#ifndef CORCAST_RENDER_INK_INKPIECES_H
#define CORCAST_RENDER_INK_INKPIECES_H

#include "base/base.h"
#include "scene/scene.h"

/* A growing list of pieces; zeroed, it is empty. Release it with inkpieces_release. */
typedef struct InkPieces {
    Strokes list; /* its width_mm and height_mm are not used */
    size_t points_capacity, strokes_capacity;
} InkPieces;

/* Begins a piece of this width, without points. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_begin(InkPieces *pieces, double width_mm, Err *err);
/* Adds a point, in mm on paper, to the piece that was begun last; there must be one. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status inkpieces_add(InkPieces *pieces, const double point[2], Err *err);
/* Appends the pieces of `more`, clipped to the paper, which may divide a piece. `more` is
 * unchanged. `paper` is width and height, mm. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_append(InkPieces *pieces, const InkPieces *more, const double paper[2],
                                   Err *err);
void inkpieces_release(InkPieces *pieces);

/* Joins pieces of equal width whose ends lie within 0.02 mm of each other. Each end is joined to at
 * most one other.
 *
 * strokes   receives the strokes, in the order of their first pieces; release it with
 *           strokes_release.
 * Errors    STATUS_MEMORY.
 * Cost      O(n log n). */
MUST_CHECK Status inkpieces_join(const InkPieces *pieces, Strokes *strokes, Err *err);

#endif
