/* Runs one operation of the library, so that its files can be compared with those of the
 * command line, and its allocations can be made to fail.
 *
 *   session grow OUT NAME=VALUE...                 writes the tree to OUT
 *   session refine IN OUT NAME=VALUE...
 *   session export COMMAND IN OUT NAME=VALUE...
 *   session bytes COMMAND IN OUT NAME=VALUE...     as export, through a sink into OUT's folder
 *   session render IN OUT.ppm NAME=VALUE...        writes the pixels of a picture in memory
 *   session compare A B NAME=VALUE...              prints the report
 *   session info IN NAME=VALUE...                  prints the report; also coverage
 *   session pulse OUT IN NAME=VALUE...             writes the tree, prints the report; also flow,
 * answer session convert IN OUT                         reads the bytes of the tree IN in memory
 *   session recode IN OUT                          reads the bytes of the picture IN in memory, and
 *                                                  writes it through a sink into OUT's folder
 *
 * Ends with the status of the library, and its error message on standard error. */
#include "corcast.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static corcast_error *error;

/* Returns options with the arguments NAME=VALUE set; NULL after a failure, with *status set. */
static corcast_options *options_of(const char *command, char **arguments, int *status)
{
    corcast_options *options = NULL;
    *status = corcast_options_new(command, &options, error);
    for (; !*status && *arguments; arguments++) {
        char name[64];
        const char *equals = strchr(*arguments, '=');
        snprintf(name, sizeof name, "%.*s", (int)(equals - *arguments), *arguments);
        *status = corcast_options_set(options, name, equals + 1, error);
    }
    return options;
}

static int grow(char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    corcast_report *report = NULL;
    corcast_options *options = options_of("grow", arguments + 1, &status);
    if (!status)
        status = corcast_grow(options, &tree, &report, error);
    if (!status)
        status = corcast_tree_write(tree, arguments[0], error);
    corcast_report_free(report);
    corcast_tree_free(tree);
    corcast_options_free(options);
    return status;
}

static int refine(char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    corcast_options *options = options_of("refine", arguments + 2, &status);
    if (!status)
        status = corcast_tree_read(arguments[0], NULL, &tree, error);
    if (!status)
        status = corcast_refine(tree, options, NULL, error);
    if (!status)
        status = corcast_tree_write(tree, arguments[1], error);
    corcast_tree_free(tree);
    corcast_options_free(options);
    return status;
}

static int export_tree(char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    corcast_options *options = options_of(arguments[0], arguments + 3, &status);
    if (!status)
        status = corcast_tree_read(arguments[1], NULL, &tree, error);
    if (!status)
        status = corcast_export(tree, options, arguments[2], error);
    corcast_tree_free(tree);
    corcast_options_free(options);
    return status;
}

/* Appends to the file of that name in the folder `user`. */
static int keep(void *user, const char *name, const void *bytes, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", (const char *)user, name);
    FILE *file = fopen(path, "ab");
    const int failed = !file || fwrite(bytes, 1, size, file) != size;
    if (file)
        fclose(file);
    return failed;
}

static int export_bytes(char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    char *slash = strrchr(arguments[2], '/');
    corcast_options *options = options_of(arguments[0], arguments + 3, &status);
    *slash = '\0';
    if (!status)
        status = corcast_tree_read(arguments[1], NULL, &tree, error);
    if (!status)
        status = corcast_export_bytes(tree, options, slash + 1, keep, arguments[2], error);
    corcast_tree_free(tree);
    corcast_options_free(options);
    return status;
}

static int write_pixels(const corcast_image *image, const char *path)
{
    int width = 0, height = 0, channels = 0;
    int status = corcast_image_shape(image, CORCAST_COLOR, &width, &height, &channels, error);
    const size_t size = (size_t)width * (size_t)height * (size_t)channels;
    unsigned char *pixels = status ? NULL : malloc(size);
    FILE *file = pixels ? fopen(path, "wb") : NULL;
    if (!status && !file)
        status = 3;
    if (!status)
        status = corcast_image_pixels(image, CORCAST_COLOR, CORCAST_U8, pixels, size, error);
    if (!status && (fprintf(file, "P6\n%d %d\n255\n", width, height) < 0 ||
                    fwrite(pixels, 1, size, file) != size))
        status = 3;
    if (file)
        fclose(file);
    free(pixels);
    return status;
}

static int render(char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    corcast_scene *scene = NULL;
    corcast_image *image = NULL;
    corcast_options *options = options_of("render", arguments + 2, &status);
    if (!status)
        status = corcast_tree_read(arguments[0], NULL, &tree, error);
    if (!status)
        status = corcast_scene_new(tree, options, &scene, error);
    corcast_tree_free(tree);
    corcast_options_free(options);
    if (!status)
        status = corcast_render(scene, &image, NULL, error);
    corcast_scene_free(scene);
    if (!status)
        status = write_pixels(image, arguments[1]);
    corcast_image_free(image);
    return status;
}

static int compare(char **arguments)
{
    int status;
    corcast_image *a = NULL, *b = NULL;
    corcast_report *report = NULL;
    corcast_options *options = options_of("compare", arguments + 2, &status);
    if (!status)
        status = corcast_image_read(arguments[0], &a, error);
    if (!status)
        status = corcast_image_read(arguments[1], &b, error);
    if (!status)
        status = corcast_compare(a, b, options, &report, error);
    fputs(corcast_report_json(report), stdout);
    corcast_report_free(report);
    corcast_image_free(a);
    corcast_image_free(b);
    corcast_options_free(options);
    return status;
}

typedef int Measure(const corcast_tree *tree, const corcast_options *options,
                    corcast_report **report, corcast_error *error);

static int measure(const char *command, Measure *run, char **arguments)
{
    int status;
    corcast_tree *tree = NULL;
    corcast_report *report = NULL;
    corcast_options *options = options_of(command, arguments + 1, &status);
    if (!status)
        status = corcast_tree_read(arguments[0], NULL, &tree, error);
    if (!status)
        status = run(tree, options, &report, error);
    fputs(corcast_report_json(report), stdout);
    corcast_report_free(report);
    corcast_tree_free(tree);
    corcast_options_free(options);
    return status;
}

static int info(char **arguments)
{
    return measure("info", corcast_info, arguments);
}

static int coverage(char **arguments)
{
    return measure("coverage", corcast_coverage, arguments);
}

static const char *output;

/* corcast_pulse or corcast_flow */
static int (*computed)(corcast_tree *tree, const corcast_options *options, corcast_report **report,
                       corcast_error *failure);

static int compute_and_write(const corcast_tree *tree, const corcast_options *options,
                             corcast_report **report, corcast_error *failure)
{
    corcast_tree *copy = NULL;
    int status = corcast_tree_copy(tree, &copy, failure);
    if (!status)
        status = computed(copy, options, report, failure);
    if (!status)
        status = corcast_tree_write(copy, output, failure);
    corcast_tree_free(copy);
    return status;
}

static int pulse(char **arguments)
{
    output = arguments[0];
    computed = corcast_pulse;
    return measure("pulse", compute_and_write, arguments + 1);
}

static int flow(char **arguments)
{
    output = arguments[0];
    computed = corcast_flow;
    return measure("flow", compute_and_write, arguments + 1);
}

static int answer_to_output(const corcast_tree *tree, const corcast_options *options,
                            corcast_report **report, corcast_error *failure)
{
    return corcast_answer(tree, options, output, report, failure);
}

static int answer(char **arguments)
{
    output = arguments[0];
    return measure("answer", answer_to_output, arguments + 1);
}

static char bytes_read[1 << 20];

/* Reads a file into bytes_read. Returns its size; ends the program with 3 if it cannot be read. */
static size_t read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(3);
    }
    const size_t size = fread(bytes_read, 1, sizeof bytes_read, file);
    fclose(file);
    return size;
}

static int convert(char **arguments)
{
    corcast_tree *tree = NULL;
    const size_t size = read_file(arguments[0]);
    int status = corcast_tree_read_bytes(bytes_read, size, arguments[0], NULL, &tree, error);
    if (!status)
        status = corcast_tree_write(tree, arguments[1], error);
    corcast_tree_free(tree);
    return status;
}

static int recode(char **arguments)
{
    corcast_image *image = NULL;
    char *slash = strrchr(arguments[1], '/');
    const size_t size = read_file(arguments[0]);
    int status = corcast_image_read_bytes(bytes_read, size, NULL, &image, error);
    *slash = '\0';
    if (!status)
        status = corcast_image_write_bytes(image, CORCAST_COLOR, CORCAST_U8, slash + 1, keep,
                                           arguments[1], error);
    corcast_image_free(image);
    return status;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        int (*run)(char **arguments);
    } operations[] = {{"grow", grow},          {"refine", refine},   {"export", export_tree},
                      {"bytes", export_bytes}, {"render", render},   {"compare", compare},
                      {"info", info},          {"convert", convert}, {"coverage", coverage},
                      {"pulse", pulse},        {"flow", flow},       {"answer", answer},
                      {"recode", recode}};
    int status = 2;
    error = corcast_error_new();
    for (size_t i = 0; argc > 1 && i < sizeof operations / sizeof *operations; i++)
        if (strcmp(argv[1], operations[i].name) == 0)
            status = operations[i].run(argv + 2);
    if (status > 1)
        fprintf(stderr, "session: %s\n", error ? corcast_error_text(error) : "out of memory");
    corcast_error_free(error);
    return status;
}
