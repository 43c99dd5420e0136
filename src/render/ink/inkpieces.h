/* Collects pieces of lines on paper and joins them to strokes. A piece is a polyline that one
 * vessel contributes; a stroke is a chain of pieces whose ends meet. The calls are inkpieces_begin
 * and inkpieces_add for each piece, inkpieces_append to merge lists, and finally inkpieces_join. */
#ifndef CORCAST_RENDER_INK_INKPIECES_H
#define CORCAST_RENDER_INK_INKPIECES_H

#include "base/base.h"
#include "scene/scene.h"

/* A list of pieces. A zeroed list is empty. Release it with inkpieces_release. */
typedef struct InkPieces {
    Strokes list; /* its width_mm and height_mm are not used */
    size_t points_capacity, strokes_capacity;
} InkPieces;

/* Begins a piece of this width, without points. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_begin(InkPieces *pieces, double width_mm, Err *err);
/* Adds a point, in mm on the paper, to the piece that was begun last. At least one piece must have
 * been begun. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_add(InkPieces *pieces, const double point[2], Err *err);
/* Appends copies of the pieces of `more`, clipped to the paper. Clipping may divide a piece.
 * `paper` is the width and height of the paper, mm. Errors: STATUS_MEMORY. */
MUST_CHECK Status inkpieces_append(InkPieces *pieces, const InkPieces *more, const double paper[2],
                                   Err *err);
void inkpieces_release(InkPieces *pieces);

/* Joins pieces of equal width whose ends are within 0.02 mm of each other: far more than the error
 * of ends that meet, and too little to see. Each end is joined to at most one other end.
 *
 * strokes   receives the strokes, in the order of their first pieces; release it with
 *           strokes_release.
 * Errors    STATUS_MEMORY.
 * Cost      O(n log n). */
MUST_CHECK Status inkpieces_join(const InkPieces *pieces, Strokes *strokes, Err *err);

#endif
