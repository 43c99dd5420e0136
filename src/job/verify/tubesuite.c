/* Runs the operation `suite`: lets a renderer draw the scenes of the tube suite, and grades the
 * pictures by answers, which are proven bounds of the colors. The scenes are sections of
 * templates/suite/scenes.ini. Each is set up as `answer` sets up its scene, so that file, answer
 * and picture show the same numbers. All pictures have one sample, at the center of the pixel: any
 * renderer can draw them. */
#include "job/verify/tubesuite.h"

#include "emit/emit.h"
#include "job/verify/answer.h"
#include "options/output.h"
#include "options/templates.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The names of formats, which are also the extensions of scenes. */
static const char *const formats[] = {"pov", "tachyon", "json", "swc", NULL};

static const Option own[] = {
    {.name = "format",
     SETS(CHOICE, TubeSuiteOptions, format),
     .choices = formats,
     .help = "format of the scenes: pov, tachyon, json (for any renderer), or swc (a tree, with "
             "options of `corcast render`)"},
    {.name = "title",
     SETS(TEXT, TubeSuiteOptions, title),
     .argument = "TEXT",
     .otherwise = "the command",
     .help = "name of the renderer on the score card"},
    {.name = "levels",
     SETS(NUMBER, TubeSuiteOptions, levels),
     FROM_TO(0, 255),
     .help = "distance from its interval up to which a pixel counts as right, in levels of "
             "1/255; 0.5 accepts renderers that truncate decimals instead of rounding"},
    {.name = "output",
     SETS(FOLDER, TubeSuiteOptions, renderer.folder),
     .argument = "DIR",
     .help = "folder to write to: the scenes, the pictures, suite.json and index.html"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* A scene of 64 x 64 pixels that takes more than a minute counts as not drawn. Reasons of the
 * numbers not recorded; more jobs at a time finish earlier on a machine with more processors. */
static void set_defaults(void *options)
{
    TubeSuiteOptions *suite = options;
    suite->renderer.shell = (ShellRenderer){.timeout_s = 60, .jobs = 8};
}

static void release_case(TubeCase *one)
{
    free(one->name);
    free(one->group);
    free(one->look);
    free(one->options);
    free(one->tree);
    if (one->drawing)
        drawing_release(one->drawing);
}

void tubesuite_release(TubeSuite *suite)
{
    for (size_t i = 0; i < suite->cases.n; i++)
        release_case(&suite->cases.items[i]);
    free(suite->drawings);
    ARRAY_RELEASE(&suite->cases);
}

/* ---- the scenes ------------------------------------------------------------------------------ */

/* Takes a line of scenes.ini. The line [NAME] begins a scene. The rows of a tree are separated by
 * slashes. */
static Status take_line(void *user, const char *section, const char *name, const char *value,
                        Err *err)
{
    TubeSuite *suite = user;
    if (!name) {
        TRY(ARRAY_PUSH(&suite->cases, "scenes", err, (TubeCase){.rows = 1}));
        return mem_strdup(&suite->cases.items[suite->cases.n - 1].name, section, err);
    }
    TubeCase *one = &suite->cases.items[suite->cases.n - 1];
    char **member = strcmp(name, "group") == 0     ? &one->group
                    : strcmp(name, "look") == 0    ? &one->look
                    : strcmp(name, "options") == 0 ? &one->options
                    : strcmp(name, "tree") == 0    ? &one->tree
                                                   : NULL;
    if (!member || *member)
        return err_set(err, STATUS_INPUT, "'%s' is not a name, or occurs twice", name);
    for (const char *at = value; member == &one->tree && *at; at++)
        one->rows += *at == '/';
    return mem_strdup(member, value, err);
}

/* Reads the scenes. Leaves out the last group, implicit surfaces, if the format has no such shapes.
 */
static Status read_suite(const TubeSuiteOptions *options, TubeSuite *suite, Err *err)
{
    char *path = NULL;
    const bool has_surfaces = options->format == SUITE_POV || options->format == SUITE_SWC;
    TRY(templates_path("suite/scenes.ini", &path, err));
    Status status = ini_read(path, "a suite of scenes", take_line, suite, NULL, err);
    free(path);
    TRY(status);
    while (!has_surfaces && strcmp(suite->cases.items[suite->cases.n - 1].group, "surface") == 0)
        release_case(&suite->cases.items[--suite->cases.n]);
    return STATUS_OK;
}

/* Writes the tree of a scene as SWC. */
static Status write_tree(const TubeCase *one, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    for (const char *at = one->tree; *at; at++)
        text_append(&text, *at == '/' ? "\n" : at, 1);
    text_puts(&text, "\n");
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}

/* Sets the options of a scene, "name=value name=value ...", and appends them to `camera` as a
 * command line has them. */
static Status set_options(const TubeCase *one, Parsed *answer, Text *camera, Err *err)
{
    char *copy = NULL;
    Status status;
    TRY_GOTO(mem_strdup(&copy, one->options, err));
    for (char *rest = copy, *word; (word = strtok_r(rest, " ", &rest));) {
        char *value = strchr(word, '=');
        if (!value)
            TRY_GOTO(err_set(err, STATUS_INPUT, "%s: option '%s' has no value", one->name, word));
        *value++ = '\0';
        TRY_GOTO(options_set(answer, word, value, err));
        text_printf(camera, " --%s %s", word, value);
    }
done:
    free(copy);
    return status;
}

/* Prepares the options of `answer` for a scene. */
static Status prepare_answer(const TubeCase *one, const char *tree, const char *look,
                             Parsed *answer, Text *camera, Err *err)
{
    char size[32];
    snprintf(size, sizeof size, "%dx%d", SUITE_PIXELS, SUITE_PIXELS);
    answer->in_memory = true;
    answer->operands[answer->n_operands++] = tree;
    TRY(options_set(answer, "size", size, err));
    TRY(options_set(answer, "look", look, err));
    text_printf(camera, "--size %s --antialias 1 --look ", size);
    text_put_shell_word(camera, look);
    TRY(set_options(one, answer, camera, err));
    TRY(text_check(camera, err));
    return options_finish(answer, err);
}

/* ---- answers and drawings -------------------------------------------------------------------- */

/* Writes a scene in the format of the renderer. A tree is already written. */
static Status write_scene(const TubeSuiteOptions *options, const PictureOptions *picture,
                          const Scene *scene, const char *path, Err *err)
{
    char *templates = NULL;
    Text text = TEXT_INIT;
    EmitReport report = {0};
    EmitOutput to = {.file = &text, .report = &report};
    Status status;
    if (options->format == SUITE_SWC)
        return STATUS_OK;
    if (options->format == SUITE_JSON)
        return json_write(answer_scene_json(scene, picture->stage.shadows), path, err);
    TRY_GOTO(templates_folder(&templates, err));
    const EmitParams params = {.scene = scene,
                               .command = "corcast suite",
                               .file = file_name(path),
                               .shadows = picture->stage.shadows,
                               .cells = picture_cells(picture),
                               .templates = templates,
                               .description = "a scene of the tube suite",
                               .generator = GENERATOR};
    TRY_GOTO(emit_write(emitter_find(formats[options->format], false), &params, &to, err));
    status = file_write_text(path, &text, err);
done:
    text_release(&text);
    free(templates);
    return status;
}

/* Copies the intervals of an answer into the form that is graded. */
static Status take_answer(const Answer *answer, AnswerFile *file, Err *err)
{
    const int width = answer->plane.width, height = answer->plane.height;
    TRY(plane_init(&file->low, width, height, 3, err));
    TRY(plane_init(&file->high, width, height, 3, err));
    TRY(plane_init(&file->state, width, height, 1, err));
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        const float *values = answer->plane.values + i * ANSWER_CHANNELS;
        memcpy(file->low.values + 3 * i, values + ANSWER_LOW, 3 * sizeof(float));
        memcpy(file->high.values + 3 * i, values + ANSWER_HIGH, 3 * sizeof(float));
        file->state.values[i] = values[ANSWER_STATE];
    }
    return STATUS_OK;
}

/* Names the files of a scene, and writes its tree. *tree receives the path of the tree. */
static Status open_case(const TubeSuiteOptions *options, const char *scenes, TubeCase *one,
                        char **tree, Err *err)
{
    TRY(drawing_name(one->drawing, scenes, one->name, formats[options->format],
                     options->format == SUITE_TACHYON ? "ppm" : "png", err));
    TRY(file_with_suffix(one->drawing->scene, ".swc", tree, err));
    return write_tree(one, *tree, err);
}

/* Makes the answer of a scene, writes the scene, and forms the command that draws it. */
static Status prepare(const TubeSuiteOptions *options, const char *scenes, TubeCase *one,
                      AnswerFile *file, Err *err)
{
    Parsed parsed = {0};
    Text camera = TEXT_INIT, command = TEXT_INIT;
    Scene scene = {0};
    Answer answer = {0};
    PictureReport report;
    char look[80], *look_path = NULL, *tree = NULL;
    ShellDrawing *drawing = one->drawing;
    Status status;
    snprintf(look, sizeof look, "suite/%.60s.ini", one->look);
    TRY_GOTO(open_case(options, scenes, one, &tree, err));
    TRY_GOTO(templates_path(look, &look_path, err));
    TRY_GOTO(parsed_init(&parsed, &command_answer, err));
    TRY_GOTO(prepare_answer(one, tree, look_path, &parsed, &camera, err));
    const AnswerOptions *answered = parsed.options;
    const AnswerParams params = {
        .pattern = 1, .width = 1.0 / 510, .shadows = answered->picture.stage.shadows};
    TRY_GOTO(picture_scene(&answered->picture, &parsed, &scene, &report, err));
    TRY_GOTO(answer_make(&scene, &params, &answer, err));
    TRY_GOTO(take_answer(&answer, file, err));
    TRY_GOTO(write_scene(options, &answered->picture, &scene, drawing->scene, err));
    const DrawingMarks marks = {.scene = drawing->scene,
                                .picture = drawing->picture,
                                .camera = text_chars(&camera),
                                .width = SUITE_PIXELS,
                                .height = SUITE_PIXELS,
                                .needs_camera = options->format == SUITE_SWC};
    drawing_command(options->renderer.shell.command, &marks, &command);
    status = text_take(&command, &drawing->command, err);
done:
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", one->name);
    answer_release(&answer);
    scene_release(&scene);
    parsed_release(&parsed);
    text_release(&camera);
    text_release(&command);
    free(look_path);
    free(tree);
    return status;
}

static Status write_pictures(const TubeSuiteOptions *options, const TubeCase *one,
                             const Image *image, const Plane *distances, Err *err)
{
    Picture far = {0}, shown = {0};
    const char *folder = options->renderer.folder;
    char *path = NULL, *distance_path = NULL;
    Status status;
    TRY_GOTO(mem_printf(&path, err, "%s/%s.png", folder, one->name));
    TRY_GOTO(mem_printf(&distance_path, err, "%s/%s.distance.png", folder, one->name));
    TRY_GOTO(answergrade_picture(distances, &far, err));
    TRY_GOTO(image->plane.values ? picture_from_plane(&shown, &image->plane, ENCODING_SRGB, 8, err)
                                 : picture_to_srgb(&shown, &image->picture, 8, err));
    TRY_GOTO(picture_write(&shown, path, ENCODING_SRGB, NULL, NULL, err));
    status = picture_write(&far, distance_path, ENCODING_SRGB, NULL, NULL, err);
done:
    picture_release(&far);
    picture_release(&shown);
    free(path);
    free(distance_path);
    return status;
}

/* Counts the pixels that are farther from their intervals than `levels`, and than the rounding of
 * colors [compare/grade/grade.h]. */
static size_t count_wrong(const Plane *distances, double levels)
{
    size_t wrong = 0;
    const double slack = levels > ANSWERGRADE_SLACK ? levels : ANSWERGRADE_SLACK;
    for (size_t i = 0; i < (size_t)distances->width * (size_t)distances->height; i++)
        wrong += fabs((double)distances->values[i]) > slack;
    return wrong;
}

/* Grades the picture of a scene. A picture of another size counts as not drawn. A picture is
 * certified if no pixel is wrong and at least one is decided. */
static Status grade(const TubeSuiteOptions *options, const AnswerFile *answer, TubeCase *one,
                    Err *err)
{
    Image image;
    Plane distances = {0};
    Err why = {""};
    Status status = STATUS_OK;
    TRY(drawing_read(one->drawing, &image, err));
    if (!one->drawing->is_drawn)
        return STATUS_OK;
    if (options->format == SUITE_TACHYON && image.picture.bits)
        image.picture.gamma = 1; /* Tachyon writes linear codes */
    status = answergrade_image(answer, &image, &one->grade, &distances, &why);
    if (status == STATUS_OK) {
        one->wrong = count_wrong(&distances, options->levels);
        one->certified = one->wrong == 0 && one->grade.undecided < one->grade.pixels;
        status = write_pictures(options, one, &image, &distances, err);
    } else {
        status = drawing_refuse(one->drawing, status, &why, err);
    }
    image_release(&image);
    plane_release(&distances);
    return status;
}

/* ---- the operation --------------------------------------------------------------------------- */

static Status write_card(const TubeSuite *suite, Err *err)
{
    char *json = NULL, *html = NULL;
    Text page = TEXT_INIT;
    Status status;
    TRY_GOTO(file_join(suite->options->renderer.folder, "suite.json", &json, err));
    TRY_GOTO(file_join(suite->options->renderer.folder, "index.html", &html, err));
    TRY_GOTO(json_write(tubesuite_json(suite), json, err));
    tubesuite_page(suite, &page);
    status = file_write_text(html, &page, err);
done:
    free(json);
    free(html);
    text_release(&page);
    return status;
}

/* Draws all scenes. `scenes` is the absolute path of their folder. */
static Status run_cases(const TubeSuiteOptions *options, const char *scenes, TubeSuite *suite,
                        Err *err)
{
    const size_t n = suite->cases.n;
    TubeCase *cases = suite->cases.items;
    AnswerFile *answers = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&answers, n, sizeof *answers, "answers", err));
    TRY_GOTO(mem_calloc(&suite->drawings, n, sizeof *suite->drawings, "drawings", err));
    for (size_t i = 0; i < n; i++) {
        cases[i].drawing = &suite->drawings[i];
        TRY_GOTO(prepare(options, scenes, &cases[i], &answers[i], err));
    }
    TRY_GOTO(drawings_run(&options->renderer.shell, suite->drawings, n, err));
    for (size_t i = 0; i < n; i++) {
        TRY_GOTO(grade(options, &answers[i], &cases[i], err));
        suite->drawn += cases[i].drawing->is_drawn;
        suite->certified += cases[i].certified;
    }
    if (suite->drawn > 0)
        status = write_card(suite, err);
    else
        status = err_set(err, STATUS_TOOL, "--render: the renderer drew none of %zu scenes: %s", n,
                         cases[0].drawing->reason);
done:
    for (size_t i = 0; answers && i < n; i++)
        answerfile_release(&answers[i]);
    free(answers);
    return status;
}

Status tubesuite_run(const TubeSuiteOptions *options, TubeSuite *suite, Err *err)
{
    char *folder = NULL, *scenes = NULL;
    Status status;
    suite->options = options;
    TRY_GOTO(renderer_open_folder(&options->renderer, "the score card", &folder, err));
    TRY_GOTO(read_suite(options, suite, err));
    TRY_GOTO(file_join(folder, "scenes", &scenes, err));
    TRY_GOTO(file_make_folder(scenes, err));
    status = run_cases(options, scenes, suite, err);
done:
    free(folder);
    free(scenes);
    return status;
}

const Command command_suite = {
    .name = "suite",
    .summary = "grade a renderer by scenes whose pixels have proven answers",
    .operands = "--render COMMAND -o DIR",
    .examples =
        "  corcast suite --render 'povray +I{scene} +O{picture} +W{width} +H{height} -D' -o card\n"
        "  corcast suite --format tachyon --render 'tachyon {scene} -shade_phong -format PPM -o "
        "{picture}' -o card\n"
        "  corcast suite --format swc --render 'corcast render {scene} {camera} --exact -o "
        "{picture} --quiet' -o card\n"
        "\nThe command writes 72 scenes of cylinders and spheres and, as pov and swc, 12 of "
        "implicit\n"
        "surfaces. It lets the renderer draw them with one sample at the center of each pixel, "
        "and\n"
        "compares each pixel with the interval that is proven to contain its color. A picture is\n"
        "certified if no pixel is outside its interval. DIR/index.html is the score card. The "
        "exit\n"
        "status is 1 if a picture is not certified.\n",
    .max_operands = 0,
    .size = sizeof(TubeSuiteOptions),
    .set_defaults = set_defaults,
    .tables = {{&renderer_options, offsetof(TubeSuiteOptions, renderer)}, {&own_table, 0}},
};
