/* The door of the room render: scene -> image, in double precision with float colours, arranged so
 * that it repeats POV-Ray 3.7's arithmetic [docs/POVRAY.md]. */
#ifndef CORCAST_RENDER_RENDER_H
#define CORCAST_RENDER_RENDER_H

#include "base/base.h"
#include "image/image.h"
#include "render/job.h"
#include "render/light/shade.h"
#include "scene/scene.h"
#include "surface/surface.h"

/* Bands begin at multiples of so many rows. */
enum { RENDER_BAND_STEP = 8 };

/* A scene made ready to be drawn, whole or band by band. */
typedef struct Renderer Renderer;

/* Builds what rays need of the geometry; the scene is borrowed, and `params` as long as this call.
 * Until renderer_free, camera, lights and colours of the scene may change between calls, geometry
 * may not. What tiles need is built with the first rows, and anew only where camera, lights or
 * antialiasing have changed. STATUS_USAGE when this processor cannot run the kernels;
 * STATUS_MEMORY. */
MUST_CHECK Status renderer_new(const Scene *scene, const RenderParams *params, Renderer **out,
                               Err *err);
void renderer_free(Renderer *renderer);

/* Renders the rows first .. first + rows of the picture into *frame (owned), which has as many: the
 * very bytes that those rows have in the whole picture. `first` is a multiple of RENDER_BAND_STEP,
 * and so is `rows` unless they end with the picture. STATUS_MEMORY when the planes do not fit. */
MUST_CHECK Status renderer_rows(Renderer *renderer, int first, int rows, Frame *frame, Err *err);

/* What comes next has `antialias` of RenderParams. */
void renderer_antialias(Renderer *renderer, int antialias);

/* Of all calls so far, renderer_new included. */
RenderStats renderer_stats(const Renderer *renderer);

/* Renders the whole picture into *frame (owned). The same bytes for any number of threads.
 * STATUS_MEMORY when the planes do not fit. `stats` may be NULL. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

#endif
