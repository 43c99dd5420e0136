/* Fuzzes the library: calls its functions in any order with any handles. The bytes are a
 * program. Each call takes the next byte as its function, and further bytes select handles,
 * options and values. Freed handles are used again, which a build with CORCAST_DEBUG reports as
 * an error. A call that fails must set an error message, and a call that succeeds must set
 * none. Sizes and counts are limited to small values, and files belong to this process. */
#include "corcast.h"
#include "fuzz.h"

#include <stdio.h>

enum { SLOTS = 4 };

typedef struct Play {
    const uint8_t *at, *end;
    corcast_error *error;
    corcast_options *options[SLOTS];
    corcast_tree *trees[SLOTS];
    corcast_scene *scenes[SLOTS];
    corcast_image *images[SLOTS];
    corcast_mesh *meshes[SLOTS];
    corcast_report *reports[SLOTS];
    char path[512];    /* a file of this process */
    unsigned patience; /* calls of the progress callback until it stops the work */
} Play;

static unsigned next(Play *play)
{
    return play->at < play->end ? *play->at++ : 0;
}

/* A handle that may be NULL, live or freed. */
#define ANY(list) (play->list[next(play) % SLOTS])

static const char *const commands[] = {"grow",   "refine",  "info",     "render",  "scene",
                                       "export", "compare", "certify",  "convert", "figure",
                                       "verify", "pulse",   "coverage", "flow",    "?"};

/* Names and values that lead somewhere; others are made of the bytes. */
static const char *const names[] = {
    "terminals", "seed",    "gamma",      "model", "size",       "color-by", "look",      "view",
    "shadows",   "ao",      "planes",     "bits",  "domain",     "inlet",    "refine",    "tier",
    "antialias", "stats",   "voxel",      "lod",   "background", "legend",   "turntable", "only",
    "ids",       "threads", "lambda",     "from",  "templates",  "recipe",   "json",      "output",
    "tolerance", "method",  "projection", "print", "wall",       "parts"};
static const char *const values[] = {
    "3",       "0",        "-1",       "on",       "off",        "isosurface", "joined",
    "mesh",    "blob",     "flow",     "strahler", "8x8",        "16x9",       "depth,id,normal",
    "32",      "16",       "none",     "0,0",      "5,5,5",      "ball:10",    "disc:10",
    "journal", "topology", "geometry", "A",        "trace",      "nan",        "1e308",
    "x",       "",         "1,2,3",    "0.5",      "perspective"};

static int progress(void *user, const char *step, double fraction)
{
    Play *play = user;
    assert(fraction >= 0 && fraction <= 1);
    assert(!step || *step);
    return play->patience-- == 0;
}

static void message(void *user, int is_warning, const char *sentence)
{
    (void)user;
    assert((is_warning == 0 || is_warning == 1) && *sentence);
}

static int sink(void *user, const char *name, const void *bytes, size_t size)
{
    (void)bytes;
    assert(!strchr(name, '/'));
    return size > 0 && ((Play *)user)->patience-- == 0;
}

static int set_option(Play *play)
{
    char name[8], value[16];
    const unsigned i = next(play), k = next(play);
    snprintf(name, sizeof name, "%.7s", (const char *)(play->at < play->end ? "q-perf" : "x"));
    snprintf(value, sizeof value, "%u", k);
    corcast_options *options = ANY(options);
    return corcast_options_set(options, i < sizeof names / sizeof *names ? names[i] : name,
                               k < sizeof values / sizeof *values ? values[k]
                               : k == 255                         ? NULL
                                                                  : value,
                               play->error);
}

/* Options that keep the work small, whatever else is set. */
static int new_options(Play *play)
{
    corcast_options **slot = &ANY(options);
    const char *command = commands[next(play) % (sizeof commands / sizeof *commands)];
    corcast_options_free(*slot);
    int status = corcast_options_new(command, slot, play->error);
    if (status)
        return status;
    (void)corcast_options_set(*slot, "terminals", "8", NULL);
    (void)corcast_options_set(*slot, "refine-moves", "50", NULL);
    (void)corcast_options_set(*slot, "size", "12x10", NULL);
    (void)corcast_options_set(*slot, "threads", "1", NULL);
    return corcast_options_callbacks(*slot, progress, message, play, play->error);
}

static int from_nodes(Play *play)
{
    double positions[24], radii[8];
    int32_t parents[8], ids[8];
    corcast_tree **slot = &ANY(trees);
    const corcast_nodes nodes = {.n = next(play) % 9,
                                 .positions = positions,
                                 .radii = radii,
                                 .parents = parents,
                                 .ids = next(play) % 2 ? ids : NULL};
    for (int i = 0; i < 24; i++)
        positions[i] = (double)next(play) - 100;
    for (int i = 0; i < 8; i++) {
        radii[i] = (double)(next(play) % 32) / 8;
        parents[i] = (int32_t)(next(play) % 10) - 1;
        ids[i] = (int32_t)next(play) - 2;
    }
    corcast_tree_free(*slot);
    return corcast_tree_from_nodes(&nodes, slot, play->error);
}

static int from_bytes(Play *play)
{
    static const char *const files[] = {"a.swc", "a.csv", "a.vtk", "a.vtp", "a.pvd", "a.xyz", "-"};
    corcast_tree **slot = &ANY(trees);
    const char *name = files[next(play) % 7];
    corcast_options *options = ANY(options);
    const size_t left = (size_t)(play->end - play->at), size = left < 400 ? left : 400;
    const uint8_t *bytes = play->at;
    play->at += size;
    corcast_tree_free(*slot);
    return corcast_tree_read_bytes(bytes, size, name, options, slot, play->error);
}

/* Reads pictures of two formats that are cut off anywhere, and passes them on in another format. */
static int recode(Play *play)
{
    static const char picture[] = "P5 3 2 255\n......PF 1 1 -1\n............";
    static const char *const outputs[] = {"b.png", "b.exr", "b.tif", "b.webp", "b", "c/b.ppm"};
    corcast_image **image = &ANY(images);
    const size_t from = next(play) % 2 ? 17 : 0, size = next(play) % (sizeof picture - from);
    corcast_image_free(*image);
    (void)corcast_image_read_bytes(picture + from, size, "b", image, play->error);
    return corcast_image_write_bytes(*image, (corcast_plane)(next(play) % 5),
                                     (corcast_type)(next(play) % 5), outputs[next(play) % 6], sink,
                                     play, play->error);
}

static int get_pixels(Play *play)
{
    static float buffer[4096];
    int width = 0, height = 0, channels = 0;
    corcast_image *image = ANY(images);
    const corcast_plane plane = (corcast_plane)(next(play) % 6);
    (void)corcast_image_shape(image, plane, &width, &height, &channels, NULL);
    return corcast_image_pixels(image, plane, (corcast_type)(next(play) % 6), buffer,
                                next(play) * 16u, play->error);
}

static int get_field(Play *play)
{
    static const char *const fields[] = {"flow", "pressure", "wss", "strahler", "level", "none"};
    const double *value = NULL;
    const char *unit = NULL;
    corcast_nodes nodes;
    corcast_tree *tree = ANY(trees);
    const char *name = fields[next(play) % 6];
    int status = corcast_tree_field(tree, name, ANY(options), &value, &unit, play->error);
    if (status == 0 && corcast_tree_nodes(tree, &nodes, NULL) == 0)
        for (size_t i = 0; i < nodes.n; i++)
            assert(value[i] == value[i] || value[i] != value[i]);
    return status;
}

static int get_member(Play *play)
{
    static const char *const keys[] = {"segments",    "a.0",    "",     ".",
                                       "bound.bound", "agrees", "cause"};
    double number;
    const char *text;
    corcast_report *report = ANY(reports);
    assert(corcast_report_json(report));
    (void)corcast_report_text(report, keys[next(play) % 7], &text, NULL);
    return corcast_report_number(report, keys[next(play) % 7], &number, play->error);
}

static int read_option(Play *play)
{
    const char *value = NULL;
    return corcast_options_get(ANY(options), names[next(play) % 38], &value, play->error);
}

#define REPORT (corcast_report_free(*report), *report = NULL, report)

/* Calls the function of the next byte. Every handle that is replaced is freed before. */
static int play_one(Play *play)
{
    static const char *const outputs[] = {"a.stl", "a.pov", "a.png", "a.swc", "a.nii", "a.svg"};
    const unsigned what = next(play);
    corcast_tree **tree = &ANY(trees);
    corcast_report **report = &ANY(reports);
    corcast_scene **scene = &ANY(scenes);
    corcast_image **image = &ANY(images);
    corcast_options *options = ANY(options);
    corcast_error *error = play->error;
    switch (what % 28) {
    case 0:
        return new_options(play);
    case 1:
        return set_option(play);
    case 2:
        return set_option(play);
    case 3:
        return set_option(play);
    case 4:
        return read_option(play);
    case 5:
        corcast_tree_free(*tree);
        return corcast_grow(options, tree, REPORT, error);
    case 6:
        return corcast_refine(*tree, options, REPORT, error);
    case 7:
        return corcast_certify(*tree, options, REPORT, error);
    case 8:
        return corcast_info(*tree, options, REPORT, error);
    case 9:
        return from_nodes(play);
    case 10:
        return from_bytes(play);
    case 11:
        return get_field(play);
    case 12:
        return corcast_tree_write_bytes(*tree, outputs[next(play) % 6], sink, play, error);
    case 13:
        corcast_scene_free(*scene);
        return corcast_scene_new(*tree, options, scene, error);
    case 14:
        corcast_image_free(*image);
        return corcast_render(*scene, image, REPORT, error);
    case 15:
        return get_pixels(play);
    case 16:
        return corcast_compare(*image, ANY(images), options, REPORT, error);
    case 17:
        return get_member(play);
    case 18:
        corcast_tree_free(*tree);
        return corcast_tree_copy(ANY(trees), tree, error);
    case 19:
        return corcast_export_bytes(*tree, options, outputs[next(play) % 6], sink, play, error);
    case 20:
        corcast_mesh_free(play->meshes[0]);
        return corcast_mesh_new(*tree, options, &play->meshes[0], error);
    case 21:
        corcast_options_free(options);
        return 0;
    case 23:
        return corcast_pulse(*tree, options, REPORT, error);
    case 26:
        return corcast_flow(*tree, options, REPORT, error);
    case 24:
        return corcast_coverage(*tree, options, REPORT, error);
    case 25:
        return recode(play);
    case 22:
        corcast_image_free(*image);
        return 0;
    default:
        corcast_tree_free(*tree);
        return 0;
    }
}

static void release(Play *play)
{
    for (int i = 0; i < SLOTS; i++) {
        corcast_options_free(play->options[i]);
        corcast_tree_free(play->trees[i]);
        corcast_scene_free(play->scenes[i]);
        corcast_image_free(play->images[i]);
        corcast_mesh_free(play->meshes[i]);
        corcast_report_free(play->reports[i]);
    }
    corcast_error_free(play->error);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Play play = {.at = bytes, .end = bytes + size, .error = corcast_error_new(), .patience = 200};
    for (int calls = 0; play.at < play.end && calls < 60; calls++) {
        int status = play_one(&play);
        assert(status >= 0 && status <= 3);
        assert(status < 2 || *corcast_error_text(play.error));
        if (play.patience > 200)
            play.patience = 200;
    }
    release(&play);
    return 0;
}
