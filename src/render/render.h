/* The door of the room render: geometry, view and appearance -> image, in double precision with
 * float colours, arranged so that it repeats POV-Ray 3.7's arithmetic [docs/POVRAY.md]. */
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

/* Draws one geometry in any views and appearances. */
typedef struct Renderer Renderer;

/* Builds what every view needs of the geometry, which is borrowed until renderer_free; `params` is
 * copied. STATUS_USAGE when this processor cannot run the kernels; STATUS_MEMORY;
 * STATUS_INFEASIBLE when POV-Ray's cells of an isosurface cannot be built. */
MUST_CHECK Status renderer_new(const Geometry *geometry, const RenderParams *params, Renderer **out,
                               Err *err);
void renderer_free(Renderer *renderer);

/* Renders the rows first .. first + rows of the picture of a view into *frame (owned), which has as
 * many: the very bytes that those rows have in the whole picture. `first` is a multiple of
 * RENDER_BAND_STEP, and so is `rows` unless they end with the picture.
 *
 * What the view needs of the geometry is prepared with its first rows and kept for the next ones as
 * long as camera, lights and ground plane, bit by bit, and antialiasing stay the same. Another
 * appearance or background costs its pixels alone, a transparent view, whose frame has alpha,
 * twice. The planes of geometry that are wanted beside colours do not change the colours. Neither
 * view nor appearance is kept. Not to be called by two threads at once. STATUS_MEMORY when the
 * planes do not fit; STATUS_USAGE when the method cannot draw this view (RENDER_ZBUFFER from among
 * the vessels, RENDER_RASTER of more than 524,280 pixels a side). */
MUST_CHECK Status renderer_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                                int first, int rows, Frame *frame, Err *err);

/* Sets `antialias` of RenderParams for the rows to come. */
void renderer_antialias(Renderer *renderer, int antialias);

/* Of all calls so far, renderer_new included. */
RenderStats renderer_stats(const Renderer *renderer);

/* Renders the whole picture into *frame (owned). The same bytes for any number of threads.
 * STATUS_MEMORY when the planes do not fit. `stats` may be NULL. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

/* Returns how near to the camera vessels of this geometry are not seen, mm: POV-Ray's limit. */
double render_nearest_mm(const Geometry *geometry);

/* The fastest instructions that this processor has; never KERNELS_FASTEST. */
RenderKernels render_fastest_kernels(void);

#endif
