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
    const EmitParams *params;
    const Scene *scene;
    CylinderEnd *ends; /* in order of place; owned */
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

void put_point(Text *text, Vec3 v)
{
    text_puts(text, "[");
    text_number(text, v.x + 0); /* adding 0 turns -0 into 0 */
    text_puts(text, ",");
    text_number(text, v.y + 0);
    text_puts(text, ",");
    text_number(text, v.z + 0);
    text_puts(text, "]");
}

static void put_rgb(Text *text, Rgb color)
{
    char r[NUMBER_TEXT_SIZE], g[NUMBER_TEXT_SIZE], b[NUMBER_TEXT_SIZE];
    text_printf(text, "[%s,%s,%s]", number_text_float(color.r, r), number_text_float(color.g, g),
                number_text_float(color.b, b));
}

/* The radius, what follows it, and the colour, if there is more than one. */
static void put_rest(Text *text, const Scene *scene, const Primitive *primitive,
                     const Vec3 *outwards)
{
    text_puts(text, ",");
    text_number(text, primitive->radius_mm);
    if (outwards) {
        text_puts(text, ",");
        put_point(text, *outwards);
    }
    if (scene->appearance.colors) {
        text_puts(text, ",");
        put_rgb(text, scene->appearance.colors[primitive->segment]);
    }
    text_puts(text, ");\n");
}

static void put_vessel(Text *text, const Scene *scene, const Primitive *cylinder)
{
    text_printf(text, "  vessel(%u,", scene->geometry.ids[cylinder->segment]);
    put_point(text, cylinder->a);
    text_puts(text, ",");
    put_point(text, cylinder->b);
    put_rest(text, scene, cylinder, NULL);
}

static void put_ball(Text *text, const Parametric *made, const Primitive *ball)
{
    const CylinderEnd *first;
    size_t n = ends_at(made, ball->a, &first);
    text_puts(text, n == 1 ? "  end(" : n == 2 ? "  bend(" : "  bifurcation(");
    put_point(text, ball->a);
    put_rest(text, made->scene, ball, n == 1 ? &first->outwards : NULL);
}

static Status put_calls(Text *out, void *context, Err *err)
{
    const Parametric *made = context;
    for (size_t i = 0; i < made->scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &made->scene->geometry.primitives[i];
        if (primitive->kind == PRIMITIVE_CYLINDER)
            put_vessel(out, made->scene, primitive);
        else
            put_ball(out, made, primitive);
    }
    return text_check(out, err);
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

Status openscad_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                      Err *err)
{
    (void)second;
    const Scene *scene = params->scene;
    Parametric made = {.params = params, .scene = scene};
    Values values = {0};
    TRY(find_ends(&made, err));
    const Geometry *shape = &scene->geometry;
    const Box bounds = {vec3_add(shape->bounds.low, shape->origin),
                        vec3_add(shape->bounds.high, shape->origin)};
    add_file(&values, params->file, ".stl", "");
    add_about(&values, params, bounds, vec3(0, 0, 0));
    text_printf(add_value(&values, "count"), "%zu", shape->drawn);
    text_printf(add_value(&values, "quick"), "%d", OPENSCAD_QUICK);
    text_printf(add_value(&values, "seconds"), "%.2g", openscad_seconds(scene));
    text_printf(add_value(&values, "max_radius"), "%.2g", largest_radius(scene));
    put_rgb(add_value(&values, "color"), scene->appearance.color);
    put_point(add_value(&values, "origin"), scene->geometry.origin);
    put_point(add_value(&values, "low"), scene->geometry.bounds.low);
    put_point(add_value(&values, "high"), scene->geometry.bounds.high);
    add_part(&values, "calls", put_calls, &made);
    report->openscad_s = openscad_seconds(scene);
    Status status = values_expand(&values, params, "openscad/parametric.scad", out, err);
    free(made.ends);
    return status;
}
