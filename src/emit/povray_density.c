/* Writes a scene with a box that contains a medium. The density of the medium is read from a file.
 * The camera is orthographic, and a pixel is as large as a voxel. The emission is such that a ray
 * through a full diameter of the thickest vessel collects a brightness of 1. */
#include "emit/emit.h"
#include "emit/rows.h"
#include "emit/values.h"

/* Appends a camera that looks straight at the front of the box. The picture is as wide and as high
 * as the box. */
static Status put_camera(Text *out, const void *context, Err *err)
{
    Values values = {0};
    add_flag(&values, "perspective", false);
    text_puts(add_value(&values, "location"), "Glow_Center + z * vlength(Glow_Size)");
    text_puts(add_value(&values, "look_at"), "Glow_Center");
    text_puts(add_value(&values, "right"), "x * Glow_Size.x");
    text_puts(add_value(&values, "up"), "y * Glow_Size.y");
    text_puts(add_value(&values, "direction"), "-z");
    text_puts(add_value(&values, "width"), "Glow_Size.x / Camera_Distance");
    text_puts(add_value(&values, "height"), "Glow_Size.y / Camera_Distance");
    return values_expand(&values, context, "povray/camera.inc", out, err);
}

Status emit_density(const EmitParams *params, const DensityBox *density, Text *out, Err *err)
{
    const int64_t *n = density->n;
    int64_t most = n[0] > n[1] ? n[0] : n[1];
    Values values = {0};
    most = n[2] > most ? n[2] : most;
    TRY(povray_check_name(params->second_file, err));
    add_file(&values, params->file, ".png", "\"");
    add_about(&values, params, density->box, density->origin);
    text_puts(add_value(&values, "density_file"), params->second_file);
    add_count(&values, "width", (size_t)n[0]);
    add_count(&values, "height", (size_t)n[1]);
    add_count(&values, "samples", (size_t)most);
    add_number(&values, "emission", 1 / density->thickest_mm);
    put_text(add_value(&values, "low"), "<%v>", density->box.low);
    put_text(add_value(&values, "high"), "<%v>", density->box.high);
    add_part(&values, "camera", put_camera, params);
    return values_expand(&values, params, "povray/density.pov", out, err);
}
