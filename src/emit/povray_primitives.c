/* A union of one macro call for each primitive; POV-Ray warns of a union of one alone. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

static void put_primitive(Text *text, const EmitParams *params, const Primitive *primitive)
{
    bool cylinder = primitive->kind == PRIMITIVE_CYLINDER;
    text_puts(text, cylinder ? "Vessel_Cylinder(" : "Vessel_Sphere(");
    put_vector(text, primitive->a);
    if (cylinder) {
        text_puts(text, ",");
        put_vector(text, primitive->b);
    }
    text_puts(text, ",");
    text_number(text, primitive->radius_mm);
    text_puts(text, ",");
    put_paint(text, params, primitive->segment);
    text_puts(text, ")\n");
}

static Status put_calls(Text *out, void *context, Err *err)
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

Status put_primitives(Text *out, PovrayGeometry *geometry, Err *err)
{
    bool alone = geometry->objects[geometry->object].n == 1;
    return put_declaration(out, geometry, alone ? "object" : "Tree_Of()", put_calls, err);
}

Status put_primitive_macros(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {0};
    return values_expand(&values, geometry->params, "povray/primitives.inc", out, err);
}
