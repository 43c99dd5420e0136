/* Wrong use of the library: each call must return an error whose message contains the words
 * beside the call, and must never crash. Then the callbacks: a callback that stops the work, in
 * each operation, and a sink that refuses bytes. */
#include "corcast.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static corcast_error *error;
static int failures;

static void check(int line, int status, int expected, const char *words)
{
    const char *said = corcast_error_text(error);
    if (status == expected && strstr(said, words))
        return;
    printf("line %d: status %d, expected %d; \"%s\", expected \"%s\"\n", line, status, expected,
           said, words);
    failures++;
}
#define EXPECT(status, words, call) check(__LINE__, call, status, words)
#define OK(call) check(__LINE__, call, CORCAST_OK, "")

static corcast_options *options_of(const char *command)
{
    corcast_options *options = NULL;
    OK(corcast_options_new(command, &options, error));
    return options;
}

static corcast_tree *small_tree(const char *terminals)
{
    corcast_tree *tree = NULL;
    corcast_options *options = options_of("grow");
    OK(corcast_options_set(options, "terminals", terminals, error));
    OK(corcast_grow(options, &tree, NULL, error));
    corcast_options_free(options);
    return tree;
}

static void null_arguments(const corcast_tree *tree)
{
    corcast_tree *out = NULL;
    corcast_nodes nodes;
    const char *text;
    double number;
    EXPECT(2, "options is NULL", corcast_grow(NULL, &out, NULL, error));
    EXPECT(2, "tree is NULL", corcast_refine(NULL, NULL, NULL, error));
    EXPECT(2, "report is NULL", corcast_info(tree, NULL, NULL, error));
    EXPECT(2, "tree is NULL", corcast_pulse(NULL, NULL, NULL, error));
    EXPECT(2, "tree is NULL", corcast_flow(NULL, NULL, NULL, error));
    EXPECT(2, "report is NULL", corcast_coverage(tree, NULL, NULL, error));
    EXPECT(2, "path is NULL", corcast_answer(tree, NULL, NULL, NULL, error));
    EXPECT(2, "path is NULL", corcast_tree_read(NULL, NULL, &out, error));
    EXPECT(2, "out is NULL", corcast_tree_read("a.swc", NULL, NULL, error));
    EXPECT(2, "bytes is NULL", corcast_tree_read_bytes(NULL, 1, "a.swc", NULL, &out, error));
    EXPECT(2, "tree is NULL", corcast_tree_nodes(NULL, &nodes, error));
    EXPECT(2, "nodes is NULL", corcast_tree_nodes(tree, NULL, error));
    EXPECT(2, "report is NULL", corcast_report_number(NULL, "a", &number, error));
    EXPECT(2, "out is NULL", corcast_options_new("grow", NULL, error));
    EXPECT(2, "options is NULL", corcast_options_set(NULL, "gamma", "3", error));
    EXPECT(2, "options is NULL", corcast_options_get(NULL, "gamma", &text, error));
    EXPECT(2, "scene is NULL", corcast_render(NULL, NULL, NULL, error));
    EXPECT(2, "a is NULL", corcast_compare(NULL, NULL, NULL, NULL, error));
    EXPECT(2, "sink is NULL", corcast_tree_write_bytes(tree, "a.swc", NULL, NULL, error));
    corcast_tree_free(NULL);
    corcast_image_free(NULL);
}

static void wrong_handles(corcast_tree *tree)
{
    corcast_options *options = options_of("render");
    corcast_tree *out = NULL;
    EXPECT(2, "tree is not a corcast_tree",
           corcast_refine((corcast_tree *)(void *)options, NULL, NULL, error));
    EXPECT(2, "the options belong to the command render", corcast_grow(options, &out, NULL, error));
    EXPECT(2, "not a corcast_options",
           corcast_options_set((corcast_options *)(void *)tree, "gamma", "3", error));
    corcast_options_free(options);
}

/* A debug build finds the use of handles that were freed. */
static void freed_handles(void)
{
    corcast_nodes nodes;
    corcast_tree *tree = small_tree("4");
    corcast_tree_free(tree);
    EXPECT(2, "it was freed", corcast_tree_nodes(tree, &nodes, error));
    corcast_tree_free(tree);
}

static void wrong_options(void)
{
    const char *value = NULL;
    corcast_options *options = options_of("grow");
    EXPECT(2, "gamma", corcast_options_set(options, "gama", "3", error));
    EXPECT(2, "--gamma", corcast_options_set(options, "gamma", "three", error));
    EXPECT(2, "standard streams", corcast_options_set(options, "from", "-", error));
    EXPECT(2, "standard streams", corcast_options_set(options, "domain", "mask:-,0.5", error));
    EXPECT(2, "command line only", corcast_options_set(options, "help", "on", error));
    OK(corcast_options_set(options, "gamma", "2.5", error));
    EXPECT(2, "--gamma", corcast_options_set(options, "gamma", "-1", error));
    OK(corcast_options_get(options, "gamma", &value, error));
    if (strcmp(value, "2.5") != 0)
        failures++, printf("gamma is %s after a value that was refused\n", value);
    OK(corcast_options_set(options, "gamma", NULL, error));
    OK(corcast_options_get(options, "gamma", &value, error));
    if (!value || strcmp(value, "3") != 0)
        failures++, printf("gamma is %s after it was unset\n", value ? value : "NULL");
    corcast_options_free(options);
    options = options_of("info"); /* whose viscosity is that of the tree */
    OK(corcast_options_get(options, "viscosity", &value, error));
    if (value)
        failures++, printf("viscosity is %s though it was not set\n", value);
    OK(corcast_options_set(options, "viscosity", "3.5", error));
    OK(corcast_options_get(options, "viscosity", &value, error));
    if (!value || strcmp(value, "3.5") != 0)
        failures++, printf("viscosity is %s after it was set\n", value ? value : "NULL");
    corcast_options_free(options);
    EXPECT(2, "is not a command", corcast_options_new("gro", &options, error));
}

/* An option of all commands keeps its place when another option is reset. */
static void reset_options(void)
{
    const char *value = NULL;
    corcast_options *options = options_of("grow");
    OK(corcast_options_set(options, "seed", "7", error));
    OK(corcast_options_set(options, "terminals", "9", error));
    OK(corcast_options_set(options, "terminals", NULL, error));
    OK(corcast_options_set(options, "partial", "off", error));
    OK(corcast_options_get(options, "seed", &value, error));
    if (!value || strcmp(value, "7") != 0)
        failures++, printf("seed is %s after another option was reset\n", value ? value : "NULL");
    corcast_options_free(options);
}

static void wrong_arrays(void)
{
    corcast_tree *out = NULL;
    double positions[] = {0, 0, 0, 1, 0, 0}, radii[] = {1, 1};
    int32_t parents[] = {-1, 1};
    corcast_nodes nodes = {.n = 0, .positions = positions, .radii = radii, .parents = parents};
    EXPECT(2, "n is 0", corcast_tree_from_nodes(&nodes, &out, error));
    nodes.n = 2;
    EXPECT(2, "", corcast_tree_from_nodes(&nodes, &out, error));
    parents[1] = 0;
    radii[1] = (double)NAN;
    EXPECT(2, "", corcast_tree_from_nodes(&nodes, &out, error));
    radii[1] = 0.5;
    positions[3] = (double)INFINITY;
    EXPECT(2, "", corcast_tree_from_nodes(&nodes, &out, error));
    positions[3] = 1;
    nodes.n = (size_t)1 << 40;
    EXPECT(2, "", corcast_tree_from_nodes(&nodes, &out, error));
    nodes.n = 2;
    OK(corcast_tree_from_nodes(&nodes, &out, error));
    corcast_tree_free(out);
}

static void wrong_pixels(const unsigned char *data)
{
    corcast_image *image = NULL;
    const corcast_pixels good = {2, 2, 3, CORCAST_U8, data, 12};
    corcast_pixels pixels = good;
    EXPECT(2, "pixels is NULL", corcast_image_from_pixels(NULL, &image, error));
    pixels.size = 11;
    EXPECT(2, "12", corcast_image_from_pixels(&pixels, &image, error));
    pixels = good;
    pixels.channels = 7;
    EXPECT(2, "channels", corcast_image_from_pixels(&pixels, &image, error));
    pixels = good;
    pixels.type = (corcast_type)9;
    EXPECT(2, "type", corcast_image_from_pixels(&pixels, &image, error));
    pixels = good;
    pixels.width = -2;
    EXPECT(2, "sides", corcast_image_from_pixels(&pixels, &image, error));
}

static void small_buffers(void)
{
    unsigned char pixels[12] = {0};
    const corcast_pixels given = {2, 2, 3, CORCAST_U8, pixels, 12};
    corcast_image *image = NULL;
    wrong_pixels(pixels);
    OK(corcast_image_from_pixels(&given, &image, error));
    EXPECT(2, "needs 12",
           corcast_image_pixels(image, CORCAST_COLOR, CORCAST_U8, pixels, 11, error));
    EXPECT(2, "no depth",
           corcast_image_pixels(image, CORCAST_DEPTH, CORCAST_F32, pixels, 12, error));
    EXPECT(2, "type", corcast_image_pixels(image, CORCAST_ID, CORCAST_U8, pixels, 12, error));
    EXPECT(2, "plane",
           corcast_image_pixels(image, (corcast_plane)7, CORCAST_U8, pixels, 12, error));
    OK(corcast_image_pixels(image, CORCAST_COLOR, CORCAST_U8, pixels, 12, error));
    corcast_image_free(image);
}

static int refuse(void *user, const char *name, const void *bytes, size_t size)
{
    (void)user;
    (void)name;
    (void)bytes;
    return size < 1u << 30;
}

static void wrong_image_bytes(void)
{
    const unsigned char pixels[12] = {0};
    const corcast_pixels given = {2, 2, 3, CORCAST_U8, pixels, 12};
    corcast_image *image = NULL;
    EXPECT(2, "bytes is NULL", corcast_image_read_bytes(NULL, 3, "a.png", &image, error));
    EXPECT(2, "a.png: is not an image", corcast_image_read_bytes("abc", 3, "a.png", &image, error));
    EXPECT(2, "the bytes:", corcast_image_read_bytes("P6\n2 2\n255\n", 11, NULL, &image, error));
    OK(corcast_image_from_pixels(&given, &image, error));
#define WRITE(name, sink)                                                                          \
    corcast_image_write_bytes(image, CORCAST_COLOR, CORCAST_U8, name, sink, NULL, error)
    EXPECT(3, "sink", WRITE("a.png", refuse));
    EXPECT(2, "sink is NULL", WRITE("a.png", NULL));
    EXPECT(2, "folder", WRITE("b/a.png", refuse));
    EXPECT(2, "floats", WRITE("a.exr", refuse));
    corcast_image_free(image);
}

/* ---- callbacks ------------------------------------------------------------------------------- */

static int stop(void *user, const char *step, double fraction)
{
    (void)fraction;
    *(int *)user += step != NULL;
    return 1;
}

static corcast_options *stopping(const char *command, int *calls)
{
    corcast_options *options = options_of(command);
    OK(corcast_options_callbacks(options, stop, NULL, calls, error));
    return options;
}

static void expect_cancelled(int line, int status, int *calls)
{
    check(line, status, CORCAST_FAILED, "stopped by the caller");
    if (strcmp(corcast_error_kind(error), "cancelled") != 0 || *calls == 0)
        failures++, printf("line %d: kind %s, %d calls\n", line, corcast_error_kind(error), *calls);
    *calls = 0;
}
#define CANCELLED(call) expect_cancelled(__LINE__, call, &calls)

static void cancelled_growth(corcast_tree *tree)
{
    int calls = 0;
    corcast_tree *out = NULL;
    corcast_options *options = stopping("grow", &calls);
    OK(corcast_options_set(options, "terminals", "2000", error));
    CANCELLED(corcast_grow(options, &out, NULL, error));
    corcast_options_free(options);
    options = stopping("refine", &calls);
    OK(corcast_options_set(options, "refine", "topology", error));
    CANCELLED(corcast_refine(tree, options, NULL, error));
    corcast_options_free(options);
}

static void cancelled_picture(const corcast_tree *tree, const char *name, const char *value)
{
    int calls = 0;
    corcast_scene *scene = NULL;
    corcast_image *image = NULL;
    corcast_options *options = stopping("render", &calls);
    OK(corcast_options_set(options, name, value, error));
    OK(corcast_scene_new(tree, options, &scene, error));
    calls = 0;
    CANCELLED(corcast_render(scene, &image, NULL, error));
    corcast_scene_free(scene);
    corcast_options_free(options);
}

static void cancelled_files(const corcast_tree *tree)
{
    int calls = 0;
    corcast_mesh *mesh = NULL;
    corcast_options *options = stopping("export", &calls);
    CANCELLED(corcast_mesh_new(tree, options, &mesh, error));
    OK(corcast_options_set(options, "voxel", "1", error));
    CANCELLED(corcast_export(tree, options, "volume.nii", error));
    corcast_options_free(options);
    options = stopping("verify", &calls);
    CANCELLED(corcast_verify(tree, options, "verified", NULL, error));
    corcast_options_free(options);
}

static void refused_bytes(const corcast_tree *tree)
{
    corcast_options *options = options_of("scene");
    EXPECT(3, "sink", corcast_tree_write_bytes(tree, "a.swc", refuse, NULL, error));
    EXPECT(3, "sink", corcast_export_bytes(tree, options, "a.pov", refuse, NULL, error));
    EXPECT(2, "folder", corcast_export_bytes(tree, options, "b/a.pov", refuse, NULL, error));
    corcast_options_free(options);
}

/* A tree that changes between two calls: what was made of it before stays as it was. */
static void changed_tree(corcast_tree *tree)
{
    const double *flow = NULL;
    const char *unit = NULL;
    corcast_scene *scene = NULL;
    corcast_image *image = NULL;
    OK(corcast_tree_field(tree, "flow", NULL, &flow, &unit, error));
    OK(corcast_scene_new(tree, NULL, &scene, error));
    OK(corcast_refine(tree, NULL, NULL, error));
    OK(corcast_tree_field(tree, "flow", NULL, &flow, &unit, error));
    if (strcmp(unit, "ml/min") != 0 || !isnan(flow[0]) || !(flow[1] > 0))
        failures++, printf("flow is %g %s\n", flow[1], unit);
    OK(corcast_render(scene, &image, NULL, error));
    EXPECT(2, "wrong-field", corcast_tree_field(tree, "wrong-field", NULL, &flow, &unit, error));
    corcast_image_free(image);
    corcast_scene_free(scene);
}

int main(int argc, char **argv)
{
    error = corcast_error_new();
    corcast_tree *tree = small_tree("60");
    null_arguments(tree);
    wrong_handles(tree);
    wrong_options();
    reset_options();
    wrong_arrays();
    small_buffers();
    wrong_image_bytes();
    cancelled_growth(tree);
    cancelled_picture(tree, "model", "joined");
    cancelled_picture(tree, "model", "isosurface");
    cancelled_picture(tree, "method", "trace");
    cancelled_files(tree);
    refused_bytes(tree);
    changed_tree(tree);
    if (argc > 1 && strcmp(argv[1], "freed") == 0)
        freed_handles();
    corcast_tree_free(tree);
    corcast_error_free(error);
    return failures > 0;
}
