#include "app/coloring.h"

#include "app/templates.h"
#include "image/image.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char of_tree[] = "the tree's";

static const Option rows[] = {
    {.name = "color-by",
     SETS(TEXT, Coloring, field),
     .group = GROUP_COLOR,
     .argument = "FIELD",
     .list = "fields",
     .help = "radius or length (mm), flow (ml/min), velocity (mm/s), pressure (mmHg), wss (wall "
             "shear stress, Pa), reynolds, level, strahler, diameter-strahler or branch"},
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
    {.name = "q-perf",
     SETS(NUMBER, Coloring, flow.number[META_Q_PERF]),
     GIVEN(Coloring, flow.known[META_Q_PERF]),
     .range = &meta_rows[META_Q_PERF].range,
     .group = GROUP_BLOOD,
     .unit = "ml/min",
     .otherwise = of_tree,
     .help = "flow through the inlet"},
    {.name = "p-perf",
     SETS(NUMBER, Coloring, flow.number[META_P_PERF]),
     GIVEN(Coloring, flow.known[META_P_PERF]),
     .range = &meta_rows[META_P_PERF].range,
     .group = GROUP_BLOOD,
     .unit = "mmHg",
     .otherwise = of_tree,
     .help = "pressure at the inlet"},
    {.name = "viscosity",
     SETS(NUMBER, Coloring, flow.number[META_VISCOSITY]),
     GIVEN(Coloring, flow.known[META_VISCOSITY]),
     .range = &meta_rows[META_VISCOSITY].range,
     .group = GROUP_BLOOD,
     .unit = "cP",
     .otherwise = of_tree,
     .help = "of the blood"},
};

const OptionTable coloring_table = OPTION_TABLE(rows);

void coloring_set_defaults(Coloring *coloring)
{
    coloring->colormap = "viridis";
}

static double scaled(const Coloring *coloring, double value)
{
    return coloring->log ? (value > 0 ? log(value) : (double)NAN) : value;
}

/* The ends of the colour map, on the scale of the colours. */
static Status find_range(const Coloring *coloring, const Field *field, double range[2], Err *err)
{
    if (coloring->has_range && coloring->log && !(coloring->range[0] > 0))
        return err_set(err, STATUS_USAGE, "--range: with --log both ends must be positive, not %g",
                       coloring->range[0]);
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (size_t i = 0; i < field->n && !coloring->has_range; i++) {
        double value = scaled(coloring, field->value[i]);
        if (isfinite(value)) {
            range[0] = fmin(range[0], value);
            range[1] = fmax(range[1], value);
        }
    }
    if (coloring->has_range)
        for (int i = 0; i < 2; i++)
            range[i] = scaled(coloring, coloring->range[i]);
    if (!(range[0] <= range[1]))
        return err_set(err, STATUS_INPUT, "--color-by: the field %s has no value%s", field->name,
                       coloring->log ? " above 0" : "");
    return STATUS_OK;
}

Status coloring_read_map(const Coloring *coloring, Colormap *map, Err *err)
{
    char *path = NULL;
    TRY(template_file("colormap", "colormaps", coloring->colormap, ".txt", &path, err));
    Status status = colormap_read(map, path, err);
    free(path);
    return status;
}

Status coloring_apply(const Coloring *coloring, const Colormap *map, const Tree *tree, Rgb **colors,
                      Err *err)
{
    *colors = NULL;
    if (!coloring->field)
        return STATUS_OK;
    Field field = {0};
    Rgb *made = NULL;
    double range[2] = {0, 0};
    Status status = derive_field(tree, &coloring->flow, coloring->field, &field, err);
    if (status != STATUS_OK)
        return status;
    TRY_GOTO(find_range(coloring, &field, range, err));
    TRY_GOTO(mem_calloc(&made, tree->n, sizeof *made, "colours", err));
    for (size_t i = 0; i < tree->n; i++) {
        double width = range[1] - range[0];
        double value = scaled(coloring, field.value[i]);
        float rgb[3];
        colormap_linear(map, width > 0 ? (value - range[0]) / width : value - range[0] + 0.5, rgb);
        made[i] = (Rgb){rgb[0], rgb[1], rgb[2]};
    }
    *colors = made;
done:
    field_release(&field);
    return status;
}
