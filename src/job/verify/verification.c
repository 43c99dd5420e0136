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

void verification_release(Verification *verification)
{
    if (verification->moments.n_frames > 0)
        verification->scene.appearance = verification->moments;
    scene_release(&verification->scene);
    geometry_release(&verification->resting);
    planes_release(&verification->povray);
    planes_release(&verification->native);
    frame_release(&verification->exact);
    frame_release(&verification->tachyon);
    picture_release(&verification->shown[0]);
    picture_release(&verification->shown[1]);
    settled_release(&verification->found.settled);
    witness_release(&verification->found.witness);
    for (size_t i = 0; i < verification->commands.n; i++)
        free(verification->commands.items[i]);
    ARRAY_RELEASE(&verification->commands);
    free(verification->name);
    free(verification->description);
    free(verification->templates);
}

Status verification_add_command(Verification *verification, const char *command, Err *err)
{
    TRY(ARRAY_PUSH(&verification->commands, "commands", err, NULL));
    return mem_strdup(&verification->commands.items[verification->commands.n - 1], command, err);
}

/* ---- corcast's side -------------------------------------------------------------------------- */

bool verification_takes_two_steps(const Verification *verification)
{
    return models[verification->scene.geometry.model].proof == PROOF_STEPS;
}

static RenderParams render_params(const Verification *verification, const CellParams *povray_cells)
{
    return (RenderParams){.kernels = verification->options->kernels,
                          .threads = verification->common->threads,
                          .antialias = verification->options->picture.antialias,
                          .shadows = verification->options->picture.stage.shadows,
                          .povray_cells = povray_cells,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true,
                          .want_id = true};
}

static Encoding encoding_of(const Verification *verification)
{
    return verification->options->bits == 16 ? ENCODING_LINEAR : ENCODING_SRGB;
}

static Status write_frame(const Verification *verification, const Frame *frame, const char *name,
                          Encoding encoding, Err *err)
{
    char *path = NULL;
    TRY(file_join(verification->options->folder, name, &path, err));
    const FramesForm form = {.path = path,
                             .bits = verification->options->bits,
                             .packing = {.threads = verification->common->threads},
                             .encoding = encoding,
                             .picture = true,
                             .dpi = verification->options->picture.size.dpi,
                             .provenance = verification->commands.items[0],
                             .colors = verification->scene.appearance.meaning};
    Status status = frames_write(frame, &form, err);
    free(path);
    return status;
}

/* Draws one frame: of an isosurface with POV-Ray's root finder, unless `exact`. */
static Status render_frame(Verification *verification, bool exact, Frame *frame, Err *err)
{
    const CellParams cells = picture_cells(&verification->options->picture);
    const RenderParams params = render_params(
        verification, verification_takes_two_steps(verification) && !exact ? &cells : NULL);
    return render(&verification->scene, &params, frame, &verification->stats, err);
}

/* Draws alpha. Colors are compared in front of the look's background, as POV-Ray draws them; alpha
 * is compared in a picture of its own. */
static Status render_alpha(Verification *verification, Err *err)
{
    const CellParams cells = picture_cells(&verification->options->picture);
    RenderParams params =
        render_params(verification, verification_takes_two_steps(verification) ? &cells : NULL);
    Scene scene = verification->scene;
    Frame frame = {0};
    Picture picture = {0};
    Status status;
    params.want_depth = params.want_normal = params.want_id = false;
    scene.view.transparent = true;
    scene.view.fade = (Fade){0}; /* vessels of POV-Ray's picture are opaque */
    TRY_GOTO(render(&scene, &params, &frame, NULL, err));
    TRY_GOTO(picture_from_transparent(&picture, &frame.color, &frame.alpha, ENCODING_SRGB, 8, err));
    status = picture_take_alpha(&verification->native.alpha, &picture, err);
done:
    frame_release(&frame);
    picture_release(&picture);
    return status;
}

static Status render_native(Verification *verification, Err *err)
{
    OraclePlanes *native = &verification->native;
    TRY(render_frame(verification, false, &native->frame, err));
    if (verification->has_alpha)
        TRY(render_alpha(verification, err));
    TRY(picture_from_plane(&native->picture, &native->frame.color, encoding_of(verification),
                           verification->options->bits, err));
    return verification_takes_two_steps(verification)
               ? render_frame(verification, true, &verification->exact, err)
               : STATUS_OK;
}

/* ---- the other programs ---------------------------------------------------------------------- */

Status verification_pick_frame(Verification *verification, int frame, Err *err)
{
    const Appearance *all = &verification->scene.appearance;
    size_t n = all->n_frames ? all->n_frames : 1;
    if (frame > 0)
        TRY(fieldscale_check_frame(frame, all->name ? all->name : "the picture", n, err));
    verification->frame = frame ? frame : 1;
    if (all->n_frames == 0)
        return STATUS_OK;
    verification->moments = *all;
    verification->scene.appearance =
        appearance_frame(&verification->moments, (size_t)verification->frame - 1);
    if (!verification->scene.appearance.radius_factors)
        return STATUS_OK;
    Geometry beaten;
    TRY(geometry_with_scaled_radii(&verification->scene.geometry,
                                   verification->scene.appearance.radius_factors, &beaten, err));
    verification->resting = verification->scene.geometry;
    verification->scene.geometry = beaten;
    return STATUS_OK;
}

/* Sets the texts of scene files. */
static Status set_texts(Verification *verification, Err *err)
{
    Text description = TEXT_INIT;
    picture_description(&verification->scene.geometry, verification->tree, &description);
    if (verification->scene.appearance.meaning)
        text_printf(&description, ", colored by %s", verification->scene.appearance.meaning);
    Status status = text_take(&description, &verification->description, err);
    text_release(&description);
    return status == STATUS_OK ? templates_folder(&verification->templates, err) : status;
}

static EmitParams emit_params(const Verification *verification, const Scene *scene)
{
    return (EmitParams){.scene = scene,
                        .command = verification->commands.items[0],
                        .shadows = verification->options->picture.stage.shadows,
                        .cells = picture_cells(&verification->options->picture),
                        .templates = verification->templates,
                        .description = verification->description,
                        .generator = GENERATOR};
}

/* Draws POV-Ray's picture and writes its planes in corcast's formats, too. */
static Status draw_povray(Verification *verification, PovrayTiles *tiles, Err *err)
{
    char *picture = NULL;
    TRY(povraytiles_draw(tiles, &verification->povray, &verification->run, err));
    TRY(file_join(verification->options->folder, "povray.png", &picture, err));
    Status status = frames_write(&verification->povray.frame, &(FramesForm){.path = picture}, err);
    free(picture);
    return status;
}

/* POV-Ray and corcast, which draw at the same time. */
typedef enum Side { SIDE_POVRAY, SIDE_NATIVE, SIDES } Side;

typedef struct BothSides {
    Verification *verification;
    PovrayTiles *povray;
} BothSides;

/* Draws one side, in a thread of its own. */
static Status draw_side(size_t side, int worker, void *context, Err *err)
{
    (void)worker;
    BothSides *both = context;
    return side == SIDE_POVRAY ? draw_povray(both->verification, both->povray, err)
                               : render_native(both->verification, err);
}

/* Draws both sides. If both fail, the error is POV-Ray's. */
static Status draw_both(Verification *verification, Err *err)
{
    const size_t n = verification->moments.n_frames;
    Scene written = verification->scene;
    Progress progress;
    if (n > 0)
        written.appearance = verification->moments;
    if (verification->moments.radius_factors)
        written.geometry = verification->resting;
    const PovrayTilesParams params = {.emit = emit_params(verification, &written),
                                      .folder = verification->options->folder,
                                      .clock =
                                          n > 1 ? (verification->frame - 1) / (double)(n - 1) : 0,
                                      .antialias = verification->options->picture.antialias,
                                      .bits = verification->options->bits,
                                      .alpha = verification->has_alpha,
                                      .min_tiles = verification->options->tiles,
                                      .threads = verification->common->threads,
                                      .program = verification->options->povray,
                                      .progress = progress_report,
                                      .progress_context = &progress};
    BothSides both = {.verification = verification};
    Status status;
    TRY_GOTO(povraytiles_prepare(&params, &both.povray, err));
    verification->n_tiles = povraytiles_count(both.povray);
    verification->has_alpha = verification->has_alpha && verification->n_tiles == 1;
    for (size_t i = 0; i < povraytiles_n_commands(both.povray); i++)
        TRY_GOTO(verification_add_command(verification, povraytiles_command(both.povray, i), err));
    progress_start(&progress, "POV-Ray", verification->common->talk);
    status = threads_try(SIDES, verification->common->threads, draw_side, &both, err);
    progress_end(&progress);
done:
    povraytiles_free(both.povray);
    return status;
}

static Status draw_tachyon(Verification *verification, Err *err)
{
    const TachyonParams params = {.emit = emit_params(verification, &verification->scene),
                                  .folder = verification->options->folder,
                                  .threads = verification->common->threads,
                                  .program = verification->options->tachyon};
    TachyonRun run;
    TRY(tachyon_draw(&params, &verification->tachyon, &run, err));
    Witness *witness = &verification->found.witness;
    witness->seconds = run.seconds;
    snprintf(witness->version, sizeof witness->version, "%s", run.version);
    return STATUS_OK;
}

Status verification_draw(Verification *verification, Err *err)
{
    TRY(set_texts(verification, err));
    TRY(draw_both(verification, err));
    if (verification->options->witness == WITNESS_TACHYON)
        TRY(draw_tachyon(verification, err));
    TRY(write_frame(verification, &verification->native.frame, "native.png",
                    encoding_of(verification), err));
    if (verification_takes_two_steps(verification))
        TRY(write_frame(verification, &verification->exact, "exact.png", ENCODING_SRGB, err));
    if (verification->options->bits == 8)
        return STATUS_OK;
    TRY(picture_to_srgb(&verification->shown[0], &verification->povray.picture, 8, err));
    return picture_to_srgb(&verification->shown[1], &verification->native.picture, 8, err);
}

/* ---- comparison ------------------------------------------------------------------------------ */

const Picture *verification_shown(const Verification *verification, int side)
{
    const OraclePlanes *planes = side ? &verification->native : &verification->povray;
    return verification->options->bits == 8 ? &planes->picture : &verification->shown[side];
}

/* Explains pixels that differ. The tolerance then counts no settled pixel. */
static Status settle_sides(Verification *verification, const Rendering *a, const Rendering *b,
                           Tolerance *tolerance, Err *err)
{
    const CellParams cells = picture_cells(&verification->options->picture);
    const RenderParams params =
        render_params(verification, verification_takes_two_steps(verification) ? &cells : NULL);
    const ExplainCase input = {&verification->scene,      &params,  a, b,
                               encoding_of(verification), tolerance};
    verification->found.examined = explain_applies(&input);
    if (!verification->found.examined)
        return STATUS_OK;
    TRY(explain_pixels(&input, &verification->found.settled, err));
    tolerance->settled = verification->found.settled.marks;
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
static Status check_surface(Verification *verification, Err *err)
{
    const Frame *seen = &verification->native.frame, *exact = &verification->exact;
    const SurfacePlanes sight = {seen->depth.values, seen->normal.values, seen->id.ids};
    const SurfacePlanes exact_sight = {exact->depth.values, exact->normal.values, exact->id.ids};
    const ErfForm erf = picture_cells(&verification->options->picture).erf;
    Plane allowed = {0};
    Status status;
    TRY_GOTO(plane_init(&allowed, seen->depth.width, seen->depth.height, 1, err));
    TRY_GOTO(surface_tolerance(&verification->scene.geometry, &verification->scene.view.camera, erf,
                               &sight, &exact_sight, allowed.values, err));
    status =
        surface_check(&seen->depth, &exact->depth, &allowed, &verification->found.surface, err);
done:
    plane_release(&allowed);
    return status;
}

/* Compares the colors of the exact surface with POV-Ray's, as a screen shows them. */
static Status compare_exact(Verification *verification, const Rendering *povray, Err *err)
{
    Picture picture;
    const Tolerance tolerance = exact_tolerance(&verification->exact.id);
    TRY(picture_from_plane(&picture, &verification->exact.color, ENCODING_SRGB, 8, err));
    Rendering a = *povray;
    a.picture = verification_shown(verification, 0);
    const Rendering b = {.picture = &picture,
                         .ids = &verification->exact.id,
                         .depth = &verification->exact.depth,
                         .normal = &verification->exact.normal};
    Status status = compare_pictures(&a, &b, &tolerance, &verification->found.exact, NULL, err);
    picture_release(&picture);
    return status;
}

static Status compare_alpha(Verification *verification, const Tolerance *tolerance, Err *err)
{
    Tolerance of_alpha = *tolerance;
    of_alpha.title = "alpha";
    const Rendering a = {.picture = &verification->povray.alpha,
                         .ids = &verification->povray.frame.id};
    const Rendering b = {.picture = &verification->native.alpha,
                         .ids = &verification->native.frame.id};
    return compare_pictures(&a, &b, &of_alpha, &verification->found.alpha, NULL, err);
}

static Status compare_witness(Verification *verification, double depth_step_mm, Err *err)
{
    const Frame *povray = &verification->povray.frame, *native = &verification->native.frame;
    const Testimony three[] = {
        {"POV-Ray", &povray->id, &povray->depth},
        {"corcast", &native->id, &native->depth},
        {"Tachyon", &verification->tachyon.id, &verification->tachyon.depth}};
    return witness_compare(three, depth_step_mm, &verification->found.witness, err);
}

static Rendering rendering_of(const OraclePlanes *planes)
{
    return (Rendering){.picture = &planes->picture,
                       .ids = &planes->frame.id,
                       .depth = &planes->frame.depth,
                       .normal = &planes->frame.normal};
}

static Status compare_colors_of(Verification *verification, const Rendering *a, const Rendering *b,
                                const Tolerance *tolerance, Err *err)
{
    CompareResult *color = &verification->found.planes[PLANE_COLOR];
    TRY(compare_pictures(a, b, tolerance, color, NULL, err));
    TRY(compare_perception(verification_shown(verification, 0), verification_shown(verification, 1),
                           color, err));
    return color->agrees ? STATUS_OK : compare_cause(a->picture, b->picture, color, err);
}

Status verification_compare(Verification *verification, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&verification->scene.view.camera, verification->scene.geometry.bounds,
                       &near_mm, &far_mm);
    const double depth_step_mm = (far_mm - near_mm) / 65535;
    Tolerance tolerance = tolerance_identity(depth_step_mm);
    const Rendering a = rendering_of(&verification->povray),
                    b = rendering_of(&verification->native);
    CompareResult *planes = verification->found.planes;
    if (verification->options->witness == WITNESS_TACHYON)
        TRY(compare_witness(verification, depth_step_mm, err));
    TRY(settle_sides(verification, &a, &b, &tolerance, err));
    TRY(compare_colors_of(verification, &a, &b, &tolerance, err));
    TRY(compare_planes(PLANE_DEPTH, &a, &b, &tolerance, &planes[PLANE_DEPTH], err));
    TRY(compare_planes(PLANE_NORMAL, &a, &b, &tolerance, &planes[PLANE_NORMAL], err));
    TRY(compare_ids(a.ids, b.ids, &tolerance, &planes[PLANE_ID], err));
    if (verification->has_alpha)
        TRY(compare_alpha(verification, &tolerance, err));
    if (!verification_takes_two_steps(verification))
        return STATUS_OK;
    TRY(compare_exact(verification, &a, err));
    return check_surface(verification, err);
}
