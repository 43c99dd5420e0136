/* Defines the options that color vessels by a field, a quantity per segment. Reads the field, and
 * fits a color scale to its values unless options state the scale. The values are converted to the
 * unit of
 * --unit first, so that all numbers of options and messages have this unit. */
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
     .help = "color vessels by a field, a quantity per segment: radius, flow, wss (wall shear "
             "stress) and others, a column of the tree file, or a column of a table "
             "(FILE.csv:COLUMN)"},
    {.name = "moment",
     SETS(WHOLE, Coloring, frame),
     FROM_TO(1, 1000000),
     .group = GROUP_COLOR,
     .argument = "K",
     .otherwise = "1; `corcast scene` writes all steps to S.pov",
     .when = WHEN(ONE_MOMENT),
     .needs = "color-by",
     .help = "number of the time step to show, for a field that changes with time. The first is "
             "1; a number above the last step is an error. A web page of `corcast export` always "
             "has all steps"},
    {.name = "colormap",
     SETS(LOOKUP, Coloring, colormap),
     .group = GROUP_COLOR,
     .list = "colormaps",
     .needs = "color-by",
     .help = "color map of --color-by: its name, such as cividis. A value with a '/', such as "
             "./my.txt, is the path of a file of your own, with one color per line: red, green "
             "and blue, each 0..1"},
    {.name = "unit",
     SETS(TEXT, Coloring, unit),
     .group = GROUP_COLOR,
     .argument = "UNIT",
     .otherwise = "the unit of the field, which `corcast fields` lists",
     .needs = "color-by",
     .help = "unit of the values of --color-by, in colors, legend, --range and --classes. "
             "Pressure and stress: Pa, kPa, mmHg, dyn/cm2, cmH2O. Length: um, mm, cm, m. Flow: "
             "ul/min, ml/min, l/min, ml/s, mm3/s, cm3/s. Velocity: um/s, mm/s, cm/s, m/s. A unit "
             "of another quantity is an error"},
    {.name = "range",
     SETS(RANGE, Coloring, range),
     GIVEN(Coloring, has_range),
     .group = GROUP_COLOR,
     .otherwise = "minimum and maximum of the field",
     .when = WHEN(NO_BOUNDS),
     .needs = "color-by",
     .help = "values at the two ends of the color map: numbers in the unit of --unit, such as "
             "0,25, percentiles of the field, such as 2%,98%, or one of each. Values outside the "
             "range get the colors --under and --over"},
    {.name = "range-of",
     SETS(CHOICE, Coloring, range_of),
     .choices = ranges_of,
     .group = GROUP_COLOR,
     .when = WHEN(WHOLE_RANGE) | WHEN(FITTED_RANGE),
     .needs = "color-by",
     .help =
         "which segments determine the default of --range and the percentiles in --range: drawn "
         "(the segments that --prune-radius keeps, also outside the image), tree (all segments "
         "of the file)"},
    {.name = "log",
     SETS(FLAG, Coloring, log),
     .group = GROUP_COLOR,
     .when = WHEN(NO_BOUNDS),
     .needs = "color-by",
     .help = "use a logarithmic color scale; segments with values of 0 or less get the color of "
             "--no-data"},
    {.name = "classes",
     SETS(NUMBERS, Coloring, classes),
     .group = GROUP_COLOR,
     .argument = "N|A,B,...",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "draw color classes instead of continuous colors. N (up to 256) divides --range, or "
             "its logarithm with --log, into N equal classes; 1 means continuous colors. A,B,... "
             "are increasing bounds, which replace --range; n bounds make n + 1 classes: 0,5,10 "
             "makes below 0, 0 to 5, 5 to 10, and 10 and above. A value at a bound is in the "
             "class above the bound"},
    {.name = "under",
     SETS(COLOR, Coloring, under),
     GIVEN(Coloring, has_under),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "first color of --colormap",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "color of values below --range, or of the lowest class if --classes gives bounds: a "
             "CSS name, #RRGGBB, or R,G,B each 0..1"},
    {.name = "over",
     SETS(COLOR, Coloring, over),
     GIVEN(Coloring, has_over),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "last color of --colormap",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "color of values above --range, or of the highest class if --classes gives bounds: a "
             "CSS name, #RRGGBB, or R,G,B each 0..1"},
    {.name = "no-data",
     SETS(COLOR, Coloring, none),
     GIVEN(Coloring, has_none),
     .group = GROUP_COLOR,
     .argument = "COLOR",
     .otherwise = "gray",
     .when = WHEN(STEPS),
     .needs = "color-by",
     .help = "color of segments that have no value of --color-by or, with --log, a value of 0 or "
             "less: a CSS name, #RRGGBB, or R,G,B each 0..1"},
};

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const Coloring *coloring = set;
    (void)parsed;
    const RangeEnds *ends = &coloring->range;
    const bool blood = coloring->field || coloring->uses_blood;
    const bool has_values = coloring->has_range && !ends->percent[0] && !ends->percent[1];
    return UNLESS(blood, USES_BLOOD) | UNLESS(blood || coloring->uses_flow, USES_FLOW) |
           UNLESS(coloring->classes.n <= 1, NO_BOUNDS) | UNLESS(!has_values, FITTED_RANGE);
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

/* The field whose values are read. Borrows its members. */
typedef struct FieldSource {
    const char *name;
    const char *unit; /* NULL: the field's own unit */
    TreeMeta said;    /* values that options specify */
} FieldSource;

/* Reads the values of the segments of a tree, and of their pieces unless `pieces` is NULL. The
 * caller releases *values even after an error. */
static Status read_values(const FieldSource *source, const Tree *tree, const SmoothTree *pieces,
                          FieldValues *values, Err *err)
{
    FieldSeries series = {0}, divided = {0};
    Status status;
    TRY_GOTO(derive_series(tree, &source->said, source->name, &series, err));
    if (pieces)
        TRY_GOTO(derive_pieces(&(DividedTree){tree, &pieces->tree, pieces->segment}, &source->said,
                               &series, &divided, err));
    TRY_GOTO(fieldvalues_take(tree, &series, source->unit, values, err));
    if (pieces)
        fieldvalues_show_pieces(values, &divided);
done:
    fieldseries_release(&series);
    fieldseries_release(&divided);
    return status;
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

static ScaleColor own_color(bool given, Vec3 srgb)
{
    Rgb color = rgb_of_option(srgb);
    return (ScaleColor){given, {color.r, color.g, color.b}};
}

static FieldScaleParams scale_params(const Coloring *coloring, const Look *look)
{
    const RangeEnds *ends = &coloring->range;
    return (FieldScaleParams){.look = look,
                              .has_ends = coloring->has_range,
                              .ends = {ends->at[0], ends->at[1]},
                              .percent = {ends->percent[0], ends->percent[1]},
                              .log = coloring->log,
                              .of_tree = coloring->range_of == RANGE_OF_TREE,
                              .classes = coloring->classes.at,
                              .n_classes = coloring->classes.n,
                              .under = own_color(coloring->has_under, coloring->under),
                              .over = own_color(coloring->has_over, coloring->over),
                              .none = own_color(coloring->has_none, coloring->none),
                              .map_name = coloring->colormap,
                              .frame = coloring->frame};
}

static Status color_field(const Coloring *coloring, const ColoredTree *tree, const Look *look,
                          Colormap *map, Appearance *appearance, Err *err)
{
    const FieldScaleParams params = scale_params(coloring, look);
    size_t length;
    const char *column;
    const bool is_file = values_parse(coloring->field, &length, &column);
    const FieldSource source = {is_file ? tree->joined : coloring->field, coloring->unit,
                                blood_specified(&coloring->blood)};
    FieldValues drawn = {0}, whole = {0};
    Status status;
    const bool of_tree = params.of_tree && tree->whole != tree->drawn;
    TRY_GOTO(read_values(&source, tree->drawn, tree->pieces, &drawn, err));
    if (of_tree)
        TRY_GOTO(read_values(&source, tree->whole, NULL, &whole, err));
    status = fieldscale_color(&params, map, of_tree ? &whole : &drawn, &drawn, appearance, err);
done:
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", tree->path);
    fieldvalues_release(&drawn);
    fieldvalues_release(&whole);
    return status;
}

Status coloring_appearance(const Coloring *coloring, const ColoredTree *tree, const Look *look,
                           Appearance *appearance, Err *err)
{
    if (!coloring->field)
        return stage_appearance(look, NULL, NULL, appearance, err);
    Colormap map = {0};
    TRY(read_map(coloring, &map, err));
    Status status = color_field(coloring, tree, look, &map, appearance, err);
    colormap_release(&map);
    return status;
}

/* Makes a color map of two colors: that of the look's tips and that of its vessels. */
static Status map_of_look(const Look *look, Colormap *map, Err *err)
{
    const Rgb ends[] = {look->tips.color, look->color};
    TRY(mem_calloc(&map->srgb, 2, sizeof *map->srgb, "colors", err));
    map->n = 2;
    for (int i = 0; i < 2; i++) {
        map->srgb[i][0] = srgb_encode(ends[i].r);
        map->srgb[i][1] = srgb_encode(ends[i].g);
        map->srgb[i][2] = srgb_encode(ends[i].b);
    }
    return STATUS_OK;
}

/* Returns the largest number of segments that begin at one node. */
static Status most_daughters(const Tree *tree, size_t *most, Err *err)
{
    uint32_t *count = NULL;
    *most = 0;
    TRY(mem_calloc(&count, tree->n, sizeof *count, "nodes", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && ++count[tree->parent[i]] > *most)
            *most = count[tree->parent[i]];
    free(count);
    return STATUS_OK;
}

/* The scale is logarithmic from the 2nd percentile of the radii to the widest vessel. A few stray
 * thin vessels do not stretch it then. */
Status coloring_by_radius(const ColoredTree *tree, const Look *look, Appearance *appearance,
                          Err *err)
{
    enum { MOST_DAUGHTERS = 255 }; /* POV-Ray's isosurface can color 256 vessels that meet */
    const double one_class = 1;
    size_t most;
    const FieldScaleParams params = {.look = look,
                                     .has_ends = true,
                                     .ends = {2, 100},
                                     .percent = {true, true},
                                     .log = true,
                                     .classes = &one_class,
                                     .n_classes = 1};
    const FieldSource source = {.name = "radius"};
    FieldValues radii = {0};
    Colormap map = {0};
    Status status;
    TRY(most_daughters(tree->drawn, &most, err));
    if (most > MOST_DAUGHTERS)
        return stage_appearance(look, NULL, NULL, appearance, err);
    TRY_GOTO(map_of_look(look, &map, err));
    TRY_GOTO(read_values(&source, tree->drawn, tree->pieces, &radii, err));
    TRY_GOTO(fieldscale_color(&params, &map, &radii, &radii, appearance, err));
    free(appearance->meaning);
    appearance->meaning = NULL;
done:
    if (status == STATUS_INPUT) /* no segment has a radius, so that there is no geometry either */
        status = stage_appearance(look, NULL, NULL, appearance, err);
    fieldvalues_release(&radii);
    colormap_release(&map);
    return status;
}

/* ---- reports --------------------------------------------------------------------------------- */

void coloring_report(const Appearance *appearance, const Talk *talk)
{
    const double most_decades = 3; /* a linear scale shows hardly anything of the lowest */
    if (!appearance->meaning)
        return;
    talk_note(talk, "%s", appearance->meaning);
    const double decades = fieldscale_decades(appearance);
    if (decades > most_decades)
        talk_note(talk, "the field %s spans %.1f decades; use --log for a logarithmic scale",
                  appearance->scale.name, decades);
}

json_t *coloring_json(const Appearance *appearance)
{
    const ColorScale *scale = &appearance->scale;
    if (!appearance->meaning)
        return json_null();
    json_t *bounds = json_array();
    for (int i = 0; i < scale->n_bounds; i++)
        bounds = json_with_item(bounds, json_number(scale->bounds[i]));
    return JSON_OBJECT({"field", json_text(scale->name)}, {"unit", json_text(scale->unit)},
                       {"low", json_number(scale->range[0])},
                       {"high", json_number(scale->range[1])}, {"log", json_boolean(scale->log)},
                       {"classes", json_integer(colorscale_steps(scale))}, {"bounds", bounds},
                       {"said", json_text(appearance->meaning)});
}
