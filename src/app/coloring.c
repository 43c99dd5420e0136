/* A field of the tree, and a scale for its values: of the options, or fitted to them. */
#include "app/coloring.h"

#include "app/commands.h"
#include "app/templates.h"
#include "image/image.h"
#include <stdlib.h>
#include <string.h>

static const Option rows[] = {
    {.name = "color-by",
     SETS(TEXT, Coloring, field),
     .group = GROUP_COLOR,
     .argument = "FIELD",
     .list = "fields",
     .help = "a field of the tree, such as radius, flow or wss, or a column of its file"},
    {.name = "colormap",
     SETS(LOOKUP, Coloring, colormap),
     .group = GROUP_COLOR,
     .list = "colormaps",
     .help = "a file of templates/colormaps, or a path"},
    {.name = "range",
     SETS(RANGE, Coloring, range),
     GIVEN(Coloring, has_range),
     .group = GROUP_COLOR,
     .otherwise = "the field's",
     .help = "values at the ends of the colour map"},
    {.name = "log", SETS(FLAG, Coloring, log), .group = GROUP_COLOR, .help = "logarithmic colours"},
    {.name = "classes",
     SETS(WHOLE, Coloring, classes),
     FROM_TO(1, 256),
     .group = GROUP_COLOR,
     .help = "equal steps of the range, each of one colour; 1: colours run on"},
};

const OptionTable coloring_table = OPTION_TABLE(rows);

void coloring_set_defaults(Coloring *coloring)
{
    coloring->colormap = "viridis";
    coloring->classes = 1;
}

bool coloring_takes(const Coloring *coloring, const Option *option)
{
    static const char *const without_field[] = {"color-by", "look", NULL};
    return coloring->field || (option->group != GROUP_COLOR && option->group != GROUP_BLOOD) ||
           is_one_of(option->name, without_field);
}

Status coloring_check_needs(const Coloring *coloring, const Parsed *parsed, Err *err)
{
    for (size_t i = 0; i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        if (setting->typed && !coloring_takes(coloring, setting->option))
            return err_set(err, STATUS_USAGE, "--%s needs --color-by", setting->option->name);
    }
    return STATUS_OK;
}

/* The ends of the scale: given, or the field's. */
static Status set_range(const Coloring *coloring, const Field *field, ColorScale *scale, Err *err)
{
    if (!coloring->has_range && !colorscale_fit(scale, field->value, field->n))
        return err_set(err, STATUS_INPUT, "--color-by: the field %s has no value%s", field->name,
                       scale->log ? " above 0" : "");
    if (!coloring->has_range)
        return STATUS_OK;
    if (scale->log && !(coloring->range[0] > 0))
        return err_set(err, STATUS_USAGE, "--range: with --log both ends must be positive, not %g",
                       coloring->range[0]);
    memcpy(scale->range, coloring->range, sizeof scale->range);
    return STATUS_OK;
}

Status coloring_read_look(const char *name, Look *look, Err *err)
{
    char *path = NULL;
    TRY(template_file("look", "looks", name, ".ini", &path, err));
    Status status = look_read(look, path, err);
    free(path);
    return status;
}

static Status read_map(const Coloring *coloring, Colormap *map, Err *err)
{
    char *path = NULL;
    TRY(template_file("colormap", "colormaps", coloring->colormap, ".txt", &path, err));
    Status status = colormap_read(map, path, err);
    free(path);
    return status;
}

/* The field, and its scale; the sentences do not name the tree. */
static Status read_field(const Coloring *coloring, const Tree *tree, Field *field,
                         ColorScale *scale, Err *err)
{
    const TreeMeta said = blood_said(&coloring->blood);
    TRY(derive_field(tree, &said, coloring->field, field, err));
    TRY(set_range(coloring, field, scale, err));
    scale->name = field->name;
    scale->unit = field->unit;
    return STATUS_OK;
}

Status coloring_appearance(const Coloring *coloring, const Tree *tree, const char *tree_path,
                           const Look *look, Appearance *appearance, Err *err)
{
    if (!coloring->field)
        return stage_appearance(look, NULL, NULL, appearance, err);
    Field field = {0};
    ColorScale scale = {.log = coloring->log, .classes = coloring->classes};
    Status status;
    TRY_GOTO(read_map(coloring, &scale.map, err));
    status = read_field(coloring, tree, &field, &scale, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree_path);
    TRY_GOTO(status);
    TRY_GOTO(stage_appearance(look, &field, &scale, appearance, err));
done:
    if (status != STATUS_OK)
        colormap_release(&scale.map);
    field_release(&field);
    return status;
}
