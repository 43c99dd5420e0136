/* One scene, two renderers: POV-Ray draws it from files (povray_side.c) and corcast from memory, at
 * the same time, since POV-Ray first waits a quarter of a second for itself; then all four planes
 * of both are compared. An implicit surface takes two steps: corcast repeats POV-Ray's root finder,
 * whose picture must be POV-Ray's, and where that sees the surface is compared with where it is. */
#include "job/verify/verification.h"

#include "job/export/scenefiles.h"
#include "job/picture/frames.h"
#include "job/verify/povray_side.h"
#include "oracle/settle.h"
#include "oracle/tachyon.h"
#include <math.h>
#include <stdlib.h>

void verification_release(Verification *v)
{
    if (v->frames.n_frames > 0)
        v->scene.appearance = v->frames;
    scene_release(&v->scene);
    frame_release(&v->native);
    frame_release(&v->povray);
    frame_release(&v->exact);
    frame_release(&v->tachyon);
    witness_release(&v->witness);
    picture_release(&v->native_picture);
    picture_release(&v->povray_picture);
    picture_release(&v->native_alpha);
    picture_release(&v->povray_alpha);
    picture_release(&v->native_shown);
    settled_release(&v->settled);
    picture_release(&v->povray_shown);
    for (size_t i = 0; i < v->n_commands; i++)
        free(v->commands[i]);
    free(v->commands);
    free(v->name);
}

Status verification_add_command(Verification *v, char ***command, Err *err)
{
    TRY(mem_reserve(&v->commands, &v->command_room, v->n_commands + 1, sizeof *v->commands,
                    "commands", err));
    *command = &v->commands[v->n_commands++];
    **command = NULL;
    return STATUS_OK;
}

/* ---- the two sides --------------------------------------------------------------------------- */

bool verification_takes_two_steps(const Verification *v)
{
    return models[v->scene.geometry.model].proof == PROOF_STEPS;
}

static RenderParams render_params(const Verification *v, const CellParams *povray_cells)
{
    return (RenderParams){.kernels = v->kernels,
                          .threads = v->common->threads,
                          .antialias = v->picture->antialias,
                          .shadows = v->picture->stage.shadows,
                          .povray_cells = povray_cells,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true,
                          .want_id = true};
}

static Status render_frame(Verification *v, const CellParams *povray_cells, Frame *frame, Err *err)
{
    RenderParams params = render_params(v, povray_cells);
    return render(&v->scene, &params, frame, &v->stats, err);
}

static Encoding encoding_of(const Verification *v)
{
    return v->bits == 16 ? ENCODING_LINEAR : ENCODING_SRGB;
}

static Status write_frame(const Verification *v, const Frame *frame, const char *name,
                          Encoding encoding, Err *err)
{
    char *path = NULL;
    TRY(file_join(v->folder, name, &path, err));
    const FramesForm form = {.path = path,
                             .bits = v->bits,
                             .packing = {.threads = v->common->threads},
                             .encoding = encoding,
                             .picture = true,
                             .dpi = v->picture->size.dpi,
                             .provenance = v->commands[0],
                             .colors = v->scene.appearance.said};
    Status status = frames_write(frame, &form, err);
    free(path);
    return status;
}

/* Of an isosurface, where POV-Ray's root finder sees it. */
static const CellParams *cells_of(const Verification *v)
{
    return verification_takes_two_steps(v) ? &v->cells : NULL;
}

/* Colours are judged before the look's background, as POV-Ray draws them, and alpha in a picture of
 * its own. */
static Status render_alpha(Verification *v, Err *err)
{
    RenderParams params = render_params(v, cells_of(v));
    View view = v->scene.view;
    Scene scene = v->scene;
    Frame frame;
    Picture picture;
    params.want_depth = params.want_normal = params.want_id = false;
    view.transparent = true;
    scene.view = view;
    TRY(render(&scene, &params, &frame, NULL, err));
    Status status =
        picture_from_transparent(&picture, &frame.color, &frame.alpha, ENCODING_SRGB, 8, err);
    frame_release(&frame);
    TRY(status);
    status = picture_take_alpha(&v->native_alpha, &picture, err);
    picture_release(&picture);
    return status;
}

static Status render_native(Verification *v, Err *err)
{
    TRY(render_frame(v, cells_of(v), &v->native, err));
    if (v->has_alpha)
        TRY(render_alpha(v, err));
    TRY(picture_from_plane(&v->native_picture, &v->native.color, encoding_of(v), v->bits, err));
    return verification_takes_two_steps(v) ? render_frame(v, NULL, &v->exact, err) : STATUS_OK;
}

static Status write_native(const Verification *v, Err *err)
{
    TRY(write_frame(v, &v->native, "native.png", encoding_of(v), err));
    return verification_takes_two_steps(v)
               ? write_frame(v, &v->exact, "exact.png", ENCODING_SRGB, err)
               : STATUS_OK;
}

/* What a screen shows of linear codes. */
static Status show_both(Verification *v, Err *err)
{
    if (v->bits == 8)
        return STATUS_OK;
    TRY(picture_to_srgb(&v->povray_shown, &v->povray_picture, 8, err));
    return picture_to_srgb(&v->native_shown, &v->native_picture, 8, err);
}

/* ---- the witness ----------------------------------------------------------------------------- */

static Status write_witness_scene(const Verification *v, const char *scene, Err *err)
{
    const EmitParams params = {.scene = &v->scene, .command = v->commands[0], .planes = true};
    return scene_files_write(emitter_find("tachyon", false), &params, v->tree, scene, err);
}

static Status draw_witness_plane(Verification *v, const char *scene, WitnessPlane plane, Err *err)
{
    static const char *const names[] = {
        [WITNESS_DEPTH] = "tachyon.depth.ppm", [WITNESS_ID] = "tachyon.id.ppm"};
    char *path = NULL;
    double near_mm, far_mm, seconds = 0;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    TRY(file_join(v->folder, names[plane], &path, err));
    WitnessParams params = {.scene = scene,
                            .output = path,
                            .width = v->picture->size.pixels[0],
                            .height = v->picture->size.pixels[1],
                            .threads = v->common->threads,
                            .plane = plane};
    Status status = tachyon_from_environment(&params, err);
    if (status == STATUS_OK)
        status = witness_run(&params, &seconds, v->witness.version, err);
    v->witness.seconds += seconds;
    if (status == STATUS_OK)
        status = plane == WITNESS_ID ? witness_read_ids(&v->tachyon.id, path, err)
                                     : witness_read_depth(&v->tachyon.depth, path, &v->tachyon.id,
                                                          near_mm, far_mm, err);
    free(path);
    return status;
}

static Status ask_witness(Verification *v, Err *err)
{
    char *scene = NULL;
    TRY(file_join(v->folder, "scene.tachyon", &scene, err));
    Status status = write_witness_scene(v, scene, err);
    if (status == STATUS_OK)
        status = draw_witness_plane(v, scene, WITNESS_ID, err);
    if (status == STATUS_OK)
        status = draw_witness_plane(v, scene, WITNESS_DEPTH, err);
    free(scene);
    return status;
}

Status verification_pick_frame(Verification *v, int frame, Err *err)
{
    const Appearance *all = &v->scene.appearance;
    size_t n = all->n_frames ? all->n_frames : 1;
    if (frame > 0)
        TRY(coloring_check_frame(frame, all->name ? all->name : "the picture", n, err));
    v->frame = frame ? frame : 1;
    if (all->n_frames == 0)
        return STATUS_OK;
    v->frames = *all;
    v->scene.appearance = appearance_frame(&v->frames, (size_t)v->frame - 1);
    return STATUS_OK;
}

/* POV-Ray and corcast, which draw at the same time. */
typedef enum Side { SIDE_POVRAY, SIDE_NATIVE, SIDES } Side;

typedef struct BothSides {
    Verification *v;
    PovraySide *povray;
} BothSides;

static Status draw_side(size_t side, int worker, void *context, Err *err)
{
    (void)worker;
    BothSides *both = context;
    return side == SIDE_POVRAY ? povray_side_draw(both->povray, err) : render_native(both->v, err);
}

/* Fails as POV-Ray's side did, where both did. */
static Status draw_sides(Verification *v, Err *err)
{
    BothSides both = {.v = v};
    TRY(povray_side_prepare(v, &both.povray, err));
    Status status = threads_try(SIDES, v->common->threads, draw_side, &both, err);
    povray_side_free(both.povray);
    return status;
}

Status verification_draw(Verification *v, Err *err)
{
    v->cells = picture_cells(v->picture);
    TRY(draw_sides(v, err));
    if (v->asks_witness)
        TRY(ask_witness(v, err));
    TRY(write_native(v, err));
    return show_both(v, err);
}

/* ---- comparison ------------------------------------------------------------------------------ */

const Picture *verification_shown_by_povray(const Verification *v)
{
    return v->bits == 8 ? &v->povray_picture : &v->povray_shown;
}

const Picture *verification_shown_natively(const Verification *v)
{
    return v->bits == 8 ? &v->native_picture : &v->native_shown;
}

/* Asks who is right where the sides differ; the tolerance then knows. */
static Status settle_sides(Verification *v, const Rendering *a, const Rendering *b,
                           Tolerance *tolerance, Err *err)
{
    const RenderParams params = render_params(v, cells_of(v));
    const SettleCase asked = {&v->scene, &params, a, b, encoding_of(v), tolerance};
    v->asked = settle_applies(&asked);
    if (!v->asked)
        return STATUS_OK;
    TRY(settle_pixels(&asked, &v->settled, err));
    tolerance->settled = v->settled.marks;
    return STATUS_OK;
}

/* Whether vessels are seen whole: their mean breadth, twice the area over the outline, is at most a
 * quarter of the picture. Along an edge between pixels an outline is pi / 4 long
 * [Cauchy-Crofton]. */
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

/* Of a vessel from near by, POV-Ray's steps tilt all normals that are seen one way, by up to 0.1
 * degrees: what that makes of the colours averages out over the breadth of a vessel alone. */
static Tolerance exact_tolerance(const IdPlane *ids)
{
    Tolerance tolerance = tolerance_surface(0);
    tolerance.title = "exact color";
    if (sees_whole_vessels(ids))
        return tolerance;
    tolerance.gain = tolerance.offset_levels = tolerance.interior_ppm = (double)INFINITY;
    tolerance.segment_levels = tolerance.bias_levels = 1.5;
    return tolerance;
}

/* Holds where POV-Ray's root finder sees the surface against where it is. */
static Status check_surface(Verification *v, Err *err)
{
    const Frame *seen = &v->native, *exact = &v->exact;
    const SurfaceSight sight = {seen->depth.values, seen->normal.values, seen->id.ids};
    const SurfaceSight exact_sight = {exact->depth.values, exact->normal.values, exact->id.ids};
    Plane allowed = {0};
    TRY(plane_init(&allowed, seen->depth.width, seen->depth.height, 1, err));
    Status status = surface_tolerance(&v->scene.geometry, &v->scene.view.camera, v->cells.erf,
                                      &sight, &exact_sight, allowed.values, err);
    if (status == STATUS_OK)
        status = surface_check(&seen->depth, &exact->depth, &allowed, &v->surface, err);
    plane_release(&allowed);
    return status;
}

/* Holds the colours of the surface where it is against POV-Ray's, as they are shown. */
static Status compare_exact(Verification *v, const Rendering *povray, Err *err)
{
    Picture picture;
    const Tolerance tolerance = exact_tolerance(&v->exact.id);
    TRY(picture_from_plane(&picture, &v->exact.color, ENCODING_SRGB, 8, err));
    Rendering a = *povray;
    a.picture = verification_shown_by_povray(v);
    const Rendering b = {.picture = &picture,
                         .ids = &v->exact.id,
                         .depth = &v->exact.depth,
                         .normal = &v->exact.normal};
    Status status = compare_pictures(&a, &b, &tolerance, &v->exact_color, NULL, err);
    picture_release(&picture);
    return status;
}

static Status compare_alpha(Verification *v, const Tolerance *tolerance, Err *err)
{
    Tolerance of_alpha = *tolerance;
    of_alpha.title = "alpha";
    const Rendering a = {.picture = &v->povray_alpha, .ids = &v->povray.id};
    const Rendering b = {.picture = &v->native_alpha, .ids = &v->native.id};
    return compare_pictures(&a, &b, &of_alpha, &v->alpha, NULL, err);
}

static Status compare_witness(Verification *v, double depth_step_mm, Err *err)
{
    const Testimony three[] = {{"POV-Ray", &v->povray.id, &v->povray.depth},
                               {"corcast", &v->native.id, &v->native.depth},
                               {"Tachyon", &v->tachyon.id, &v->tachyon.depth}};
    return witness_compare(three, depth_step_mm, &v->witness, err);
}

Status verification_compare(Verification *v, Err *err)
{
    double near_mm, far_mm;
    camera_depth_range(&v->scene.view.camera, v->scene.geometry.bounds, &near_mm, &far_mm);
    Tolerance tolerance = tolerance_identity((far_mm - near_mm) / 65535);
    const IdPlane *a = &v->povray.id, *b = &v->native.id;
    const Rendering view_a = {.picture = &v->povray_picture,
                              .ids = a,
                              .depth = &v->povray.depth,
                              .normal = &v->povray.normal};
    const Rendering view_b = {.picture = &v->native_picture,
                              .ids = b,
                              .depth = &v->native.depth,
                              .normal = &v->native.normal};
    if (v->asks_witness)
        TRY(compare_witness(v, (far_mm - near_mm) / 65535, err));
    TRY(settle_sides(v, &view_a, &view_b, &tolerance, err));
    TRY(compare_pictures(&view_a, &view_b, &tolerance, &v->results[PLANE_COLOR], NULL, err));
    TRY(compare_perception(verification_shown_by_povray(v), verification_shown_natively(v),
                           &v->results[PLANE_COLOR], err));
    if (!v->results[PLANE_COLOR].agrees)
        TRY(compare_cause(&v->povray_picture, &v->native_picture, &v->results[PLANE_COLOR], err));
    TRY(compare_planes(PLANE_DEPTH, &v->povray.depth, &v->native.depth, a, b, &tolerance,
                       &v->results[PLANE_DEPTH], err));
    TRY(compare_planes(PLANE_NORMAL, &v->povray.normal, &v->native.normal, a, b, &tolerance,
                       &v->results[PLANE_NORMAL], err));
    TRY(compare_ids(a, b, &tolerance, &v->results[PLANE_ID], err));
    if (v->has_alpha)
        TRY(compare_alpha(v, &tolerance, err));
    if (!verification_takes_two_steps(v))
        return STATUS_OK;
    TRY(compare_exact(v, &view_a, err));
    return check_surface(v, err);
}
