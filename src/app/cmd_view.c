/* A window on a tree. What it shows is the picture that `render` draws with the options that key o
 * prints: the same scene, the same renderer, the same camera, moved by moving its options. */
#include "app/commands.h"
#include "app/display.h"
#include "app/picture.h"
#include "app/window.h"
#include "render/render.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Command command = {
    .name = "view",
    .summary = "look at a tree in a window",
    .operands = "T.swc",
    .examples = "  corcast view tree.swc\n"
                "  corcast view tree.swc --model isosurface --color-by pressure --antialias 3\n"
                "in the window:\n"
                "  drag turns, drag with the right button or shift moves, the wheel zooms\n"
                "  1 ... 5    cylinders, joined, rounded, isosurface, blob\n"
                "  c          the next field that colours the vessels, or none\n"
                "  p s a      projection, shadows, ambient occlusion\n"
                "  r          back to where the camera was\n"
                "  o          print the options that draw this picture\n"
                "  w          write them as a recipe, for --recipe\n"
                "  q, Escape  quit\n",
    .min_operands = 1,
    .max_operands = 1,
};

static const char *const fields[] = {NULL,  "radius",   "flow",  "velocity", "pressure",
                                     "wss", "reynolds", "level", "strahler", "branch"};
enum { N_FIELDS = sizeof fields / sizeof *fields };

typedef struct Viewer {
    PictureOptions *options; /* camera included, once there is a scene */
    const Common *common;
    const char *tree, *recipe;
    PictureSource source;
    StageParams home; /* the camera that the options asked for */
    Scene scene;
    Display *display;
    Window *window;
    bool moved; /* the picture is of another camera */
    bool quit;
} Viewer;

/* ---- scene and camera --------------------------------------------------------------------------- */

static Status make_display(Viewer *viewer, Err *err)
{
    int coarseness = viewer->display ? display_coarseness(viewer->display) : 0;
    const RenderParams params = {.method = RENDER_RASTER,
                                 .threads = viewer->common->threads,
                                 .antialias = viewer->options->antialias,
                                 .shadows = viewer->options->stage.shadows,
                                 .occlusion = viewer->options->occlusion,
                                 .codes_suffice = true,
                                 .want_color = true};
    display_free(viewer->display);
    viewer->display = NULL;
    TRY(display_new(&viewer->scene, &params, &viewer->display, err));
    if (coarseness)
        display_set_coarseness(viewer->display, coarseness);
    viewer->moved = true;
    return STATUS_OK;
}

/* Builds the scene anew; the one there is stays on failure. */
static Status make_scene(Viewer *viewer, Err *err)
{
    Scene scene;
    TRY(picture_build(viewer->options, &viewer->source, &scene, NULL, err));
    scene_release(&viewer->scene);
    viewer->scene = scene;
    return make_display(viewer, err);
}

static Status aim(Viewer *viewer, Err *err)
{
    const StageParams params = picture_stage(viewer->options);
    viewer->moved = true;
    return stage_aim(&viewer->source.look, &params, &viewer->scene, err);
}

static void set_title(const Viewer *viewer)
{
    Text title = TEXT_INIT;
    const char *field = viewer->options->coloring.field;
    text_printf(&title, "%s: %zu segments, %s%s%s", file_name(viewer->tree), viewer->scene.drawn,
                model_name(viewer->scene.model), field ? ", " : "", field ? field : "");
    if (title.chars)
        window_title(viewer->window, title.chars);
    text_release(&title);
}

static Status use_model(Viewer *viewer, SceneModel model, Err *err)
{
    viewer->options->model = (int)model;
    TRY(make_scene(viewer, err));
    set_title(viewer);
    return STATUS_OK;
}

/* Fields that the tree has not got are passed over. */
static Status use_next_field(Viewer *viewer, Err *err)
{
    const char **field = &viewer->options->coloring.field;
    int number = 0;
    while (number < N_FIELDS && *field && (!fields[number] || strcmp(fields[number], *field) != 0))
        number++;
    for (int i = 1; i <= N_FIELDS; i++) {
        *field = fields[(number + i) % N_FIELDS];
        Status status = make_scene(viewer, err);
        if (status != STATUS_INPUT && status != STATUS_USAGE) {
            set_title(viewer);
            return status;
        }
    }
    return make_scene(viewer, err);
}

/* ---- what is shown, as options ------------------------------------------------------------------ */

typedef struct Settings {
    Text *text;
    const char *before, *between, *after; /* a name and a value */
} Settings;

static void put_word(const Settings *settings, const char *name, const char *value)
{
    text_printf(settings->text, "%s%s%s%s%s", settings->before, name, settings->between, value,
                settings->after);
}

static void put_numbers(const Settings *settings, const char *name, const double *values, int n)
{
    Text list = TEXT_INIT;
    for (int i = 0; i < n; i++) {
        text_puts(&list, i ? "," : "");
        text_number(&list, values[i] + 0);
    }
    put_word(settings, name, list.chars ? list.chars : "");
    text_release(&list);
}

static void put_vector(const Settings *settings, const char *name, Vec3 v)
{
    const double values[] = {v.x, v.y, v.z};
    put_numbers(settings, name, values, 3);
}

static void put_whole(const Settings *settings, const char *name, int value, int unless)
{
    char number[16];
    snprintf(number, sizeof number, "%d", value);
    if (value != unless)
        put_word(settings, name, number);
}

static void put_settings(const Settings *settings, const PictureOptions *options)
{
    const StageParams *stage = &options->stage;
    const Coloring *coloring = &options->coloring;
    char size[32];
    snprintf(size, sizeof size, "%dx%d", options->size[0], options->size[1]);
    put_word(settings, "model", model_name((SceneModel)options->model));
    put_word(settings, "size", size);
    bool perspective = options->projection == PROJECTION_PERSPECTIVE;
    put_word(settings, "projection", perspective ? "perspective" : "orthographic");
    put_vector(settings, "location", stage->location);
    put_vector(settings, "look-at", stage->look_at);
    put_vector(settings, "up", stage->up);
    put_numbers(settings, perspective ? "angle" : "height",
                perspective ? &stage->angle_deg : &stage->height_mm, 1);
    if (options->prune_radius_mm > 0)
        put_numbers(settings, "prune-radius", &options->prune_radius_mm, 1);
    if (options->potential && options->model == SCENE_ISOSURFACE)
        put_word(settings, "potential", "graph");
    if (options->joints && options->model == SCENE_JOINED)
        put_word(settings, "joints", "paper");
    if (strcmp(options->look, "cast") != 0)
        put_word(settings, "look", options->look);
    if (options->has_background)
        put_vector(settings, "background", options->background);
    if (stage->shadows)
        put_word(settings, "shadows", "on");
    put_whole(settings, "antialias", options->antialias, 1);
    put_whole(settings, "ao", options->occlusion, 0);
    if (!coloring->field)
        return;
    put_word(settings, "color-by", coloring->field);
    put_word(settings, "colormap", coloring->colormap);
    if (coloring->has_range)
        put_numbers(settings, "range", coloring->range, 2);
}

static Status print_options(const Viewer *viewer, Err *err)
{
    Text text = TEXT_INIT;
    const Settings settings = {&text, " --", " ", ""};
    put_settings(&settings, viewer->options);
    if (viewer->options->coloring.log && viewer->options->coloring.field)
        text_puts(&text, " --log");
    Status status = text_check(&text, err);
    if (status == STATUS_OK) {
        printf("corcast render %s%s -o P.png\n", viewer->tree, text.chars);
        fflush(stdout);
    }
    text_release(&text);
    return status;
}

static Status write_recipe(const Viewer *viewer, Err *err)
{
    Text text = TEXT_INIT;
    const Settings settings = {&text, "", " = ", "\n"};
    text_printf(&text, "; a view of %s; use: corcast render %s --recipe %s -o P.png\n",
                file_name(viewer->tree), file_name(viewer->tree), file_name(viewer->recipe));
    put_settings(&settings, viewer->options);
    if (viewer->options->coloring.log && viewer->options->coloring.field)
        put_word(&settings, "log", "on");
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        status = file_write(viewer->recipe, text.chars, text.length, err);
    if (status == STATUS_OK && !viewer->common->quiet)
        fprintf(stderr, "corcast: the view is written to %s\n", viewer->recipe);
    text_release(&text);
    return status;
}

/* ---- events ------------------------------------------------------------------------------------- */

static Status use_projection(Viewer *viewer, Err *err)
{
    StageParams stage = picture_stage(viewer->options);
    Projection other = stage.projection == PROJECTION_PERSPECTIVE ? PROJECTION_ORTHOGRAPHIC
                                                                  : PROJECTION_PERSPECTIVE;
    orbit_project(&stage, other, &viewer->scene);
    viewer->options->stage = stage;
    viewer->options->projection = (int)other;
    return aim(viewer, err);
}

static Status go_home(Viewer *viewer, Err *err)
{
    const StageParams *now = &viewer->options->stage;
    bool shadows = now->shadows;
    viewer->options->stage = viewer->home;
    viewer->options->stage.shadows = shadows;
    viewer->options->projection = (int)viewer->home.projection;
    return aim(viewer, err);
}

static Status on_key(Viewer *viewer, int key, Err *err)
{
    PictureOptions *options = viewer->options;
    switch (key) {
    case 'q':
    case WINDOW_KEY_ESCAPE:
        viewer->quit = true;
        return STATUS_OK;
    case '1':
    case '2':
    case '3':
    case '4':
    case '5':
        return use_model(viewer, (SceneModel)(SCENE_CYLINDERS + key - '1'), err);
    case 'c':
        return use_next_field(viewer, err);
    case 'p':
        return use_projection(viewer, err);
    case 's':
        options->stage.shadows = !options->stage.shadows;
        TRY(aim(viewer, err));
        return make_display(viewer, err);
    case 'a':
        options->occlusion = options->occlusion ? 0 : 16;
        return make_display(viewer, err);
    case 'r':
        return go_home(viewer, err);
    case 'o':
        return print_options(viewer, err);
    case 'w':
        return write_recipe(viewer, err);
    default:
        return STATUS_OK;
    }
}

static Status on_drag(Viewer *viewer, const WindowEvent *event, Err *err)
{
    StageParams stage = picture_stage(viewer->options);
    int side = stage.width < stage.height ? stage.width : stage.height;
    const double half_turn = 3.14159265358979323846;
    if (event->button == WINDOW_LEFT)
        orbit_turn(&stage, event->x / side * half_turn, -event->y / side * half_turn);
    else
        orbit_pan(&stage, event->x / stage.height, -event->y / stage.height);
    viewer->options->stage = stage;
    return aim(viewer, err);
}

static Status on_wheel(Viewer *viewer, const WindowEvent *event, Err *err)
{
    StageParams stage = picture_stage(viewer->options);
    orbit_zoom(&stage, pow(1.15, event->y));
    viewer->options->stage = stage;
    return aim(viewer, err);
}

static Status on_event(Viewer *viewer, const WindowEvent *event, Err *err)
{
    switch (event->kind) {
    case WINDOW_NOTHING:
        break;
    case WINDOW_QUIT:
        viewer->quit = true;
        break;
    case WINDOW_KEY:
        return on_key(viewer, event->key, err);
    case WINDOW_DRAG:
        return on_drag(viewer, event, err);
    case WINDOW_WHEEL:
        return on_wheel(viewer, event, err);
    case WINDOW_SIZE:
        viewer->options->size[0] = event->x < 1 ? 1 : (int)event->x;
        viewer->options->size[1] = event->y < 1 ? 1 : (int)event->y;
        return aim(viewer, err);
    case WINDOW_EXPOSED:
        viewer->moved = true;
        break;
    }
    return STATUS_OK;
}

/* ---- the loop ----------------------------------------------------------------------------------- */

static Status draw(Viewer *viewer, bool *done, Err *err)
{
    DisplayPicture picture;
    if (viewer->moved) {
        TRY(display_quick(viewer->display, &picture, err));
        *done = false;
    } else {
        TRY(display_refine(viewer->display, &picture, done, err));
    }
    viewer->moved = false;
    return window_show(viewer->window, picture.rgb, picture.width, picture.height, err);
}

/* All events that wait are heard before the next picture is drawn. */
static Status run(Viewer *viewer, Err *err)
{
    bool done = false;
    while (!viewer->quit) {
        WindowEvent event = window_event(viewer->window, done && !viewer->moved);
        while (event.kind != WINDOW_NOTHING && !viewer->quit) {
            TRY(on_event(viewer, &event, err));
            event = window_event(viewer->window, false);
        }
        if (!viewer->quit && (viewer->moved || !done))
            TRY(draw(viewer, &done, err));
    }
    return STATUS_OK;
}

/* Once around in so many pictures, as fast as they come. */
static Status turn_around(Viewer *viewer, int pictures, Err *err)
{
    const double full_turn = 6.283185307179586;
    bool done;
    double start_s = clock_seconds(), coarseness = 0;
    for (int i = 0; i < pictures && !viewer->quit; i++) {
        WindowEvent event = window_event(viewer->window, false);
        if (event.kind == WINDOW_QUIT)
            viewer->quit = true;
        StageParams stage = picture_stage(viewer->options);
        orbit_turn(&stage, full_turn / pictures, 0);
        viewer->options->stage = stage;
        TRY(aim(viewer, err));
        coarseness += display_coarseness(viewer->display);
        TRY(draw(viewer, &done, err));
    }
    printf("%.1f pictures a second, each pixel %.2f x %.2f of the window's\n",
           pictures / (clock_seconds() - start_s), coarseness / pictures, coarseness / pictures);
    return STATUS_OK;
}

static Status open_viewer(Viewer *viewer, Err *err)
{
    PictureOptions *options = viewer->options;
    TRY(picture_read_source(options, viewer->tree, &viewer->source, err));
    Status status = make_scene(viewer, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", viewer->tree);
    TRY(status);
    StageParams stage = picture_stage(options);
    orbit_begin(&stage, &viewer->scene);
    viewer->home = options->stage = stage;
    TRY(window_open(&viewer->window, file_name(viewer->tree), options->size[0], options->size[1],
                    err));
    set_title(viewer);
    return STATUS_OK;
}

Status run_view(int argc, char **argv, Err *err)
{
    PictureOptions picture;
    picture_options_init(&picture);
    const char *recipe = "view.ini";
    int turn = 0;
    const Option own[] = {
        {"save", OPTION_TEXT, &recipe, NULL, 0, 0, NULL, "FILE",
         "the recipe that key w writes (view.ini)"},
        {"turn", OPTION_WHOLE, &turn, NULL, 1, 100000, NULL, "N",
         "turn once around in N pictures, say how many a second, and quit"},
        {0},
    };
    const Option *const tables[] = {own, picture.table, picture.coloring.table, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Viewer viewer = {.options = &picture,
                     .common = &parsed.common,
                     .tree = parsed.operands[0],
                     .recipe = recipe};
    if (parsed.common.help)
        goto done;
    TRY_GOTO(open_viewer(&viewer, err));
    status = turn ? turn_around(&viewer, turn, err) : run(&viewer, err);
done:
    window_close(viewer.window);
    display_free(viewer.display);
    scene_release(&viewer.scene);
    picture_source_release(&viewer.source);
    parsed_release(&parsed);
    return status;
}
