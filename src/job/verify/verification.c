/* Draws one scene with two renderers and compares the pictures. POV-Ray draws it from files
 * (oracle/povray_tiles.h) and corcast from memory. Both draw at the same time, because POV-Ray is
 * idle for a quarter of a second of each run. Then all planes are compared: colors, depths,
 * normals, ids.
 *
 * An isosurface takes two steps. corcast repeats POV-Ray's root finder, and the resulting picture
 * must equal POV-Ray's. Then the surface that this root finder sees is compared with the exact
 * surface. */
#include "job/verify/verification.h"

#include "job/picture/frames.h"
#include "options/output.h"
#include "options/templates.h"
#include "oracle/explain.h"
#include "oracle/povray_tiles.h"
#include "oracle/tachyon.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void verification_release(Verification *v)
{
    if (v->moments.n_frames > 0)
        v->scene.appearance = v->moments;
    scene_release(&v->scene);
    geometry_release(&v->resting);
    planes_release(&v->povray);
    planes_release(&v->native);
    frame_release(&v->exact);
    frame_release(&v->tachyon);
    picture_release(&v->shown[0]);
    picture_release(&v->shown[1]);
    settled_release(&v->found.settled);
    witness_release(&v->found.witness);
    for (size_t i = 0; i < v->commands.n; i++)
        free(v->commands.items[i]);
    ARRAY_RELEASE(&v->commands);
    free(v->name);
    free(v->description);
    free(v->templates);
}

Status verification_add_command(Verification *v, const char *command, Err *err)
{
    TRY(ARRAY_PUSH(&v->commands, "commands", err, NULL));
    return mem_strdup(&v->commands.items[v->commands.n - 1], command, err);
}

/* ---- corcast's side -------------------------------------------------------------------------- */

bool verification_takes_two_steps(const Verification *v)
{
    return models[v->scene.geometry.model].proof == PROOF_STEPS;
}

static RenderParams render_params(const Verification *v, const CellParams *povray_cells)
{
    return (RenderParams){.kernels = v->options->kernels,
                          .threads = v->common->threads,
                          .antialias = v->options->picture.antialias,
                          .shadows = v->options->picture.stage.shadows,
                          .povray_cells = povray_cells,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true,
                          .want_id = true};
}

static Encoding encoding_of(const Verification *v)
{
    return v->options->bits == 16 ? ENCODING_LINEAR : ENCODING_SRGB;
}

static Status write_frame(const Verification *v, const Frame *frame, const char *name,
                          Encoding encoding, Err *err)
{
    char *path = NULL;
    TRY(file_join(v->options->folder, name, &path, err));
    const FramesForm form = {.path = path,
                             .bits = v->options->bits,
                             .packing = {.threads = v->common->threads},
                             .encoding = encoding,
                             .picture = true,
                             .dpi = v->options->picture.size.dpi,
                             .provenance = v->commands.items[0],
                             .colors = v->scene.appearance.meaning};
    Status status = frames_write(frame, &form, err);
    free(path);
    return status;
}

/* Draws one frame: of an isosurface with POV-Ray's root finder, unless `exact`. */
static Status render_frame(Verification *v, bool exact, Frame *frame, Err *err)
{
    const CellParams cells = picture_cells(&v->options->picture);
    const RenderParams params =
        render_params(v, verification_takes_two_steps(v) && !exact ? &cells : NULL);
    return render(&v->scene, &params, frame, &v->stats, err);
}

/* Draws alpha. Colors are compared in front of the look's background, as POV-Ray draws them; alpha
 * is compared in a picture of its own. */
static Status render_alpha(Verification *v, Err *err)
{
    const CellParams cells = picture_cells(&v->options->picture);
    RenderParams params = render_params(v, verification_takes_two_steps(v) ? &cells : NULL);
    Scene scene = v->scene;
    Frame frame = {0};
    Picture picture = {0};
    Status status;
    params.want_depth = params.want_normal = params.want_id = false;
    scene.view.transparent = true;
    scene.view.fade = (Fade){0}; /* vessels of POV-Ray's picture are opaque */
    TRY_GOTO(render(&scene, &params, &frame, NULL, err));
    TRY_GOTO(picture_from_transparent(&picture, &frame.color, &frame.alpha, ENCODING_SRGB, 8, err));
    status = picture_take_alpha(&v->native.alpha, &picture, err);
done:
    frame_release(&frame);
    picture_release(&picture);
    return status;
}

static Status render_native(Verification *v, Err *err)
{
    OraclePlanes *native = &v->native;
    TRY(render_frame(v, false, &native->frame, err));
    if (v->has_alpha)
        TRY(render_alpha(v, err));
    TRY(picture_from_plane(&native->picture, &native->frame.color, encoding_of(v), v->options->bits,
                           err));
    return verification_takes_two_steps(v) ? render_frame(v, true, &v->exact, err) : STATUS_OK;
}

/* ---- the other programs ---------------------------------------------------------------------- */

Status verification_pick_frame(Verification *v, int frame, Err *err)
{
    const Appearance *all = &v->scene.appearance;
    size_t n = all->n_frames ? all->n_frames : 1;
    if (frame > 0)
        TRY(fieldscale_check_frame(frame, all->name ? all->name : "the picture", n, err));
    v->frame = frame ? frame : 1;
    if (all->n_frames == 0)
        return STATUS_OK;
    v->moments = *all;
    v->scene.appearance = appearance_frame(&v->moments, (size_t)v->frame - 1);
    if (!v->scene.appearance.radius_factors)
        return STATUS_OK;
    Geometry beaten;
    TRY(geometry_with_scaled_radii(&v->scene.geometry, v->scene.appearance.radius_factors, &beaten,
                                   err));
    v->resting = v->scene.geometry;
    v->scene.geometry = beaten;
    return STATUS_OK;
}

/* Sets the texts of scene files. */
static Status set_texts(Verification *v, Err *err)
{
    Text description = TEXT_INIT;
    picture_description(&v->scene.geometry, v->tree, &description);
    if (v->scene.appearance.meaning)
        text_printf(&description, ", colored by %s", v->scene.appearance.meaning);
    Status status = text_take(&description, &v->description, err);
    text_release(&description);
    return status == STATUS_OK ? templates_folder(&v->templates, err) : status;
}

static EmitParams emit_params(const Verification *v, const Scene *scene)
{
    return (EmitParams){.scene = scene,
                        .command = v->commands.items[0],
                        .shadows = v->options->picture.stage.shadows,
                        .cells = picture_cells(&v->options->picture),
                        .templates = v->templates,
                        .description = v->description,
                        .generator = GENERATOR};
}

/* Draws POV-Ray's picture and writes its planes in corcast's formats, too. */
static Status draw_povray(Verification *v, PovrayTiles *tiles, Err *err)
{
    char *picture = NULL;
    TRY(povraytiles_draw(tiles, &v->povray, &v->run, err));
    TRY(file_join(v->options->folder, "povray.png", &picture, err));
    Status status = frames_write(&v->povray.frame, &(FramesForm){.path = picture}, err);
    free(picture);
    return status;
}

/* POV-Ray and corcast, which draw at the same time. */
typedef enum Side { SIDE_POVRAY, SIDE_NATIVE, SIDES } Side;

typedef struct BothSides {
    Verification *v;
    PovrayTiles *povray;
} BothSides;

/* Draws one side, in a thread of its own. */
static Status draw_side(size_t side, int worker, void *context, Err *err)
{
    (void)worker;
    BothSides *both = context;
    return side == SIDE_POVRAY ? draw_povray(both->v, both->povray, err)
                               : render_native(both->v, err);
}

/* Draws both sides. If both fail, the error is POV-Ray's. */
static Status draw_both(Verification *v, Err *err)
{
    const size_t n = v->moments.n_frames;
    Scene written = v->scene;
    Progress progress;
    if (n > 0)
        written.appearance = v->moments;
    if (v->moments.radius_factors)
        written.geometry = v->resting;
    const PovrayTilesParams params = {.emit = emit_params(v, &written),
                                      .folder = v->options->folder,
                                      .clock = n > 1 ? (v->frame - 1) / (double)(n - 1) : 0,
                                      .antialias = v->options->picture.antialias,
                                      .bits = v->options->bits,
                                      .alpha = v->has_alpha,
                                      .min_tiles = v->options->tiles,
                                      .threads = v->common->threads,
                                      .program = v->options->povray,
                                      .progress = progress_report,
                                      .progress_context = &progress};
    BothSides both = {.v = v};
    Status status;
    TRY_GOTO(povraytiles_prepare(&params, &both.povray, err));
    v->n_tiles = povraytiles_count(both.povray);
    v->has_alpha = v->has_alpha && v->n_tiles == 1;
    for (size_t i = 0; i < povraytiles_n_commands(both.povray); i++)
        TRY_GOTO(verification_add_command(v, povraytiles_command(both.povray, i), err));
    progress_start(&progress, "POV-Ray", v->common->talk);
    status = threads_try(SIDES, v->common->threads, draw_side, &both, err);
    progress_end(&progress);
done:
    povraytiles_free(both.povray);
    return status;
}

static Status draw_tachyon(Verification *v, Err *err)
{
    const TachyonParams params = {.emit = emit_params(v, &v->scene),
                                  .folder = v->options->folder,
                                  .threads = v->common->threads,
                                  .program = v->options->tachyon};
    TachyonRun run;
    TRY(tachyon_draw(&params, &v->tachyon, &run, err));
    Witness *witness = &v->found.witness;
    witness->seconds = run.seconds;
    snprintf(witness->version, sizeof witness->version, "%s", run.version);
    return STATUS_OK;
}

Status verification_draw(Verification *v, Err *err)
{
    TRY(set_texts(v, err));
    TRY(draw_both(v, err));
    if (v->options->witness == WITNESS_TACHYON)
        TRY(draw_tachyon(v, err));
    TRY(write_frame(v, &v->native.frame, "native.png", encoding_of(v), err));
    if (verification_takes_two_steps(v))
        TRY(write_frame(v, &v->exact, "exact.png", ENCODING_SRGB, err));
    if (v->options->bits == 8)
        return STATUS_OK;
    TRY(picture_to_srgb(&v->shown[0], &v->povray.picture, 8, err));
    return picture_to_srgb(&v->shown[1], &v->native.picture, 8, err);
}

/* ---- comparison ------------------------------------------------------------------------------ */

const Picture *verification_shown(const Verification *v, int side)
{
    const OraclePlanes *planes = side ? &v->native : &v->povray;
    return v->options->bits == 8 ? &planes->picture : &v->shown[side];
}

/* Explains pixels that differ. The tolerance then counts no settled pixel. */
static Status settle_sides(Verification *v, const Rendering *a, const Rendering *b,
                           Tolerance *tolerance, Err *err)
{
    const CellParams cells = picture_cells(&v->options->picture);
    const RenderParams params = render_params(v, verification_takes_two_steps(v) ? &cells : NULL);
    const ExplainCase input = {&v->scene, &params, a, b, encoding_of(v), tolerance};
    v->found.examined = explain_applies(&input);
    if (!v->found.examined)
        return STATUS_OK;
    TRY(explain_pixels(&input, &v->found.settled, err));
    tolerance->settled = v->found.settled.marks;
    return STATUS_OK;
}

/* Returns true if whole vessels are visible: their mean breadth, twice the area over the length of
 * the outline, is at most a quarter of the picture. Each edge between pixels counts as an outline
 * of length pi / 4 [Cauchy-Crofton]. */
static bool sees_whole_vessels(const IdPlane *ids)
{
    size_t width = (size_t)ids->width, height = (size_t)ids->height, seen = 0, sides = 0;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            const uint32_t *id = &ids->ids[y * width + x];
            seen += *id != 0;
            sides += x + 1 < width && !id[0] != !id[1];
            sides += y + 1 < height && !id[0] != !id[width];
        }
    double side = (double)(width < height ? width : height);
    return 2 * (double)seen * 4 <= side * PI / 4 * (double)sides;
}

/* Returns the tolerance for the colors of the exact surface. POV-Ray's steps tilt normals by up to
 * 0.1 degrees. The effect on the colors averages out over the breadth of a vessel. In a close
 * view, where only one side of a vessel is visible, all normals are tilted one way, and the rules
 * on means do not apply. A mean of 1.5 levels is allowed instead, which 0.1 degrees can cause at a
 * highlight. */
static Tolerance exact_tolerance(const IdPlane *ids)
{
    Tolerance tolerance = tolerance_surface(0);
    tolerance.title = "exact color";
    if (sees_whole_vessels(ids))
        return tolerance;
    tolerance.limits[LIMIT_GAIN] = tolerance.limits[LIMIT_OFFSET_LEVELS] =
        tolerance.limits[LIMIT_INTERIOR_PPM] = (double)INFINITY;
    tolerance.limits[LIMIT_SEGMENT_LEVELS] = tolerance.limits[LIMIT_BIAS_LEVELS] = 1.5;
    return tolerance;
}

/* Compares the surface that POV-Ray's root finder sees with the exact surface. */
static Status check_surface(Verification *v, Err *err)
{
    const Frame *seen = &v->native.frame, *exact = &v->exact;
    const SurfacePlanes sight = {seen->depth.values, seen->normal.values, seen->id.ids};
    const SurfacePlanes exact_sight = {exact->depth.values, exact->normal.values, exact->id.ids};
    const ErfForm erf = picture_cells(&v->options->picture).erf;
    Plane allowed = {0};
    Status status;
    TRY_GOTO(plane_init(&allowed, seen->depth.width, seen->depth.height, 1, err));
    TRY_GOTO(surface_tolerance(&v->scene.geometry, &v->scene.view.camera, erf, &sight, &exact_sight,
                               allowed.values, err));
    status = surface_check(&seen->depth, &exact->depth, &allowed, &v->found.surface, err);
done:
    plane_release(&allowed);
    return status;
}

/* Compares the colors of the exact surface with POV-Ray's, as a screen shows them. */
static Status compare_exact(Verification *v, const Rendering *povray, Err *err)
{
    Picture picture;
    const Tolerance tolerance = exact_tolerance(&v->exact.id);
    TRY(picture_from_plane(&picture, &v->exact.color, ENCODING_SRGB, 8, err));
    Rendering a = *povray;
    a.picture = verification_shown(v, 0);
    const Rendering b = {.picture = &picture,
                         .ids = &v->exact.id,
                         .depth = &v->exact.depth,
                         .normal = &v->exact.normal};
    Status status = compare_pictures(&a, &b, &tolerance, &v->found.exact, NULL, err);
    picture_release(&picture);
    return status;
}

static Status compare_alpha(Verification *v, const Tolerance *tolerance, Err *err)
{
    Tolerance of_alpha = *tolerance;
    of_alpha.title = "alpha";
    const Rendering a = {.picture = &v->povray.alpha, .ids = &v->povray.frame.id};
    const Rendering b = {.picture = &v->native.alpha, .ids = &v->native.frame.id};
    return compare_pictures(&a, &b, &of_alpha, &v->found.alpha, NULL, err);
}

static Status compare_witness(Verification *v, double depth_step_mm, Err *err)
{
    const Frame *povray = &v->povray.frame, *native = &v->native.frame;
    const Testimony three[] = {{"POV-Ray", &povray->id, &povray->depth},
                               {"corcast", &native->id, &native->depth},
                               {"Tachyon", &v->tachyon.id, &v->tachyon.depth}};
    return witness_compare(three, depth_step_mm, &v->found.witness, err);
}

static Rendering rendering_of(const OraclePlanes *planes)
{
    return (Rendering){.picture = &planes->picture,
                       .ids = &planes->frame.id,
                       .depth = &planes->frame.depth,
                       .normal = &planes->frame.normal};
}

static Status compare_colors_of(Verification *v, const Rendering *a, const Rendering *b,
                                const Tolerance *tolerance, Err *err)
{
    CompareResult *color = &v->found.planes[PLANE_COLOR];
    TRY(compare_pictures(a, b, tolerance, color, NULL, err));
    TRY(compare_perception(verification_shown(v, 0), verification_shown(v, 1), color, err));
    return color->agrees ? STATUS_OK : compare_cause(a->picture, b->picture, color, err);
}

Status verification_compare(Verification *v, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    const double depth_step_mm = (far_mm - near_mm) / 65535;
    Tolerance tolerance = tolerance_identity(depth_step_mm);
    const Rendering a = rendering_of(&v->povray), b = rendering_of(&v->native);
    CompareResult *planes = v->found.planes;
    if (v->options->witness == WITNESS_TACHYON)
        TRY(compare_witness(v, depth_step_mm, err));
    TRY(settle_sides(v, &a, &b, &tolerance, err));
    TRY(compare_colors_of(v, &a, &b, &tolerance, err));
    TRY(compare_planes(PLANE_DEPTH, &a, &b, &tolerance, &planes[PLANE_DEPTH], err));
    TRY(compare_planes(PLANE_NORMAL, &a, &b, &tolerance, &planes[PLANE_NORMAL], err));
    TRY(compare_ids(a.ids, b.ids, &tolerance, &planes[PLANE_ID], err));
    if (v->has_alpha)
        TRY(compare_alpha(v, &tolerance, err));
    if (!verification_takes_two_steps(v))
        return STATUS_OK;
    TRY(compare_exact(v, &a, err));
    return check_surface(v, err);
}
