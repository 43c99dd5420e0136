/* Writes cylinders, balls and joints for POV-Ray as a union with one macro call per primitive. A
 * single primitive is not put into a union, because POV-Ray warns about a union of one object. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

static void put_primitive(Text *text, const EmitParams *params, const Primitive *primitive)
{
    if (primitive->kind == PRIMITIVE_CYLINDER)
        put_text(text, "Vessel_Cylinder(<%v>,<%v>,%n", primitive->a, primitive->b,
                 primitive->radius_mm);
    else
        put_text(text, "Vessel_Sphere(<%v>,%n", primitive->a, primitive->radius_mm);
    if (params->scene->appearance.radius_factors)
        put_text(text, "*Frame_Widths[%u]", primitive->segment);
    text_puts(text, ",");
    put_paint(text, params, primitive->segment);
    text_puts(text, ")\n");
}

static Status put_calls(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems *items = &geometry->objects[geometry->object];
    for (size_t i = 0; i < items->n; i++) {
        const Primitive *primitive = &geometry->scene->geometry.primitives[items->index[i]];
        if (primitive->kind == PRIMITIVE_JOINT)
            put_joint(out, geometry->params, primitive);
        else
            put_primitive(out, geometry->params, primitive);
    }
    return text_check(out, err);
}

Status put_primitives(Text *out, const PovrayGeometry *geometry, Err *err)
{
    const bool alone = geometry->objects[geometry->object].n == 1;
    return put_declaration(out, geometry, alone ? "object" : "Tree_Of()", put_calls, err);
}

Status put_primitive_macros(Text *out, const void *geometry, Err *err)
{
    return put_template(((const PovrayGeometry *)geometry)->params, "povray/primitives.inc", out,
                        err);
}

Status put_primitive_and_joint_macros(Text *out, const void *geometry, Err *err)
{
    TRY(put_primitive_macros(out, geometry, err));
    return put_joint_macros(out, geometry, err);
}
