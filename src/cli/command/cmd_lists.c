/* Prints the values of an option: the commands models, fields, looks and others. A line has a name,
 * a tab and a description, so that scripts can cut the name off. Some lists have more columns
 * between the name and the description. */
#include "cli/commands.h"
#include "derive/derive.h"
#include "domain/domain.h"
#include "job/picture/picture.h"
#include "job/picture/preset.h"
#include "options/options.h"
#include "options/templates.h"
#include "pulse/pulse.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void list_fields(Text *lines)
{
    for (size_t i = 0; derive_field_name(i); i++)
        text_printf(lines, "%s\t%s\t%s\n", derive_field_name(i),
                    *derive_field_unit(i) ? derive_field_unit(i) : "-",
                    derive_field_description(i));
}

static void list_domains(Text *lines)
{
    const DomainShape *shape;
    for (size_t i = 0; (shape = domain_shape(i)); i++)
        text_printf(lines, "%s:%s\t%s\n", shape->name, shape->parameters, shape->description);
}

static void list_formats(Text *lines)
{
    TreeFormat format;
    for (size_t i = 0; tree_format_at(i, &format); i++)
        text_printf(lines, ".%s\t%s\t%s\n", format.extension, format.name, format.description);
}

/* Appends the name of a look, whether POV-Ray can reproduce it, and what it looks like. */
static Status describe_look(const char *name, Text *lines, Err *err)
{
    char *path = NULL;
    Look look;
    Text names = TEXT_INIT;
    TRY(template_file("look", "looks", name, ".ini", &path, err));
    Status status = look_read(&look, path, err);
    free(path);
    TRY(status);
    Effects effects = look_effects(&look, 1, 1);
    effects.grade.present = false;
    effects_list(&effects, look.options.occlusion > 0, &names);
    text_printf(lines, "%s\t", name);
    if (effects.xray.per_mm > 0)
        text_puts(lines, "not in POV-Ray");
    else
        text_puts(lines, names.length ? "in POV-Ray without " : "also in POV-Ray");
    if (!(effects.xray.per_mm > 0))
        text_add(lines, &names);
    text_printf(lines, "\t%s\n", look.about);
    text_release(&names);
    return text_check(lines, err);
}

static Status describe_preset(const char *name, Text *lines, Err *err)
{
    Preset preset;
    TRY(preset_read(name, &preset, err));
    text_printf(lines, "%s\t%s\n", name, preset.about);
    preset_release(&preset);
    return text_check(lines, err);
}

/* Appends the name of a published data set and the first clause of the comment in its file. */
static Status describe_morphometry(const char *name, Text *lines, Err *err)
{
    static const FileForm form = {.name = "a published table", .most_bytes = 1e6, .is_text = true};
    char *path = NULL, *text = NULL;
    size_t size;
    TRY(template_file("morphometry", "morphometry", name, ".txt", &path, err));
    Status status = file_read(path, &form, &text, &size, err);
    free(path);
    TRY(status);
    const char *head = text + strspn(text, "# ");
    text_printf(lines, "%s\t%.*s\n", name, (int)strcspn(head, ":\n"), head);
    free(text);
    return text_check(lines, err);
}

static Status describe_waveform(const char *name, Text *lines, Err *err)
{
    char *path = NULL;
    Waveform waveform;
    TRY(template_file("drive", "waveforms", name, ".ini", &path, err));
    Status status = waveform_read_template(path, &waveform, err);
    free(path);
    TRY(status);
    text_printf(lines, "%s\t%s\t%g s\t%s [%s]\n", name, waveform.is_flow ? "flow" : "pressure",
                waveform.period_s, waveform.about, waveform.source);
    return text_check(lines, err);
}

static void list_walls(Text *lines)
{
    for (size_t i = 0; pulse_wall_name(i); i++)
        text_printf(lines, "%s\t%s\n", pulse_wall_name(i), pulse_wall_description(i));
}

/* A list command: either appends all lines, or describes one file of a folder of the templates. */
typedef struct NameList {
    const Command *command;
    void (*list)(Text *lines);      /* NULL: the names are those of files */
    const char *folder, *extension; /* of the files */
    Status (*describe)(const char *name, Text *lines, Err *err);
} NameList;

static const NameList name_lists[] = {
    {&command_fields, list_fields, NULL, NULL, NULL},
    {&command_domains, list_domains, NULL, NULL, NULL},
    {&command_formats, list_formats, NULL, NULL, NULL},
    {&command_walls, list_walls, NULL, NULL, NULL},
    {&command_looks, NULL, "looks", ".ini", describe_look},
    {&command_presets, NULL, "presets", ".ini", describe_preset},
    {&command_morphometries, NULL, "morphometry", ".txt", describe_morphometry},
    {&command_waveforms, NULL, "waveforms", ".ini", describe_waveform},
};

/* Describes each file of a list, in alphabetical order. */
static Status list_templates(const NameList *list, Text *lines, Err *err)
{
    Text names = TEXT_INIT;
    Status status = template_names(list->folder, list->extension, &names, err);
    char *rest = NULL, *all = NULL;
    if (status == STATUS_OK)
        status = mem_strdup(&all, text_chars(&names), err);
    for (char *name = all ? strtok_r(all, "\n", &rest) : NULL; name && status == STATUS_OK;
         name = strtok_r(NULL, "\n", &rest))
        status = list->describe(name, lines, err);
    free(all);
    text_release(&names);
    return status;
}

/* The values of `models --of`, and the elements that models of each kind are made of. */
typedef enum ModelKind { MODELS_OF_ANYTHING, MODELS_OF_PRIMITIVES, MODELS_OF_A_FIELD } ModelKind;
static const char *const model_kinds[] = {"anything", "primitives", "field", NULL};
static const unsigned kind_elements[] = {~0U, MODEL_PRIMITIVES, MODEL_FIELD};

typedef struct ModelsOptions {
    ModelKind of;
} ModelsOptions;

static const Option models_own[] = {
    {.name = "of",
     SETS(CHOICE, ModelsOptions, of),
     .choices = model_kinds,
     .help = "models to list: anything (all models), primitives (models made of cylinders, "
             "spheres and joints), field (models that are a surface of a potential, such as "
             "isosurface)"},
};

static const OptionTable models_table = OPTION_TABLE(models_own);

Status run_models(void *options, Parsed *parsed, Err *err)
{
    (void)parsed;
    (void)err;
    const ModelsOptions *own = options;
    for (int i = 0; i < SCENE_MODELS; i++)
        if (model_is_of((SceneModel)i, kind_elements[own->of]))
            printf("%s\t%s\n", models[i].name, models[i].description);
    return STATUS_OK;
}

Status run_list(void *options, Parsed *parsed, Err *err)
{
    (void)options;
    const NameList *list = name_lists;
    Text lines = TEXT_INIT;
    Status status = STATUS_OK;
    while (list->command != parsed->command)
        list++;
    if (list->list)
        list->list(&lines);
    else
        status = list_templates(list, &lines, err);
    return command_print(status, &lines, err);
}

const Command command_models = {.name = "models",
                                .summary = "list the vessel geometries, the values of --model",
                                .operands = "",
                                .size = sizeof(ModelsOptions),
                                .tables = {{&models_table, 0}}};
const Command command_fields = {
    .name = "fields",
    .summary = "list the quantities that --color-by can show, with their units",
    .operands = "",
    .examples = "  corcast fields   # each line: name, unit (- for none), meaning\n"};
const Command command_looks = {
    .name = "looks",
    .summary = "list the looks (colors, finish and lights), the values of --look",
    .operands = "",
    .examples = "  corcast looks   # each line: name, whether POV-Ray can draw it, appearance\n"};
const Command command_presets = {.name = "presets",
                                 .summary = "list the publishers' formats, the values of --preset",
                                 .operands = ""};
const Command command_domains = {
    .name = "domains", .summary = "list the tissue shapes, the values of --domain", .operands = ""};
const Command command_formats = {.name = "formats",
                                 .summary =
                                     "list the file formats of trees, the values of --input-format",
                                 .operands = "",
                                 .examples = "  corcast formats   # each line: extension, name, "
                                             "what a file contains; unit of lengths\n"};
const Command command_morphometries = {
    .name = "morphometries",
    .summary = "list the published data sets, the values of `info --morphometry`",
    .operands = ""};
const Command command_waveforms = {
    .name = "waveforms",
    .summary =
        "list the curves of pressure and flow over a cardiac cycle, the values of `pulse --drive`",
    .operands = "",
    .examples = "  corcast waveforms   # each line: name, quantity, duration of the cycle, meaning "
                "[source]\n"};
const Command command_walls = {.name = "walls",
                               .summary =
                                   "list the laws of wall stiffness, the values of `pulse --wall`",
                               .operands = ""};
