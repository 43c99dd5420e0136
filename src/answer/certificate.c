/* Lists end with null, so that every item is followed by a comma. */
#include "answer/certificate.h"

static void put_numbers(Text *out, const double *numbers, size_t n)
{
    text_printf(out, "[");
    for (size_t i = 0; i < n; i++)
        text_printf(out, "%s%.17g", i ? "," : "", numbers[i]);
    text_printf(out, "],");
}

static void put_vector(Text *out, const char *name, Vec3 v)
{
    text_printf(out, "\"%s\":", name);
    put_numbers(out, (const double[]){v.x, v.y, v.z}, 3);
}

static void put_color(Text *out, const char *name, Rgb color)
{
    put_vector(out, name, vec3((double)color.r, (double)color.g, (double)color.b));
}

static void put_finish(Text *out, const char *name, const Finish *f)
{
    const float exponent = 1 / f->roughness;
    const double numbers[] = {(double)f->ambient, (double)f->diffuse,    (double)f->brilliance,
                              (double)f->phong,   (double)f->phong_size, (double)f->specular,
                              (double)exponent};
    text_printf(out, "\"%s\":", name);
    put_numbers(out, numbers, sizeof numbers / sizeof *numbers);
}

static void put_light(Text *out, const Light *light, bool shadows)
{
    text_printf(out, "{\"parallel\":%d,\"shadows\":%d,\"samples\":%d,", light->parallel,
                shadows && light->casts_shadows, light->samples);
    put_vector(out, "location", light->location);
    put_vector(out, "target", light->target);
    put_color(out, "color", light->color);
    text_printf(out, "\"end\":0},\n");
}

static void put_ground(Text *out, const Ground *ground)
{
    if (!ground->present) {
        text_printf(out, "\"ground\":null,");
        return;
    }
    text_printf(out, "\"ground\":{\"offset\":%.17g,", ground->offset_mm);
    put_vector(out, "normal", ground->normal);
    put_color(out, "color", ground->color);
    put_finish(out, "finish", &ground->finish);
    text_printf(out, "\"end\":0},");
}

void certificate_put_scene(const AnswerPlan *plan, Text *out)
{
    const Scene *scene = plan->scene;
    const View *view = &scene->view;
    const Camera *camera = &view->camera;
    text_printf(out, "{\"pattern\":%d,\"perspective\":%d,\"size\":[%d,%d],\n", plan->params.pattern,
                camera->projection == PROJECTION_PERSPECTIVE, camera->width, camera->height);
    put_vector(out, "location", camera->location);
    put_vector(out, "right", camera->right);
    put_vector(out, "up", camera->up);
    put_vector(out, "direction", camera->direction);
    put_color(out, "background", view->background);
    put_finish(out, "finish", &scene->appearance.finish);
    text_printf(out, "\n\"fade\":");
    put_numbers(out,
                (const double[]){view->fade.nearest, view->fade.farthest, view->fade.near_mm,
                                 view->fade.far_mm},
                4);
    put_ground(out, &view->ground);
    text_printf(out, "\"lights\":[\n");
    for (size_t i = 0; i < view->n_lights; i++)
        put_light(out, &view->lights[i], plan->params.shadows);
    text_printf(out, "null],\"solids\":[\n");
    for (size_t i = 0; i < scene->geometry.n_primitives; i++) {
        const Primitive *primitive = &scene->geometry.primitives[i];
        text_printf(out, "{\"ball\":%d,\"radius\":%.17g,", primitive->kind == PRIMITIVE_SPHERE,
                    primitive->radius_mm);
        put_vector(out, "a", primitive->a);
        put_vector(out, "b", primitive->b);
        put_color(out, "color", appearance_color(&scene->appearance, primitive->segment));
        text_printf(out, "\"end\":0},\n");
    }
    text_printf(out, "null],\"pixels\":[\n");
}

void certificate_put_form(Text *out, const LeafPolygon *polygon, const FormColor *color,
                          double weight)
{
    if (!out)
        return;
    text_printf(out, "{\"weight\":%.17g,\"polygon\":[", weight);
    for (int i = 0; i < polygon->n; i++)
        put_numbers(out, (const double[]){polygon->x[i], polygon->y[i]}, 2);
    text_printf(out, "null],\"form\":[");
    for (int c = 0; c < 3; c++) {
        const Form f = color->channels[c];
        put_numbers(out, (const double[]){f.c, f.x, f.y, f.e}, 4);
    }
    text_printf(out, "null]},\n");
}

void certificate_put_span(Text *out, double area, const ColorSpan *span)
{
    if (!out)
        return;
    text_printf(out, "{\"area\":%.17g,\"low\":", area);
    put_numbers(out, span->low, 3);
    text_printf(out, "\"high\":");
    put_numbers(out, span->high, 3);
    text_printf(out, "\"end\":0},\n");
}

static void put_leaf(AnswerWork *work, int i, int j, AreaLeaf *leaf, Text *out)
{
    const LeafPolygon polygon = arealeaf_polygon(leaf);
    text_printf(out, "{\"at\":");
    put_numbers(out, (const double[]){i + 0.5 + leaf->x, j + 0.5 + leaf->y}, 2);
    text_printf(out, "\"along\":");
    put_numbers(out, leaf->along, 2);
    text_printf(out, "\"across\":");
    put_numbers(out, leaf->across, 2);
    text_printf(out, "\"polygon\":[");
    for (int k = 0; k < polygon.n; k++)
        put_numbers(out, (const double[]){polygon.x[k], polygon.y[k]}, 2);
    text_printf(out, "null],\"parts\":[\n");
    work->record = out;
    arealeaf_measure(work, i, j, leaf);
    work->record = NULL;
    text_printf(out, "null],\"low\":");
    put_numbers(out, leaf->low, 3);
    text_printf(out, "\"high\":");
    put_numbers(out, leaf->high, 3);
    text_printf(out, "\"end\":0},\n");
}

void certificate_put_pixel(AnswerWork *work, int i, int j, const ColorSpan *span, Text *out)
{
    text_printf(out, "{\"pixel\":[%d,%d],\"low\":", i, j);
    put_numbers(out, span->low, 3);
    text_printf(out, "\"high\":");
    put_numbers(out, span->high, 3);
    text_printf(out, "\"leaves\":[\n");
    for (size_t k = 0; k < work->heap.n && work->plan->params.pattern == 0; k++)
        put_leaf(work, i, j, &work->leaves.items[work->heap.items[k].value], out);
    text_printf(out, "null]},\n");
}
