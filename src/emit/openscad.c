/* Writes a parametric model for OpenSCAD: a variable for each node and each radius, and calls of
 * modules that the template defines. The calls refer to the variables, so that a user who moves a
 * node also moves its vessels, its joint and its end.
 *
 * The primitives of a scene have no nodes. The nodes are recovered from positions: the centre of a
 * ball is exactly equal, to the last bit, to the ends of the cylinders that meet there. One such
 * cylinder end means an end of the tree, two mean a bend, and more mean a bifurcation.
 *
 * put_text has conversions of its own: %v appends a vector, %n a number, %c a color. */
#include "emit/rows.h"
#include "emit/values.h"

#include <stdlib.h>
#include <string.h>

/* Time that OpenSCAD 2021.01 takes per cylinder or ball of 12 sides, s. Measured: the mean over
 * trees of 5 to 100 vessels. */
static const double seconds_per_primitive = 0.3;

/* An end of a cylinder. */
typedef struct CylinderEnd {
    Vec3 at;
    uint32_t cylinder; /* index of a primitive */
    bool is_far;       /* the distal end, farther from the root */
} CylinderEnd;

/* The scene, and the table by which nodes are found. */
typedef struct Parametric {
    const Scene *scene;
    CylinderEnd *ends; /* sorted by position, far ends first; owned */
    size_t n_ends;
} Parametric;

static int compare_positions(const void *a, const void *b)
{
    const Vec3 *p = &((const CylinderEnd *)a)->at, *q = &((const CylinderEnd *)b)->at;
    const int x = compare_numbers(p->x, q->x), y = compare_numbers(p->y, q->y);
    return x ? x : y ? y : compare_numbers(p->z, q->z);
}

static int compare_ends(const void *a, const void *b)
{
    const CylinderEnd *p = a, *q = b;
    const int order = compare_positions(a, b), end = compare_numbers(q->is_far, p->is_far);
    return order ? order : end ? end : compare_numbers(p->cylinder, q->cylinder);
}

/* Lists the ends of all cylinders by position. */
static Status find_ends(Parametric *model, Err *err)
{
    const Scene *scene = model->scene;
    TRY(mem_calloc(&model->ends, 2 * scene->geometry.n_primitives, sizeof *model->ends, "ends",
                   err));
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &scene->geometry.primitives[i];
        if (primitive->kind != PRIMITIVE_CYLINDER)
            continue;
        model->ends[model->n_ends++] = (CylinderEnd){primitive->a, (uint32_t)i, false};
        model->ends[model->n_ends++] = (CylinderEnd){primitive->b, (uint32_t)i, true};
    }
    qsort(model->ends, model->n_ends, sizeof *model->ends, compare_ends);
    return STATUS_OK;
}

/* Returns the number of cylinder ends at a point. Sets *first to the first of them in model->ends;
 * NULL if there is none. */
static size_t ends_at(const Parametric *model, Vec3 point, const CylinderEnd **first)
{
    const CylinderEnd key = {.at = point};
    const CylinderEnd *last = model->ends + model->n_ends;
    *first = bsearch(&key, model->ends, model->n_ends, sizeof key, compare_positions);
    if (!*first)
        return 0;
    while (*first > model->ends && compare_positions(*first - 1, &key) == 0)
        (*first)--;
    size_t n = 0;
    while (*first + n < last && compare_positions(*first + n, &key) == 0)
        n++;
    return n;
}

/* ---- variables ------------------------------------------------------------------------------- */

static uint32_t id_of(const Parametric *model, uint32_t cylinder)
{
    const Geometry *geometry = &model->scene->geometry;
    return geometry->ids[geometry->primitives[cylinder].segment];
}

/* Appends the name of the variable of a node. `first` is the first cylinder end at the node. The
 * name is "p" and the id of the segment that ends there; at a root, where no segment ends, "start"
 * and the id of the first segment that begins there. */
static void put_node(Text *out, const Parametric *model, const CylinderEnd *first)
{
    put_text(out, first->is_far ? "p%u" : "start%u", id_of(model, first->cylinder));
}

static void put_node_at(Text *out, const Parametric *model, Vec3 at)
{
    const CylinderEnd *first;
    ends_at(model, at, &first);
    put_node(out, model, first);
}

/* Declares the variables of a cylinder: its radius, and the nodes whose names contain its id. */
static void put_variables(Text *out, const void *context, size_t i)
{
    const Parametric *model = context;
    const Primitive *primitive = &model->scene->geometry.primitives[i];
    if (primitive->kind != PRIMITIVE_CYLINDER)
        return;
    const Vec3 node[] = {primitive->a, primitive->b};
    for (int k = 0; k < 2; k++) {
        const CylinderEnd *first;
        ends_at(model, node[k], &first);
        if (first->cylinder != i || first->is_far != (k == 1))
            continue;
        put_node(out, model, first);
        put_text(out, " = [%v];\n", node[k]);
    }
    put_text(out, "r%u = %n;\n", id_of(model, (uint32_t)i), primitive->radius_mm);
}

/* Appends each end of a cylinder as a pair of a node and a radius. */
static void put_ends(Text *out, const void *context, size_t i)
{
    const Parametric *model = context;
    const Primitive *primitive = &model->scene->geometry.primitives[i];
    for (int k = 0; primitive->kind == PRIMITIVE_CYLINDER && k < 2; k++) {
        text_puts(out, "  [");
        put_node_at(out, model, k ? primitive->b : primitive->a);
        put_text(out, ",r%u],\n", id_of(model, (uint32_t)i));
    }
}

/* ---- calls ----------------------------------------------------------------------------------- */

/* Appends the color if vessels differ in color, and ends the call. */
static void put_end_of_call(Text *text, const Scene *scene, const Primitive *primitive)
{
    if (scene->appearance.meaning)
        put_text(text, ",[%c]", scene->appearance.colors[primitive->segment]);
    text_puts(text, ");\n");
}

static void put_vessel(Text *out, const Parametric *model, size_t i)
{
    const Primitive *primitive = &model->scene->geometry.primitives[i];
    const uint32_t id = id_of(model, (uint32_t)i);
    put_text(out, "  vessel(%u,", id);
    put_node_at(out, model, primitive->a);
    text_puts(out, ",");
    put_node_at(out, model, primitive->b);
    put_text(out, ",r%u", id);
    put_end_of_call(out, model->scene, primitive);
}

/* Appends the call that draws a ball. The ball's radius in the file is the maximum of the radius
 * variables of the cylinders that meet there; a number if there are none. */
static void put_joint(Text *out, const Parametric *model, const Primitive *ball)
{
    const CylinderEnd *end;
    const size_t n = ends_at(model, ball->a, &end);
    if (n == 0) { /* the ball of a segment of length 0 */
        put_text(out, "  bifurcation([%v],%n", ball->a, ball->radius_mm);
        put_end_of_call(out, model->scene, ball);
        return;
    }
    put_text(out, "  %s(", n == 1 ? "end" : n == 2 ? "bend" : "bifurcation");
    put_node(out, model, end);
    text_puts(out, n == 1 ? "," : ",max(");
    for (size_t k = 0; k < n; k++)
        put_text(out, k ? ",r%u" : "r%u", id_of(model, end[k].cylinder));
    text_puts(out, n == 1 ? "," : ")");
    if (n == 1) { /* the direction from the vessel to its end */
        const Primitive *cylinder = &model->scene->geometry.primitives[end->cylinder];
        put_node(out, model, end);
        text_puts(out, "-");
        put_node_at(out, model, end->is_far ? cylinder->a : cylinder->b);
    }
    put_end_of_call(out, model->scene, ball);
}

static void put_call(Text *out, const void *context, size_t i)
{
    const Parametric *model = context;
    const Primitive *primitive = &model->scene->geometry.primitives[i];
    if (primitive->kind == PRIMITIVE_CYLINDER)
        put_vessel(out, model, i);
    else
        put_joint(out, model, primitive);
}

/* ---- the file -------------------------------------------------------------------------------- */

/* Estimates the time in seconds that OpenSCAD takes to unite the primitives, with 12 sides each. */
static double openscad_seconds(const Scene *scene)
{
    return seconds_per_primitive * (double)scene->geometry.n_primitives;
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
    Parametric model = {.scene = scene};
    Values values = {.digits = params->digits};
    TRY(find_ends(&model, err));
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
    add_list(&values, "variables", put_variables, &model, shape->n_primitives);
    add_list(&values, "ends", put_ends, &model, shape->n_primitives);
    add_list(&values, "calls", put_call, &model, shape->n_primitives);
    to->report->openscad_s = openscad_seconds(scene);
    Status status = values_expand(&values, params, "openscad/parametric.scad", to->file, err);
    free(model.ends);
    return status;
}
