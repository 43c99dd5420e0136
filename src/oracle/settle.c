/* For a blob, the place, the normal, the segment and the shadows of a pixel are computed from the
 * field along its ray; of the renderer only the shading function is used, whose colours are
 * POV-Ray's at all other pixels. For another model the renderer draws the pixel twice more, through
 * a camera of one pixel: with shadow rays that count what they hit from 1e-3 mm on, as POV-Ray's
 * do, and from 1e-4 mm on, as its shadow cache does. */
#include "oracle/settle.h"

#include "field/field.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ASKED = 500 };

static const double first_slack_mm = 1e-3, cached_slack_mm = 1e-4;
/* A place so far from a root, in radii of the vessel, is still meant to be that root: where POV-Ray
 * misses one, its precision is gone. */
static const double same_root_radii = 0.02;
/* The cosine of ray and normal below which a ray grazes. POV-Ray misses roots mostly there, of
 * neighbouring rays too; where the field rises steeply, of one ray alone. */
static const double grazing_cosine = 0.1;
/* A's normals are known to 16-bit codes. */
static const double normal_slack = 2e-4;

/* What is between a place and a light. */
typedef struct Blockage {
    double part;       /* of the light, that arrives */
    double blocked_mm; /* from the place to the wall that a ray grazes most; NAN: none is there */
    double cosine;     /* of that ray and the wall's normal */
    int grazed;        /* points whose rays graze the first wall in their way */
} Blockage;

typedef struct Asker {
    const SettleCase *asked;
    View one; /* the view through one pixel, or in dimmer lights */
    Renderer *first,
        *cached;    /* of other models: with POV-Ray's limit, and that of its shadow cache */
    TermMean *mean; /* of a blob whose colours blend, or NULL */
    Blockage blockages[VIEW_MAX_LIGHTS]; /* of each light, to the place last asked about */
} Asker;

static ModelProof proof_of(const SettleCase *asked)
{
    return models[asked->scene->geometry.model].proof;
}

static void asker_release(Asker *asker)
{
    renderer_free(asker->first);
    renderer_free(asker->cached);
    termmean_free(asker->mean);
}

static Status new_renderer(Asker *asker, double shadow_from_mm, Renderer **out, Err *err)
{
    RenderParams params = *asker->asked->params;
    params.threads = 1;
    params.shadow_from_mm = shadow_from_mm;
    return renderer_new(&asker->asked->scene->geometry, &params, out, err);
}

static Status asker_init(Asker *asker, const SettleCase *asked, Err *err)
{
    asker->asked = asked;
    asker->one = asked->scene->view;
    if (proof_of(asked) == PROOF_FIELD)
        return asked->scene->appearance.places
                   ? termmean_new(&asked->scene->geometry, &asker->mean, err)
                   : STATUS_OK;
    TRY(new_renderer(asker, first_slack_mm, &asker->first, err));
    return new_renderer(asker, cached_slack_mm, &asker->cached, err);
}

/* ---- the shadow cache ------------------------------------------------------------------------ */

static Status draw_one(const Asker *asker, Renderer *renderer, Rgb *color, Err *err)
{
    Frame frame;
    TRY(renderer_rows(renderer, &asker->one, &asker->asked->scene->appearance, 0, 1, &frame, err));
    const float *values = frame.color.values;
    *color = (Rgb){values[0], values[1], values[2]};
    frame_release(&frame);
    return STATUS_OK;
}

/* Whether a side's colour lies between two others; of 16 bits, codes may be off by one. */
static bool lies_between(const Asker *asker, const Rendering *side, Rgb low, Rgb high, size_t pixel)
{
    const Picture *picture = side->picture;
    const float lows[3] = {low.r, low.g, low.b}, highs[3] = {high.r, high.g, high.b};
    int slack = picture->bits == 16;
    for (size_t c = 0; c < 3; c++) {
        int code = picture_code(picture, 3 * pixel + c);
        if (code < image_code(lows[c], asker->asked->encoding, picture->bits) - slack ||
            code > image_code(highs[c], asker->asked->encoding, picture->bits) + slack)
            return false;
    }
    return true;
}

static bool has_color(const Asker *asker, const Rendering *side, Rgb color, size_t pixel)
{
    return lies_between(asker, side, color, color, pixel);
}

static Status ask_cache(Asker *asker, size_t pixel, SettledPixel *found, Err *err)
{
    Rgb first, cached;
    asker->one.camera = camera_of_pixel(&asker->asked->scene->view.camera, found->x, found->y);
    TRY(draw_one(asker, asker->first, &first, err));
    TRY(draw_one(asker, asker->cached, &cached, err));
    if (has_color(asker, asker->asked->b, first, pixel) &&
        lies_between(asker, asker->asked->a, cached, first, pixel))
        found->cause = SETTLED_SHADOW_CACHE;
    return STATUS_OK;
}

/* ---- the field of a blob --------------------------------------------------------------------- */

static Status ask_field(const Asker *asker, Ray ray, double t_min, double t_max, BlobRoots *roots,
                        Err *err)
{
    const Geometry *geometry = &asker->asked->scene->geometry;
    return blob_roots(geometry->segments, geometry->n_segments, ray, t_min, t_max, roots, err);
}

/* The field's normal at `x`, against the ray, and the segment of the largest term there. */
static const FieldSegment *find_wall(const Asker *asker, Ray ray, Vec3 x, Vec3 *normal)
{
    const Geometry *geometry = &asker->asked->scene->geometry;
    const FieldSegment *largest = &geometry->segments[0];
    Vec3 sum = vec3(0, 0, 0);
    double most = -HUGE_VAL;
    for (size_t i = 0; i < geometry->n_segments; i++) {
        BlobComponent components[BLOB_COMPONENTS];
        Vec3 gradient;
        Ball ball = blob_ball(&geometry->segments[i]);
        if (vec3_distance(ball.center, x) > ball.radius)
            continue;
        blob_components(&blob_shape, &geometry->segments[i], components);
        double term = blob_components_at(components, x, &gradient);
        sum = vec3_add(sum, gradient);
        if (term > most) {
            most = term;
            largest = &geometry->segments[i];
        }
    }
    *normal = vec3_scale(vec3_normalized(sum), vec3_dot(sum, ray.direction) > 0 ? -1 : 1);
    return largest;
}

/* Whether the way from `place` to a light is free, by the field. */
static Status ask_way(const Asker *asker, Vec3 place, LightWay way, bool *free, Blockage *found,
                      Err *err)
{
    Ray ray = {place, way.towards};
    double far = way.distance - first_slack_mm, t;
    BlobRoots roots;
    Vec3 normal;
    *free = !ground_hit(&asker->asked->scene->view.ground, ray, first_slack_mm, far, &t);
    if (!*free)
        return STATUS_OK;
    TRY(ask_field(asker, ray, render_nearest_mm(&asker->asked->scene->geometry), far, &roots, err));
    *free = roots.n == 0;
    if (*free)
        return STATUS_OK;
    find_wall(asker, ray, ray_at(ray, roots.t[0]), &normal);
    double cosine = fabs(vec3_dot(normal, way.towards));
    found->grazed += cosine <= grazing_cosine;
    if (!(cosine >= found->cosine)) {
        found->cosine = cosine;
        found->blocked_mm = roots.t[0];
    }
    return STATUS_OK;
}

static Status ask_light(const Asker *asker, const Light *light, Vec3 place, Blockage *found,
                        Err *err)
{
    int n = light_points(light), reach = 0;
    *found = (Blockage){1, (double)NAN, (double)NAN, 0};
    if (!asker->asked->params->shadows || !light->casts_shadows)
        return STATUS_OK;
    for (int k = 0; k < n; k++) {
        bool free;
        TRY(ask_way(asker, place, light_way_to_point(light, k, place), &free, found, err));
        reach += free;
    }
    found->part = (double)reach / n;
    return STATUS_OK;
}

static Status ask_lights(Asker *asker, Vec3 place, Err *err)
{
    const View *view = &asker->asked->scene->view;
    for (size_t i = 0; i < view->n_lights; i++)
        TRY(ask_light(asker, &view->lights[i], place, &asker->blockages[i], err));
    return STATUS_OK;
}

/* Lights as bright as they arrive; that of number `brighter`, if there is one, by some points
 * more. */
static void set_lights(Asker *asker, size_t brighter, int more)
{
    const View *view = &asker->asked->scene->view;
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        double part = asker->blockages[i].part;
        if (i == brighter)
            part += (double)more / light_points(light);
        asker->one.lights[i].color =
            (Rgb){(float)((double)light->color.r * part), (float)((double)light->color.g * part),
                  (float)((double)light->color.b * part)};
    }
}

/* What a ray sees. */
typedef struct Look {
    double t; /* INFINITY where neither vessel nor ground is seen */
    ShadingInput at;
    uint32_t id; /* 0: the ground or nothing */
    Rgb color;
} Look;

/* The colour of what is seen, in the lights as they arrive and `more` samples of that of number
 * `brighter`. */
static Rgb lit(Asker *asker, const Look *seen, size_t brighter, int more)
{
    if (seen->t == HUGE_VAL)
        return asker->asked->scene->view.background;
    set_lights(asker, brighter, more);
    return shade(&asker->one, &seen->at, NULL, NULL);
}

/* The wall at `t`. */
static Look wall_at(const Asker *asker, Ray ray, double t)
{
    const Scene *scene = asker->asked->scene;
    Look seen = {.t = t, .at = {.point = ray_at(ray, t), .direction = ray.direction, .open = 1}};
    const FieldSegment *wall = find_wall(asker, ray, seen.at.point, &seen.at.normal);
    seen.id = scene->geometry.ids[wall->segment];
    seen.at.finish = &scene->appearance.finish;
    seen.at.pigment =
        asker->mean
            ? appearance_blended(&scene->appearance,
                                 termmean_at(asker->mean, scene->appearance.places, seen.at.point))
            : appearance_color(&scene->appearance, wall->segment);
    return seen;
}

/* What a ray sees that meets a wall at `t` and none before. Leaves in asker->blockages what
 * arrives there of each light. */
static Status look_to(Asker *asker, Ray ray, double t, Look *seen, Err *err)
{
    const Ground *ground = &asker->asked->scene->view.ground;
    if (ground_hit(ground, ray, cached_slack_mm, t, &t)) {
        bool below = vec3_dot(ground->normal, ray.direction) > 0;
        *seen = (Look){t,
                       {.finish = &ground->finish,
                        .pigment = ground->color,
                        .point = ray_at(ray, t),
                        .normal = vec3_scale(ground->normal, below ? -1 : 1),
                        .direction = ray.direction,
                        .open = 1},
                       0,
                       {0, 0, 0}};
    } else if (t < HUGE_VAL) {
        *seen = wall_at(asker, ray, t);
    } else {
        *seen = (Look){.t = HUGE_VAL};
    }
    if (t < HUGE_VAL)
        TRY(ask_lights(asker, seen->at.point, err));
    seen->color = lit(asker, seen, SIZE_MAX, 0);
    return STATUS_OK;
}

static double root_of(const BlobRoots *roots, int number)
{
    return number < roots->n ? roots->t[number] : HUGE_VAL;
}

/* One ray of a pixel. */
typedef struct Sample {
    Ray ray;
    BlobRoots roots;
    Look truth;
} Sample;

static int samples_of(const Asker *asker)
{
    int n = asker->asked->params->antialias;
    return n > 1 ? n * n + 1 : 1;
}

/* The pixel's middle first. */
static Ray sample_ray(const Asker *asker, int i, int j, int sample)
{
    const Camera *camera = &asker->asked->scene->view.camera;
    int n = asker->asked->params->antialias;
    if (sample == 0)
        return camera_ray(camera, i, j);
    return camera_ray(camera, i - 0.5 + ((sample - 1) % n + 0.5) / n,
                      j - 0.5 + ((sample - 1) / n + 0.5) / n);
}

/* The pixel's colour when one of its samples has another. */
static Rgb mean_with(const Asker *asker, const Sample *samples, int changed, Rgb color)
{
    int n = samples_of(asker);
    Rgb sum = {0, 0, 0};
    for (int s = 0; s < n; s++) {
        Rgb of = s == changed ? color : samples[s].truth.color;
        sum = (Rgb){sum.r + of.r, sum.g + of.g, sum.b + of.b};
    }
    double count = n;
    return (Rgb){(float)((double)sum.r / count), (float)((double)sum.g / count),
                 (float)((double)sum.b / count)};
}

/* Whether A's pixel is what it is when one sample has that colour. */
static bool explains(const Asker *asker, const Sample *samples, int changed, Rgb color,
                     size_t pixel)
{
    return has_color(asker, asker->asked->a, mean_with(asker, samples, changed, color), pixel);
}

static Status ask_sample(Asker *asker, Sample *sample, Err *err)
{
    TRY(ask_field(asker, sample->ray, render_nearest_mm(&asker->asked->scene->geometry), HUGE_VAL,
                  &sample->roots, err));
    return look_to(asker, sample->ray, root_of(&sample->roots, 0), &sample->truth, err);
}

static Vec3 normal_at(const Rendering *side, size_t pixel)
{
    const float *n = &side->normal->values[3 * pixel];
    return vec3((double)n[0], (double)n[1], (double)n[2]);
}

/* Whether B shows what the field says: place, normal, segment and colour. */
static bool native_is_right(const Asker *asker, const Sample *samples, size_t pixel)
{
    const Rendering *b = asker->asked->b;
    double t = (double)b->depth->values[pixel], root = root_of(&samples[0].roots, 0);
    if (isfinite(t) != isfinite(root))
        return false;
    if (isfinite(t)) {
        Look wall = wall_at(asker, samples[0].ray, root);
        if (!(fabs(t - root) <= 1e-6 + root * (double)FLT_EPSILON) ||
            !(vec3_distance(wall.at.normal, normal_at(b, pixel)) <= normal_slack) ||
            b->ids->ids[pixel] != wall.id)
            return false;
    }
    return has_color(asker, b, mean_with(asker, samples, 0, samples[0].truth.color), pixel);
}

static double radius_of(const Asker *asker, uint32_t id)
{
    const Geometry *geometry = &asker->asked->scene->geometry;
    for (size_t i = 0; i < geometry->n_segments; i++)
        if (geometry->ids[geometry->segments[i].segment] == id)
            return geometry->segments[i].radius_mm;
    return 0;
}

/* Whether A sees the wall at the root of that number, if not quite at its place. */
static bool sees_root(const Asker *asker, const Sample *sample, int number, size_t pixel)
{
    double t = (double)asker->asked->a->depth->values[pixel];
    if (number >= sample->roots.n || !isfinite(t))
        return false;
    Look wall = wall_at(asker, sample->ray, t);
    double radius = radius_of(asker, wall.id), rounding = t * (double)FLT_EPSILON / radius;
    return fabs(t - sample->roots.t[number]) <= same_root_radii * radius &&
           vec3_distance(wall.at.normal, normal_at(asker->asked->a, pixel)) <=
               normal_slack + rounding;
}

/* How much the ray of a sample grazes at its first root: the cosine to the normal; NAN without a
 * root. */
static double grazing_of(const Asker *asker, const Sample *sample)
{
    if (sample->roots.n == 0)
        return (double)NAN;
    Look wall = wall_at(asker, sample->ray, sample->roots.t[0]);
    return fabs(vec3_dot(wall.at.normal, sample->ray.direction));
}

/* Whether no neighbour of the pixel differs. */
static bool is_alone(const Asker *asker, const SettledPixel *found)
{
    const Camera *camera = &asker->asked->scene->view.camera;
    for (int y = found->y - 1; y <= found->y + 1; y++)
        for (int x = found->x - 1; x <= found->x + 1; x++) {
            bool inside = x >= 0 && x < camera->width && y >= 0 && y < camera->height;
            if (!inside || (x == found->x && y == found->y))
                continue;
            size_t pixel = (size_t)y * (size_t)camera->width + (size_t)x;
            if (pixel_beyond(asker->asked->a, asker->asked->b, pixel, asker->asked->tolerance))
                return false;
        }
    return true;
}

static bool may_miss(const Asker *asker, const SettledPixel *found, double cosine)
{
    return cosine <= grazing_cosine || (isfinite(cosine) && is_alone(asker, found));
}

/* Whether A sees a later root or nothing, where it may have missed the first. */
static void find_missed(const Asker *asker, const Sample *sample, size_t pixel, SettledPixel *found)
{
    double cosine = grazing_of(asker, sample);
    bool later = !isfinite(asker->asked->a->depth->values[pixel]);
    for (int k = 1; k < sample->roots.n && !later; k++)
        later = sees_root(asker, sample, k, pixel);
    if (!later || !may_miss(asker, found, cosine))
        return;
    found->cause = SETTLED_ROOT;
    found->cosine = cosine;
}

/* Whether A sees the first root but from a little before or behind it, and shows that place's
 * normal and colour. */
static Status ask_inexact(Asker *asker, const Sample *sample, size_t pixel, SettledPixel *found,
                          Err *err)
{
    double t = (double)asker->asked->a->depth->values[pixel];
    if (samples_of(asker) > 1 || !sees_root(asker, sample, 0, pixel))
        return STATUS_OK;
    double root = sample->roots.t[0], by = fabs(t - root) + 2 * t * (double)FLT_EPSILON;
    Rgb low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    TRY(ask_lights(asker, ray_at(sample->ray, root), err));
    for (int k = -1; k <= 1; k++) {
        Look wall = wall_at(asker, sample->ray, root + k * by);
        Rgb color = lit(asker, &wall, SIZE_MAX, 0);
        low = (Rgb){fminf(low.r, color.r), fminf(low.g, color.g), fminf(low.b, color.b)};
        high = (Rgb){fmaxf(high.r, color.r), fmaxf(high.g, color.g), fmaxf(high.b, color.b)};
    }
    if (lies_between(asker, asker->asked->a, low, high, pixel))
        found->cause = SETTLED_INEXACT_ROOT;
    return STATUS_OK;
}

/* Whether A is as if a light that rays graze had some more samples in sight, or any other one. */
static bool misses_of_light(Asker *asker, const Sample *samples, int s, size_t pixel,
                            const Look *seen, size_t light)
{
    int most = asker->blockages[light].grazed > 1 ? asker->blockages[light].grazed : 1;
    for (int more = 1; more <= most; more++)
        if (explains(asker, samples, s, lit(asker, seen, light, more), pixel))
            return true;
    return false;
}

/* Whether A is as if rays of a sample to one light had missed what is in their way. */
static Status ask_shadows(Asker *asker, const Sample *samples, int s, size_t pixel,
                          SettledPixel *found, Err *err)
{
    const Sample *sample = &samples[s];
    Look seen;
    TRY(look_to(asker, sample->ray, root_of(&sample->roots, 0), &seen, err));
    for (size_t i = 0; i < asker->asked->scene->view.n_lights && seen.t < HUGE_VAL; i++) {
        const Blockage *blockage = &asker->blockages[i];
        if (!may_miss(asker, found, blockage->cosine) ||
            !misses_of_light(asker, samples, s, pixel, &seen, i))
            continue;
        found->cause = SETTLED_SHADOW_ROOT;
        found->distance_mm = blockage->blocked_mm;
        found->cosine = blockage->cosine;
        return STATUS_OK;
    }
    return STATUS_OK;
}

/* Whether A is as if a sample had missed its first roots. */
static Status ask_later_roots(Asker *asker, const Sample *samples, int s, size_t pixel,
                              SettledPixel *found, Err *err)
{
    const Sample *sample = &samples[s];
    double cosine = grazing_of(asker, sample);
    for (int k = 1; k <= sample->roots.n && may_miss(asker, found, cosine); k++) {
        Look seen;
        TRY(look_to(asker, sample->ray, root_of(&sample->roots, k), &seen, err));
        if (!explains(asker, samples, s, seen.color, pixel))
            continue;
        found->cause = SETTLED_ROOT;
        found->cosine = cosine;
        return STATUS_OK;
    }
    return STATUS_OK;
}

static Status ask_samples(Asker *asker, Sample *samples, size_t pixel, unsigned beyond,
                          SettledPixel *found, Err *err)
{
    int n = samples_of(asker);
    for (int s = 0; s < n; s++) {
        samples[s].ray = sample_ray(asker, found->x, found->y, s);
        TRY(ask_sample(asker, &samples[s], err));
        if (!samples[s].roots.sure)
            return STATUS_OK;
    }
    if (samples[0].roots.n > 0)
        found->root_mm = samples[0].roots.t[0];
    if (!native_is_right(asker, samples, pixel))
        return STATUS_OK;
    if (beyond & BEYOND_GEOMETRY)
        find_missed(asker, &samples[0], pixel, found);
    if (found->cause == SETTLED_NOT)
        TRY(ask_inexact(asker, &samples[0], pixel, found, err));
    if (beyond & BEYOND_GEOMETRY)
        return STATUS_OK;
    for (int s = 0; s < n && found->cause == SETTLED_NOT; s++)
        TRY(ask_shadows(asker, samples, s, pixel, found, err));
    for (int s = 1; s < n && found->cause == SETTLED_NOT; s++)
        TRY(ask_later_roots(asker, samples, s, pixel, found, err));
    return STATUS_OK;
}

static Status ask_blob(Asker *asker, size_t pixel, unsigned beyond, SettledPixel *found, Err *err)
{
    Sample *samples;
    TRY(mem_calloc(&samples, (size_t)samples_of(asker), sizeof *samples, "samples", err));
    Status status = ask_samples(asker, samples, pixel, beyond, found, err);
    free(samples);
    return status;
}

/* ---- all pixels ------------------------------------------------------------------------------ */

bool settle_applies(const SettleCase *asked)
{
    return proof_of(asked) == PROOF_FIELD || asked->params->shadows;
}

static Status ask_pixel(Asker *asker, size_t pixel, unsigned beyond, Settled *settled, Err *err)
{
    const SettleCase *asked = asker->asked;
    int width = asked->scene->view.camera.width;
    SettledPixel found = {.x = (int)(pixel % (size_t)width),
                          .y = (int)(pixel / (size_t)width),
                          .id = asked->b->ids->ids[pixel],
                          .a_mm = (double)asked->a->depth->values[pixel],
                          .b_mm = (double)asked->b->depth->values[pixel],
                          .root_mm = (double)NAN,
                          .distance_mm = (double)NAN,
                          .cosine = (double)NAN};
    if (proof_of(asked) == PROOF_FIELD)
        TRY(ask_blob(asker, pixel, beyond, &found, err));
    else if (!(beyond & BEYOND_GEOMETRY))
        TRY(ask_cache(asker, pixel, &found, err));
    settled_note(settled, pixel, &found);
    return STATUS_OK;
}

Status settle_pixels(const SettleCase *asked, Settled *settled, Err *err)
{
    const Camera *camera = &asked->scene->view.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    Asker asker = {0};
    Settled made = {0};
    Status status;
    bool blob = proof_of(asked) == PROOF_FIELD;
    TRY_GOTO(settled_init(&made, pixels, blob ? SETTLED_ROOT : SETTLED_SHADOW_CACHE,
                          blob ? SETTLED_SHADOW_ROOT : SETTLED_SHADOW_CACHE, err));
    for (size_t i = 0; i < pixels; i++) {
        unsigned beyond = pixel_beyond(asked->a, asked->b, i, asked->tolerance);
        if (!beyond)
            continue;
        if (made.asked == MOST_ASKED) {
            made.unasked++;
            continue;
        }
        if (!asker.asked)
            TRY_GOTO(asker_init(&asker, asked, err));
        TRY_GOTO(ask_pixel(&asker, i, beyond, &made, err));
    }
    settled_judge(&made);
    *settled = made;
    made = (Settled){0};
done:
    asker_release(&asker);
    settled_release(&made);
    return status;
}
