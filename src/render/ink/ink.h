/* Vessels as a line drawing: the outlines that are seen, as lines on paper. */
#ifndef CORCAST_RENDER_INK_H
#define CORCAST_RENDER_INK_H

#include "base/base.h"
#include "scene/scene.h"

typedef struct InkParams {
    double width_mm; /* of the paper; its height follows from the camera */
    double line_mm;  /* width of a line, > 0 */
    int threads;     /* 0: all processors */
} InkParams;

/* Draws the models of cylinders, joints and balls (MODEL_PRIMITIVES) in
 * *strokes (owned). A vessel wider on paper than two lines is drawn by its outlines, inside it, so
 * that their outer edges are the vessel's true edges; a thinner one by one line as wide as the
 * vessel. What lies behind or inside a vessel is left out, to a hundredth of a line; hidden parts
 * shorter than half a line may be drawn. Strokes that meet end to end are one. The same strokes for
 * any number of threads. STATUS_MEMORY; STATUS_USAGE when a vessel is not in front of the camera.
 * O(n log n) of n vessels and of the length of their lines.
 */
MUST_CHECK Status ink_draw(const Geometry *geometry, const View *view, const InkParams *params,
                           Strokes *strokes, Err *err);

#endif
