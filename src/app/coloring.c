/* A field of the tree, and a scale for its values: of the options, or fitted to them. */
#include "app/coloring.h"

#include "app/commands.h"
#include "app/templates.h"
#include "image/image.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

static const Option rows[] = {
    {.name = "color-by",
     SETS(TEXT, Coloring, field),
     .group = GROUP_COLOR,
     .argument = "FIELD",
     .list = "fields",
     .help = "a field of the tree, such as radius, flow or wss, a column of its file, or "
             "FILE.csv:COLUMN"},
    {.name = "frame",
     SETS(WHOLE, Coloring, frame),
     FROM_TO(1, 1000000),
     .group = GROUP_COLOR,
     .argument = "K",
     .otherwise = "",
     .help = "of values that change with time: the K-th moment alone"},
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

Status coloring_join(const Coloring *coloring, Tree *tree, char **joined, Err *err)
{
    size_t length;
    const char *column;
    if (!coloring->field || !values_parse(coloring->field, &length, &column))
        return STATUS_OK;
    char *path = NULL;
    TRY(mem_strdup(&path, coloring->field, err));
    path[length] = '\0';
    Status status = tree_read_values(tree, path, column, joined, err);
    free(path);
    return status;
}

/* The field, and its scale; the sentences do not name the tree. All frames have one scale. */
static Status read_field(const Coloring *coloring, const Tree *tree, const char *name,
                         FieldSeries *series, ColorScale *scale, Err *err)
{
    const TreeMeta said = blood_said(&coloring->blood);
    TRY(derive_series(tree, &said, name, series, err));
    if (coloring->frame > 1 && (size_t)coloring->frame > series->frames)
        return err_set(err, STATUS_USAGE, "--frame %d: %s has %zu frame%s", coloring->frame,
                       series->field.name, series->frames, series->frames == 1 ? "" : "s");
    TRY(set_range(coloring, &series->field, scale, err));
    scale->name = series->field.name;
    scale->unit = series->field.unit;
    return STATUS_OK;
}

/* The colours of all frames, or of the one that is asked for. */
static Status color_frames(const Coloring *coloring, const Look *look, FieldSeries *series,
                           const ColorScale *scale, Appearance *appearance, Err *err)
{
    size_t n = series->field.n / series->frames;
    Field shown = series->field;
    if (coloring->frame) {
        shown.value += (size_t)(coloring->frame - 1) * n;
        shown.n = n;
    }
    TRY(stage_appearance(look, &shown, scale, appearance, err));
    if (coloring->frame || !series->time)
        return STATUS_OK;
    appearance->n_frames = series->frames;
    appearance->n_segments = n;
    appearance->time = series->time;
    series->time = NULL;
    return STATUS_OK;
}

Status coloring_appearance(const Coloring *coloring, const Tree *tree, const char *tree_path,
                           const char *joined, const Look *look, Appearance *appearance, Err *err)
{
    if (!coloring->field)
        return stage_appearance(look, NULL, NULL, appearance, err);
    FieldSeries series = {0};
    ColorScale scale = {.log = coloring->log, .classes = coloring->classes};
    size_t length;
    const char *column;
    bool is_file = values_parse(coloring->field, &length, &column);
    Status status;
    TRY_GOTO(read_map(coloring, &scale.map, err));
    status = read_field(coloring, tree, is_file ? joined : coloring->field, &series, &scale, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree_path);
    TRY_GOTO(status);
    TRY_GOTO(color_frames(coloring, look, &series, &scale, appearance, err));
done:
    if (status != STATUS_OK)
        colormap_release(&scale.map);
    fieldseries_release(&series);
    return status;
}
