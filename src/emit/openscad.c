/* A model in OpenSCAD's own manner: one call for each vessel and for each place where vessels meet
 * or end, of modules that the template defines, so that all of it answers to the customizer.
 *
 * A scene of cylinders and balls has no nodes, but its balls lie where cylinders begin and end, to
 * the last bit: how many do tells a bifurcation from a bend and an end. */
#include "emit/rows.h"
#include "emit/values.h"

#include <stdlib.h>
#include <string.h>

/* What OpenSCAD 2021.01 takes for each cylinder and ball of 12 sides, the mean of trees of 5 to 100
 * vessels. */
static const double seconds_a_primitive = 0.3;

/* An end of a cylinder, and the direction in which it leaves it, unit. */
typedef struct CylinderEnd {
    Vec3 at, outwards;
} CylinderEnd;

typedef struct Parametric {
    const Scene *scene;
    CylinderEnd *ends; /* sorted by position; owned */
    size_t n_ends;
} Parametric;

static int by_place(const void *a, const void *b)
{
    const Vec3 *p = &((const CylinderEnd *)a)->at, *q = &((const CylinderEnd *)b)->at;
    for (int axis = 0; axis < 3; axis++) {
        double x = vec3_component(*p, axis), y = vec3_component(*q, axis);
        if (x != y)
            return x < y ? -1 : 1;
    }
    return 0;
}

static Status find_ends(Parametric *made, Err *err)
{
    const Scene *scene = made->scene;
    TRY(mem_calloc(&made->ends, 2 * scene->geometry.n_primitives, sizeof *made->ends, "ends", err));
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &scene->geometry.primitives[i];
        if (primitive->kind != PRIMITIVE_CYLINDER)
            continue;
        Vec3 along = vec3_normalized(vec3_sub(primitive->b, primitive->a));
        made->ends[made->n_ends++] = (CylinderEnd){primitive->b, along};
        made->ends[made->n_ends++] = (CylinderEnd){primitive->a, vec3_scale(along, -1)};
    }
    qsort(made->ends, made->n_ends, sizeof *made->ends, by_place);
    return STATUS_OK;
}

/* How many cylinders end at a point, and the first of these ends. */
static size_t ends_at(const Parametric *made, Vec3 point, const CylinderEnd **first)
{
    const CylinderEnd key = {.at = point};
    const CylinderEnd *last = made->ends + made->n_ends;
    *first = bsearch(&key, made->ends, made->n_ends, sizeof key, by_place);
    if (!*first)
        return 0;
    while (*first > made->ends && by_place(*first - 1, &key) == 0)
        (*first)--;
    size_t n = 0;
    while (*first + n < last && by_place(*first + n, &key) == 0)
        n++;
    return n;
}

/* ---- calls ----------------------------------------------------------------------------------- */

/* Appends the radius, what follows it, and the color if vessels differ in color. */
static void put_rest(Text *text, const Scene *scene, const Primitive *primitive,
                     const Vec3 *outwards)
{
    put_text(text, ",%n", primitive->radius_mm);
    if (outwards)
        put_text(text, ",[%v]", *outwards);
    if (scene->appearance.colors)
        put_text(text, ",[%c]", scene->appearance.colors[primitive->segment]);
    text_puts(text, ");\n");
}

static void put_call(Text *out, const void *context, size_t i)
{
    const Parametric *made = context;
    const Primitive *primitive = &made->scene->geometry.primitives[i];
    if (primitive->kind == PRIMITIVE_CYLINDER) {
        put_text(out, "  vessel(%u,[%v],[%v]", made->scene->geometry.ids[primitive->segment],
                 primitive->a, primitive->b);
        put_rest(out, made->scene, primitive, NULL);
        return;
    }
    const CylinderEnd *first;
    size_t n = ends_at(made, primitive->a, &first);
    put_text(out, "  %s([%v]", n == 1 ? "end" : n == 2 ? "bend" : "bifurcation", primitive->a);
    put_rest(out, made->scene, primitive, n == 1 ? &first->outwards : NULL);
}

/* ---- the file -------------------------------------------------------------------------------- */

/* About how long CGAL takes to unite them, with 12 sides. */
static double openscad_seconds(const Scene *scene)
{
    return seconds_a_primitive * (double)scene->geometry.n_primitives;
}

static double largest_radius(const Scene *scene)
{
    double largest = 0;
    for (size_t i = 0; i < scene->geometry.n_primitives; i++)
        largest = fmax(largest, scene->geometry.primitives[i].radius_mm);
    return largest;
}

Status openscad_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    const Scene *scene = params->scene;
    Parametric made = {.scene = scene};
    Values values = {.digits = params->digits};
    TRY(find_ends(&made, err));
    const Geometry *shape = &scene->geometry;
    const Box bounds = {vec3_add(shape->bounds.low, shape->origin),
                        vec3_add(shape->bounds.high, shape->origin)};
    add_file(&values, params->file, ".stl", "");
    add_about(&values, params, bounds, vec3(0, 0, 0));
    add_count(&values, "count", shape->drawn);
    add_count(&values, "quick", OPENSCAD_QUICK);
    text_printf(add_value(&values, "seconds"), "%.2g", openscad_seconds(scene));
    text_printf(add_value(&values, "max_radius"), "%.2g", largest_radius(scene));
    put_text(add_value(&values, "color"), "[%c]", scene->appearance.color);
    put_text(add_value(&values, "origin"), "[%v]", shape->origin);
    put_text(add_value(&values, "low"), "[%v]", shape->bounds.low);
    put_text(add_value(&values, "high"), "[%v]", shape->bounds.high);
    add_list(&values, "calls", put_call, &made, shape->n_primitives);
    to->report->openscad_s = openscad_seconds(scene);
    Status status = values_expand(&values, params, "openscad/parametric.scad", to->file, err);
    free(made.ends);
    return status;
}
