/* The door of the room render: scene -> image, in double precision with float colours, arranged so
 * that it repeats POV-Ray 3.7's arithmetic [docs/POVRAY.md]. */
#ifndef CORCAST_RENDER_RENDER_H
#define CORCAST_RENDER_RENDER_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"
#include "surface/surface.h"

typedef struct RenderParams {
    int threads;   /* 0: all processors */
    int antialias; /* 1: one ray through each pixel's centre; N > 1: that ray and N x N more, the
                    * places and weights of POV-Ray's +A0.0 +AM1 +RN -J */
    double antialias_threshold; /* 0: every pixel; else those that resample_mask tells, in (0, 1] */
    bool shadows;
    const CellParams *povray_cells; /* of an implicit model: where POV-Ray's root finder sees it in
                                     * these cells; NULL: where it is, by proof */
    bool want_color, want_depth, want_normal, want_id; /* geometry planes are of the centre ray */
    void (*progress)(double fraction, void *context);  /* called by one thread; may be NULL */
    void *progress_context;
} RenderParams;

typedef struct RenderStats {
    double prepare_s; /* building the search structure */
    double trace_s;
    size_t rays; /* primary */
} RenderStats;

/* Renders into *frame (owned). The same bytes for any number of threads. STATUS_MEMORY when the
 * planes do not fit. `stats` may be NULL. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

#endif
