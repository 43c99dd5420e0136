/* Declares the options of a picture, and makes its scene from them. The look (a file of colors,
 * finish and lights) and the tree are read once. Geometry, appearance and view are made from them,
 * each by a function of its own, so that animations can replace one of the three. An option that
 * has no effect on the picture is refused. */
#include "job/picture/picture.h"

#include "image/image.h"
#include "job/picture/frames.h"
#include "job/tree/tree_domain.h"
#include "options/reading.h"
#include "options/talk.h"
#include "render/render.h"
#include <stdlib.h>
#include <string.h>

static const char *const potentials[] = {"paper", "graph", NULL};
static const char *const joint_forms[] = {
    [JOINTS_ROBUST] = "robust", [JOINTS_PAPER] = "paper", NULL};
static const char *const projections[] = {
    [PROJECTION_ORTHOGRAPHIC] = "orthographic", [PROJECTION_PERSPECTIVE] = "perspective", NULL};
static const char *const views[] = {
    [VIEW_FRONT] = "front", [VIEW_BACK] = "back",     [VIEW_LEFT] = "left", [VIEW_RIGHT] = "right",
    [VIEW_TOP] = "top",     [VIEW_BOTTOM] = "bottom", [VIEW_ISO] = "iso",   NULL};
static const char *const up_axes[] = {[UP_Y] = "y", [UP_Z] = "z", NULL};

/* What the camera frames: the tree, whatever the model; the domain that the tree states; or the
 * geometry that is drawn. */
enum { PICTURE_TREE, PICTURE_DOMAIN, PICTURE_DRAWING };
static const char *const framings[] = {
    [PICTURE_TREE] = "tree", [PICTURE_DOMAIN] = "domain", [PICTURE_DRAWING] = "drawing", NULL};

/* The color of a point of a field: that of the segment with the largest term, or the color of the
 * mean value of all segments. */
enum { BLEND_SEGMENT, BLEND_BLENDED };
static const char *const color_blends[] = {
    [BLEND_SEGMENT] = "segment", [BLEND_BLENDED] = "blended", NULL};

static const char *const erf_names[] = {[ERF_FAST] = "fast", [ERF_EXACT] = "exact", NULL};

/* Ranges of options that other commands have as well. With a mesh tolerance of 0.002
 * of the radius about 50 triangles are around a vessel, with 0.2 five, which no longer look round.
 */
const Range antialias_range = {1, RENDER_MAX_ANTIALIAS}, prune_range = {0, 1e7},
            tolerance_range = {0.002, 0.2};

static const Option rows[] = {
    {.name = "model",
     SETS(CHOICE, PictureOptions, model),
     .choices = model_names,
     .group = GROUP_VESSELS,
     .when = WHEN(MODELS),
     .help = "vessel geometry: cylinders (one closed cylinder per segment), joined (cylinders "
             "connected by straight-sided transitions), rounded (cylinders with spheres where "
             "they meet or end), isosurface (smoothly blended surface), blob (POV-Ray's quick "
             "approximation of isosurface), mesh (isosurface as triangles, with ends cut flat)"},
    {.name = "potential",
     SETS(CHOICE, PictureOptions, potential),
     .choices = potentials,
     .group = GROUP_VESSELS,
     .when = WHEN(POTENTIAL) | WHEN(SURFACES),
     .help = "for --model isosurface only: which vessels blend into each other where they come "
             "close in space: paper (all vessels, as in Neumann 1996), graph (only vessels that "
             "are also close along the tree)"},
    {.name = "joints",
     SETS(CHOICE, PictureOptions, joints),
     GIVEN(PictureOptions, has_joints),
     .choices = joint_forms,
     .group = GROUP_VESSELS,
     .when = WHEN(JOINTS) | WHEN(SURFACES),
     .help = "for --model joined only: what is drawn where a junction cannot be built because "
             "vessels are too short or turn too sharply: robust (spheres, as --model rounded "
             "draws), paper (the junction of Neumann 1996, which is defective in these cases)"},
    {.name = "mesh-tolerance",
     .former = "tolerance",
     SETS(NUMBER, PictureOptions, tolerance),
     .range = &tolerance_range,
     .group = GROUP_VESSELS,
     .when = WHEN(TRIANGLES),
     .help = "for --model mesh only: maximum distance of the triangles from the exact surface, as "
             "a fraction of the local radius"},
    {.name = "part-overlaps",
     SETS(FLAG, PictureOptions, part_overlaps),
     .group = GROUP_VESSELS,
     .when = WHEN(TRIANGLES) | WHEN(SURFACES),
     .help = "for --model mesh only: make overlapping vessels that are not connected thinner, "
             "until they no longer touch"},
    {SMOOTH_OPTION(PictureOptions, smooth), GIVEN(PictureOptions, has_smooth),
     .otherwise = "set by --look, in most looks off", .when = WHEN(VESSELS)},
    {.name = "prune-radius",
     SETS(NUMBER, PictureOptions, prune_radius_mm),
     .range = &prune_range,
     .group = GROUP_VESSELS,
     .unit = "mm",
     .help = "radius below which segments are dropped, with their subtrees; 0 drops none"},
    {.name = "color-blend",
     SETS(CHOICE, PictureOptions, color_blend),
     .choices = color_blends,
     .group = GROUP_COLOR,
     .when = WHEN(FIELD_MODEL),
     .needs = "color-by",
     .help = "with --color-by, for --model isosurface and blob only: color of a point where "
             "segments merge: segment (the color of the segment that contributes most to the "
             "surface at the point), blended (the color of the mean value of all segments, "
             "weighted by their contributions)"},
    {.name = "size",
     SETS(SIZE, PictureOptions, size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_CAMERA,
     .when = WHEN(CAMERA),
     .help = "size of the image (for `corcast view`: of the window): in pixels (800x600), or on "
             "paper with a unit (89mmx60mm; mm, cm, in or pt), which --dpi converts to pixels; "
             "one length with a unit gives a square (89mm)"},
    {DPI_OF_SIZE(PictureOptions, size), .group = GROUP_CAMERA,
     .when = WHEN(ON_PAPER) | WHEN(ON_PAPER_OR_KEPT),
     .help = "pixels per inch. With a --size on paper, it sets the number of pixels. With a "
             "--size in pixels, it is only stored in the image file, if the format can store it"},
    {.name = "projection",
     SETS(CHOICE, PictureOptions, projection),
     GIVEN(PictureOptions, has_projection),
     .choices = projections,
     .group = GROUP_CAMERA,
     .otherwise = "set by --look, in most looks orthographic",
     .when = WHEN(CAMERA),
     .help = "projection of the camera"},
    {.name = "view",
     SETS(CHOICE, PictureOptions, view),
     GIVEN(PictureOptions, has_view),
     .choices = views,
     .group = GROUP_CAMERA,
     .when = WHEN(CAMERA),
     .help = "direction from which the camera looks at the tree: front (from +z), back (-z), left "
             "(-x), right (+x), top (+y), bottom (-y), iso (from the middle between front, right "
             "and top). With --up-axis z, front is from -y, back from +y, top from +z, bottom "
             "from -z"},
    {.name = "turn",
     SETS(NUMBERS, PictureOptions, turn),
     GIVEN(PictureOptions, has_turn),
     .group = GROUP_CAMERA,
     .argument = "AZ,EL",
     .otherwise = "0,0",
     .when = WHEN(CAMERA),
     .help = "angles, in degrees, by which the camera moves around the tree, away from the "
             "direction of --view: AZ to the right and EL up; negative angles move left and down. "
             "EL may be omitted"},
    {.name = "up-axis",
     SETS(CHOICE, PictureOptions, stage.up_axis),
     .choices = up_axes,
     .group = GROUP_CAMERA,
     .when = WHEN(CAMERA),
     .help = "axis of the tree's coordinates that points up in the image: y, or z (common in "
             "measured trees)"},
    {.name = "frame",
     SETS(CHOICE, PictureOptions, frame),
     .choices = framings,
     .group = GROUP_CAMERA,
     .when = WHEN(CAMERA),
     .help = "what the camera is fitted to, with --margin around it: tree (the segments with "
             "their radii; the scale is then the same for every --model), domain (the tissue "
             "shape that the tree file states; an error if it states none), drawing (all that the "
             "--model draws)"},
    {.name = "location",
     SETS(VECTOR, PictureOptions, stage.location),
     GIVEN(PictureOptions, stage.has_location),
     .group = GROUP_CAMERA,
     .otherwise = "in the direction of --view and --turn, at a distance that shows all of --frame",
     .when = WHEN(CAMERA),
     .help = "position of the camera, mm, in the coordinates of the tree; --view and --turn are "
             "then errors. With --projection orthographic, the distance of the camera does not "
             "change the size of the tree in the image; --height sets that size"},
    {.name = "look-at",
     SETS(VECTOR, PictureOptions, stage.look_at),
     GIVEN(PictureOptions, stage.has_look_at),
     .group = GROUP_CAMERA,
     .otherwise = "center of --frame",
     .when = WHEN(CAMERA),
     .help = "point at the center of the image, mm, in the coordinates of the tree. With "
             "--location, the camera turns towards the point. Without --location, the camera "
             "keeps its direction and is shifted"},
    {.name = "up",
     SETS(VECTOR, PictureOptions, stage.up),
     GIVEN(PictureOptions, stage.has_up),
     .group = GROUP_CAMERA,
     .otherwise = "the axis of --up-axis; with --view top the back of the tree, with --view bottom "
                  "the front of the tree",
     .when = WHEN(CAMERA),
     .help = "direction that points up in the image: a vector of any length, in the coordinates "
             "of the tree, that is not parallel to the camera's direction"},
    {.name = "angle",
     SETS(NUMBER, PictureOptions, stage.angle_deg),
     GIVEN(PictureOptions, has_angle),
     FROM_TO(0.01, 170),
     .group = GROUP_CAMERA,
     .unit = "deg",
     .when = WHEN(CAMERA),
     .help = "for --projection perspective only: full horizontal angle of view"},
    {.name = "height",
     SETS(NUMBER, PictureOptions, stage.height_mm),
     GIVEN(PictureOptions, has_height),
     FROM_TO(1e-6, 1e7),
     .group = GROUP_CAMERA,
     .unit = "mm",
     .otherwise = "height of --frame with --margin around it",
     .when = WHEN(CAMERA),
     .help = "for --projection orthographic only: height of the region that the image shows"},
    {.name = "margin",
     SETS(NUMBER, PictureOptions, stage.margin),
     FROM_TO(0, 0.45),
     .group = GROUP_CAMERA,
     .when = WHEN(CAMERA),
     .argument = "FRACTION",
     .help = "empty border on each side of what --frame names, as a fraction of the image's "
             "width and height"},
    {.name = "antialias",
     SETS(WHOLE, PictureOptions, antialias),
     GIVEN(PictureOptions, has_antialias),
     .range = &antialias_range,
     .group = GROUP_LIGHT,
     .when = WHEN(CAMERA),
     .help = "number of samples per pixel, N x N; 1 turns antialiasing off"},
    {.name = "ao",
     SETS(WHOLE, PictureOptions, occlusion),
     GIVEN(PictureOptions, has_occlusion),
     FROM_TO(0, LOOK_MAX_OCCLUSION),
     .group = GROUP_LIGHT,
     .otherwise = "set by --look, in most looks 0",
     .when = WHEN(LIT),
     .help = "ambient occlusion, the darkening where surfaces hide each other from the sky: "
             "number of rays per pixel (with `corcast render --exact`: per sample). 0 turns it "
             "off; scene, verify and answer accept only 0"},
    {.name = "look",
     SETS(LOOKUP, PictureOptions, look),
     .group = GROUP_LIGHT,
     .list = "looks",
     .otherwise = "the look cast; with --color-by the look data, whose lights keep the colors of "
                  "the legend",
     .when = WHEN(VESSELS),
     .help = "colors, finish and lights of the image: the name of a look, or the path, with a "
             "'/', of a file of your own, such as ./my.ini (docs/FORMATS.md describes it)"},
    {.name = "erf",
     SETS(CHOICE, PictureOptions, erf),
     .choices = erf_names,
     .group = GROUP_POVRAY,
     .when = WHEN(POTENTIAL),
     .help = "for --model isosurface, if POV-Ray draws it or `corcast render --hits povray` "
             "imitates POV-Ray: error function in the formula of the surface: fast (an "
             "approximation), exact"},
    {.name = "cell-beta",
     SETS(NUMBER, PictureOptions, cell_beta),
     FROM_TO(0.5, 64),
     .group = GROUP_POVRAY,
     .otherwise = "6",
     .when = WHEN(POTENTIAL),
     .help = "for --model isosurface, if POV-Ray draws it or `corcast render --hits povray` "
             "imitates POV-Ray: maximum side of the cubes into which the surface is divided, as a "
             "multiple of the smallest vessel radius in the cube. With smaller cubes, POV-Ray "
             "takes longer to read the scene and less time to draw it"},
    {.name = "shadows",
     SETS(SWITCH, PictureOptions, stage.shadows),
     GIVEN(PictureOptions, has_shadows),
     .group = GROUP_LIGHT,
     .otherwise = "set by --look, in most looks off",
     .when = WHEN(CAMERA) | WHEN(LIGHTS),
     .help = "draw the shadows that vessels cast; --shadows without a value is on"},
    {.name = "background",
     SETS(COLOR, PictureOptions, background),
     GIVEN(PictureOptions, has_background),
     .can_be_none = true,
     .group = GROUP_LIGHT,
     .otherwise = "set by --look",
     .when = WHEN(CAMERA),
     .help = "background color: a CSS name, #RRGGBB, R,G,B each 0..1, or none (transparent)"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const PictureOptions *options = set;
    (void)parsed;
    const SceneModel model =
        options->as_mesh ? model_with(MODEL_TRIANGLES) : (SceneModel)options->model;
    const bool field = model_has(model, MODEL_FIELD);
    return UNLESS(model_has(model, MODEL_POTENTIAL), POTENTIAL) |
           UNLESS(model_has(model, MODEL_JOINTS), JOINTS) |
           UNLESS(model_has(model, MODEL_TRIANGLES), TRIANGLES) | UNLESS(field, FIELD_MODEL) |
           UNLESS(field, FIELD_IDS);
}

#define DEFAULT_LOOK "cast"

/* Reads the look. Colors that mean something must be those of the legend, so a field has a look of
 * its own. */
static Status read_look(PictureOptions *options, const Parsed *parsed, Err *err)
{
    if (!options_specified(parsed, "look"))
        options->look = options->coloring.field ? "data" : DEFAULT_LOOK;
    return coloring_read_look(options->look, &options->look_file, err);
}

/* Reads the look, and takes from it what no option specifies. A --height needs an orthographic
 * picture, so it also replaces the look's projection. */
static Status settle(void *set, const Parsed *parsed, Err *err)
{
    PictureOptions *options = set;
    TRY(read_look(options, parsed, err));
    const LookOptions *proposed = &options->look_file.options;
    if (!options->has_smooth)
        options->smooth = proposed->smooth;
    if (!options->has_shadows)
        options->stage.shadows = proposed->shadows;
    if (!options->has_occlusion)
        options->occlusion = proposed->occlusion;
    if (!options->has_projection && !options->has_height)
        options->projection = (int)proposed->projection;
    return STATUS_OK;
}

const OptionTable picture_table = {OPTION_ROWS(rows), .settle = settle, .unmet = unmet};

void picture_set_defaults(PictureOptions *picture)
{
    *picture = (PictureOptions){.stage = view_defaults(),
                                .model = model_with(MODEL_DEFAULT),
                                .tolerance = MESHING_TOLERANCE,
                                .size = {.pixels = {1000, 1000}},
                                .antialias = 1,
                                .look = DEFAULT_LOOK};
    coloring_set_defaults(&picture->coloring);
}

CellParams picture_cells(const PictureOptions *options)
{
    return (CellParams){.beta = options->cell_beta, .erf = (ErfForm)options->erf};
}

/* Refuses options that exclude each other, instead of ignoring one of them. */
static Status check_camera(const PictureOptions *options, Err *err)
{
    const ViewParams *stage = &options->stage;
    bool perspective = options->projection == PROJECTION_PERSPECTIVE;
    if (options->has_height && perspective)
        return err_set(err, STATUS_USAGE,
                       "--height needs an orthographic picture; in perspective use --angle");
    if (options->has_angle && !perspective)
        return err_set(
            err, STATUS_USAGE,
            "--angle needs a perspective picture; in orthographic projection use --height");
    if (stage->has_location && (options->has_view || options->has_turn))
        return err_set(err, STATUS_USAGE, "--%s and --location exclude each other; give one",
                       options->has_view ? "view" : "turn");
    if (options->turn.n > 2)
        return err_set(err, STATUS_USAGE, "--turn takes AZ,EL or AZ in degrees, such as 30,15");
    if (stage->has_up && !(vec3_length(stage->up) > 0 && isfinite(vec3_length(stage->up))))
        return err_set(err, STATUS_USAGE,
                       "--up: the vector must have a length from 1e-150 to 1e150");
    return STATUS_OK;
}

ConditionSet picture_unmet_dpi(const PictureSize *size, const char *output)
{
    const bool kept = !output || image_traits(output).keeps_dpi || frames_is_page(output);
    return UNLESS(size_is_on_paper(size) || kept, ON_PAPER_OR_KEPT);
}

Status picture_check_povray(const PictureOptions *options, Err *err)
{
    if (options->occlusion == 0 || !options->has_occlusion)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--ao cannot be verified: POV-Ray has no ambient occlusion");
}

/* Sends notes about segments and joints of the tree that the picture does not show. */
static Status say_losses(const Geometry *geometry, const PictureReport *made, const Talk *talk,
                         Err *err)
{
    const StageReport *report = &made->staged;
    const size_t segments = report->dropped + report->drawn;
    size_t hidden;
    TRY(surface_count_missing(geometry, &hidden, err));
    if (made->pruned)
        talk_note(talk, "%zu of %zu segments are pruned", made->pruned, made->pruned + segments);
    if (report->dropped)
        talk_note(talk, "%zu of %zu segments have no length or no radius and are not drawn",
                  report->dropped, segments);
    if (report->covered)
        talk_note(talk,
                  "%zu of %zu segments are inside other segments between the same two points and "
                  "are not drawn",
                  report->covered, segments);
    if (hidden)
        talk_note(talk,
                  "%zu of %zu segments are too short for their radius and show no surface: their "
                  "potential is below e^-2",
                  hidden, segments);
    if (report->thinned)
        talk_note(talk, "%zu segment%s thinned until unconnected vessels no longer overlap",
                  report->thinned, report->thinned == 1 ? " is" : "s are");
    if (report->junctions_short + report->junctions_sharp)
        talk_note(
            talk,
            "%zu joints could not be built because vessels are too short, %zu because vessels "
            "turn too sharply; they are %s",
            report->junctions_short, report->junctions_sharp,
            made->joints == JOINTS_PAPER ? "built nevertheless" : "replaced by spheres");
    if (report->junctions_crowded)
        talk_note(
            talk,
            "%zu joints could not be built because too many vessels meet; they are replaced by "
            "spheres",
            report->junctions_crowded);
    return STATUS_OK;
}

/* Returns the farthest distance of a corner of the box from the camera, along rays. */
static double farthest_corner(const Camera *camera, const Box *box)
{
    double farthest = 0;
    for (int i = 0; i < 8; i++) {
        const Vec3 corner = {i & 1 ? box->low.x : box->high.x, i & 2 ? box->low.y : box->high.y,
                             i & 4 ? box->low.z : box->high.z};
        const Vec3 from = vec3_sub(corner, camera->location);
        farthest = fmax(farthest, camera->projection == PROJECTION_ORTHOGRAPHIC
                                      ? vec3_dot(from, camera->direction)
                                      : vec3_length(from));
    }
    return farthest;
}

/* Returns true if the tree is so small that POV-Ray's least distance from the camera, which render
 * keeps to, may hide it or a part of it: at most ten such distances across. In a larger tree only a
 * camera inside the tree loses anything. */
static bool may_be_hidden(const Scene *scene)
{
    const Box *box = &scene->geometry.bounds;
    return vec3_distance(box->low, box->high) <= 10 * render_nearest_mm(&scene->geometry);
}

/* Refuses a tiny tree if POV-Ray's least distance from the camera hides all of it. */
static Status check_distance(const Scene *scene, Err *err)
{
    const double least = render_nearest_mm(&scene->geometry);
    if (!may_be_hidden(scene) ||
        farthest_corner(&scene->view.camera, &scene->geometry.bounds) > least)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the whole tree is nearer to the camera than %g mm, where neither POV-Ray nor "
                   "render draws it; use a larger --input-unit or another camera",
                   least);
}

/* Sends notes about parts of a tiny tree that POV-Ray's fixed lengths hide. POV-Ray draws no sphere
 * with a radius up to 1e-5, and its shadow rays ignore hits up to 1e-3. */
static void say_limits(const Scene *scene, bool shadows, const Talk *talk)
{
    const Geometry *geometry = &scene->geometry;
    const double nearest_mm = render_nearest_mm(geometry);
    const double ball_mm = 1e-5, shadow_mm = fmax(nearest_mm, 1e-3);
    double thickest = 0, near_mm, far_mm;
    size_t balls = 0;
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        thickest = fmax(thickest, geometry->primitives[i].radius_mm);
        balls += geometry->primitives[i].kind == PRIMITIVE_SPHERE &&
                 geometry->primitives[i].radius_mm <= ball_mm;
    }
    for (size_t i = 0; i < geometry->n_segments; i++)
        thickest = fmax(thickest, geometry->segments[i].radius_mm);
    camera_depth_range(&scene->view.camera, geometry->bounds, &near_mm, &far_mm);
    if (may_be_hidden(scene) && near_mm < nearest_mm)
        talk_note(talk,
                  "parts of the tree nearer to the camera than %g mm are not drawn, as in POV-Ray; "
                  "use a larger --input-unit or another camera",
                  nearest_mm);
    if (balls)
        talk_note(
            talk,
            "%zu spheres have a radius of at most %g mm and are not drawn, as in POV-Ray; use a "
            "larger --input-unit",
            balls, ball_mm);
    if (shadows && 2 * thickest < shadow_mm)
        talk_note(talk,
                  "no vessel casts a shadow on itself: as in POV-Ray, parts nearer than %g mm to "
                  "a lit point cast no shadow on it, and all vessels are thinner than that",
                  shadow_mm);
}

static bool is_xray(const Look *look)
{
    return look_effects(look, 1, 1).xray.per_mm > 0;
}

/* Sets the look as the picture uses it: with the background of the options, and without effects if
 * the options omit them. Refuses options that an x-ray ignores. */
static Status take_look(const PictureOptions *options, const Parsed *parsed, Look *look, Err *err)
{
    const bool xray = is_xray(&options->look_file);
    *look = options->look_file;
    if (options->omits_effects)
        look->effects = (LookEffects){0};
    if (options->omits_effects || options->has_background)
        look->corners.present = false;
    if (xray && options->coloring.field)
        return err_set(err, STATUS_USAGE,
                       "--color-by has no effect: --look %s uses two fixed colors", options->look);
    if (xray)
        TRY(options_refuse(parsed, WHEN(LIT) | WHEN(LIGHTS), err));
    if (options->has_background && !color_is_none(options->background))
        look->background = rgb_of_option(options->background);
    return STATUS_OK;
}

/* Replaces the tree by the tree without thin segments. */
static Status prune(double radius_mm, bool keep_whole, PictureTree *of, Err *err)
{
    Tree rest;
    TRY(reading_refuse_loops(&of->tree, of->path, "--prune-radius", err));
    TRY(tree_prune_copy(&of->tree, radius_mm, &rest, err));
    of->pruned = of->tree.n - rest.n;
    size_t i = 0;
    while (i < rest.n && !tree_is_segment(&rest, i))
        i++;
    if (of->pruned > 0 && i == rest.n) { /* no segment is left */
        tree_release(&rest);
        return err_set(err, STATUS_INPUT, "%s: all %zu segments are thinner than --prune-radius %g",
                       of->path, of->pruned, radius_mm);
    }
    if (keep_whole)
        of->whole = of->tree;
    else
        tree_release(&of->tree);
    of->tree = rest;
    return STATUS_OK;
}

Status picture_read_tree(const Coloring *coloring, double prune_radius_mm, const Parsed *parsed,
                         PictureTree *out, Err *err)
{
    PictureTree made = {.path = parsed->operands[0]};
    TRY(reading_tree(parsed, made.path, &made.tree, NULL, err));
    Status status = blood_apply(&coloring->blood, parsed, &made.tree, err);
    if (status == STATUS_OK)
        status = coloring_join(coloring, &made.tree, &made.joined, err);
    if (status == STATUS_OK && prune_radius_mm > 0)
        status = prune(prune_radius_mm, coloring->range_of == RANGE_OF_TREE, &made, err);
    if (status == STATUS_OK)
        *out = made;
    else
        picture_tree_release(&made);
    return status;
}

void picture_tree_release(PictureTree *tree)
{
    tree_release(&tree->tree);
    tree_release(&tree->whole);
    smoothtree_release(&tree->smooth);
    free(tree->joined);
}

Status picture_smooth_tree(PictureTree *of, SceneModel model, Err *err)
{
    return stage_smooth(&of->tree, model, &of->smooth, err);
}

const SmoothTree *picture_pieces(const PictureTree *of)
{
    return of->smooth.tree.n ? &of->smooth : NULL;
}

void picture_report_smoothing(const SmoothReport *report, const Talk *talk)
{
    if (report->pieces == 0)
        return;
    talk_note(talk,
              "smooth: %zu segments are drawn as %zu pieces, at most %.3g mm (%.3g radii) from the "
              "straight segments; radii change by at most %.3g %%",
              report->segments, report->pieces, report->distance_mm, report->distance_radii,
              100 * report->radius_change);
}

ColoredTree picture_colored_tree(const PictureTree *tree)
{
    return (ColoredTree){.path = tree->path,
                         .joined = tree->joined,
                         .drawn = &tree->tree,
                         .pieces = picture_pieces(tree),
                         .whole = tree->whole.n ? &tree->whole : &tree->tree};
}

static Status find_domain(const PictureTree *of, Box *domain, Err *err)
{
    bool found;
    Status status = tree_domain_box(&of->tree, domain, &found, err);
    if (status == STATUS_OK && !found)
        status = err_set(err, STATUS_INPUT,
                         "--frame domain: the tree does not state the domain that it was grown in");
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", of->path);
    return status;
}

Status picture_read_source(const PictureOptions *options, const Parsed *parsed,
                           PictureSource *source, Err *err)
{
    PictureSource made = {0};
    TRY(check_camera(options, err));
    TRY(take_look(options, parsed, &made.look, err));
    TRY(picture_read_tree(&options->coloring, options->prune_radius_mm, parsed, &made.of, err));
    Status status = options->smooth ? picture_smooth_tree(&made.of, (SceneModel)options->model, err)
                                    : STATUS_OK;
    if (status == STATUS_OK && options->frame == PICTURE_DOMAIN)
        status = find_domain(&made.of, &made.domain, err);
    if (status == STATUS_OK)
        *source = made;
    else
        picture_source_release(&made);
    return status;
}

Status picture_use_field(PictureOptions *options, const Parsed *parsed, const char *field,
                         PictureSource *source, Err *err)
{
    options->coloring.field = field;
    TRY(read_look(options, parsed, err));
    return take_look(options, parsed, &source->look, err);
}

void picture_source_release(PictureSource *source)
{
    picture_tree_release(&source->of);
}

bool picture_is_transparent(const PictureOptions *options)
{
    return options->has_background && color_is_none(options->background);
}

ViewParams picture_view_params(const PictureOptions *options, const PictureSource *source)
{
    ViewParams params = options->stage;
    const SmoothTree *smooth = picture_pieces(&source->of);
    params.tree = smooth ? &smooth->tree : &source->of.tree;
    if (options->frame == PICTURE_DRAWING)
        params.tree = NULL;
    params.domain = options->frame == PICTURE_DOMAIN ? &source->domain : NULL;
    params.transparent = picture_is_transparent(options);
    params.turn_deg = options->turn.at[0];
    params.rise_deg = options->turn.at[1];
    params.projection = (Projection)options->projection;
    params.view = (NamedView)options->view;
    params.width = options->size.pixels[0];
    params.height = options->size.pixels[1];
    return params;
}

/* Reads the tree's series dilation, of segments or of pieces. */
static Status read_dilation(const PictureOptions *options, const PictureTree *tree,
                            FieldSeries *series, Err *err)
{
    const TreeMeta said = blood_specified(&options->coloring.blood);
    const SmoothTree *pieces = picture_pieces(tree);
    FieldSeries of_segments = {0};
    TRY(derive_series(&tree->tree, &said, "dilation", pieces ? &of_segments : series, err));
    if (!pieces)
        return STATUS_OK;
    Status status = derive_pieces(&(DividedTree){&tree->tree, &pieces->tree, pieces->segment},
                                  &said, &of_segments, series, err);
    fieldseries_release(&of_segments);
    return status;
}

/* Computes the factors of all radii in all frames from the tree's series dilation, frame by frame.
 *
 * frames   number of frames of the colors.
 * widths   receives a number per frame and segment, or piece; the caller frees them.
 * Errors   STATUS_INPUT if the tree has no such series, or it has another number of frames, or a
 *          radius would not be above 0. STATUS_MEMORY. */
static Status read_widths(const PictureOptions *options, const PictureTree *tree, size_t frames,
                          double **widths, Err *err)
{
    FieldSeries series;
    Status status = read_dilation(options, tree, &series, err);
    if (status == STATUS_MEMORY)
        return status;
    if (status != STATUS_OK || !series.time) {
        if (status == STATUS_OK)
            fieldseries_release(&series);
        return err_set(err, STATUS_INPUT,
                       "--beat: the tree has no series dilation; corcast pulse T -o P.vtp --fields "
                       "dilation,wss writes one");
    }
    if (series.frames != frames) {
        status = err_set(err, STATUS_INPUT,
                         "--beat: the series dilation has %zu time steps, but the colors have %zu",
                         series.frames, frames);
        fieldseries_release(&series);
        return status;
    }
    /* An exaggerated beat could make a radius 0 or negative. A vessel keeps at least 5 % of its
     * width, so that it stays visible. */
    for (size_t k = 0; k < series.field.n; k++) {
        const double dilation = series.field.value[k];
        series.field.value[k] = fmax(1 + options->beat * (isnan(dilation) ? 0 : dilation), 0.05);
    }
    *widths = series.field.value;
    series.field.value = NULL;
    fieldseries_release(&series);
    return STATUS_OK;
}

/* Makes the geometry of a tree whose vessels have other radii. */
static Status widened_geometry(const PictureOptions *options, const PictureSource *source,
                               const double *factors, const Common *common, Geometry *geometry,
                               StageReport *report, Err *err)
{
    PictureSource at = *source;
    Tree *drawn = picture_pieces(&at.of) ? &at.of.smooth.tree : &at.of.tree;
    double *radius;
    TRY(mem_calloc(&radius, drawn->n, sizeof *radius, "radii", err));
    for (size_t i = 0; i < drawn->n; i++)
        radius[i] = drawn->radius_mm[i] * factors[i];
    drawn->radius_mm = radius;
    Status status = picture_geometry(options, &at, common, geometry, report, err);
    free(radius);
    return status;
}

/* Makes the geometry of one frame of a beating tree. Cylinders and spheres are those of the tree at
 * rest with other radii, as in a scene of POV-Ray that contains all frames. */
static Status beating_geometry(const PictureOptions *options, const PictureSource *source,
                               const Common *common, Geometry *geometry, StageReport *report,
                               Err *err)
{
    const Tree *tree = &source->of.tree;
    PictureOptions still = *options;
    const size_t frame = (size_t)options->coloring.frame - 1;
    Series series;
    Geometry resting = {0};
    double *widths = NULL;
    Status status;
    still.beat = 0;
    TRY(tree_series(tree, "dilation", &series, err));
    const size_t frames = series.n;
    series_release(&series);
    TRY(read_widths(options, &source->of, frames, &widths, err));
    const size_t n = picture_pieces(&source->of) ? source->of.smooth.tree.n : tree->n;
    const double *factors = &widths[(frame < frames ? frame : 0) * n];
    if (model_is_of((SceneModel)options->model, MODEL_CYLINDERS | MODEL_BALLS)) {
        TRY_GOTO(picture_geometry(&still, source, common, &resting, report, err));
        status = geometry_with_scaled_radii(&resting, factors, geometry, err);
    } else {
        status = widened_geometry(&still, source, factors, common, geometry, report, err);
    }
done:
    geometry_release(&resting);
    free(widths);
    return status;
}

Status picture_geometry(const PictureOptions *options, const PictureSource *source,
                        const Common *common, Geometry *geometry, StageReport *report, Err *err)
{
    if (options->beat > 0 && options->coloring.frame > 0)
        return beating_geometry(options, source, common, geometry, report, err);
    const SceneModel model = (SceneModel)options->model;
    Progress progress;
    const GeometryParams params = {.model = model,
                                   .smooth = picture_pieces(&source->of),
                                   .joints = (JointForm)options->joints,
                                   .implied_ends = options->by_tiles && !is_xray(&source->look),
                                   .graph =
                                       options->potential != 0 && model_has(model, MODEL_POTENTIAL),
                                   .part_overlaps = options->part_overlaps,
                                   .mesh = {.tolerance = options->tolerance,
                                            .threads = common->threads,
                                            .progress = progress_report,
                                            .context = &progress}};
    progress_start(&progress, "triangulating", common->talk);
    Status status = stage_geometry(&source->of.tree, &params, geometry, report, err);
    progress_end(&progress);
    return status;
}

/* Makes the colors blend, if the options specify it. */
static Status blend(const PictureOptions *options, Appearance *appearance, Err *err)
{
    /* Maximum number of colors: a color map of POV-Ray holds 256 entries, two per color. */
    enum { MOST_STEPS = 128 };
    const ColorScale *scale = &appearance->scale;
    if (options->color_blend == BLEND_SEGMENT || !appearance->colors)
        return STATUS_OK;
    if (colorscale_selects_by_integer(scale))
        return err_set(err, STATUS_USAGE,
                       "--color-blend blended: the colors of --colormap %s are separate and blend "
                       "only with --classes",
                       options->coloring.colormap);
    if (colorscale_steps(scale) > MOST_STEPS)
        return err_set(err, STATUS_USAGE,
                       "--color-blend blended takes at most %d --classes, not %d", MOST_STEPS,
                       colorscale_steps(scale));
    return stage_blend(appearance, err);
}

Status picture_appearance(const PictureOptions *options, const PictureSource *source,
                          Appearance *appearance, Err *err)
{
    const ColoredTree tree = picture_colored_tree(&source->of);
    Appearance made;
    if (options->coloring.field || !source->look.tips.present)
        TRY(coloring_appearance(&options->coloring, &tree, &source->look, &made, err));
    else
        TRY(coloring_by_radius(&tree, &source->look, &made, err));
    Status status = blend(options, &made, err);
    if (status == STATUS_OK && options->beat > 0 && made.n_frames > 0)
        status = read_widths(options, &source->of, made.n_frames, &made.radius_factors, err);
    else if (status == STATUS_OK && options->beat > 0 && options->coloring.frame == 0)
        status = err_set(err, STATUS_USAGE,
                         "--beat: the field '%s' does not change in time; --color-by takes a field "
                         "of %s that does, such as wss of corcast pulse",
                         options->coloring.field, source->of.path);
    if (status == STATUS_OK)
        *appearance = made;
    else
        appearance_release(&made);
    return status;
}

Status picture_view(const PictureOptions *options, const PictureSource *source,
                    const Geometry *geometry, View *view, Err *err)
{
    const ViewParams params = picture_view_params(options, source);
    return stage_view(&source->look, &params, geometry, view, err);
}

static Status make_scene(const PictureOptions *options, const PictureSource *source,
                         const Common *common, Scene *scene, StageReport *report, Err *err)
{
    TRY(picture_appearance(options, source, &scene->appearance, err));
    Status status = picture_geometry(options, source, common, &scene->geometry, report, err);
    if (status == STATUS_OK)
        status = picture_view(options, source, &scene->geometry, &scene->view, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", source->of.path);
    return status;
}

Status picture_scene(const PictureOptions *options, const Parsed *parsed, Scene *scene,
                     PictureReport *report, Err *err)
{
    PictureSource source;
    TRY(picture_read_source(options, parsed, &source, err));
    Status status = picture_scene_of(options, &source, parsed, scene, NULL, report, err);
    picture_source_release(&source);
    return status;
}

Status picture_scene_of(const PictureOptions *options, const PictureSource *source,
                        const Parsed *parsed, Scene *scene, Anatomy *anatomy, PictureReport *report,
                        Err *err)
{
    PictureReport told = {.pruned = source->of.pruned,
                          .smooth = source->of.smooth.report,
                          .joints = (JointForm)options->joints,
                          .shadows = options->stage.shadows};
    Scene made = {0};
    Status status = make_scene(options, source, &parsed->common, &made, &told.staged, err);
    if (status == STATUS_OK)
        status = check_distance(&made, err);
    if (status == STATUS_OK && anatomy)
        status = stage_anatomy(&source->of.tree, picture_pieces(&source->of), made.geometry.origin,
                               anatomy, err);
    if (status != STATUS_OK) {
        scene_release(&made);
        return status;
    }
    *scene = made;
    *report = told;
    return STATUS_OK;
}

Status picture_report(const Scene *scene, const PictureReport *report, const Talk *talk, Err *err)
{
    say_limits(scene, report->shadows, talk);
    picture_report_smoothing(&report->smooth, talk);
    TRY(say_losses(&scene->geometry, report, talk, err));
    coloring_report(&scene->appearance, talk);
    return STATUS_OK;
}

Status picture_report_effects(const PictureOptions *options, const char *what, const Talk *talk,
                              Err *err)
{
    Text names = TEXT_INIT;
    Effects effects = look_effects(&options->look_file, 1, 1);
    effects.grade.present &= options->omits_effects; /* a scene has it */
    if (effects.xray.per_mm > 0)
        return err_set(err, STATUS_USAGE, "--look %s: POV-Ray cannot draw an x-ray; use render",
                       options->look);
    effects_list(&effects, options->occlusion > 0, &names);
    Status status = text_check(&names, err);
    if (status == STATUS_OK && names.length)
        talk_note(talk, "--look %s: only corcast draws %s; %s", options->look, text_chars(&names),
                  what);
    text_release(&names);
    return status;
}

Status picture_check_memory(int width, int height, double bytes_per_pixel, Err *err)
{
    double needed = (double)width * height * bytes_per_pixel;
    double memory = mem_machine_bytes();
    if (needed < 0.9 * memory) /* the rest is for the system and for what else the program holds */
        return STATUS_OK;
    return err_set(err, STATUS_MEMORY,
                   "out of memory: --size %dx%d needs %.1f GB and this machine has %.1f GB", width,
                   height, needed * 1e-9, memory * 1e-9);
}

Status picture_check_ids(const Geometry *geometry, const char *tree_path, Err *err)
{
    for (size_t i = 0; i < geometry->n_ids; i++)
        if (geometry->ids[i] > IMAGE_MAX_ID)
            return err_set(err, STATUS_INPUT,
                           "%s: the id %u is too large for an id plane (maximum %d); `corcast "
                           "convert` renumbers the nodes from 1",
                           tree_path, geometry->ids[i], IMAGE_MAX_ID);
    return STATUS_OK;
}

void picture_description(const Geometry *geometry, const char *tree_path, Text *out)
{
    text_puts(out, "arterial tree ");
    text_put_line(out, file_name(tree_path));
    text_printf(out, ", %zu segments as %s", geometry->drawn, models[geometry->model].name);
}
