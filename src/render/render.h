/* The public header of the module render: draws a geometry, with a view and an appearance, into the
 * planes of a Frame.
 *
 * `render` draws a whole Scene in one call. A Renderer draws several pictures of one geometry, or a
 * picture in bands of rows:
 *
 *     Renderer *renderer;
 *     TRY(renderer_new(&geometry, &params, &renderer, err));
 *     TRY(renderer_rows(renderer, &view, &appearance, 0, view.camera.height, &frame, err));
 *     renderer_free(renderer);
 *
 * Rays are computed in double precision, in the order of operations of POV-Ray 3.7
 * [docs/POVRAY.md]. Colors are linear floats. Lengths are in mm. */
#ifndef CORCAST_RENDER_RENDER_H
#define CORCAST_RENDER_RENDER_H

#include "base/base.h"
#include "field/field.h"
#include "image/image.h"
#include "render/ink/ink.h"
#include "render/job.h"
#include "render/light/shade.h"
#include "scene/scene.h"

/* Bands begin at multiples of this many rows. It equals the height of a tile [tile.h]. */
enum { RENDER_BAND_STEP = 8 };

/* Draws one geometry in any number of views and appearances. */
typedef struct Renderer Renderer;

/* Creates a renderer, and builds the search structures that every view needs.
 *
 * geometry  borrowed until renderer_free.
 * params    copied.
 * out       receives the renderer; release it with renderer_free. Set on success only.
 * Errors    STATUS_USAGE if this processor cannot run the kernels; STATUS_INFEASIBLE if POV-Ray's
 *           cells of an isosurface cannot be built; STATUS_MEMORY. */
MUST_CHECK Status renderer_new(const Geometry *geometry, const RenderParams *params, Renderer **out,
                               Err *err);
/* Frees the renderer. NULL is allowed. */
void renderer_free(Renderer *renderer);

/* Renders the rows [first, first + rows) of the image of a view. The bytes are those of the same
 * rows of the whole image.
 *
 * The first call for a view prepares the view. Later calls reuse the prepared data if camera,
 * lights, ground plane and antialiasing are the same, bit by bit; appearance and background may
 * differ, and only the pixels are then computed. A transparent view, whose frame has alpha, takes
 * twice the time. The colors do not depend on whether planes of depth, normal or id are wanted.
 *
 * view, appearance  not used after the call.
 * first    a multiple of RENDER_BAND_STEP.
 * rows     a multiple of RENDER_BAND_STEP, unless the rows end with the image.
 * frame    receives the planes of these rows; the caller releases it with frame_release, even after
 *          an error.
 * Errors   STATUS_MEMORY. STATUS_CANCELLED if params->progress asks to stop. STATUS_USAGE if the
 *          method cannot draw this view: RENDER_ZBUFFER with a camera among the vessels,
 *          RENDER_RASTER with more than 524,280 pixels (65,535 tiles) per side.
 * Threads  calls with one renderer must not overlap. */
MUST_CHECK Status renderer_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                                int first, int rows, Frame *frame, Err *err);

/* Sets RenderParams.antialias for later calls of renderer_rows. */
void renderer_antialias(Renderer *renderer, int antialias);

/* Returns the statistics of all calls so far, including renderer_new. */
RenderStats renderer_stats(const Renderer *renderer);

/* Renders the whole image of a scene. The bytes do not depend on the number of threads.
 *
 * frame    receives the planes; owned by the caller.
 * stats    receives the statistics; NULL is allowed.
 * Errors   those of renderer_new and renderer_rows. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

/* Returns the distance from the camera, mm, below which surfaces of this geometry are not visible.
 * This is POV-Ray's limit. */
double render_nearest_mm(const Geometry *geometry);

/* Returns the fastest kernels that this processor can run; never KERNELS_FASTEST. */
RenderKernels render_fastest_kernels(void);

#endif
