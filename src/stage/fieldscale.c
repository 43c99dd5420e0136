/* All numbers of a scale are in one unit, so the values are converted first. The range comes from
 * the values of segments that can be drawn, in all frames: colors then have the same meaning
 * throughout a film. */
#include "stage/fieldscale.h"

#include "stage/stage.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- values ---------------------------------------------------------------------------------- */

static Status refuse_unit(const Field *field, const char *unit, Err *err)
{
    Text others = TEXT_INIT;
    unit_put_others(field->unit, &others);
    Status status = text_check(&others, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_USAGE, "`unit`: the field %s is %s%s, not in %.40s%s%s",
                         field->name, *field->unit ? "in " : "a pure number", field->unit, unit,
                         others.length ? "; it can be in " : "", text_chars(&others));
    text_release(&others);
    return status;
}

static Status convert(Field *field, const char *unit, Err *err)
{
    if (!unit || strcmp(unit, field->unit) == 0)
        return STATUS_OK;
    const double ratio = unit_ratio(field->unit, unit);
    if (!(ratio > 0))
        return refuse_unit(field, unit, err);
    for (size_t i = 0; i < field->n; i++)
        field->value[i] *= ratio;
    field->unit = unit_canonical_name(unit);
    return STATUS_OK;
}

Status fieldvalues_take(const Tree *tree, FieldSeries *series, const char *unit, FieldValues *out,
                        Err *err)
{
    *out = (FieldValues){.series = *series};
    *series = (FieldSeries){0};
    Field *field = &out->series.field;
    TRY(convert(field, unit, err));
    TRY(mem_calloc(&out->scale_values, field->n, sizeof *out->scale_values, "field values", err));
    for (size_t i = 0; i < field->n; i++)
        if (segment_can_be_drawn(tree, i % tree->n))
            out->scale_values[out->n_scale_values++] = field->value[i];
    return STATUS_OK;
}

void fieldvalues_show_pieces(FieldValues *values, FieldSeries *pieces)
{
    const double ratio = unit_ratio(pieces->field.unit, values->series.field.unit);
    for (size_t i = 0; i < pieces->field.n && ratio > 0; i++)
        pieces->field.value[i] *= ratio;
    pieces->field.unit = values->series.field.unit;
    fieldseries_release(&values->series);
    values->series = *pieces;
    *pieces = (FieldSeries){0};
}

void fieldvalues_release(FieldValues *values)
{
    fieldseries_release(&values->series);
    free(values->scale_values);
    *values = (FieldValues){0};
}

/* ---- the scale ------------------------------------------------------------------------------- */

static Status set_classes(const FieldScaleParams *params, ColorScale *scale, Err *err)
{
    enum { MOST_CLASSES = 256 }; /* as many as an 8-bit plane can distinguish */
    const double *at = params->classes;
    if (params->n_classes == 1) {
        if (!(at[0] >= 1 && at[0] <= MOST_CLASSES && at[0] == floor(at[0])))
            return err_set(err, STATUS_USAGE,
                           "`classes`: '%g' is not an integer from 1 to %d, nor a list of bounds",
                           at[0], MOST_CLASSES);
        scale->classes = (int)at[0];
        return STATUS_OK;
    }
    for (size_t i = 1; i < params->n_classes; i++)
        if (!(at[i - 1] < at[i]))
            return err_set(err, STATUS_USAGE,
                           "`classes`: bounds must ascend, but %g comes before %g", at[i - 1],
                           at[i]);
    memcpy(scale->bounds, at, params->n_classes * sizeof *at);
    scale->n_bounds = (int)params->n_classes;
    return STATUS_OK;
}

/* Sets the range to the ends that are specified. */
static Status set_ends(const FieldScaleParams *params, const FieldValues *values, ColorScale *scale,
                       Err *err)
{
    const double percent[] = {params->percent[0] ? params->ends[0] : 0,
                              params->percent[1] ? params->ends[1] : 0};
    double range[2];
    TRY(colorscale_percentiles(scale, values->scale_values, values->n_scale_values, percent, range,
                               err));
    for (int i = 0; i < 2; i++)
        range[i] = params->percent[i] ? range[i] : params->ends[i];
    if (scale->log && !(range[0] > 0))
        return err_set(err, STATUS_USAGE, "`range`: with `log` both ends must be positive, not %g",
                       range[0]);
    if (!(range[0] <= range[1]))
        return err_set(err, STATUS_USAGE,
                       "`range`: the lower end %g of the field %s is above the upper end %g",
                       range[0], values->series.field.name, range[1]);
    memcpy(scale->range, range, sizeof range);
    return STATUS_OK;
}

/* Returns true if both ends are values: the field has no part in the range. */
static bool is_fixed(const FieldScaleParams *params)
{
    return params->has_ends && !params->percent[0] && !params->percent[1];
}

static Status set_range(const FieldScaleParams *params, const FieldValues *values,
                        ColorScale *scale, Err *err)
{
    if (!is_fixed(params) && !colorscale_fit(scale, values->scale_values, values->n_scale_values))
        return err_set(err, STATUS_INPUT, "`color_by`: the field %s has no value%s",
                       values->series.field.name, scale->log ? " above 0" : "");
    return params->has_ends ? set_ends(params, values, scale, err) : STATUS_OK;
}

/* The colors of a separate map are selected by integers or by classes. */
static Status check_separate(const FieldScaleParams *params, const ColorScale *scale,
                             const FieldValues *values, Err *err)
{
    if (!scale->map.separate || scale->n_bounds || scale->classes > 1)
        return STATUS_OK;
    for (size_t i = 0; i < values->n_scale_values; i++)
        if (isfinite(values->scale_values[i]) &&
            values->scale_values[i] != floor(values->scale_values[i]))
            return err_set(err, STATUS_USAGE,
                           "`colormap` %s has separate colors, which suit integers; the field %s "
                           "needs `classes` for them",
                           params->map_name, values->series.field.name);
    return STATUS_OK;
}

/* ---- words ----------------------------------------------------------------------------------- */

static void put_source(const FieldScaleParams *params, const FieldValues *values, Text *text)
{
    const size_t frames = values->series.frames, n = values->n_scale_values / frames;
    if (is_fixed(params)) {
        text_puts(text, ", as given");
        return;
    }
    text_puts(text, ", ");
    for (int i = 0; params->has_ends && i < 2; i++)
        text_printf(text, "%g%s%s", params->ends[i], params->percent[i] ? "%" : "",
                    i ? " " : " to ");
    if (params->of_tree)
        text_printf(text, "of all %zu segments of the tree", n);
    else
        text_printf(text, "of the %zu segments drawn", n);
    if (frames > 1)
        text_printf(text, " in %zu time steps", frames);
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

static Status say(const FieldScaleParams *params, const FieldValues *range_of,
                  const FieldValues *shown, Appearance *appearance, Err *err)
{
    Text text = TEXT_INIT;
    colorscale_put_range(&appearance->scale, &text);
    put_source(params, range_of, &text);
    put_steps(&appearance->scale, &text);
    appearance->outside =
        colorscale_outside(&appearance->scale, shown->scale_values, shown->n_scale_values);
    put_outside(&appearance->scale, appearance->outside, &text);
    Status status = text_take(&text, &appearance->meaning, err);
    text_release(&text);
    appearance->fitted = !params->has_ends;
    return status;
}

double fieldscale_decades(const Appearance *appearance)
{
    ColorScale log = appearance->scale;
    log.log = true;
    if (!appearance->fitted || appearance->scale.log || colorscale_steps(&appearance->scale) ||
        appearance->scale.range[0] < 0 ||
        !colorscale_fit(&log, appearance->values, appearance->n_values))
        return 0;
    return elementary_log10(log.range[1] / log.range[0]);
}

/* ---- appearance ------------------------------------------------------------------------------ */

Status fieldscale_check_frame(int frame, const char *name, size_t frames, Err *err)
{
    if (frames >= (size_t)frame)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "`moment` %d: %s has %zu time step%s", frame, name, frames,
                   frames == 1 ? "" : "s");
}

/* Makes the colors of all frames, or of the one that is shown. */
static Status color_frames(const FieldScaleParams *params, FieldSeries *series,
                           const ColorScale *scale, Appearance *appearance, Err *err)
{
    const int frame = params->frame;
    size_t n = series->field.n / series->frames;
    Field shown = series->field;
    if (frame) {
        TRY(fieldscale_check_frame(frame, series->field.name, series->frames, err));
        shown.value += (size_t)(frame - 1) * n;
        shown.n = n;
    }
    TRY(stage_appearance(params->look, &shown, scale, appearance, err));
    if (frame || !series->time)
        return STATUS_OK;
    appearance->n_frames = series->frames;
    appearance->n_segments = n;
    appearance->time = series->time;
    series->time = NULL;
    return STATUS_OK;
}

Status fieldscale_color(const FieldScaleParams *params, Colormap *map, const FieldValues *range_of,
                        FieldValues *shown, Appearance *appearance, Err *err)
{
    ColorScale scale = {.name = shown->series.field.name,
                        .unit = shown->series.field.unit,
                        .log = params->log,
                        .under = params->under,
                        .over = params->over,
                        .none = params->none,
                        .map = *map};
    Appearance made = {0};
    TRY(set_classes(params, &scale, err));
    TRY(set_range(params, range_of, &scale, err));
    TRY(check_separate(params, &scale, shown, err));
    TRY(color_frames(params, &shown->series, &scale, &made, err));
    Status status = say(params, range_of, shown, &made, err);
    if (status != STATUS_OK) {
        made.scale.map = (Colormap){0}; /* the caller still owns the map */
        appearance_release(&made);
        return status;
    }
    *map = (Colormap){0};
    *appearance = made;
    return STATUS_OK;
}
