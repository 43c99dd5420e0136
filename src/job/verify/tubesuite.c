/* The scenes are sections of templates/suite/scenes.ini. Each is set up as `answer` sets up its
 * scene, so that file, answer and picture show the same numbers. All pictures have one sample, at
 * the center of the pixel: any renderer can draw them. */
#include "job/verify/tubesuite.h"

#include "emit/emit.h"
#include "job/verify/answer.h"
#include "options/output.h"
#include "options/templates.h"
#include "oracle/shell.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const formats[] = {"pov", "tachyon", "json", "swc", NULL};

static const Option own[] = {
    {.name = "render",
     SETS(TEXT, TubeSuiteOptions, render),
     .argument = "COMMAND",
     .help = "shell command that renders the file {scene} into the image file {picture} of "
             "{width} x {height} pixels, with one sample at the center of each pixel; if "
             "the command lacks {scene}, the scene and the picture are added at its end; {camera}, "
             "only with --format swc, stands for options of `corcast render`"},
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
     .help = "distance from the interval up to which a pixel counts as right, in levels of 1/255; "
             "0.5 accepts renderers that cut decimals instead of rounding"},
    {.name = "timeout",
     SETS(NUMBER, TubeSuiteOptions, timeout_s),
     FROM_TO(0.1, 1e5),
     .unit = "s",
     .help = "a rendering that takes longer is ended"},
    {.name = "jobs",
     SETS(WHOLE, TubeSuiteOptions, jobs),
     FROM_TO(1, 32),
     .aside = true,
     .argument = "N",
     .help = "renderings that run at the same time"},
    {.name = "output",
     SETS(FOLDER, TubeSuiteOptions, folder),
     .argument = "DIR",
     .help = "folder for the scenes, the pictures, suite.json and index.html"},
    {.name = "json",
     SETS(FLAG, TubeSuiteOptions, json),
     .help = "print the score card as JSON on standard output"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    TubeSuiteOptions *suite = options;
    suite->timeout_s = 60;
    suite->jobs = 8;
}

void tubesuite_release(TubeSuite *suite)
{
    for (size_t i = 0; i < suite->cases.n; i++) {
        TubeCase *one = &suite->cases.items[i];
        free(one->name);
        free(one->group);
        free(one->look);
        free(one->options);
        free(one->tree);
    }
    ARRAY_RELEASE(&suite->cases);
}

/* ---- the scenes ------------------------------------------------------------------------------ */

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
        return err_set(err, STATUS_INPUT, "'%s' is not a name, or is there twice", name);
    for (const char *at = value; member == &one->tree && *at; at++)
        one->rows += *at == '/';
    return mem_strdup(member, value, err);
}

static Status read_suite(TubeSuite *suite, Err *err)
{
    char *path = NULL;
    TRY(templates_path("suite/scenes.ini", &path, err));
    Status status = ini_read(path, "a suite of scenes", take_line, suite, NULL, err);
    free(path);
    return status;
}

/* The folder of the scenes, and the files of one scene. All are owned. */
typedef struct SuiteFiles {
    char *tree, *look, *scene, *picture, *log;
    char *camera;  /* options of `render` */
    char *command; /* draws the scene */
} SuiteFiles;

static void files_free(SuiteFiles *files)
{
    free(files->tree);
    free(files->look);
    free(files->scene);
    free(files->picture);
    free(files->log);
    free(files->camera);
    free(files->command);
}

static Status name_file(const char *folder, const char *name, const char *suffix, char **path,
                        Err *err)
{
    Text file = TEXT_INIT;
    text_printf(&file, "%s%s", name, suffix);
    Status status = text_check(&file, err);
    if (status == STATUS_OK)
        status = file_join(folder, text_chars(&file), path, err);
    text_release(&file);
    return status;
}

static Status name_files(const TubeSuiteOptions *options, const char *scenes, const TubeCase *one,
                         SuiteFiles *files, Err *err)
{
    static const char *const suffixes[SUITE_FORMATS] = {".pov", ".tachyon", ".json", ".swc"};
    char look[80];
    snprintf(look, sizeof look, "suite/%.60s.ini", one->look);
    TRY(name_file(scenes, one->name, ".swc", &files->tree, err));
    TRY(name_file(scenes, one->name, suffixes[options->format], &files->scene, err));
    TRY(name_file(scenes, one->name, options->format == SUITE_TACHYON ? ".ppm" : ".png",
                  &files->picture, err));
    TRY(name_file(scenes, one->name, ".log", &files->log, err));
    return templates_path(look, &files->look, err);
}

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
static Status prepare_answer(const TubeCase *one, const SuiteFiles *files, Parsed *answer,
                             Text *camera, Err *err)
{
    char size[32];
    snprintf(size, sizeof size, "%dx%d", SUITE_PIXELS, SUITE_PIXELS);
    answer->in_memory = true;
    answer->operands[answer->n_operands++] = files->tree;
    TRY(options_set(answer, "size", size, err));
    TRY(options_set(answer, "look", files->look, err));
    text_printf(camera, "--size %s --antialias 1 --look ", size);
    text_put_shell_word(camera, files->look);
    TRY(set_options(one, answer, camera, err));
    TRY(text_check(camera, err));
    return options_finish(answer, err);
}

/* ---- answers and drawings -------------------------------------------------------------------- */

static Status write_scene(const TubeSuiteOptions *options, const PictureOptions *picture,
                          const Scene *scene, const SuiteFiles *files, Err *err)
{
    char *templates = NULL;
    Text text = TEXT_INIT;
    EmitReport report = {0};
    EmitOutput to = {.file = &text, .report = &report};
    Status status;
    if (options->format == SUITE_SWC)
        return STATUS_OK;
    if (options->format == SUITE_JSON)
        return json_write(answer_scene_json(scene, picture->stage.shadows), files->scene, err);
    TRY_GOTO(templates_folder(&templates, err));
    const EmitParams params = {.scene = scene,
                               .command = "corcast suite",
                               .file = file_name(files->scene),
                               .shadows = picture->stage.shadows,
                               .cells = picture_cells(picture),
                               .templates = templates,
                               .description = "a scene of the tube suite",
                               .generator = GENERATOR};
    TRY_GOTO(emit_write(emitter_find(formats[options->format], false), &params, &to, err));
    status = file_write_text(files->scene, &text, err);
done:
    text_release(&text);
    free(templates);
    return status;
}

/* Takes the intervals of an answer for grading. */
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

/* Makes the answer of a scene, writes the scene, and forms the command that draws it. */
static Status prepare(const TubeSuiteOptions *options, const TubeCase *one, SuiteFiles *files,
                      AnswerFile *file, Err *err)
{
    Parsed parsed = {0};
    Text camera = TEXT_INIT, command = TEXT_INIT;
    Scene scene = {0};
    Answer answer = {0};
    PictureReport report;
    Status status;
    TRY_GOTO(write_tree(one, files->tree, err));
    TRY_GOTO(parsed_init(&parsed, &command_answer, err));
    TRY_GOTO(prepare_answer(one, files, &parsed, &camera, err));
    const AnswerOptions *answered = parsed.options;
    const AnswerParams params = {
        .pattern = 1, .width = 1.0 / 510, .shadows = answered->picture.stage.shadows};
    TRY_GOTO(picture_scene(&answered->picture, &parsed, &scene, &report, err));
    TRY_GOTO(answer_make(&scene, &params, &answer, err));
    TRY_GOTO(take_answer(&answer, file, err));
    TRY_GOTO(write_scene(options, &answered->picture, &scene, files, err));
    const ShellMark marks[] = {{"{scene}", files->scene, false},
                               {"{picture}", files->picture, false},
                               {"{camera}", text_chars(&camera), true},
                               {"{width}", "64", true},
                               {"{height}", "64", true}};
    shell_fill(options->render, marks, 5, options->format == SUITE_SWC ? 3 : 2, &command);
    status = text_take(&command, &files->command, err);
done:
    if (status != STATUS_OK)
        err_prefix(err, "%s: ", one->name);
    answer_release(&answer);
    scene_release(&scene);
    parsed_release(&parsed);
    text_release(&camera);
    text_release(&command);
    return status;
}

static Status write_pictures(const TubeSuiteOptions *options, const TubeCase *one,
                             const Image *image, const Plane *distances, Err *err)
{
    Picture far = {0}, shown = {0};
    char *path = NULL, *distance_path = NULL;
    Status status;
    TRY_GOTO(name_file(options->folder, one->name, ".png", &path, err));
    TRY_GOTO(name_file(options->folder, one->name, ".distance.png", &distance_path, err));
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

/* Counts the pixels that are farther from their intervals than `levels`. */
static size_t count_wrong(const Plane *distances, double levels)
{
    size_t wrong = 0;
    const double slack = levels > ANSWERGRADE_SLACK ? levels : ANSWERGRADE_SLACK;
    for (size_t i = 0; i < (size_t)distances->width * (size_t)distances->height; i++)
        wrong += fabs((double)distances->values[i]) > slack;
    return wrong;
}

/* Grades the picture of a scene. A picture that cannot be read, or of another size, is not drawn.
 */
static Status grade(const TubeSuiteOptions *options, const SuiteFiles *files, const ShellEnd *end,
                    const AnswerFile *answer, TubeCase *one, Err *err)
{
    static const float black[3] = {0, 0, 0};
    Image image = {0};
    Plane distances = {0};
    Err why;
    snprintf(why.text, sizeof why.text, "exit status %d, see %s", end->exit_status, files->log);
    Status status = STATUS_TOOL;
    if (!end->timed_out && end->exit_status == 0)
        status = access(files->picture, F_OK) == 0
                     ? image_read(&image, files->picture, ALPHA_KEPT, NULL, &why)
                     : err_set(&why, STATUS_TOOL, "the command wrote no picture");
    if (status == STATUS_OK)
        status = image_composite(&image, black, &why);
    if (status == STATUS_OK && options->format == SUITE_TACHYON && image.picture.bits)
        image.picture.gamma = 1; /* Tachyon writes linear codes */
    if (status == STATUS_OK)
        status = answergrade_image(answer, &image, &one->grade, &distances, &why);
    one->drawn = status == STATUS_OK;
    one->wrong = one->drawn ? count_wrong(&distances, options->levels) : 0;
    one->certified = one->drawn && one->wrong == 0 && one->grade.undecided < one->grade.pixels;
    snprintf(one->reason, sizeof one->reason, "%.390s", one->drawn ? "" : why.text);
    if (one->drawn)
        status = write_pictures(options, one, &image, &distances, err);
    else
        status = status == STATUS_MEMORY ? err_set(err, status, "%s", why.text) : STATUS_OK;
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
    TRY_GOTO(file_join(suite->options->folder, "suite.json", &json, err));
    TRY_GOTO(file_join(suite->options->folder, "index.html", &html, err));
    TRY_GOTO(json_write(tubesuite_json(suite), json, err));
    tubesuite_page(suite, &page);
    status = file_write_text(html, &page, err);
done:
    free(json);
    free(html);
    text_release(&page);
    return status;
}

/* What belongs to each scene while it is drawn. */
typedef struct SuiteRun {
    char *scenes; /* absolute path of the folder of the scenes; owned */
    SuiteFiles *files;
    AnswerFile *answers;
    ShellCommand *commands;
} SuiteRun;

static void run_release(SuiteRun *run, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (run->files)
            files_free(&run->files[i]);
        if (run->answers)
            answerfile_release(&run->answers[i]);
    }
    free(run->scenes);
    free(run->files);
    free(run->answers);
    free(run->commands);
}

static Status open_run(const TubeSuiteOptions *options, size_t n, SuiteRun *run, Err *err)
{
    char *path = NULL;
    TRY(file_join(options->folder, "scenes", &path, err));
    Status status = file_make_folder(path, err);
    run->scenes = status == STATUS_OK ? realpath(path, NULL) : NULL;
    free(path);
    TRY(status);
    TRY(mem_calloc(&run->files, n, sizeof *run->files, "files", err));
    TRY(mem_calloc(&run->answers, n, sizeof *run->answers, "answers", err));
    TRY(mem_calloc(&run->commands, n, sizeof *run->commands, "commands", err));
    return run->scenes ? STATUS_OK
                       : err_set(err, STATUS_IO, "%s: the folder is gone", options->folder);
}

static Status run_cases(const TubeSuiteOptions *options, TubeSuite *suite, SuiteRun *run, Err *err)
{
    const size_t n = suite->cases.n;
    TubeCase *cases = suite->cases.items;
    for (size_t i = 0; i < n; i++) {
        TRY(name_files(options, run->scenes, &cases[i], &run->files[i], err));
        TRY(prepare(options, &cases[i], &run->files[i], &run->answers[i], err));
        remove(run->files[i].picture);
        run->commands[i] =
            (ShellCommand){.command = run->files[i].command, .log = run->files[i].log};
    }
    TRY(shell_run_all(run->commands, n, options->jobs, options->timeout_s, err));
    for (size_t i = 0; i < n; i++) {
        TRY(grade(options, &run->files[i], &run->commands[i].end, &run->answers[i], &cases[i],
                  err));
        suite->drawn += cases[i].drawn;
        suite->certified += cases[i].certified;
    }
    if (suite->drawn > 0)
        return write_card(suite, err);
    return err_set(err, STATUS_TOOL, "--render: the renderer drew none of %zu scenes: %s", n,
                   cases[0].reason);
}

Status tubesuite_run(const TubeSuiteOptions *options, Parsed *parsed, TubeSuite *suite, Err *err)
{
    SuiteRun run = {0};
    (void)parsed;
    if (!options->render || !*options->render)
        return err_set(err, STATUS_USAGE,
                       "--render needs a command, such as --render 'povray +I{scene} +O{picture} "
                       "+W{width} +H{height} -D'");
    if (!options->folder)
        return err_set(err, STATUS_USAGE,
                       "-o DIR, the folder that receives the score card, is missing");
    suite->options = options;
    TRY(read_suite(suite, err));
    Status status = open_run(options, suite->cases.n, &run, err);
    if (status == STATUS_OK)
        status = run_cases(options, suite, &run, err);
    run_release(&run, suite->cases.n);
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
        "\nThe command writes 72 scenes of cylinders and spheres, lets the renderer draw them, and "
        "compares\neach pixel with the interval that is proven to contain its color. "
        "DIR/index.html "
        "is the score\ncard. The exit status is 1 if a picture is not certified.\n",
    .max_operands = 0,
    .size = sizeof(TubeSuiteOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
};
