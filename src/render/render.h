/* The public header of render: draws a geometry in a view and an appearance. Rays are computed in
 * double precision, in POV-Ray 3.7's order of operations [docs/POVRAY.md]; colors are floats. */
#ifndef CORCAST_RENDER_RENDER_H
#define CORCAST_RENDER_RENDER_H

#include "base/base.h"
#include "field/field.h"
#include "image/image.h"
#include "render/ink/ink.h"
#include "render/job.h"
#include "render/light/shade.h"
#include "scene/scene.h"

/* Bands begin at multiples of this many rows. */
enum { RENDER_BAND_STEP = 8 };

/* Draws one geometry in any number of views and appearances. */
typedef struct Renderer Renderer;

/* Makes a renderer, and builds the search structures that every view needs.
 *
 * geometry  borrowed until renderer_free.
 * params    copied.
 * Errors    STATUS_USAGE if this processor cannot run the kernels; STATUS_INFEASIBLE if POV-Ray's
 *           cells of an isosurface cannot be built; STATUS_MEMORY. */
MUST_CHECK Status renderer_new(const Geometry *geometry, const RenderParams *params, Renderer **out,
                               Err *err);
void renderer_free(Renderer *renderer);

/* Renders the rows [first, first + rows) of the picture of a view. They have the bytes that they
 * have in the whole picture.
 *
 * What the view needs of the geometry is prepared with its first rows. It is kept for later calls
 * as long as camera, lights and ground plane stay the same, bit by bit, and antialiasing does, too.
 * A call with another appearance or background costs its pixels only. A transparent view, whose
 * frame has alpha, costs twice as much. Planes of geometry that are wanted beside colors do not
 * change the colors.
 *
 * view, appearance  not kept after the call.
 * first    a multiple of RENDER_BAND_STEP.
 * rows     a multiple of RENDER_BAND_STEP, unless the rows end with the picture.
 * frame    receives the planes of these rows; owned by the caller.
 * Errors   STATUS_MEMORY; STATUS_USAGE if the method cannot draw this view: RENDER_ZBUFFER from
 *          among the vessels, RENDER_RASTER with more than 524,280 pixels per side.
 * Threads  calls with one renderer must not overlap. */
MUST_CHECK Status renderer_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                                int first, int rows, Frame *frame, Err *err);

/* Sets RenderParams.antialias for later calls of renderer_rows. */
void renderer_antialias(Renderer *renderer, int antialias);

/* Returns the statistics of all calls so far, including renderer_new. */
RenderStats renderer_stats(const Renderer *renderer);

/* Renders the whole picture of a scene. The bytes do not depend on the number of threads.
 *
 * frame    receives the planes; owned by the caller.
 * stats    NULL is allowed.
 * Errors   those of renderer_new and renderer_rows. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

/* Returns the distance from the camera, mm, up to which vessels of this geometry are not visible:
 * POV-Ray's limit. */
double render_nearest_mm(const Geometry *geometry);

/* Returns the fastest kernels that this processor can run; never KERNELS_FASTEST. */
RenderKernels render_fastest_kernels(void);

#endif
