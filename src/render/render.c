/* Selects the engine (the drawing method) for a picture, and keeps the data that several pictures
 * share.
 *
 * A picture is drawn in passes: one for the colors, and one for the planes of geometry (depth,
 * normal, segment id). If the pass of the colors computes these planes as well, there is only one
 * pass [opaque_rows]. The first engine of the table `engines` that supports a drawing draws it.
 * Special engines come first; the engine of rays, which supports every drawing, comes last.
 *
 * The shared data have three lifetimes. Data of the geometry, such as the search structure of rays
 * (Caster), are built once. Data of a view, such as the lists of vessels per tile and the light
 * views, are kept as long as the key of the view stays the same [ViewKey]. An appearance affects
 * colors only, so nothing is kept for it.
 *
 * Vessels that are narrower than the distance of samples are drawn by coverage: by the area that
 * they cover in each sample's cell [thin/thinvessels.h]. A second renderer of the same geometry,
 * the covering renderer, then draws the colors. Its engine leaves the thin vessels out, and their
 * strips are drawn over its samples. All vessels, thin ones too, cast shadows and block ambient
 * light. How much of each light the thin vessels receive is computed once per view: for soft area
 * lights together with the first band, whose light views it shares; for all other lights right
 * after that.
 *
 * If effects (outlines, halos) are on, a picture with N x N samples per pixel is drawn as a picture
 * with N x N times as many pixels, a part of the band at a time. Its pixels are the samples on
 * which the effects are drawn. A pixel of the result is the mean of its samples. */
#include "render/render.h"

#include "render/cast/caster.h"
#include "render/effect/effect.h"
#include "render/engine.h"
#include "render/light/bandvisibility.h"
#include "render/thin/thinvessels.h"
#include "render/tile/tilekernels.h"
#include "render/tile/tilerender.h"
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const Engine *const engines[] = {&xray_engine, &field_engine, &raster_engine,
                                        &zbuffer_engine, &ray_engine};

/* Everything that decides what is prepared for a view. Keys are compared by their bytes: unused
 * members and padding are zero. has_color is last and is compared apart: what was prepared for
 * colors, which need shadows, also serves planes of geometry. */
typedef struct ViewKey {
    const Engine *engine; /* NULL: no engine is prepared */
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    bool has_ground; /* the ground decides which lights reach all vessels */
    Vec3 ground_normal;
    double ground_offset_mm;
    int antialias;
    bool has_color;
} ViewKey;

struct Renderer {
    const Geometry *geometry;
    RenderParams params; /* of the caller; `threads` is the actual number */
    RenderStats stats;
    /* Data of the geometry. Each is made when it is first needed: */
    Caster *caster;
    TermMean *mean;
    RadiusTable radii;
    OccluderSet occluders;
    /* Data of the current view: */
    ViewKey key;
    void *prepared;     /* result of Engine.prepare for `key`; owned */
    Renderer *covering; /* draws the colors of views with thin vessels; NULL until there is one */
    /* Only in a covering renderer: */
    ViewKey thin_key; /* of `thin`; without an engine */
    ThinVessels thin;
    OffPixelPoints *unlit; /* &thin.lights until the light visibility at the thin vessels is
                            * computed; then NULL */
};

/* ---- planes ---------------------------------------------------------------------------------- */

/* Allocates the planes that `params` asks for. Their pixels are undefined. Colors are 8-bit codes
 * if `codes`, else floats. The caller releases *frame, even after an error. */
static Status make_planes(int width, int height, const RenderParams *params, bool codes,
                          Frame *frame, Err *err)
{
    if (params->want_color && codes)
        TRY(picture_init(&frame->codes, width, height, 3, 8, err));
    else if (params->want_color)
        TRY(plane_init_unset(&frame->color, width, height, 3, err));
    if (params->want_depth)
        TRY(plane_init_unset(&frame->depth, width, height, 1, err));
    if (params->want_normal)
        TRY(plane_init_unset(&frame->normal, width, height, 3, err));
    if (params->want_id)
        TRY(idplane_init(&frame->id, width, height, err));
    return STATUS_OK;
}

static void crop_plane(Plane *plane, const Band *band)
{
    if (!plane->values)
        return;
    size_t row = (size_t)plane->width * (size_t)plane->channels;
    plane->height = band->rows - band->above - band->below;
    memmove(plane->values, plane->values + (size_t)band->above * row,
            (size_t)plane->height * row * sizeof *plane->values);
}

/* Removes the rows above and below the band. A frame with 8-bit codes has no such rows. */
static void crop_planes(Frame *frame, const Band *band)
{
    crop_plane(&frame->color, band);
    crop_plane(&frame->depth, band);
    crop_plane(&frame->normal, band);
    if (!frame->id.ids)
        return;
    size_t width = (size_t)frame->id.width;
    frame->id.height = band->rows - band->above - band->below;
    memmove(frame->id.ids, frame->id.ids + (size_t)band->above * width,
            (size_t)frame->id.height * width * sizeof *frame->id.ids);
}

/* ---- preparation ----------------------------------------------------------------------------- */

static const Engine *engine_for(const Drawing *drawing)
{
    size_t i = 0;
    while (!engines[i]->supports(drawing))
        i++;
    return engines[i];
}

/* Makes the caster unless there is one. */
static Status make_caster(Renderer *renderer, Err *err)
{
    const RenderParams *params = &renderer->params;
    if (renderer->caster)
        return STATUS_OK;
    double start_s = clock_seconds();
    TRY(caster_new(renderer->geometry, params->povray_cells, params->threads, &renderer->caster,
                   err));
    if (params->shadow_from_mm > 0)
        caster_set_shadow_nearest(renderer->caster, params->shadow_from_mm);
    renderer->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

/* Makes the caster if the drawing's engine casts rays, and sets drawing->caster. */
static Status prepare_caster(Renderer *renderer, Drawing *drawing, Err *err)
{
    const Engine *engine = engine_for(drawing);
    if (engine->needs_rays
            ? engine->needs_rays(drawing)
            : engine->tiles && shadowengine_needs_rays(engine->tiles->shadows, drawing))
        TRY(make_caster(renderer, err));
    drawing->caster = renderer->caster;
    return STATUS_OK;
}

/* Sets drawing->mean, by which colors blend between the segments of an implicit surface. Makes it
 * if the drawing needs it and there is none. */
static Status prepare_mean(Renderer *renderer, Drawing *drawing, Err *err)
{
    if (!drawing->appearance->positions || !model_has(renderer->geometry->model, MODEL_FIELD))
        return STATUS_OK;
    double start_s = clock_seconds();
    if (!renderer->mean)
        TRY(termmean_new(renderer->geometry, &renderer->mean, err));
    renderer->stats.prepare_s += clock_seconds() - start_s;
    drawing->mean = renderer->mean;
    return STATUS_OK;
}

RenderKernels render_fastest_kernels(void)
{
    return (RenderKernels)kernels_usable();
}

double render_nearest_mm(const Geometry *geometry)
{
    return caster_nearest_mm(geometry);
}

static Status check_kernels(RenderKernels kernels, Err *err)
{
    int usable = kernels_usable();
    if ((int)kernels <= usable)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "`kernels`: this processor cannot run %s, at most %s",
                   render_kernel_names[kernels], render_kernel_names[usable]);
}

Status renderer_new(const Geometry *geometry, const RenderParams *params, Renderer **out, Err *err)
{
    static const View plain; /* has no lights and no ground: all views need what it needs */
    Renderer *renderer;
    double start_cpu_s = clock_cpu_seconds();
    TRY(check_kernels(params->kernels, err));
    TRY(mem_calloc(&renderer, 1, sizeof *renderer, "renderers", err));
    renderer->geometry = geometry;
    renderer->params = *params;
    if (params->threads <= 0)
        renderer->params.threads = threads_available();
    Drawing any = {.geometry = geometry, .view = &plain, .params = &renderer->params};
    Status status = params->cover_thin ? STATUS_OK : prepare_caster(renderer, &any, err);
    if (status != STATUS_OK) {
        renderer_free(renderer);
        return status;
    }
    renderer->stats.cpu_s = clock_cpu_seconds() - start_cpu_s;
    *out = renderer;
    return STATUS_OK;
}

static void forget_view(Renderer *renderer)
{
    if (renderer->prepared)
        renderer->key.engine->free(renderer->prepared);
    renderer->prepared = NULL;
    renderer->key.engine = NULL;
}

void renderer_free(Renderer *renderer)
{
    if (!renderer)
        return;
    forget_view(renderer);
    renderer_free(renderer->covering);
    thinvessels_release(&renderer->thin);
    caster_free(renderer->caster);
    termmean_free(renderer->mean);
    radiustable_release(&renderer->radii);
    occluderset_release(&renderer->occluders);
    free(renderer);
}

static void key_make(ViewKey *key, const Engine *engine, const Camera *camera, const View *view,
                     const RenderParams *params)
{
    memset(key, 0, sizeof *key);
    key->engine = engine;
    memcpy(&key->camera, camera, sizeof *camera);
    memcpy(key->lights, view->lights, view->n_lights * sizeof *view->lights);
    key->n_lights = view->n_lights;
    key->has_ground = view->ground.present;
    if (key->has_ground) {
        key->ground_normal = view->ground.normal;
        key->ground_offset_mm = view->ground.offset_mm;
    }
    key->antialias = params->antialias;
    key->has_color = params->want_color;
}

/* Returns true if what was prepared for `key` serves what `wanted` asks for. */
static bool key_serves(const ViewKey *key, const ViewKey *wanted)
{
    return memcmp(key, wanted, offsetof(ViewKey, has_color)) == 0 &&
           (key->has_color || !wanted->has_color);
}

/* Prepares the engine for the drawing's view, unless what is prepared serves it. */
static Status prepare_view(Renderer *renderer, const Drawing *drawing, Err *err)
{
    const Engine *engine = engine_for(drawing);
    const double start_s = clock_seconds();
    ViewKey key;
    key_make(&key, engine, &drawing->view->camera, drawing->view, drawing->params);
    if (key_serves(&renderer->key, &key))
        return STATUS_OK;
    forget_view(renderer);
    if (engine->prepare)
        TRY(engine->prepare(engine->tiles, drawing, &renderer->prepared, err));
    memcpy(&renderer->key, &key, sizeof key);
    renderer->stats.engine = engine->name;
    renderer->stats.preparations++;
    renderer->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

void renderer_antialias(Renderer *renderer, int antialias)
{
    renderer->params.antialias = antialias;
    if (renderer->covering)
        renderer_antialias(renderer->covering, antialias);
}

RenderStats renderer_stats(const Renderer *renderer)
{
    RenderStats stats = renderer->stats;
    if (renderer->covering)
        renderstats_add(&stats, &renderer->covering->stats);
    return stats;
}

/* Returns the band of the rows [first, first + rows) of a picture, with up to `margin` more rows
 * above and below. */
static Band band_between(int first, int rows, int margin, int height)
{
    int left = height - first - rows;
    int above = first < margin ? first : margin, below = left < margin ? left : margin;
    return (Band){
        .first = first - above, .rows = rows + above + below, .above = above, .below = below};
}

/* ---- shared visibility ----------------------------------------------------------------------- */

/* A DrawVesselPlanes whose context is a renderer. */
static Status draw_vessel_planes(const Drawing *drawing, void *context, Frame *planes, Err *err)
{
    const Renderer *renderer = context;
    RenderParams params = *drawing->params;
    View vessels = *drawing->view;
    vessels.ground.present = false; /* the planes show vessels only */
    params.want_color = params.want_id = false;
    params.want_depth = params.want_normal = true;
    params.antialias = 1;
    params.occlusion = 0;
    params.progress = NULL;
    Drawing seen = *drawing;
    seen.params = &params;
    seen.view = &vessels;
    TRY(make_planes(drawing->view->camera.width, drawing->band.rows, &params, false, planes, err));
    return renderer->key.engine->rows(&seen, renderer->prepared, planes, err);
}

static int rounded_up(int rows, int step)
{
    return (rows + step - 1) / step * step;
}

/* Returns the drawing with a wider band: `margin` rows more above and below, extended to whole
 * blocks of `block` rows of the picture. The rows that were added count as rows of the band, so
 * that none of them is cropped. */
static Drawing widened(const Drawing *drawing, int margin, int block)
{
    const Band *band = &drawing->band;
    const int height = drawing->view->camera.height;
    const Band wide = band_between(band->first, band->rows, margin, height);
    int first = wide.first / block * block, end = rounded_up(wide.first + wide.rows, block);
    Drawing all = *drawing;
    all.band = (Band){.first = first, .rows = (end < height ? end : height) - first};
    return all;
}

/* Computes the ambient and light visibility that the samples of a pixel share, in the drawing's
 * band and at least `margin` rows above and below. Leaves *out unset if the drawing needs none. */
static Status find_shared_visibility(Renderer *renderer, const Drawing *drawing, int margin,
                                     PixelVisibility **out, Err *err)
{
    const RenderParams *params = drawing->params;
    if (!pixelvisibility_is_needed(drawing->view, params))
        return STATUS_OK;
    if (params->occlusion > 0 && !renderer->occluders.capsules)
        TRY(occluderset_new(renderer->geometry, &renderer->occluders, err));
    const bool soft = softshadows_are_on(drawing->view, params);
    const Drawing wide = widened(drawing, margin, soft ? VISIBILITY_BLOCK : 1);
    const TileEngine *tiles = renderer->key.engine->tiles;
    const VisibilitySources from = {.draw_planes = draw_vessel_planes,
                                    .context = renderer,
                                    .engine = tiles ? tiles->shadows : NULL,
                                    .occluders = &renderer->occluders,
                                    .off_pixel = renderer->unlit};
    return pixelvisibility_compute(&wide, &from, out, err);
}

/* ---- visibility at thin vessels -------------------------------------------------------------- */

/* Computes the visibility of one light at the thin vessels: by the light view that the engine made,
 * or by rays if there is none. */
static Status find_one_light_at_thin(Renderer *renderer, const Drawing *drawing, size_t light,
                                     Err *err)
{
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    LightBins *bins =
        renderer->key.engine->tiles ? tilerender_light_bins(renderer->prepared, light) : NULL;
    if (bins)
        return offpixel_query(drawing, &(OffPixelViews){&bins, 1, &eye}, light, renderer->unlit,
                              err);
    Drawing casting = *drawing;
    TRY(make_caster(renderer, err));
    casting.caster = renderer->caster;
    offpixel_trace(&casting, light, renderer->unlit);
    return STATUS_OK;
}

/* Computes the visibility of lights with hard shadows, and of ambient light, at the thin vessels,
 * unless it is known. find_shared_visibility has computed that of soft area lights. */
static Status find_lights_at_thin(Renderer *renderer, const Drawing *drawing, Err *err)
{
    const View *view = drawing->view;
    const RenderParams *params = drawing->params;
    if (!renderer->unlit)
        return STATUS_OK;
    const bool shared = pixelvisibility_is_needed(view, params);
    for (size_t i = 0; i < view->n_lights && params->shadows; i++)
        if (view->lights[i].casts_shadows && !(shared && light_is_soft(&view->lights[i])))
            TRY(find_one_light_at_thin(renderer, drawing, i, err));
    if (params->occlusion > 0 && shared)
        TRY(thinvessels_find_ambient(drawing, &renderer->occluders, &renderer->thin, err));
    renderer->unlit = NULL;
    return STATUS_OK;
}

/* ---- passes ---------------------------------------------------------------------------------- */

/* Draws the band of a drawing into new planes. Computes the shared visibility first, unless the
 * drawing has it. */
static Status draw_plain(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    Drawing lit = *drawing;
    PixelVisibility *visibility = NULL;
    Status status;
    /* The engine of planes may cast rays where that of colors casts none. */
    TRY_GOTO(prepare_caster(renderer, &lit, err));
    TRY_GOTO(prepare_view(renderer, drawing, err));
    const Engine *engine = renderer->key.engine;
    const double start_s = clock_seconds();
    const bool codes = params->codes_suffice && params->antialias == 1 && engine->tiles;
    TRY_GOTO(
        make_planes(drawing->view->camera.width, drawing->band.rows, params, codes, frame, err));
    if (!drawing->visibility) {
        TRY_GOTO(find_shared_visibility(renderer, drawing, RENDER_BAND_STEP, &visibility, err));
        lit.visibility = visibility;
    }
    if (drawing->hidden) {
        TRY_GOTO(find_lights_at_thin(renderer, &lit, err));
        thinvessels_color(&lit, &renderer->thin);
    }
    TRY_GOTO(engine->rows(&lit, renderer->prepared, frame, err));
    renderer->stats.trace_s += clock_seconds() - start_s;
    renderer->stats.rays += (size_t)drawing->view->camera.width * (size_t)drawing->band.rows;
done:
    pixelvisibility_free(visibility);
    return status;
}

/* Approximate number of samples that are drawn at a time. At about fifty bytes per sample, they
 * take 100 megabytes. */
static const double samples_at_once = 2e6;

/* Returns the band of the rows of samples of the pixel rows [first, first + rows). The margin of
 * the band holds the samples whose outlines and halos reach into these rows. */
static Band band_of_samples(const View *fine, int side, int first, int rows)
{
    const int reach = rounded_up(effects_reach(&fine->effects, side), RENDER_BAND_STEP);
    return band_between(first * side, rows * side, reach, fine->camera.height);
}

/* Draws `rows` rows of pixels, from row `row` of the drawing's band on, into the same rows of
 * `color`. */
static Status draw_samples(Renderer *renderer, const Drawing *fine, int row, int rows, Plane *color,
                           Err *err)
{
    const View *view = fine->view;
    Frame frame = {0};
    Drawing drawing = *fine;
    Status status;
    drawing.band = band_of_samples(view, renderer->params.antialias, fine->band.first + row, rows);
    TRY_GOTO(draw_plain(renderer, &drawing, &frame, err));
    const EffectSamples samples = {.view = view,
                                   .radii = &renderer->radii,
                                   .side = renderer->params.antialias,
                                   .threads = fine->params->threads,
                                   .band = drawing.band,
                                   .frame = &frame};
    if (frame.id.ids)
        TRY_GOTO(effects_draw(&samples, err));
    if (drawing.hidden)
        TRY_GOTO(thinvessels_draw(&drawing, &renderer->thin, &frame, err));
    effects_reduce(&samples, color, row);
done:
    frame_release(&frame);
    return status;
}

/* Computes the shared visibility for a drawing with effects: per pixel of the picture, although
 * the planes that are drawn have a pixel per sample. */
static Status find_visibility_for_effects(Renderer *renderer, const Drawing *drawing,
                                          PixelVisibility **out, Err *err)
{
    int side = drawing->params->antialias;
    int reach = rounded_up(effects_reach(&drawing->view->effects, side), RENDER_BAND_STEP);
    if (!pixelvisibility_is_needed(drawing->view, drawing->params))
        return STATUS_OK;
    TRY(prepare_view(renderer, drawing, err));
    TRY(find_shared_visibility(renderer, drawing, RENDER_BAND_STEP + reach, out, err));
    if (*out)
        (*out)->samples_per_side = side;
    return STATUS_OK;
}

/* Returns the number of rows of pixels that are drawn at a time, a multiple of RENDER_BAND_STEP. */
static int rows_at_once(const Camera *fine, int antialias)
{
    const int rows = (int)fmin(samples_at_once / fine->width / antialias, 1e6);
    return rows < RENDER_BAND_STEP ? RENDER_BAND_STEP : rows / RENDER_BAND_STEP * RENDER_BAND_STEP;
}

/* Draws the colors of the drawing's band with effects. */
static Status draw_effects(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    const Band *band = &drawing->band;
    RenderParams once = *params;
    View fine = *drawing->view;
    Drawing of_samples = *drawing;
    PixelVisibility *visibility = NULL;
    Status status;
    fine.camera.width *= params->antialias;
    fine.camera.height *= params->antialias;
    once.antialias = 1;
    once.codes_suffice = false;
    once.want_depth = once.want_id = !(fine.effects.xray.per_mm > 0);
    once.want_normal = once.want_id && fine.effects.outline.crease_cosine > -1;
    of_samples.view = &fine;
    of_samples.params = &once;
    if (!renderer->radii.rows)
        TRY_GOTO(radiustable_make(renderer->geometry, &renderer->radii, err));
    TRY_GOTO(plane_init(&frame->color, drawing->view->camera.width, band->rows, 3, err));
    TRY_GOTO(find_visibility_for_effects(renderer, drawing, &visibility, err));
    of_samples.visibility = visibility;
    const int step = rows_at_once(&fine.camera, params->antialias);
    for (int row = 0; row < band->rows; row += step)
        TRY_GOTO(draw_samples(renderer, &of_samples, row,
                              step < band->rows - row ? step : band->rows - row, &frame->color,
                              err));
done:
    pixelvisibility_free(visibility);
    return status;
}

/* The rows of an image that are to be drawn. */
typedef struct WantedRows {
    const View *view;
    const Appearance *appearance;
    int first, rows;
} WantedRows;

/* Draws the planes that `params` asks for, all of them by one engine. If the view has effects and
 * colors are drawn, `params` must ask for no other plane. A covering renderer draws its thin
 * vessels by coverage; any other renderer samples them like the rest. */
static Status draw_pass(Renderer *renderer, const WantedRows *wanted, const RenderParams *params,
                        Frame *frame, Err *err)
{
    const View *view = wanted->view;
    const bool effects = params->want_color && effects_present(&view->effects);
    /* Adaptive antialiasing compares pixels with their neighbours. */
    const bool adaptive =
        params->want_color && !effects && params->antialias > 1 && params->antialias_threshold > 0;
    const ThinLayer *thin = renderer->thin.layer.n > 0 ? &renderer->thin.layer : NULL;
    const double start_cpu_s = clock_cpu_seconds();
    Frame made = {0};
    Drawing drawing = {.geometry = renderer->geometry,
                       .view = view,
                       .appearance = wanted->appearance,
                       .params = params,
                       .hidden = thin ? thin->is_thin : NULL,
                       .thin = effects ? NULL : thin,
                       .band = band_between(wanted->first, wanted->rows,
                                            adaptive ? RENDER_BAND_STEP : 0, view->camera.height)};
    Status status;
    TRY_GOTO(prepare_caster(renderer, &drawing, err));
    TRY_GOTO(prepare_mean(renderer, &drawing, err));
    TRY_GOTO((effects ? draw_effects : draw_plain)(renderer, &drawing, &made, err));
    if (drawing.band.above + drawing.band.below)
        crop_planes(&made, &drawing.band);
    *frame = made;
    made = (Frame){0};
done:
    renderer->stats.cpu_s += clock_cpu_seconds() - start_cpu_s;
    frame_release(&made);
    return status;
}

/* ---- thin vessels ---------------------------------------------------------------------------- */

/* A vessel is thin if it is narrower than one pixel and narrower than this number of sample
 * distances. A vessel that is 3 distances wide is hit by 3 samples across, give or take one, so
 * sampling errs by up to a third of its width. A larger number draws more vessels by coverage, with
 * one color per piece instead of one per sample. */
static const double thin_below_samples = 3;

/* Returns the camera of the samples that thin vessels are drawn over. With effects, samples are the
 * pixels of a finer picture. */
static Camera camera_of_samples(const View *view, const RenderParams *params)
{
    Camera camera;
    memcpy(&camera, &view->camera, sizeof camera);
    if (effects_present(&view->effects)) {
        camera.width *= params->antialias;
        camera.height *= params->antialias;
    }
    return camera;
}

/* Finds the thin vessels of a view, unless they are known. The visibility of lights at them is
 * computed when the next rows are drawn. */
static Status find_thin_vessels(Renderer *covering, const View *view, Err *err)
{
    const RenderParams *params = &covering->params;
    ThinVessels *thin = &covering->thin;
    const int pixel = effects_present(&view->effects) ? params->antialias : 1;
    const Camera camera = camera_of_samples(view, params);
    const ThinWidths widths = {pixel * fmin(1, thin_below_samples / params->antialias),
                               pixel * params->min_width_px};
    const double start_s = clock_seconds();
    ViewKey key;
    key_make(&key, NULL, &camera, view, params);
    if (!covering->unlit && key_serves(&covering->thin_key, &key))
        return STATUS_OK;
    forget_view(covering);
    thinvessels_release(thin);
    memset(&covering->thin_key, 0, sizeof covering->thin_key);
    TRY(thinvessels_find(covering->geometry, &camera, widths, params->threads, thin, err));
    covering->unlit = &thin->lights;
    if (params->shadows)
        TRY(offpixel_init(view, &thin->lights, err));
    memcpy(&covering->thin_key, &key, sizeof key);
    covering->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

/* Returns true if thin vessels of this view are to be drawn by coverage. There may be none. */
static bool may_cover(const Renderer *renderer, const View *view)
{
    const RenderParams *params = &renderer->params;
    const Drawing drawing = {.geometry = renderer->geometry, .view = view, .params = params};
    return params->cover_thin && params->want_color && !effects_need_ids(&view->effects) &&
           engine_for(&drawing)->tiles;
}

/* Sets *colors to the renderer that draws the view's colors: the covering renderer if the view has
 * thin vessels that are drawn by coverage, otherwise `renderer`. */
static Status choose_renderer(Renderer *renderer, const View *view, Renderer **colors, Err *err)
{
    *colors = renderer;
    if (!may_cover(renderer, view))
        return STATUS_OK;
    RenderParams params = renderer->params;
    params.codes_suffice = false;
    if (!renderer->covering)
        TRY(renderer_new(renderer->geometry, &params, &renderer->covering, err));
    TRY(find_thin_vessels(renderer->covering, view, err));
    if (renderer->covering->thin.layer.n > 0)
        *colors = renderer->covering;
    return STATUS_OK;
}

/* Draws the planes of geometry and the colors, in one pass if the colors show exactly what the
 * planes show. Otherwise the planes are drawn first: they show what the centres of pixels hit, thin
 * vessels included. */
static Status opaque_rows(Renderer *renderer, const WantedRows *wanted, Frame *frame, Err *err)
{
    const View *view = wanted->view;
    const RenderParams *params = &renderer->params;
    RenderParams geometry = *params, color = *params;
    Renderer *colors;
    Frame made = {0}, colored = {0};
    Status status;
    assert(wanted->first >= 0 && wanted->rows > 0 &&
           wanted->first + wanted->rows <= view->camera.height &&
           wanted->first % RENDER_BAND_STEP == 0);
    TRY_GOTO(choose_renderer(renderer, view, &colors, err));
    if (!params->want_color || (colors == renderer && !effects_present(&view->effects)))
        return draw_pass(renderer, wanted, params, frame, err);
    geometry.want_color = false;
    color.codes_suffice = color.want_depth = color.want_normal = color.want_id = false;
    if (params->want_depth || params->want_normal || params->want_id)
        TRY_GOTO(draw_pass(renderer, wanted, &geometry, &made, err));
    TRY_GOTO(draw_pass(colors, wanted, &color, &colored, err));
    made.color = colored.color;
    *frame = made;
    made = (Frame){0};
done:
    frame_release(&made);
    return status;
}

/* ---- transparency ---------------------------------------------------------------------------- */

/* Returns the alpha of a pixel. `share` is the fraction of the pixel that shows the background.
 *
 * The fraction is a difference of two averages, each with rounding errors. If it is a multiple of
 * one sample to within these errors, it becomes that multiple: a pixel that 3 of 10 samples cover
 * has alpha 1 - 7/10 in float, whose 8-bit code is 77 (76.5 rounded up), as in POV-Ray. A pixel has
 * N x N samples, and one more at its centre unless the view has effects. */
static float alpha_of_background(float share, int antialias)
{
    /* 8 units in the last place of a number below 1: sums of up to some hundred samples. */
    static const float rounding_error = 0x1p-21f;
    for (int more = 0; more < 2; more++) {
        const float samples = (float)(antialias * antialias + more);
        const float nearest = roundf(share * samples) / samples;
        if (fabsf(share - nearest) < rounding_error)
            return 1 - nearest;
    }
    return 1 - share;
}

/* Sets alpha of a picture that was drawn over black and over white. */
static Status find_alpha(Frame *over_black, const Frame *over_white, int antialias, Err *err)
{
    const Plane *black = &over_black->color, *white = &over_white->color;
    Plane *alpha = &over_black->alpha;
    TRY(plane_init(alpha, black->width, black->height, 1, err));
    for (size_t i = 0; i < (size_t)black->width * (size_t)black->height; i++)
        alpha->values[i] =
            alpha_of_background(white->values[3 * i + 1] - black->values[3 * i + 1], antialias);
    return STATUS_OK;
}

/* Draws rows with an alpha plane. For every engine and effect, the linear color of a pixel is the
 * color of the vessels plus the background's color times the uncovered fraction. Drawing the rows
 * over black gives the former; the difference to the rows over white gives the latter. */
static Status transparent_rows(Renderer *renderer, const WantedRows *wanted, Frame *frame, Err *err)
{
    View over = *wanted->view;
    WantedRows rows = *wanted;
    Frame black = {0}, white = {0};
    Status status;
    rows.view = &over;
    over.background = (Rgb){0, 0, 0};
    TRY_GOTO(opaque_rows(renderer, &rows, &black, err));
    over.background = (Rgb){1, 1, 1};
    TRY_GOTO(opaque_rows(renderer, &rows, &white, err));
    TRY_GOTO(find_alpha(&black, &white, renderer->params.antialias, err));
    *frame = black;
    black = (Frame){0};
done:
    frame_release(&black);
    frame_release(&white);
    return status;
}

Status renderer_rows(Renderer *renderer, const View *view, const Appearance *appearance, int first,
                     int rows, Frame *frame, Err *err)
{
    const RenderParams *params = &renderer->params;
    const WantedRows wanted = {view, appearance, first, rows};
    const bool transparent = view->transparent && params->want_color && !params->codes_suffice;
    return (transparent ? transparent_rows : opaque_rows)(renderer, &wanted, frame, err);
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(&scene->geometry, params, &renderer, err));
    Status status = STATUS_OK;
    TRY_GOTO(renderer_rows(renderer, &scene->view, &scene->appearance, 0, scene->view.camera.height,
                           frame, err));
    if (stats)
        *stats = renderer->stats;
done:
    renderer_free(renderer);
    return status;
}
