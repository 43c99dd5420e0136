/* Writes a Python script for Blender. The template holds the functions of the script; this file
 * appends calls with numbers. A spline in Blender has no color, only a material, and an object
 * should have few materials. If the segments have more than MAX_MATERIALS different colors, colors
 * that agree in the leading bits of their codes share a material. The number of bits is the largest
 * that gives at most MAX_MATERIALS materials. */
#include "emit/curves.h"
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"

#include <stdlib.h>

/* More materials show finer steps of color, but make the list of materials in Blender too long to
 * work with. */
enum { MAX_MATERIALS = 64 };

typedef struct Script {
    const EmitParams *params;
    Curves curves;
    uint32_t *paints;     /* per segment: index of its material; owned */
    uint32_t *painted;    /* per material: a segment that has it; owned */
    uint64_t *color_keys; /* per segment: the leading bits of its color, and its index; sorted;
                           * owned */
    size_t n_materials;
} Script;

static int compare_keys(const void *a, const void *b)
{
    const uint64_t *one = a, *other = b;
    return (*one > *other) - (*one < *other);
}

/* Sorts color_keys by the `bits` leading bits of each color code. Returns the number of different
 * colors in these bits. */
static size_t sort_colors(Script *script, int bits)
{
    size_t n = script->params->vessels->n_segments, found = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint8_t codes[3];
        vessel_color_codes(script->params, i, codes);
        uint64_t key = 0;
        for (int k = 0; k < 3; k++)
            key = key << 8 | codes[k] >> (8 - bits);
        script->color_keys[i] = key << 32 | i;
    }
    qsort(script->color_keys, n, sizeof *script->color_keys, compare_keys);
    for (size_t i = 0; i < n; i++)
        found += i == 0 || script->color_keys[i] >> 32 != script->color_keys[i - 1] >> 32;
    return found;
}

/* Reduces the colors to at most MAX_MATERIALS materials, and notes the material of each segment. */
static Status find_materials(Script *script, Err *err)
{
    size_t n = script->params->vessels->n_segments;
    int bits = 8;
    TRY(mem_calloc(&script->paints, n, sizeof *script->paints, "materials", err));
    TRY(mem_calloc(&script->painted, n, sizeof *script->painted, "materials", err));
    TRY(mem_calloc(&script->color_keys, n, sizeof *script->color_keys, "materials", err));
    while (sort_colors(script, bits) > MAX_MATERIALS)
        bits--;
    for (size_t i = 0; i < n; i++) {
        uint32_t segment = (uint32_t)script->color_keys[i];
        if (i == 0 || script->color_keys[i] >> 32 != script->color_keys[i - 1] >> 32)
            script->painted[script->n_materials++] = segment;
        script->paints[segment] = (uint32_t)script->n_materials - 1;
    }
    return STATUS_OK;
}

static void put_material(Text *out, const void *context, size_t i)
{
    const Script *script = context;
    Rgb color = vessel_color(script->params, script->painted[i]);
    text_puts(out, "(\"vessel_");
    put_color_code(out, script->params, script->painted[i]);
    put_triple(out, "\", (", (const float[3]){color.r, color.g, color.b}, ", ", ")),\n");
}

static void put_spline(const Script *script, size_t curve, Text *out)
{
    const Curves *curves = &script->curves;
    put_text(out, "(%u, %u, [", curve_kind(curves, curve)->paint,
             script->params->vessels->ids[curve_segment(curves, curve, 0)]);
    for (size_t i = 0; i < curve_points(curves, curve); i++) {
        Vec3 at = curve_point(curves, curve, i);
        put_text(out, i ? ", %f, %f, %f, %f" : "%f, %f, %f, %f", at.x, at.y, at.z,
                 curve_radius(curves, curve, i));
    }
    text_puts(out, "]),\n");
}

/* Appends one call per object: the curves of one kind. */
static Status put_vessels(Text *out, const void *context, Err *err)
{
    const Script *script = context;
    const Curves *curves = &script->curves;
    for (size_t curve = 0, end; curve < curves->n; curve = end) {
        const CurveKind *kind = curve_kind(curves, curve);
        end = curves_group_end(curves, curve);
        text_puts(out, "vessels(\"");
        curves_put_name(script->params, kind, out);
        put_text(out, "\", %u, %u, [\n", kind->tree + 1, kind->order);
        for (size_t i = curve; i < end; i++)
            put_spline(script, i, out);
        text_puts(out, "])\n");
    }
    return text_check(out, err);
}

static Status put_script(Script *script, Text *out, Err *err)
{
    const EmitParams *params = script->params;
    Values values = {0};
    add_about(&values, params, vessels_box(params->vessels), vec3(0, 0, 0));
    add_word(&values, "input", params->file, "");
    add_number(&values, "roughness", microfacet_roughness(&params->appearance->finish));
    add_quoted(&values, "quoted_command", params->command);
    add_list(&values, "materials", put_material, script, script->n_materials);
    add_part(&values, "vessels", put_vessels, script);
    return values_expand(&values, params, "blender/tree.py", out, err);
}

Status blender_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    Script script = {.params = params};
    Status status;
    TRY_GOTO(find_materials(&script, err));
    TRY_GOTO(curves_find(params, script.paints, &script.curves, err));
    TRY_GOTO(put_script(&script, to->file, err));
done:
    curves_release(&script.curves);
    free(script.paints);
    free(script.painted);
    free(script.color_keys);
    return status;
}
