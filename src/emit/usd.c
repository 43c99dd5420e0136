/* Writes Universal Scene Description as text: linear BasisCurves, one primitive per Strahler order;
 * in a forest, one primitive per tree and order. The templates usd/tree.usda and usd/curves.usda
 * hold the frame of the file and of a primitive; this file computes the values of their keys.
 *
 * Widths are diameters. The curves have no normals, because curves with normals are drawn as
 * ribbons. Each attribute of the points is a separate array, so the points of a primitive are
 * visited once per array. put_text has its own conversions [emit/puttext.h]: %f is a float, %z a
 * size_t. */
#include "emit/curves.h"
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"

/* The curves [begin, end) of one primitive. */
typedef struct CurveGroup {
    const EmitParams *params;
    const Curves *curves;
    size_t begin, end;
} CurveGroup;

/* Calls put(group, curve, point, out) for each point, and separates the results by commas. A
 * new curve begins a new line. */
static Status put_each(const CurveGroup *group,
                       void (*put)(const CurveGroup *, size_t, size_t, Text *), Text *out, Err *err)
{
    for (size_t curve = group->begin; curve < group->end; curve++)
        for (size_t i = 0; i < curve_points(group->curves, curve); i++) {
            if (i > 0 || curve > group->begin)
                text_puts(out, i ? ", " : ",\n");
            put(group, curve, i, out);
        }
    return text_check(out, err);
}

static void put_position(const CurveGroup *group, size_t curve, size_t i, Text *out)
{
    Vec3 at = curve_point(group->curves, curve, i);
    put_text(out, "(%f, %f, %f)", at.x, at.y, at.z);
}

static void put_width(const CurveGroup *group, size_t curve, size_t i, Text *out)
{
    put_text(out, "%f", 2 * curve_radius(group->curves, curve, i));
}

static void put_color(const CurveGroup *group, size_t curve, size_t i, Text *out)
{
    Rgb color = vessel_color(group->params, curve_segment(group->curves, curve, i));
    put_triple(out, "(", (const float[3]){color.r, color.g, color.b}, ", ", ")");
}

static void put_segment_id(const CurveGroup *group, size_t curve, size_t i, Text *out)
{
    put_text(out, "%u", group->params->vessels->ids[curve_segment(group->curves, curve, i)]);
}

static Status put_points(Text *out, const void *context, Err *err)
{
    return put_each(context, put_position, out, err);
}

static Status put_widths(Text *out, const void *context, Err *err)
{
    return put_each(context, put_width, out, err);
}

/* Appends a color per point, or a single color if all vessels have the same color. */
static Status put_colors(Text *out, const void *context, Err *err)
{
    const CurveGroup *group = context;
    if (group->params->appearance->colors)
        return put_each(group, put_color, out, err);
    put_color(group, group->begin, 0, out);
    return text_check(out, err);
}

static Status put_segment_ids(Text *out, const void *context, Err *err)
{
    return put_each(context, put_segment_id, out, err);
}

static Box group_box(const CurveGroup *group)
{
    const VesselTree *vessels = group->params->vessels;
    Box box = box_empty();
    for (size_t i = group->curves->first[group->begin]; i < group->curves->first[group->end]; i++)
        box = box_with_vessel(box, &vessels->segments[group->curves->segments[i]]);
    return box;
}

/* Appends one primitive of curves, by its template. */
static Status put_group(const CurveGroup *group, Text *out, Err *err)
{
    const CurveKind *kind = curve_kind(group->curves, group->begin);
    Box box = group_box(group);
    Values values = {0};
    curves_put_name(group->params, kind, add_value(&values, "name"));
    Text *counts = add_value(&values, "counts");
    for (size_t i = group->begin; i < group->end; i++)
        put_text(counts, i > group->begin ? ", %z" : "%z", curve_points(group->curves, i));
    put_text(add_value(&values, "low"), "(%f, %f, %f)", box.low.x, box.low.y, box.low.z);
    put_text(add_value(&values, "high"), "(%f, %f, %f)", box.high.x, box.high.y, box.high.z);
    text_puts(add_value(&values, "colors_of"),
              group->params->appearance->colors ? "vertex" : "constant");
    add_count(&values, "order", kind->order);
    add_count(&values, "tree", kind->tree + 1);
    add_part(&values, "points", put_points, group);
    add_part(&values, "widths", put_widths, group);
    add_part(&values, "colors", put_colors, group);
    add_part(&values, "segments", put_segment_ids, group);
    return values_expand(&values, group->params, "usd/curves.usda", out, err);
}

static Status put_groups(Text *out, const void *context, Err *err)
{
    CurveGroup group = *(const CurveGroup *)context;
    for (; group.begin < group.curves->n; group.begin = group.end) {
        group.end = curves_group_end(group.curves, group.begin);
        TRY(put_group(&group, out, err));
    }
    return text_check(out, err);
}

Status usd_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    Curves curves;
    TRY(curves_find(params, NULL, &curves, err));
    CurveGroup group = {.params = params, .curves = &curves};
    Values values = {0};
    add_quoted(&values, "command", params->command);
    add_quoted(&values, "generator", params->generator);
    add_quoted(&values, "description", params->description);
    add_part(&values, "curves", put_groups, &group);
    Status status = values_expand(&values, params, "usd/tree.usda", to->file, err);
    curves_release(&curves);
    return status;
}
