/* Converts vessels to a line drawing on paper: strokes along their visible outlines, as for a pen.
 * Coordinates of strokes are mm on the paper. */
#ifndef CORCAST_RENDER_INK_INK_H
#define CORCAST_RENDER_INK_INK_H

#include "base/base.h"
#include "scene/scene.h"

/* Parameters of ink_strokes. */
typedef struct InkParams {
    double width_mm; /* width of the paper, mm, > 0; the height follows from the shape of the
                      * picture */
    double line_mm;  /* width of a line, mm, > 0 */
    int threads;     /* number of threads; 0: one per processor */
} InkParams;

/* Computes the strokes of a geometry of primitives.
 *
 * A vessel that is wider on paper than line_mm is represented by its two outlines. Their strokes
 * are inside the vessel, so that their outer edges are the edges of the vessel. A thinner vessel is
 * represented by one stroke, as wide as the vessel. Strokes end where they are hidden by a vessel,
 * to within 0.01 line_mm, which is too little to see. Visibility is tested every 0.5 line_mm, so a
 * shorter hidden part may be drawn. Strokes that meet end to end are joined.
 *
 * strokes   receives the strokes; release it with strokes_release. Unchanged on failure. The result
 *           does not depend on the number of threads.
 * Errors    STATUS_MEMORY; STATUS_USAGE if a vessel is not in front of the camera.
 * Cost      O(n log n + total length of the strokes / line_mm) for n vessels. */
MUST_CHECK Status ink_strokes(const Geometry *geometry, const View *view, const InkParams *params,
                              Strokes *strokes, Err *err);

#endif
