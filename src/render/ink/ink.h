/* Draws vessels as lines on paper: their visible outlines, as strokes of a pen. */
#ifndef CORCAST_RENDER_INK_INK_H
#define CORCAST_RENDER_INK_INK_H

#include "base/base.h"
#include "scene/scene.h"

typedef struct InkParams {
    double width_mm; /* width of the paper, mm, > 0; its height follows from the camera */
    double line_mm;  /* width of a line, mm, > 0 */
    int threads;     /* 0: all processors */
} InkParams;

/* Draws a geometry of primitives as lines.
 *
 * A vessel that is wider on paper than a line is drawn by its outlines. They lie inside the vessel:
 * their outer edges are the vessel's true edges. A thinner vessel is drawn by one line, as wide as
 * the vessel. What is behind or inside a vessel is left out, to a hundredth of a line; hidden parts
 * shorter than half a line may be drawn. Strokes that meet end to end are joined.
 *
 * strokes   receives the lines; release it with strokes_release. Unchanged on failure. The lines do
 *           not depend on the number of threads.
 * Errors    STATUS_MEMORY; STATUS_USAGE if a vessel is not in front of the camera.
 * Cost      O(n log n) for n vessels and the lengths of their lines. */
MUST_CHECK Status ink_draw(const Geometry *geometry, const View *view, const InkParams *params,
                           Strokes *strokes, Err *err);

#endif
