/* A field of the tree, and a scale for its values: of the options, or fitted to them. The unit
 * comes first, so that all other numbers, given and said, are in it. */
#include "job/picture/coloring.h"

#include "image/image.h"
#include "options/output.h"
#include "options/templates.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

static const char *const ranges_of[] = {[RANGE_OF_DRAWN] = "drawn", [RANGE_OF_TREE] = "tree", NULL};

static const Option rows[] = {
    {.name = "color-by",
     SETS(TEXT, Coloring, field),
     .group = GROUP_COLOR,
     .argument = "FIELD",
     .list = "fields",
     .when = WHEN(COLORS) | WHEN(VESSELS),
     .help = "a field of the tree, such as radius, flow or wss, a column of its file, or "
             "FILE.csv:COLUMN"},
    {.name = "moment",
     SETS(WHOLE, Coloring, frame),
     FROM_TO(1, 1000000),
     .group = GROUP_COLOR,
     .argument = "K",
     .otherwise = "",
     .when = WHEN(ONE_MOMENT),
     .needs = "color-by",
     .help = "of values that change with time: the K-th moment alone"},
    {.name = "colormap",
     SETS(LOOKUP, Coloring, colormap),
     .group = GROUP_COLOR,
     .list = "colormaps",
     .needs = "color-by",
     .help = "a file of templates/colormaps, or a path"},
    {.name = "unit",
     SETS(TEXT, Coloring, unit),
     .group = GROUP_COLOR,
     .argument = "UNIT",
     .otherwise = "the field's",
     .needs = "color-by",
     .help = "of the field, its range and classes: Pa, kPa, mmHg, dyn/cm2, cm/s, ml/s, ..."},
    {.name = "range",
     SETS(RANGE, Coloring, range),
     GIVEN(Coloring, has_range),
     .group = GROUP_COLOR,
     .otherwise = "the field's",
     .when = WHEN(NO_BOUNDS),
     .needs = "color-by",
     .help = "values at the ends of the colour map; 2%,98%: that many of the field's are smaller"},
    {.name = "range-of",
     SETS(CHOICE, Coloring, range_of),
     .choices = ranges_of,
     .group = GROUP_COLOR,
     .when = WHEN(WHOLE_RANGE) | WHEN(FITTED_RANGE),
     .needs = "color-by",
     .help = "whose values the range is of: of the segments drawn, or of those pruned, too"},
    {.name = "log",
     SETS(FLAG, Coloring, log),
     .group = GROUP_COLOR,
     .when = WHEN(NO_BOUNDS),
     .needs = "color-by",
     .help = "logarithmic colours"},
    {.name = "classes",
     SETS(NUMBERS, Coloring, classes),
     .group = GROUP_COLOR,
     .argument = "N|A,B,...",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "N equal steps of the range, each of one colour, or steps between bounds; 1: colours "
             "run on"},
    {.name = "under",
     SETS(COLOR, Coloring, under),
     GIVEN(Coloring, has_under),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "the map's first",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "of values below the range, or all bounds: a name, #RRGGBB or R,G,B from 0 to 1"},
    {.name = "over",
     SETS(COLOR, Coloring, over),
     GIVEN(Coloring, has_over),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "the map's last",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "of values above it"},
    {.name = "no-data",
     SETS(COLOR, Coloring, none),
     GIVEN(Coloring, has_none),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "gray",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "of segments without a value, or without its logarithm"},
};

static bool has_bounds(const Coloring *coloring)
{
    return coloring->classes.n > 1;
}

/* Whether the range is neither fitted nor of percentiles. */
static bool range_is_told(const Coloring *coloring)
{
    const RangeEnds *ends = &coloring->range;
    return coloring->has_range && !ends->percent[0] && !ends->percent[1];
}

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const Coloring *coloring = set;
    (void)parsed;
    const bool blood = coloring->field || coloring->uses_blood;
    return UNLESS(blood, USES_BLOOD) | UNLESS(blood || coloring->uses_flow, USES_FLOW) |
           UNLESS(!has_bounds(coloring), NO_BOUNDS) |
           UNLESS(!range_is_told(coloring), FITTED_RANGE);
}

const OptionTable coloring_table = {OPTION_ROWS(rows), .unmet = unmet};

void coloring_set_defaults(Coloring *coloring)
{
    coloring->colormap = "viridis";
    coloring->classes = (NumberList){.at = {1}, .n = 1};
}

Rgb rgb_of_option(Vec3 srgb)
{
    return (Rgb){srgb_decode((float)srgb.x), srgb_decode((float)srgb.y),
                 srgb_decode((float)srgb.z)};
}

Status coloring_read_look(const char *name, Look *look, Err *err)
{
    char *path = NULL;
    TRY(template_file("look", "looks", name, ".ini", &path, err));
    Status status = look_read(look, path, err);
    free(path);
    return status;
}

/* ---- values ---------------------------------------------------------------------------------- */

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

/* The field of a tree in all frames, and its values of the segments that can be drawn. */
typedef struct Values {
    FieldSeries series;
    double *drawn;
    size_t n; /* of these, in all frames */
} Values;

static void release_values(Values *values)
{
    fieldseries_release(&values->series);
    free(values->drawn);
    *values = (Values){0};
}

/* Turns the values into the unit that is asked for. */
static Status convert(Field *field, const char *unit, Err *err)
{
    if (!unit || strcmp(unit, field->unit) == 0)
        return STATUS_OK;
    double ratio = unit_ratio(field->unit, unit);
    if (ratio > 0) {
        for (size_t i = 0; i < field->n; i++)
            field->value[i] *= ratio;
        field->unit = unit_named(unit);
        return STATUS_OK;
    }
    Text others = TEXT_INIT;
    unit_put_others(field->unit, &others);
    Status status = text_check(&others, err);
    const char *known = text_chars(&others);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "--unit: the field %s is %s%s, not in %.40s%s%s",
                         field->name, *field->unit ? "in " : "a pure number", field->unit, unit,
                         *known ? "; it can be in " : "", known);
    text_release(&others);
    return status;
}

static Status read_values(const Coloring *coloring, const Tree *tree, const char *joined,
                          Values *values, Err *err)
{
    const TreeMeta said = blood_said(&coloring->blood);
    FieldSeries *series = &values->series;
    size_t length;
    const char *column;
    bool is_file = values_parse(coloring->field, &length, &column);
    TRY(derive_series(tree, &said, is_file ? joined : coloring->field, series, err));
    const Field *field = &series->field;
    TRY(convert(&series->field, coloring->unit, err));
    TRY(mem_calloc(&values->drawn, field->n, sizeof *values->drawn, "field values", err));
    for (size_t i = 0; i < field->n; i++)
        if (segment_can_be_drawn(tree, i % tree->n))
            values->drawn[values->n++] = field->value[i];
    return STATUS_OK;
}

/* ---- the scale ------------------------------------------------------------------------------- */

static Status read_map(const Coloring *coloring, Colormap *map, Err *err)
{
    char *path = NULL;
    TRY(template_file("colormap", "colormaps", coloring->colormap, ".txt", &path, err));
    Status status = colormap_read(map, path, err);
    free(path);
    return status;
}

static Status set_classes(const NumberList *list, ColorScale *scale, Err *err)
{
    enum { MOST_CLASSES = 256 };
    const double *at = list->at;
    if (list->n == 1) {
        if (!(at[0] >= 1 && at[0] <= MOST_CLASSES && at[0] == floor(at[0])))
            return err_set(
                err, STATUS_USAGE,
                "--classes: '%g' is not a whole number from 1 to %d, nor a list of bounds", at[0],
                MOST_CLASSES);
        scale->classes = (int)at[0];
        return STATUS_OK;
    }
    for (size_t i = 1; i < list->n; i++)
        if (!(at[i - 1] < at[i]))
            return err_set(err, STATUS_USAGE, "--classes: bounds ascend, but %g comes before %g",
                           at[i - 1], at[i]);
    memcpy(scale->bounds, at, list->n * sizeof *at);
    scale->n_bounds = (int)list->n;
    return STATUS_OK;
}

static ScaleColor own_color(bool given, Vec3 srgb)
{
    Rgb color = rgb_of_option(srgb);
    return (ScaleColor){given, {color.r, color.g, color.b}};
}

/* The ends that --range gives. */
static Status take_range(const RangeEnds *ends, const Values *values, ColorScale *scale, Err *err)
{
    const double percent[] = {ends->percent[0] ? ends->at[0] : 0,
                              ends->percent[1] ? ends->at[1] : 0};
    double range[2];
    TRY(colorscale_percentiles(scale, values->drawn, values->n, percent, range, err));
    for (int i = 0; i < 2; i++)
        range[i] = ends->percent[i] ? range[i] : ends->at[i];
    if (scale->log && !(range[0] > 0))
        return err_set(err, STATUS_USAGE, "--range: with --log both ends must be positive, not %g",
                       range[0]);
    if (!(range[0] <= range[1]))
        return err_set(err, STATUS_USAGE, "--range: %g, of the field %s, is not below %g", range[0],
                       values->series.field.name, range[1]);
    memcpy(scale->range, range, sizeof range);
    return STATUS_OK;
}

/* The ends of the scale: given, or of the values. */
static Status set_range(const Coloring *coloring, const Values *values, ColorScale *scale, Err *err)
{
    if (!range_is_told(coloring) && !colorscale_fit(scale, values->drawn, values->n))
        return err_set(err, STATUS_INPUT, "--color-by: the field %s has no value%s",
                       values->series.field.name, scale->log ? " above 0" : "");
    return coloring->has_range ? take_range(&coloring->range, values, scale, err) : STATUS_OK;
}

/* The colours of a separate map are for whole numbers and for classes. */
static Status check_separate(const ColorScale *scale, const Values *values, const char *map,
                             Err *err)
{
    if (!scale->map.separate || scale->n_bounds || scale->classes > 1)
        return STATUS_OK;
    for (size_t i = 0; i < values->n; i++)
        if (isfinite(values->drawn[i]) && values->drawn[i] != floor(values->drawn[i]))
            return err_set(err, STATUS_USAGE,
                           "--colormap %s has separate colours, for whole numbers; the field %s "
                           "takes them with --classes",
                           map, values->series.field.name);
    return STATUS_OK;
}

/* ---- what is said ---------------------------------------------------------------------------- */

static void put_source(const Coloring *coloring, const Values *values, Text *text)
{
    const RangeEnds *ends = &coloring->range;
    const size_t frames = values->series.frames, n = values->n / frames;
    if (range_is_told(coloring)) {
        text_puts(text, ", as given");
        return;
    }
    text_puts(text, ", ");
    for (int i = 0; coloring->has_range && i < 2; i++) {
        text_printf(text, "%g%s%s", ends->at[i], ends->percent[i] ? "%" : "", i ? " " : " to ");
    }
    if (coloring->range_of == RANGE_OF_TREE)
        text_printf(text, "of all %zu segments of the tree", n);
    else
        text_printf(text, "of the %zu segments drawn", n);
    if (frames > 1)
        text_printf(text, " in %zu frames", frames);
}

static void put_steps(const ColorScale *scale, Text *text)
{
    if (scale->classes > 1)
        text_printf(text, "; %d classes", scale->classes);
    for (int i = 0; i < scale->n_bounds; i++)
        text_printf(text, "%s%g", i ? ", " : "; classes at ", scale->bounds[i]);
    text_puts(text, scale->log ? "; logarithmic" : "");
}

static void put_outside(const ColorScale *scale, ScaleOutside outside, Text *text)
{
    if (outside.below + outside.above && !scale->n_bounds)
        text_printf(text, "; %zu below, %zu above", outside.below, outside.above);
    if (outside.none)
        text_printf(text, "; %zu without %s", outside.none, scale->log ? "a logarithm" : "a value");
}

static Status set_said(const Coloring *coloring, const Values *values, const Values *drawn,
                       Appearance *appearance, Err *err)
{
    Text text = TEXT_INIT;
    colorscale_put_range(&appearance->scale, &text);
    put_source(coloring, values, &text);
    put_steps(&appearance->scale, &text);
    appearance->outside = colorscale_outside(&appearance->scale, drawn->drawn, drawn->n);
    put_outside(&appearance->scale, appearance->outside, &text);
    Status status = text_take(&text, &appearance->said, err);
    text_release(&text);
    appearance->fitted = !coloring->has_range;
    return status;
}

void coloring_say(const Appearance *appearance, const Talk *talk)
{
    const double decades = 3;
    ColorScale log = appearance->scale;
    if (!appearance->said)
        return;
    talk_note(talk, "%s", appearance->said);
    log.log = true;
    if (!appearance->fitted || appearance->scale.log || colorscale_steps(&appearance->scale) ||
        appearance->scale.range[0] < 0 ||
        !colorscale_fit(&log, appearance->values, appearance->n_values))
        return;
    double span = elementary_log10(log.range[1] / log.range[0]);
    if (span > decades)
        talk_note(talk, "the field %s spans %.1f decades, which --log shows evenly", log.name,
                  span);
}

json_t *coloring_json(const Appearance *appearance)
{
    const ColorScale *scale = &appearance->scale;
    if (!appearance->said)
        return json_null();
    json_t *bounds = json_array();
    for (int i = 0; i < scale->n_bounds; i++)
        bounds = json_with_item(bounds, json_number(scale->bounds[i]));
    const JsonMember members[] = {
        {"field", json_text(scale->name)},
        {"unit", json_text(scale->unit)},
        {"low", json_number(scale->range[0])},
        {"high", json_number(scale->range[1])},
        {"log", json_boolean(scale->log)},
        {"classes", json_integer(colorscale_steps(scale))},
        {"bounds", bounds},
        {"said", json_text(appearance->said)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}

/* ---- appearance ------------------------------------------------------------------------------ */

Status coloring_check_frame(int frame, const char *name, size_t frames, Err *err)
{
    if (frames >= (size_t)frame)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--moment %d: %s has %zu frame%s", frame, name, frames,
                   frames == 1 ? "" : "s");
}

/* The colours of all frames, or of the one that is asked for. */
static Status color_frames(const Coloring *coloring, const Look *look, FieldSeries *series,
                           const ColorScale *scale, Appearance *appearance, Err *err)
{
    size_t n = series->field.n / series->frames;
    Field shown = series->field;
    if (coloring->frame)
        TRY(coloring_check_frame(coloring->frame, series->field.name, series->frames, err));
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

/* The scale for the values of `all`, which are those of the range, and the appearance of the drawn;
 * the sentences do not name the tree. */
static Status make_appearance(const Coloring *coloring, const Values *all, Values *drawn,
                              const Look *look, ColorScale *scale, Appearance *appearance, Err *err)
{
    scale->name = drawn->series.field.name;
    scale->unit = drawn->series.field.unit;
    TRY(set_classes(&coloring->classes, scale, err));
    TRY(set_range(coloring, all, scale, err));
    TRY(check_separate(scale, drawn, coloring->colormap, err));
    TRY(color_frames(coloring, look, &drawn->series, scale, appearance, err));
    scale->map = (Colormap){0};
    return set_said(coloring, all, drawn, appearance, err);
}

static Status color_field(const Coloring *coloring, const ColoredTree *tree, const Look *look,
                          ColorScale *scale, Appearance *appearance, Err *err)
{
    Values drawn = {0}, whole = {0};
    Status status;
    const bool of_tree = coloring->range_of == RANGE_OF_TREE && tree->whole != tree->drawn;
    TRY_GOTO(read_values(coloring, tree->drawn, tree->joined, &drawn, err));
    if (of_tree)
        TRY_GOTO(read_values(coloring, tree->whole, tree->joined, &whole, err));
    TRY_GOTO(
        make_appearance(coloring, of_tree ? &whole : &drawn, &drawn, look, scale, appearance, err));
done:
    release_values(&drawn);
    release_values(&whole);
    return status;
}

Status coloring_appearance(const Coloring *coloring, const ColoredTree *tree, const Look *look,
                           Appearance *appearance, Err *err)
{
    if (!coloring->field)
        return stage_appearance(look, NULL, NULL, appearance, err);
    Appearance made = {0};
    ColorScale scale = {.log = coloring->log,
                        .under = own_color(coloring->has_under, coloring->under),
                        .over = own_color(coloring->has_over, coloring->over),
                        .none = own_color(coloring->has_none, coloring->none)};
    TRY(read_map(coloring, &scale.map, err));
    Status status = color_field(coloring, tree, look, &scale, &made, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree->path);
    if (status == STATUS_OK)
        *appearance = made;
    else
        appearance_release(&made);
    colormap_release(&scale.map);
    return status;
}
