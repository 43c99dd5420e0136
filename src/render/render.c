/* What the geometry alone decides, the search structure of rays (Caster), is made once and kept.
 * What a view decides, an engine's lists of tiles and of what lights see, is kept until a camera,
 * lights, a ground plane or an antialiasing come that are not the same to the last bit, or another
 * engine, or until colours are wanted of what was prepared for planes of geometry alone. An
 * appearance decides nothing but colours.
 *
 * Where vessels thinner than the distance of samples are drawn by coverage, the colours come from a
 * second renderer of the same geometry, whose camera does not see the thin vessels. They are drawn
 * over each of its samples [thin/thinvessels.h]. Shadows and occlusion are those of all vessels.
 * The lights are asked once for all thin vessels of a view: area lights with its first rows, for
 * which they are looked from point by point, other lights after them.
 *
 * The first engine of the table that can draws: the special ones first, rays, which can draw
 * anything, last.
 *
 * A picture with effects is drawn as one of N x N times the pixels, N being its antialiasing, part
 * of the band by part; effects are drawn on those samples, whose means are its pixels. */
#include "render/render.h"

#include "render/cast/caster.h"
#include "render/effect/effect.h"
#include "render/field/fieldrender.h"
#include "render/light/bandvisibility.h"
#include "render/light/rayrender.h"
#include "render/raster/rasterrender.h"
#include "render/raster/zbuffer.h"
#include "render/thin/thinvessels.h"
#include "render/tile/tilekernels.h"
#include "render/xray/xray.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Engine *const engines[] = {&xray_engine, &field_engine, &raster_engine,
                                        &zbuffer_engine, &ray_engine};

struct Renderer {
    const Geometry *geometry;
    RenderParams params; /* with the number of threads */
    Caster *caster;      /* of the geometry; NULL until a view needs it */
    TermMean *mean;      /* likewise; NULL until an appearance needs it */
    RadiusTable radii;   /* likewise; empty until effects need it */
    OccluderSet beams;   /* likewise; none until there is occlusion */
    RenderStats stats;
    /* What is kept while engine, camera, lights, ground and antialiasing are these. */
    const Engine *engine; /* NULL: nothing is */
    void *prepared;       /* the engine's */
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    Ground ground;
    int antialias;
    bool has_color; /* it was prepared for colours, which need shadows, and serves planes too */
    Renderer
        *covering; /* draws colours where vessels are thin; NULL: there are none, or it is this */
    /* Of a covering renderer, what is kept while the camera is that of `thin`, and the antialiasing
     * this. */
    ThinVessels thin;
    int thin_antialias;
    View thin_lights; /* whose lights and ground thin.lights and thin.open are for */
    OffPixelPoints
        *asked; /* those of `thin` while area lights are yet to be asked for them; borrowed */
};

/* ---- planes ------------------------------------------------------------------------------------
 */

/* Makes the planes that are wanted, to be drawn all over, in *frame (owned by the caller even when
 * this fails): of colour 8-bit codes if `codes`, else floats. */
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

static void cut_plane(Plane *plane, const Band *band)
{
    if (!plane->values)
        return;
    size_t row = (size_t)plane->width * (size_t)plane->channels;
    plane->height = band->rows - band->above - band->below;
    memmove(plane->values, plane->values + (size_t)band->above * row,
            (size_t)plane->height * row * sizeof *plane->values);
}

/* Cuts off the rows of the band that are there for their neighbours alone; those of codes have
 * none. */
static void cut_planes(Frame *frame, const Band *band)
{
    cut_plane(&frame->color, band);
    cut_plane(&frame->depth, band);
    cut_plane(&frame->normal, band);
    if (!frame->id.ids)
        return;
    size_t width = (size_t)frame->id.width;
    frame->id.height = band->rows - band->above - band->below;
    memmove(frame->id.ids, frame->id.ids + (size_t)band->above * width,
            (size_t)frame->id.height * width * sizeof *frame->id.ids);
}

/* ---- what is prepared ------------------------------------------------------------------------ */

static const Engine *engine_for(const Drawing *drawing)
{
    size_t i = 0;
    while (!engines[i]->can(drawing))
        i++;
    return engines[i];
}

/* Makes the caster if there is none yet. */
static Status make_caster(Renderer *renderer, Err *err)
{
    const RenderParams *params = &renderer->params;
    if (renderer->caster)
        return STATUS_OK;
    double start_s = clock_seconds();
    TRY(caster_new(renderer->geometry, params->povray_cells, params->threads, &renderer->caster,
                   err));
    if (params->shadow_from_mm > 0)
        caster_shadow_from(renderer->caster, params->shadow_from_mm);
    renderer->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

/* Likewise if the drawing needs it. */
static Status prepare_caster(Renderer *renderer, Drawing *drawing, Err *err)
{
    if (engine_for(drawing)->needs_rays(drawing))
        TRY(make_caster(renderer, err));
    drawing->caster = renderer->caster;
    return STATUS_OK;
}

/* Makes what blends colours if the drawing needs it and none before did. */
static Status prepare_mean(Renderer *renderer, Drawing *drawing, Err *err)
{
    if (!drawing->appearance->places || !model_has(renderer->geometry->model, MODEL_FIELD))
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
    static const View plain; /* no lights, no ground: what it needs, all views need */
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
        renderer->engine->free(renderer->prepared);
    renderer->prepared = NULL;
    renderer->engine = NULL;
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
    occluderset_release(&renderer->beams);
    free(renderer);
}

/* Whether the view has these lights, bit by bit. */
static bool has_lights(const View *view, const Light *lights, size_t n)
{
    return view->n_lights == n && memcmp(view->lights, lights, n * sizeof *lights) == 0;
}

/* Returns true if the ground planes are equal. The plane decides which lights see all vessels. */
static bool is_same_plane(const Ground *a, const Ground *b)
{
    return a->present == b->present &&
           (!a->present || (memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
                            memcmp(&a->offset_mm, &b->offset_mm, sizeof a->offset_mm) == 0));
}

static bool is_prepared(const Renderer *renderer, const Engine *engine, const Drawing *drawing)
{
    const View *view = drawing->view;
    return renderer->engine == engine && renderer->antialias == drawing->params->antialias &&
           (renderer->has_color || !drawing->params->want_color) &&
           memcmp(&renderer->camera, &view->camera, sizeof view->camera) == 0 &&
           has_lights(view, renderer->lights, renderer->n_lights) &&
           is_same_plane(&renderer->ground, &view->ground);
}

/* Frees what was prepared for another view, and prepares this. */
static Status prepare_view(Renderer *renderer, const Drawing *drawing, Err *err)
{
    const View *view = drawing->view;
    const Engine *engine = engine_for(drawing);
    double start_s = clock_seconds();
    if (is_prepared(renderer, engine, drawing))
        return STATUS_OK;
    forget_view(renderer);
    if (engine->prepare)
        TRY(engine->prepare(drawing, &renderer->prepared, err));
    renderer->engine = engine;
    renderer->stats.engine = engine->name;
    memcpy(&renderer->camera, &view->camera, sizeof view->camera);
    memcpy(renderer->lights, view->lights, view->n_lights * sizeof *view->lights);
    renderer->n_lights = view->n_lights;
    renderer->ground = view->ground;
    renderer->antialias = drawing->params->antialias;
    renderer->has_color = drawing->params->want_color;
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

/* Rows of a picture of `height` rows, with up to `margin` more above and below for their sake. */
static Band band_between(int first, int rows, int margin, int height)
{
    int left = height - first - rows;
    int above = first < margin ? first : margin, below = left < margin ? left : margin;
    return (Band){
        .first = first - above, .rows = rows + above + below, .above = above, .below = below};
}

/* ---- light that samples share -----------------------------------------------------------------
 */

/* DrawVesselPlanes of a renderer. */
static Status see_vessels(const Drawing *drawing, void *context, Frame *planes, Err *err)
{
    const Renderer *renderer = context;
    RenderParams params = *drawing->params;
    View vessels = *drawing->view;
    vessels.ground.present = false; /* which no plane shows */
    params.want_color = params.want_id = false;
    params.want_depth = params.want_normal = true;
    params.antialias = 1;
    params.occlusion = 0;
    params.progress = NULL;
    Drawing seen = *drawing;
    seen.params = &params;
    seen.view = &vessels;
    TRY(make_planes(drawing->view->camera.width, drawing->band.rows, &params, false, planes, err));
    return renderer->engine->rows(&seen, renderer->prepared, planes, err);
}

static int rounded_up(int rows, int step)
{
    return (rows + step - 1) / step * step;
}

/* The drawing of a band with the rows that its shared light depends on, and that its samples look
 * at, in whole blocks of `block` rows of the picture: all of them count. */
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

/* Finds what samples share, if they share anything, in the drawing's band and `margin` rows about
 * it at least. */
static Status share(Renderer *renderer, const Drawing *drawing, int margin, PixelVisibility **out,
                    Err *err)
{
    const RenderParams *params = drawing->params;
    if (!pixelvisibility_is_needed(drawing->view, params))
        return STATUS_OK;
    if (params->occlusion > 0 && !renderer->beams.capsules)
        TRY(occluderset_new(renderer->geometry, &renderer->beams, err));
    const bool soft = softshadows_are_on(drawing->view, params);
    const Drawing wide = widened(drawing, margin, soft ? VISIBILITY_BLOCK : 1);
    const VisibilitySources from = {.draw_planes = see_vessels,
                                    .context = renderer,
                                    .engine = renderer->engine->shadows,
                                    .occluders = &renderer->beams,
                                    .off_pixel = renderer->asked};
    return pixelvisibility_compute(&wide, &from, out, err);
}

/* ---- light of thin vessels --------------------------------------------------------------------
 */

/* Has area lights asked for thin vessels with the rows to come, unless it is known what of the
 * view's lights reaches them. */
static Status begin_light(Renderer *renderer, const View *view, Err *err)
{
    const View *known = &renderer->thin_lights;
    OffPixelPoints *places = &renderer->thin.lights;
    if (places->n > 0 && has_lights(view, known->lights, known->n_lights) &&
        memcmp(&view->ground, &known->ground, sizeof view->ground) == 0)
        return STATUS_OK;
    thinvessels_place(&renderer->thin);
    renderer->thin_lights = (View){0};
    renderer->asked = places;
    return renderer->params.shadows ? offpixel_init(view, places, err) : STATUS_OK;
}

/* Asks a light for the thin vessels as rows do, or by rays. */
static Status ask_light(Renderer *renderer, const Drawing *drawing, size_t light, Err *err)
{
    const Viewpoint eye = viewpoint_of_camera(&drawing->view->camera);
    const Engine *engine = renderer->engine;
    LightBins *bins = engine->light_bins ? engine->light_bins(renderer->prepared, light) : NULL;
    if (bins)
        return offpixel_query(drawing, &(OffPixelViews){&bins, 1, &eye}, light, renderer->asked,
                              err);
    Drawing casting = *drawing;
    TRY(make_caster(renderer, err));
    casting.caster = renderer->caster;
    offpixel_trace(&casting, light, renderer->asked);
    return STATUS_OK;
}

/* Finds what is not known yet of the light that reaches thin vessels, after area lights were asked.
 */
static Status end_light(Renderer *renderer, const Drawing *drawing, Err *err)
{
    const View *view = drawing->view;
    const RenderParams *params = drawing->params;
    if (!renderer->asked)
        return STATUS_OK;
    const bool shared = pixelvisibility_is_needed(view, params);
    for (size_t i = 0; i < view->n_lights && params->shadows; i++)
        if (view->lights[i].casts_shadows && !(shared && light_is_soft(&view->lights[i])))
            TRY(ask_light(renderer, drawing, i, err));
    if (params->occlusion > 0 && shared)
        TRY(thinvessels_find_open(drawing, &renderer->beams, &renderer->thin, err));
    memcpy(&renderer->thin_lights, view, sizeof *view);
    renderer->asked = NULL;
    return STATUS_OK;
}

/* Sets the colours of the thin vessels of a band. */
static Status light_thin(Renderer *renderer, const Drawing *drawing, Err *err)
{
    TRY(end_light(renderer, drawing, err));
    thinvessels_color(drawing, &renderer->thin);
    return STATUS_OK;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static Status draw(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    Drawing lit = *drawing;
    /* Planes alone may have another engine than colours, which asks for rays. */
    TRY(prepare_caster(renderer, &lit, err));
    TRY(prepare_view(renderer, drawing, err));
    double start_s = clock_seconds();
    bool codes = params->codes_suffice && params->antialias == 1 && renderer->engine->makes_codes;
    TRY(make_planes(drawing->view->camera.width, drawing->band.rows, params, codes, frame, err));
    PixelVisibility *shared = NULL;
    Status status = STATUS_OK;
    if (!drawing->visibility) {
        status = share(renderer, drawing, RENDER_BAND_STEP, &shared, err);
        lit.visibility = shared;
    }
    if (status == STATUS_OK && drawing->hidden)
        status = light_thin(renderer, &lit, err);
    if (status == STATUS_OK)
        status = renderer->engine->rows(&lit, renderer->prepared, frame, err);
    pixelvisibility_free(shared);
    TRY(status);
    renderer->stats.trace_s += clock_seconds() - start_s;
    renderer->stats.rays += (size_t)drawing->view->camera.width * (size_t)drawing->band.rows;
    return STATUS_OK;
}

/* ---- pictures with effects --------------------------------------------------------------------
 */

/* About how many samples are drawn at a time, of some fifty bytes each. */
static const double samples_at_once = 2e6;

/* The rows of samples of the pixels' rows first .. first + rows, with those that decide them. */
static Band band_of_samples(const View *fine, int side, int first, int rows)
{
    const int reach = rounded_up(effects_reach(&fine->effects, side), RENDER_BAND_STEP);
    return band_between(first * side, rows * side, reach, fine->camera.height);
}

/* Draws rows of pixels, counted in the picture, into the rows of `color` from `row` on. */
static Status draw_samples(Renderer *renderer, const Drawing *fine, int first, int rows,
                           Plane *color, int row, Err *err)
{
    const View *view = fine->view;
    Frame frame = {0};
    Drawing drawing = *fine;
    drawing.band = band_of_samples(view, renderer->params.antialias, first, rows);
    TRY(draw(renderer, &drawing, &frame, err));
    const Samples samples = {.effects = &view->effects,
                             .camera = &view->camera,
                             .radii = &renderer->radii,
                             .paper = view->background,
                             .side = renderer->params.antialias,
                             .threads = fine->params->threads,
                             .band = drawing.band,
                             .frame = &frame};
    Status status = frame.id.ids ? effects_draw(&samples, err) : STATUS_OK;
    if (status == STATUS_OK && drawing.hidden)
        status = thinvessels_draw(&drawing, &renderer->thin, &frame, err);
    if (status == STATUS_OK)
        effects_reduce(&samples, color, row);
    frame_release(&frame);
    return status;
}

/* What the samples of pixels share where each is a pixel of a finer drawing. */
static Status share_for_effects(Renderer *renderer, const Drawing *drawing, PixelVisibility **out,
                                Err *err)
{
    const Effects *effects = &drawing->view->effects;
    int side = drawing->params->antialias;
    if (!pixelvisibility_is_needed(drawing->view, drawing->params))
        return STATUS_OK;
    TRY(prepare_view(renderer, drawing, err));
    TRY(share(renderer, drawing,
              RENDER_BAND_STEP + rounded_up(effects_reach(effects, side), RENDER_BAND_STEP), out,
              err));
    if (*out)
        (*out)->samples_per_side = side;
    return STATUS_OK;
}

/* The colours of the drawing's band. */
static Status draw_effects(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    const Band *band = &drawing->band;
    RenderParams once = *params;
    View fine = *drawing->view;
    Drawing of_samples = *drawing;
    PixelVisibility *shared = NULL;
    fine.camera.width *= params->antialias;
    fine.camera.height *= params->antialias;
    once.antialias = 1;
    once.codes_suffice = false;
    once.want_depth = once.want_id = !(fine.effects.xray.per_mm > 0);
    once.want_normal = once.want_id && fine.effects.outline.crease_cosine > -1;
    of_samples.view = &fine;
    of_samples.params = &once;
    if (!renderer->radii.rows)
        TRY(radiustable_make(renderer->geometry, &renderer->radii, err));
    TRY(plane_init(&frame->color, drawing->view->camera.width, band->rows, 3, err));
    TRY(share_for_effects(renderer, drawing, &shared, err));
    of_samples.visibility = shared;
    Status status = STATUS_OK;
    int step = (int)fmin(samples_at_once / fine.camera.width / params->antialias, 1e6);
    step = step < RENDER_BAND_STEP ? RENDER_BAND_STEP : step / RENDER_BAND_STEP * RENDER_BAND_STEP;
    for (int row = 0; row < band->rows && status == STATUS_OK; row += step) {
        int rows = step < band->rows - row ? step : band->rows - row;
        status =
            draw_samples(renderer, &of_samples, band->first + row, rows, &frame->color, row, err);
    }
    pixelvisibility_free(shared);
    return status;
}

/* The planes of geometry, of the pixels' centres, and the colours with effects. */
static Status draw_with_effects(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    RenderParams shape = *drawing->params;
    Drawing centers = *drawing;
    shape.want_color = false;
    centers.params = &shape;
    if (shape.want_depth || shape.want_normal || shape.want_id)
        TRY(draw(renderer, &centers, frame, err));
    return draw_effects(renderer, drawing, frame, err);
}

/* The rows, with thin vessels drawn by coverage if this renderer covers, else as samples see all
 * vessels. */
static Status sampled_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                           int first, int rows, Frame *frame, Err *err)
{
    const RenderParams *params = &renderer->params;
    const bool effects = params->want_color && effects_present(&view->effects);
    /* Adaptive antialiasing looks at neighbours. */
    const bool adaptive = !effects && params->antialias > 1 && params->antialias_threshold > 0;
    const ThinVessels *thin = &renderer->thin;
    const bool covers = thin->layer.n > 0;
    Frame made = {0};
    double start_cpu_s = clock_cpu_seconds();
    Drawing drawing = {
        .geometry = renderer->geometry,
        .view = view,
        .appearance = appearance,
        .params = params,
        .hidden = covers ? thin->layer.is_thin : NULL,
        .thin = covers && !effects ? &thin->layer : NULL,
        .band = band_between(first, rows, adaptive ? RENDER_BAND_STEP : 0, view->camera.height)};
    Status status = prepare_caster(renderer, &drawing, err);
    if (status == STATUS_OK && covers)
        status = begin_light(renderer, view, err);
    if (status == STATUS_OK)
        status = prepare_mean(renderer, &drawing, err);
    if (status == STATUS_OK)
        status = (effects ? draw_with_effects : draw)(renderer, &drawing, &made, err);
    renderer->stats.cpu_s += clock_cpu_seconds() - start_cpu_s;
    if (status != STATUS_OK) {
        frame_release(&made);
        return status;
    }
    if (drawing.band.above + drawing.band.below)
        cut_planes(&made, &drawing.band);
    *frame = made;
    return STATUS_OK;
}

/* ---- thin vessels ---------------------------------------------------------------------------- */

/* Vessels are thin if they are narrower than a pixel, and than this many distances of its samples.
 */
static const double most_samples = 3;

/* The camera of the samples that thin vessels are drawn over: with effects samples are pixels of a
 * finer picture. */
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

/* Finds the thin vessels of a view, unless they are those of the rows before. */
static Status find_thin(Renderer *covering, const View *view, Err *err)
{
    const RenderParams *params = &covering->params;
    const int pixel = effects_present(&view->effects) ? params->antialias : 1;
    Camera camera = camera_of_samples(view, params);
    if (covering->thin_antialias == params->antialias &&
        memcmp(&covering->thin.camera, &camera, sizeof camera) == 0)
        return STATUS_OK;
    double start_s = clock_seconds();
    forget_view(covering);
    thinvessels_release(&covering->thin);
    TRY(thinvessels_find(covering->geometry, &camera,
                         pixel * fmin(1, most_samples / params->antialias),
                         pixel * params->least_px, params->threads, &covering->thin, err));
    covering->thin_antialias = params->antialias;
    covering->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

/* Makes the renderer that draws thin vessels by coverage, and finds these. */
static Status prepare_thin(Renderer *renderer, const View *view, Err *err)
{
    RenderParams colors = renderer->params;
    colors.codes_suffice = colors.want_depth = colors.want_normal = colors.want_id = false;
    if (!renderer->covering)
        TRY(renderer_new(renderer->geometry, &colors, &renderer->covering, err));
    return find_thin(renderer->covering, view, err);
}

/* The planes that samples of all vessels find, beside colours that are there. */
static Status add_planes(Renderer *renderer, const View *view, const Appearance *appearance,
                         int first, Frame *frame, Err *err)
{
    RenderParams *params = &renderer->params;
    Frame planes;
    if (!params->want_depth && !params->want_normal && !params->want_id)
        return STATUS_OK;
    params->want_color = false;
    Status status =
        sampled_rows(renderer, view, appearance, first, frame->color.height, &planes, err);
    params->want_color = true;
    if (status != STATUS_OK)
        return status;
    planes.color = frame->color;
    *frame = planes;
    return STATUS_OK;
}

static Status covered_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                           int first, int rows, Frame *frame, Err *err)
{
    Frame made;
    TRY(sampled_rows(renderer->covering, view, appearance, first, rows, &made, err));
    Status status = add_planes(renderer, view, appearance, first, &made, err);
    if (status == STATUS_OK)
        *frame = made;
    else
        frame_release(&made);
    return status;
}

/* Whether vessels that are thin in this view, if there are any, are drawn by coverage. */
static bool may_cover(const Renderer *renderer, const View *view)
{
    const RenderParams *params = &renderer->params;
    const Drawing drawing = {.geometry = renderer->geometry, .view = view, .params = params};
    return params->cover_thin && params->want_color && !effects_have_shape(&view->effects) &&
           engine_for(&drawing)->covers;
}

static Status opaque_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                          int first, int rows, Frame *frame, Err *err)
{
    assert(first >= 0 && rows > 0 && first + rows <= view->camera.height &&
           first % RENDER_BAND_STEP == 0);
    const bool covers = may_cover(renderer, view);
    if (covers)
        TRY(prepare_thin(renderer, view, err));
    return (covers && renderer->covering->thin.layer.n > 0 ? covered_rows : sampled_rows)(
        renderer, view, appearance, first, rows, frame, err);
}

/* ---- what is transparent --------------------------------------------------------------------- */

/* Returns alpha of a pixel from the share of it that shows the background.
 *
 * The share is a difference of two averages, each with errors of rounding. Where it is, to those
 * errors, a multiple of one sample, it becomes that multiple: alpha of three of ten samples is then
 * the float 1 - 7/10, as in POV-Ray, whose code of 8 bits, 76.5 rounded, is 77. A pixel has N x N
 * samples, and one more at its centre unless the look has effects. */
static float alpha_of_background(float share, int antialias)
{
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

/* Whatever the engine and the effects, a pixel's colour is that of what is drawn plus its
 * background's, linear, times the part that is left: two backgrounds tell both. */
static Status transparent_rows(Renderer *renderer, const View *view, const Appearance *appearance,
                               int first, int rows, Frame *frame, Err *err)
{
    View over = *view;
    Frame black = {0}, white = {0};
    Status status;
    over.background = (Rgb){0, 0, 0};
    TRY_GOTO(opaque_rows(renderer, &over, appearance, first, rows, &black, err));
    over.background = (Rgb){1, 1, 1};
    TRY_GOTO(opaque_rows(renderer, &over, appearance, first, rows, &white, err));
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
    const bool transparent = view->transparent && params->want_color && !params->codes_suffice;
    return (transparent ? transparent_rows : opaque_rows)(renderer, view, appearance, first, rows,
                                                          frame, err);
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(&scene->geometry, params, &renderer, err));
    Status status = renderer_rows(renderer, &scene->view, &scene->appearance, 0,
                                  scene->view.camera.height, frame, err);
    if (status == STATUS_OK && stats)
        *stats = renderer->stats;
    renderer_free(renderer);
    return status;
}
