/* Runs `view`: shows a tree in a window. The window shows the picture that `render` draws with the
 * options that the key o prints: both use the same scene, renderer and camera. The mouse moves the
 * camera by changing these options. */
#include "cli/command/view_overlay.h"
#include "cli/commands.h"

#include "cli/screen.h"
#include "cli/window/display.h"
#include "cli/window/window.h"
#include "job/picture/picture.h"
#include "options/output.h"
#include "render/render.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct Viewer {
    PictureOptions *options; /* include the camera, after open_viewer */
    const Parsed *parsed;
    const Common *common;
    const char *tree, *recipe;
    PictureSource source;
    ViewParams home; /* the camera of the options at the start */
    Box box;         /* stage_box of the geometry */
    Scene scene;
    Display *display;
    Window *window;
    ViewOverlay overlay;
    bool plain; /* the overlay is hidden */
    bool help;  /* the overlay shows the keys */
    bool stale; /* the overlay must be drawn again */
    bool moved; /* the picture in the window is out of date */
    bool quit;
} Viewer;

/* The list of keys in --help and in the window. Blanks align the list in --help. */
#define VIEW_KEYS(X)                                                                               \
    X("drag     ", "rotate; with the right button or shift: move")                                 \
    X("wheel    ", "zoom")                                                                         \
    X("1 ... 6  ", "vessel geometry: cylinders, joined, rounded, isosurface, blob, mesh")          \
    X("c        ", "color by the next field, or by none")                                          \
    X("p s a    ", "switch projection, shadows, ambient occlusion")                                \
    X("r        ", "reset the camera")                                                             \
    X("i        ", "show or hide the legend and the status line")                                  \
    X("h, ?     ", "show or hide this list")                                                       \
    X("o        ", "print the options that reproduce this view")                                   \
    X("w        ", "write these options as a recipe, for --recipe")                                \
    X("q, Escape", "quit")

static const OverlayKey view_keys[] = {
#define X(keys, meaning) {keys, meaning},
    VIEW_KEYS(X)
#undef X
};

/* ---- scene and camera ------------------------------------------------------------------------ */

/* Makes the renderer again, which has the geometry and the lights. The new one begins with the
 * coarseness of the one before. */
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
    TRY(display_new(&viewer->scene.geometry, &params, &viewer->display, err));
    if (coarseness)
        display_set_coarseness(viewer->display, coarseness);
    viewer->moved = true;
    return STATUS_OK;
}

/* Makes the view again, after the camera of the options has changed. */
static Status aim(Viewer *viewer, Err *err)
{
    viewer->moved = true;
    return picture_view(viewer->options, &viewer->source, &viewer->scene.geometry,
                        &viewer->scene.view, err);
}

/* Builds the geometry again. On failure the geometry before stays. */
static Status make_geometry(Viewer *viewer, Err *err)
{
    Geometry made;
    TRY(picture_geometry(viewer->options, &viewer->source, viewer->common, &made, NULL, err));
    geometry_release(&viewer->scene.geometry);
    viewer->scene.geometry = made;
    const ViewParams params = picture_view_params(viewer->options, &viewer->source);
    viewer->box = stage_box(&params, &made);
    viewer->options->stage.box = &viewer->box;
    TRY(aim(viewer, err));
    return make_display(viewer, err);
}

/* Builds the appearance again. On failure the appearance before stays. */
static Status make_appearance(Viewer *viewer, Err *err)
{
    Appearance made;
    TRY(picture_appearance(viewer->options, &viewer->source, &made, err));
    appearance_release(&viewer->scene.appearance);
    viewer->scene.appearance = made;
    viewer->moved = true;
    return STATUS_OK;
}

/* Appends what the window shows: "tree.swc: 79 segments, rounded, wall shear stress". */
static void put_subject(const Viewer *viewer, Text *text)
{
    const char *field = viewer->options->coloring.field;
    text_printf(text, "%s: %zu segments, %s%s%s", file_name(viewer->tree),
                viewer->scene.geometry.drawn, models[viewer->scene.geometry.model].name,
                field ? ", " : "", field ? derive_field_title(field) : "");
}

static void set_title(Viewer *viewer)
{
    Text title = TEXT_INIT;
    put_subject(viewer, &title);
    if (text_chars(&title))
        window_title(viewer->window, text_chars(&title));
    text_release(&title);
    viewer->stale = true;
}

/* Draws the overlay of the current scene. */
static Status update_overlay(Viewer *viewer, Err *err)
{
    const int *pixels = viewer->options->size.pixels;
    const size_t n_keys = sizeof view_keys / sizeof *view_keys;
    Text line = TEXT_INIT;
    viewer->stale = false;
    window_overlay(viewer->window, NULL, 0, 0);
    if (viewer->plain)
        return STATUS_OK;
    put_subject(viewer, &line);
    text_puts(&line, "   h: keys");
    Status status = text_check(&line, err);
    const OverlayContent content = {.scene = &viewer->scene,
                                    .status = text_chars(&line),
                                    .keys = view_keys,
                                    .n_keys = viewer->help ? n_keys : 0};
    if (status == STATUS_OK)
        status = overlay_draw(&viewer->overlay, &content, pixels[0], pixels[1], err);
    if (status == STATUS_OK)
        window_overlay(viewer->window, viewer->overlay.rgba, pixels[0], pixels[1]);
    text_release(&line);
    return status;
}

/* Shows the tree in another model. If its geometry cannot be built, prints why and keeps the model
 * before. */
static Status use_model(Viewer *viewer, SceneModel model, Err *err)
{
    int before = viewer->options->model;
    viewer->options->model = (int)model;
    Status status = make_geometry(viewer, err);
    if (status != STATUS_OK && viewer->scene.geometry.model != model) {
        fprintf(stderr, "corcast view: %s\n", err->text);
        viewer->options->model = before;
        return STATUS_OK;
    }
    set_title(viewer);
    return status;
}

/* Returns the index of a field; the number of fields for NULL, no field. */
static size_t field_number(const char *field)
{
    size_t number = 0;
    while (derive_field_name(number) &&
           (!field || strcasecmp(derive_field_name(number), field) != 0))
        number++;
    return number;
}

/* Colors the vessels by the next field. Skips fields that this tree does not have. */
static Status use_next_field(Viewer *viewer, Err *err)
{
    size_t none = field_number(NULL);
    for (size_t number = field_number(viewer->options->coloring.field);;) {
        number = number == none ? 0 : number + 1;
        Status status = picture_use_field(viewer->options, viewer->parsed,
                                          derive_field_name(number), &viewer->source, err);
        if (status == STATUS_OK)
            status = make_appearance(viewer, err);
        if (status == STATUS_OK)
            status = aim(viewer, err); /* the look's lights */
        if (number == none || (status != STATUS_INPUT && status != STATUS_USAGE)) {
            set_title(viewer);
            return status;
        }
    }
}

/* ---- what is shown, as options --------------------------------------------------------------- */

/* Appends one value of an option in the form of a command line or of a recipe. */
typedef Status PutSetting(Text *text, const Option *option, const char *value, Err *err);

static Status put_argument(Text *text, const Option *option, const char *value, Err *err)
{
    (void)err;
    text_printf(text, " --%s", option->name);
    if (option->kind == OPTION_FLAG)
        return STATUS_OK;
    text_puts(text, " ");
    text_put_shell_word(text, value);
    return STATUS_OK;
}

/* Refuses a value that an INI file cannot hold: the reader removes blanks at the ends of a value,
 * and a semicolon after a blank begins a comment. */
static Status put_pair(Text *text, const Option *option, const char *value, Err *err)
{
    size_t length = strlen(value);
    bool bare = *value == ';' || strstr(value, " ;") || strpbrk(value, "\t\r\n") ||
                (length && (value[0] == ' ' || value[length - 1] == ' '));
    if (bare)
        return err_set(err, STATUS_USAGE, "--%s: a recipe cannot hold '%s'", option->name, value);
    text_printf(text, "%s = %s\n", option->name, value);
    return STATUS_OK;
}

static Status put_setting(const Setting *setting, PutSetting *put, Text *text, Err *err)
{
    Status status = STATUS_OK;
    for (size_t at = 0; at < setting_count(setting) && status == STATUS_OK; at++) {
        Text value = TEXT_INIT;
        setting_put(setting, at, &value);
        status = text_check(&value, err);
        if (status == STATUS_OK)
            status = put(text, setting->option, text_chars(&value), err);
        text_release(&value);
    }
    return status;
}

/* Returns true if the option is needed to reproduce the picture. `plain` has the default value.
 * `text` fails as in setting_differs. */
static bool is_shown(const Viewer *viewer, const Setting *setting, const Setting *plain, Text *text)
{
    const Parsed *parsed = viewer->parsed;
    static const char *const always[] = {"model", "size", "projection", NULL};
    static const char *const framing[] = {"view", "turn", "margin", "angle", "height", NULL};
    const char *name = setting->option->name;
    bool perspective = viewer->options->projection == PROJECTION_PERSPECTIVE;
    if (is_one_of(name, always) || strcmp(name, perspective ? "angle" : "height") == 0)
        return true;
    return options_has_effect(parsed, setting->option, options_unmet(parsed)) &&
           !is_one_of(name, framing) && setting_differs(setting, plain, text);
}

/* Appends model, size, projection, the position of the camera, and every option that differs from
 * its default. */
static Status put_settings(const Viewer *viewer, PutSetting *put, Text *text, Err *err)
{
    Parsed plain;
    TRY(parsed_init(&plain, &command_view, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < plain.n_settings && status == STATUS_OK; i++) {
        const Setting *setting = &viewer->parsed->settings[i];
        if (!setting->option->aside && is_shown(viewer, setting, &plain.settings[i], text))
            status = put_setting(setting, put, text, err);
    }
    parsed_release(&plain);
    TRY(status);
    return text_check(text, err);
}

static Status print_options(const Viewer *viewer, Err *err)
{
    Text text = TEXT_INIT;
    text_puts(&text, "corcast render ");
    put_shell_operand(&text, viewer->tree);
    Status status = put_settings(viewer, put_argument, &text, err);
    if (status == STATUS_OK) {
        printf("%s -o P.png\n", text_chars(&text));
        fflush(stdout);
    }
    text_release(&text);
    return status;
}

static Status write_recipe(const Viewer *viewer, Err *err)
{
    Text text = TEXT_INIT;
    text_puts(&text, "; a view of ");
    text_put_line(&text, file_name(viewer->tree));
    text_puts(&text, ", for render --recipe\n");
    Status status = put_settings(viewer, put_pair, &text, err);
    if (status == STATUS_OK)
        status = file_write_text(viewer->recipe, &text, err);
    if (status == STATUS_OK && !viewer->common->quiet)
        fprintf(stderr, "corcast: the view is written to %s\n", viewer->recipe);
    text_release(&text);
    return status;
}

/* ---- events ---------------------------------------------------------------------------------- */

/* Changes between perspective and orthographic, with the tree in the same size. */
static Status use_projection(Viewer *viewer, Err *err)
{
    ViewParams stage = picture_view_params(viewer->options, &viewer->source);
    Projection other = stage.projection == PROJECTION_PERSPECTIVE ? PROJECTION_ORTHOGRAPHIC
                                                                  : PROJECTION_PERSPECTIVE;
    orbit_project(&stage, other, &viewer->scene.geometry);
    viewer->options->stage = stage;
    viewer->options->projection = (int)other;
    return aim(viewer, err);
}

/* Resets the camera; shadows stay as they are. */
static Status go_home(Viewer *viewer, Err *err)
{
    const ViewParams *now = &viewer->options->stage;
    bool shadows = now->shadows;
    viewer->options->stage = viewer->home;
    viewer->options->stage.shadows = shadows;
    viewer->options->projection = (int)viewer->home.projection;
    return aim(viewer, err);
}

static Status on_key(Viewer *viewer, int key, Err *err)
{
    PictureOptions *options = viewer->options;
    Status status;
    Err sentence = {{0}};
    if (viewer->help && key == WINDOW_KEY_ESCAPE)
        key = 'h';
    if (key >= '1' && key < '1' + SCENE_MODELS)
        return use_model(viewer, (SceneModel)(key - '1'), err);
    switch (key) {
    case 'q':
    case WINDOW_KEY_ESCAPE:
        viewer->quit = true;
        return STATUS_OK;
    case 'h':
    case '?':
    case '/': /* the key of '?' on many keyboards */
        viewer->help = !viewer->help;
        viewer->plain = false;
        viewer->stale = true;
        return STATUS_OK;
    case 'i':
        viewer->plain = !viewer->plain;
        viewer->stale = true;
        return STATUS_OK;
    case 'c':
        return use_next_field(viewer, err);
    case 'p':
        return use_projection(viewer, err);
    case 's':
        options->stage.shadows = !options->stage.shadows;
        options->has_shadows = true;
        TRY(aim(viewer, err));
        return make_display(viewer, err);
    case 'a':
        options->occlusion = options->occlusion ? 0 : 16; /* directions; more: smoother, slower */
        options->has_occlusion = true;
        return make_display(viewer, err);
    case 'r':
        return go_home(viewer, err);
    case 'o':
        return print_options(viewer, err);
    case 'w':
        status = write_recipe(viewer, &sentence);
        if (status != STATUS_OK) /* the window stays */
            fprintf(stderr, "corcast view: %s\n", sentence.text);
        return STATUS_OK;
    default:
        return STATUS_OK;
    }
}

/* A drag over the shorter side of the window turns the camera by half a turn. A drag that moves the
 * camera keeps the tree under the mouse. */
static Status on_drag(Viewer *viewer, const WindowEvent *event, Err *err)
{
    ViewParams stage = picture_view_params(viewer->options, &viewer->source);
    int side = stage.width < stage.height ? stage.width : stage.height;
    if (event->button == WINDOW_LEFT)
        orbit_turn(&stage, event->x / side * PI, -event->y / side * PI);
    else
        orbit_pan(&stage, event->x / stage.height, -event->y / stage.height);
    viewer->options->stage = stage;
    return aim(viewer, err);
}

/* A step of the wheel zooms by 15 %, so that 5 steps double the size; reason not recorded. */
static Status on_wheel(Viewer *viewer, const WindowEvent *event, Err *err)
{
    ViewParams stage = picture_view_params(viewer->options, &viewer->source);
    orbit_zoom(&stage, elementary_pow(1.15, event->y));
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
        viewer->options->size.pixels[0] = event->x < 1 ? 1 : (int)event->x;
        viewer->options->size.pixels[1] = event->y < 1 ? 1 : (int)event->y;
        viewer->stale = true;
        return aim(viewer, err);
    case WINDOW_EXPOSED:
        viewer->moved = true;
        break;
    }
    return STATUS_OK;
}

/* ---- the loop -------------------------------------------------------------------------------- */

/* Draws a quick picture if the view has changed, and otherwise refines the last one. *done: the
 * picture is complete. */
static Status draw(Viewer *viewer, bool *done, Err *err)
{
    DisplayPicture picture;
    const Scene *scene = &viewer->scene;
    if (viewer->stale)
        TRY(update_overlay(viewer, err));
    if (viewer->moved) {
        TRY(display_quick(viewer->display, &scene->view, &scene->appearance, &picture, err));
        *done = false;
    } else {
        TRY(display_refine(viewer->display, &scene->view, &scene->appearance, &picture, done, err));
    }
    viewer->moved = false;
    return window_show(viewer->window, picture.rgb, picture.width, picture.height, err);
}

/* Handles all waiting events before each picture, so that drawing does not delay the mouse. */
static Status run(Viewer *viewer, Err *err)
{
    bool done = false;
    while (!viewer->quit) {
        WindowEvent event = window_event(viewer->window, done && !viewer->moved && !viewer->stale);
        while (event.kind != WINDOW_NOTHING && !viewer->quit) {
            TRY(on_event(viewer, &event, err));
            event = window_event(viewer->window, false);
        }
        if (!viewer->quit && (viewer->moved || viewer->stale || !done))
            TRY(draw(viewer, &done, err));
    }
    return STATUS_OK;
}

/* Draws `pictures` full-quality pictures of one turn of the camera, and prints the speed. */
static Status turn_around(Viewer *viewer, int pictures, Err *err)
{
    bool done;
    double start_s = clock_seconds(), start_cpu_s = clock_cpu_seconds();
    for (int i = 0; i < pictures && !viewer->quit; i++) {
        WindowEvent event = window_event(viewer->window, false);
        if (event.kind == WINDOW_QUIT)
            viewer->quit = true;
        ViewParams stage = picture_view_params(viewer->options, &viewer->source);
        orbit_turn(&stage, FULL_TURN / pictures, 0);
        viewer->options->stage = stage;
        TRY(aim(viewer, err));
        display_set_coarseness(viewer->display, 1);
        TRY(draw(viewer, &done, err));
    }
    printf("%.1f pictures per second, %.1f ms of processor time each\n",
           pictures / (clock_seconds() - start_s),
           1e3 * (clock_cpu_seconds() - start_cpu_s) / pictures);
    return STATUS_OK;
}

/* Reads the tree, makes the scene, and opens the window. */
static Status open_viewer(Viewer *viewer, Err *err)
{
    PictureOptions *options = viewer->options;
    TRY(overlay_open(&viewer->overlay, err));
    TRY(picture_read_source(options, viewer->parsed, &viewer->source, err));
    Status status = make_appearance(viewer, err);
    if (status == STATUS_OK)
        status = make_geometry(viewer, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", viewer->tree);
    TRY(status);
    ViewParams stage = picture_view_params(options, &viewer->source);
    orbit_begin(&stage, &viewer->scene.view.camera, &viewer->scene.geometry);
    viewer->home = options->stage = stage;
    TRY(window_open(&viewer->window, file_name(viewer->tree), options->size.pixels[0],
                    options->size.pixels[1], err));
    set_title(viewer);
    screen_print_held(viewer->common->talk->user); /* the window stays open */
    return STATUS_OK;
}

typedef struct ViewOptions {
    const char *recipe;
    int turn;
    PictureOptions picture;
} ViewOptions;

static const Option own[] = {
    {.name = "save",
     SETS(OUTPUT, ViewOptions, recipe),
     .aside = true,
     .help = "file that the key w writes: the options of the view, as a recipe"},
    {.name = "turntable",
     SETS(WHOLE, ViewOptions, turn),
     FROM_TO(1, 100000),
     .group = GROUP_RUN,
     .aside = true,
     .otherwise = "",
     .help = "measure the speed: draw one turn as this number of full-quality images, print the "
             "images per second, and quit"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    ViewOptions *own_options = options;
    picture_set_defaults(&own_options->picture);
    own_options->picture.antialias = PICTURE_ANTIALIAS;
    own_options->recipe = "view.ini";
}

Status run_view(void *options, Parsed *parsed, Err *err)
{
    ViewOptions *own_options = options;
    Viewer viewer = {.options = &own_options->picture,
                     .parsed = parsed,
                     .common = &parsed->common,
                     .tree = parsed->operands[0],
                     .recipe = own_options->recipe};
    system_keep_memory();
    Status status = open_viewer(&viewer, err);
    if (status == STATUS_OK)
        status =
            own_options->turn ? turn_around(&viewer, own_options->turn, err) : run(&viewer, err);
    window_close(viewer.window);
    overlay_release(&viewer.overlay);
    display_free(viewer.display);
    scene_release(&viewer.scene);
    picture_source_release(&viewer.source);
    return status;
}

#define X(keys, meaning) "  " keys "  " meaning "\n"
const Command command_view = {
    .name = "view",
    .summary = "show a tree in an interactive window",
    .operands = "T.swc",
    .examples = "  corcast view tree.swc\n"
                "  corcast view tree.swc --model isosurface --color-by pressure --shadows on\n"
                "\nin the window:\n" VIEW_KEYS(X),
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .own_check = true, /* keys change the model and the field */
    .without = "erf cell-beta",
    .size = sizeof(ViewOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, PICTURE_TABLES(ViewOptions, picture)},
};
