/* Explains pixels at which POV-Ray's picture (A) differs from the picture of corcast's renderer
 * (B).
 *
 * Blobs: the visible point, its normal, its segment and its shadows are computed from the field
 * along the pixel's ray. The only code that this shares with the renderer is the shading function,
 * whose colors equal POV-Ray's colors at all other pixels.
 *
 * Other models: the renderer draws the pixel twice more, with a camera of one pixel. In the first
 * drawing shadow rays ignore hits nearer than 1e-3 mm, as POV-Ray's shadow rays do. In the second
 * drawing they ignore hits nearer than 1e-4 mm, as POV-Ray's shadow cache does. */
#include "oracle/explain.h"

#include "field/field.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Maximum number of differing pixels that are examined. Further pixels are only counted. Examining
 * a pixel of a blob costs O(segments) per ray and step of a search; a picture with more differing
 * pixels than this breaks the limits of settled pixels anyway, unless it is very large. */
enum { MAX_EXAMINED = 500 };

/* POV-Ray's limits, mm: its shadow rays and its shadow cache ignore nearer hits. */
static const double shadow_ray_start_mm = 1e-3, shadow_cache_start_mm = 1e-4;
/* Maximum distance from a root, in units of the vessel's radius, at which A's visible point still
 * counts as this root. It is not zero, because POV-Ray's roots are imprecise near those that it
 * misses. A larger value would also accept a vessel that is moved by this much; the normal and the
 * color of the point are therefore tested as well. */
static const double root_tolerance_radii = 0.02;
/* A ray is grazing if its cosine to the surface normal is at most this. POV-Ray misses roots mostly
 * along grazing rays, and then also along neighbouring rays. Where the field is steep, POV-Ray also
 * misses roots along single rays [may_miss]. 0.1 is within 6 degrees of the tangent plane. A larger
 * value would let more faults of the picture pass as misses of POV-Ray. */
static const double max_grazing_cosine = 0.1;
/* Maximum length of the difference of two unit normals that count as equal. A's normals are decoded
 * from 16-bit codes, whose steps are 3e-5, so three rounded components are off by up to 3e-5. The
 * rest allows for POV-Ray's own rounding. */
static const double normal_tolerance = 2e-4;

/* The vessels that block a light at one shading point. "The grazing ray" is the shadow ray with the
 * smallest cosine to the surface normal among the shadow rays that vessels block. */
typedef struct LightBlockage {
    double visibility; /* fraction of the light that arrives, 0..1 */
    double blocker_mm; /* distance from the shading point along the grazing ray to the surface; NAN:
                        * no vessel blocks a ray */
    double cosine;     /* cosine between the grazing ray and the surface's normal; NAN: no vessel
                        * blocks a ray */
    int n_grazing;     /* number of points of the light whose rays graze the first surface that they
                        * hit */
} LightBlockage;

/* The state of one examination. */
typedef struct Examiner {
    const ExplainCase *input; /* borrowed */
    View view;                /* the scene's view, changed: a camera of one pixel, or, for a blob,
                               * the lights dimmed by their visibility */
    Renderer *ray_renderer;   /* shadow rays begin at shadow_ray_start_mm; NULL: a blob */
    Renderer *cache_renderer; /* shadow rays begin at shadow_cache_start_mm; NULL: a blob */
    TermMean *color_mean;     /* colors of a blob whose colors blend; otherwise NULL */
    LightBlockage blockages[VIEW_MAX_LIGHTS]; /* per light, for the last shading point queried */
} Examiner;

/* Returns how differences of the scene's model are explained: PROOF_FIELD for a blob, by the field
 * along the ray. */
static ModelProof proof_method(const ExplainCase *input)
{
    return models[input->scene->geometry.model].proof;
}

static void examiner_release(Examiner *examiner)
{
    renderer_free(examiner->ray_renderer);
    renderer_free(examiner->cache_renderer);
    termmean_free(examiner->color_mean);
}

/* Creates a renderer whose shadow rays ignore hits nearer than `shadow_from_mm`. It has one thread,
 * because it draws one pixel at a time. */
static Status create_renderer(Examiner *examiner, double shadow_from_mm, Renderer **out, Err *err)
{
    RenderParams params = *examiner->input->params;
    params.threads = 1;
    params.shadow_from_mm = shadow_from_mm;
    return renderer_new(&examiner->input->scene->geometry, &params, out, err);
}

static Status examiner_init(Examiner *examiner, const ExplainCase *input, Err *err)
{
    examiner->input = input;
    examiner->view = input->scene->view;
    if (proof_method(input) == PROOF_FIELD)
        return input->scene->appearance.positions
                   ? termmean_new(&input->scene->geometry, &examiner->color_mean, err)
                   : STATUS_OK;
    TRY(create_renderer(examiner, shadow_ray_start_mm, &examiner->ray_renderer, err));
    return create_renderer(examiner, shadow_cache_start_mm, &examiner->cache_renderer, err);
}

/* ---- the shadow cache ------------------------------------------------------------------------ */

/* Draws the pixel of the examiner's camera. */
static Status draw_one(const Examiner *examiner, Renderer *renderer, Rgb *color, Err *err)
{
    Frame frame;
    TRY(renderer_rows(renderer, &examiner->view, &examiner->input->scene->appearance, 0, 1, &frame,
                      err));
    const float *values = frame.color.values;
    *color = (Rgb){values[0], values[1], values[2]};
    frame_release(&frame);
    return STATUS_OK;
}

/* Returns true if each channel of a pixel of `side` (A or B) is between the channels of two colors.
 * A 16-bit code may be off by one. */
static bool lies_between(const Examiner *examiner, const Rendering *side, Rgb low, Rgb high,
                         size_t pixel)
{
    const Picture *picture = side->picture;
    const float lows[3] = {low.r, low.g, low.b}, highs[3] = {high.r, high.g, high.b};
    int slack = picture->bits == 16;
    for (size_t c = 0; c < 3; c++) {
        int code = picture_code(picture, 3 * pixel + c);
        if (code < image_code(lows[c], examiner->input->encoding, picture->bits) - slack ||
            code > image_code(highs[c], examiner->input->encoding, picture->bits) + slack)
            return false;
    }
    return true;
}

/* Returns true if a pixel of a side has this color, up to rounding. */
static bool has_color(const Examiner *examiner, const Rendering *side, Rgb color, size_t pixel)
{
    return lies_between(examiner, side, color, color, pixel);
}

/* Sets the cause SETTLED_SHADOW_CACHE if B has the color of the first drawing, and A has a color
 * between the colors of the two drawings [head of this file]. */
static Status examine_shadow_cache(Examiner *examiner, size_t pixel, SettledPixel *found, Err *err)
{
    Rgb first, cached;
    examiner->view.camera =
        camera_of_pixel(&examiner->input->scene->view.camera, found->x, found->y);
    TRY(draw_one(examiner, examiner->ray_renderer, &first, err));
    TRY(draw_one(examiner, examiner->cache_renderer, &cached, err));
    if (has_color(examiner, examiner->input->b, first, pixel) &&
        lies_between(examiner, examiner->input->a, cached, first, pixel))
        found->cause = SETTLED_SHADOW_CACHE;
    return STATUS_OK;
}

/* ---- the field of a blob --------------------------------------------------------------------- */

/* Finds all roots of the field along a ray. */
static Status find_roots(const Examiner *examiner, Ray ray, double t_min, double t_max,
                         BlobRoots *roots, Err *err)
{
    const Geometry *geometry = &examiner->input->scene->geometry;
    return blob_roots(geometry->segments, geometry->n_segments, ray, t_min, t_max, roots, err);
}

/* Finds the field's normal at `x`, on the side from which the ray comes. Returns the segment of the
 * largest term at `x`. */
static const FieldSegment *find_surface(const Examiner *examiner, Ray ray, Vec3 x, Vec3 *normal)
{
    const Geometry *geometry = &examiner->input->scene->geometry;
    const FieldSegment *largest = &geometry->segments[0];
    Vec3 sum = vec3(0, 0, 0);
    double max_term = -HUGE_VAL;
    for (size_t i = 0; i < geometry->n_segments; i++) {
        BlobComponent components[BLOB_COMPONENTS];
        Vec3 gradient;
        Ball ball = blob_ball(&geometry->segments[i]);
        if (vec3_distance(ball.center, x) > ball.radius)
            continue;
        blob_components(&blob_shape, &geometry->segments[i], components);
        double term = blob_components_at(components, x, &gradient);
        sum = vec3_add(sum, gradient);
        if (term > max_term) {
            max_term = term;
            largest = &geometry->segments[i];
        }
    }
    *normal = vec3_scale(vec3_normalized(sum), vec3_dot(sum, ray.direction) > 0 ? -1 : 1);
    return largest;
}

/* Sets *free to true if neither the ground nor a root of the field is on the shadow ray from
 * `point` to a point of a light. Updates `found` if a vessel blocks the ray. */
static Status examine_shadow_ray(const Examiner *examiner, Vec3 point, LightDirection to_light,
                                 bool *free, LightBlockage *found, Err *err)
{
    Ray ray = {point, to_light.towards};
    double far = to_light.distance - shadow_ray_start_mm, t;
    BlobRoots roots;
    Vec3 normal;
    *free = !ground_hit(&examiner->input->scene->view.ground, ray, shadow_ray_start_mm, far, &t);
    if (!*free)
        return STATUS_OK;
    TRY(find_roots(examiner, ray, render_nearest_mm(&examiner->input->scene->geometry), far, &roots,
                   err));
    *free = roots.n == 0;
    if (*free)
        return STATUS_OK;
    find_surface(examiner, ray, ray_at(ray, roots.t[0]), &normal);
    double cosine = fabs(vec3_dot(normal, to_light.towards));
    found->n_grazing += cosine <= max_grazing_cosine;
    if (!(cosine >= found->cosine)) {
        found->cosine = cosine;
        found->blocker_mm = roots.t[0];
    }
    return STATUS_OK;
}

/* Finds which fraction of a light is visible from `point`, and what blocks it. */
static Status examine_light(const Examiner *examiner, const Light *light, Vec3 point,
                            LightBlockage *found, Err *err)
{
    int n = light_points(light), n_free = 0;
    *found = (LightBlockage){1, (double)NAN, (double)NAN, 0};
    if (!examiner->input->params->shadows || !light->casts_shadows)
        return STATUS_OK;
    for (int k = 0; k < n; k++) {
        bool free;
        TRY(examine_shadow_ray(examiner, point, light_direction_to_point(light, k, point), &free,
                               found, err));
        n_free += free;
    }
    found->visibility = (double)n_free / n;
    return STATUS_OK;
}

/* Sets examiner->blockages for all lights. */
static Status examine_lights(Examiner *examiner, Vec3 point, Err *err)
{
    const View *view = &examiner->input->scene->view;
    for (size_t i = 0; i < view->n_lights; i++)
        TRY(examine_light(examiner, &view->lights[i], point, &examiner->blockages[i], err));
    return STATUS_OK;
}

/* Dims each light of examiner->view to its visible fraction. Counts `more` further points of the
 * light with index `brighter` as visible. If `brighter` is SIZE_MAX, no light gets further
 * points. */
static void set_lights(Examiner *examiner, size_t brighter, int more)
{
    const View *view = &examiner->input->scene->view;
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        double part = examiner->blockages[i].visibility;
        if (i == brighter)
            part += (double)more / light_points(light);
        examiner->view.lights[i].color =
            (Rgb){(float)((double)light->color.r * part), (float)((double)light->color.g * part),
                  (float)((double)light->color.b * part)};
    }
}

/* The point that a ray hits. */
typedef struct VisiblePoint {
    double t; /* distance along the ray, mm; HUGE_VAL: neither vessel nor ground */
    ShadingInput at;
    uint32_t id; /* 0: the ground or nothing */
    Rgb color;
} VisiblePoint;

/* Returns the color of a hit, lit by the lights that set_lights sets. */
static Rgb color_of_hit(Examiner *examiner, const VisiblePoint *seen, size_t brighter, int more)
{
    if (seen->t == HUGE_VAL)
        return examiner->input->scene->view.background;
    set_lights(examiner, brighter, more);
    const View *view = &examiner->view;
    const Rgb color = shade(view, &seen->at, NULL, NULL);
    const double part = seen->id ? fade_at(&view->fade, seen->t) : 0;
    return rgb_mixed(color, view->background, part);
}

/* Returns the hit of the surface at `t`, without its color. */
static VisiblePoint surface_at(const Examiner *examiner, Ray ray, double t)
{
    const Scene *scene = examiner->input->scene;
    VisiblePoint seen = {.t = t,
                         .at = {.point = ray_at(ray, t), .direction = ray.direction, .ambient = 1}};
    const FieldSegment *hit = find_surface(examiner, ray, seen.at.point, &seen.at.normal);
    seen.id = scene->geometry.ids[hit->segment];
    seen.at.finish = &scene->appearance.finish;
    seen.at.pigment =
        examiner->color_mean
            ? appearance_blended(
                  &scene->appearance,
                  termmean_at(examiner->color_mean, scene->appearance.positions, seen.at.point))
            : appearance_color(&scene->appearance, hit->segment);
    return seen;
}

/* Finds the point that a ray hits: the ground, or the vessel at `t`, a root of the field. `t` is
 * HUGE_VAL if there is no vessel. Sets examiner->blockages for the point. */
static Status find_hit(Examiner *examiner, Ray ray, double t, VisiblePoint *seen, Err *err)
{
    const Ground *ground = &examiner->input->scene->view.ground;
    if (ground_hit(ground, ray, shadow_cache_start_mm, t, &t)) {
        bool below = vec3_dot(ground->normal, ray.direction) > 0;
        *seen = (VisiblePoint){t,
                               {.finish = &ground->finish,
                                .pigment = ground->color,
                                .point = ray_at(ray, t),
                                .normal = vec3_scale(ground->normal, below ? -1 : 1),
                                .direction = ray.direction,
                                .ambient = 1},
                               0,
                               {0, 0, 0}};
    } else if (t < HUGE_VAL) {
        *seen = surface_at(examiner, ray, t);
    } else {
        *seen = (VisiblePoint){.t = HUGE_VAL};
    }
    if (t < HUGE_VAL)
        TRY(examine_lights(examiner, seen->at.point, err));
    seen->color = color_of_hit(examiner, seen, SIZE_MAX, 0);
    return STATUS_OK;
}

/* Returns the root with this index; HUGE_VAL if there are fewer. */
static double root_of(const BlobRoots *roots, int index)
{
    return index < roots->n ? roots->t[index] : HUGE_VAL;
}

/* One ray of a pixel. */
typedef struct PixelSample {
    Ray ray;
    BlobRoots roots;    /* roots of the field along the ray */
    VisiblePoint truth; /* what the ray hits by the field */
} PixelSample;

/* Returns the number of samples of a pixel: N x N and its center. */
static int samples_of(const Examiner *examiner)
{
    int n = examiner->input->params->antialias;
    return n > 1 ? n * n + 1 : 1;
}

/* Returns the ray of a sample. Sample 0 is at the pixel's centre. The other samples are on a
 * regular grid, as POV-Ray's switches +AM1 -J place them. */
static Ray sample_ray(const Examiner *examiner, int i, int j, int sample)
{
    const Camera *camera = &examiner->input->scene->view.camera;
    int n = examiner->input->params->antialias;
    if (sample == 0)
        return camera_ray(camera, i, j);
    return camera_ray(camera, i - 0.5 + ((sample - 1) % n + 0.5) / n,
                      j - 0.5 + ((sample - 1) / n + 0.5) / n);
}

/* Returns the mean color of the pixel's samples, where sample `changed` has `color`. */
static Rgb mean_with(const Examiner *examiner, const PixelSample *samples, int changed, Rgb color)
{
    int n = samples_of(examiner);
    Rgb sum = {0, 0, 0};
    for (int index = 0; index < n; index++) {
        Rgb of = index == changed ? color : samples[index].truth.color;
        sum = (Rgb){sum.r + of.r, sum.g + of.g, sum.b + of.b};
    }
    double count = n;
    return (Rgb){(float)((double)sum.r / count), (float)((double)sum.g / count),
                 (float)((double)sum.b / count)};
}

/* Returns true if A's pixel has the color that it would have if sample `changed` had `color`. */
static bool explains(const Examiner *examiner, const PixelSample *samples, int changed, Rgb color,
                     size_t pixel)
{
    return has_color(examiner, examiner->input->a, mean_with(examiner, samples, changed, color),
                     pixel);
}

/* Finds the roots along a sample's ray, and what the ray hits. */
static Status examine_sample(Examiner *examiner, PixelSample *sample, Err *err)
{
    TRY(find_roots(examiner, sample->ray, render_nearest_mm(&examiner->input->scene->geometry),
                   HUGE_VAL, &sample->roots, err));
    return find_hit(examiner, sample->ray, root_of(&sample->roots, 0), &sample->truth, err);
}

static Vec3 normal_at(const Rendering *side, size_t pixel)
{
    const float *n = &side->normal->values[3 * pixel];
    return vec3((double)n[0], (double)n[1], (double)n[2]);
}

/* Returns true if B has the point, the normal, the segment and the color that follow from the
 * field. The depth of B is a float, so it may differ from the root by a rounding error. Another
 * 1e-6 mm, less than any depth plane resolves, allows for the root finder of B. */
static bool native_is_right(const Examiner *examiner, const PixelSample *samples, size_t pixel)
{
    const Rendering *b = examiner->input->b;
    double t = (double)b->depth->values[pixel], root = root_of(&samples[0].roots, 0);
    if (isfinite(t) != isfinite(root))
        return false;
    if (isfinite(t)) {
        VisiblePoint hit = surface_at(examiner, samples[0].ray, root);
        if (!(fabs(t - root) <= 1e-6 + root * (double)FLT_EPSILON) ||
            !(vec3_distance(hit.at.normal, normal_at(b, pixel)) <= normal_tolerance) ||
            b->ids->ids[pixel] != hit.id)
            return false;
    }
    return has_color(examiner, b, mean_with(examiner, samples, 0, samples[0].truth.color), pixel);
}

static double radius_of(const Examiner *examiner, uint32_t id)
{
    const Geometry *geometry = &examiner->input->scene->geometry;
    for (size_t i = 0; i < geometry->n_segments; i++)
        if (geometry->ids[geometry->segments[i].segment] == id)
            return geometry->segments[i].radius_mm;
    return 0;
}

/* Returns true if A shows the surface at the root with this index, within root_tolerance_radii. */
static bool shows_root(const Examiner *examiner, const PixelSample *sample, int index, size_t pixel)
{
    double t = (double)examiner->input->a->depth->values[pixel];
    if (index >= sample->roots.n || !isfinite(t))
        return false;
    VisiblePoint hit = surface_at(examiner, sample->ray, t);
    double radius = radius_of(examiner, hit.id), rounding = t * (double)FLT_EPSILON / radius;
    return fabs(t - sample->roots.t[index]) <= root_tolerance_radii * radius &&
           vec3_distance(hit.at.normal, normal_at(examiner->input->a, pixel)) <=
               normal_tolerance + rounding;
}

/* Returns the cosine between the ray of a sample and the normal at its first root; NAN without a
 * root. */
static double cosine_at_root(const Examiner *examiner, const PixelSample *sample)
{
    if (sample->roots.n == 0)
        return (double)NAN;
    VisiblePoint hit = surface_at(examiner, sample->ray, sample->roots.t[0]);
    return fabs(vec3_dot(hit.at.normal, sample->ray.direction));
}

/* Returns true if none of the eight neighbours of the pixel differs. */
static bool is_alone(const Examiner *examiner, const SettledPixel *found)
{
    const Camera *camera = &examiner->input->scene->view.camera;
    for (int y = found->y - 1; y <= found->y + 1; y++)
        for (int x = found->x - 1; x <= found->x + 1; x++) {
            bool inside = x >= 0 && x < camera->width && y >= 0 && y < camera->height;
            if (!inside || (x == found->x && y == found->y))
                continue;
            size_t pixel = (size_t)y * (size_t)camera->width + (size_t)x;
            if (pixel_beyond(examiner->input->a, examiner->input->b, pixel,
                             examiner->input->tolerance))
                return false;
        }
    return true;
}

/* Returns true if POV-Ray may miss a root at a pixel whose ray has this cosine to the normal
 * [max_grazing_cosine]. */
static bool may_miss(const Examiner *examiner, const SettledPixel *found, double cosine)
{
    return cosine <= max_grazing_cosine || (isfinite(cosine) && is_alone(examiner, found));
}

/* Sets the cause SETTLED_ROOT if A shows a later root or no vessel, and POV-Ray may have missed the
 * first root. */
static void find_missed(const Examiner *examiner, const PixelSample *sample, size_t pixel,
                        SettledPixel *found)
{
    double cosine = cosine_at_root(examiner, sample);
    bool later = !isfinite(examiner->input->a->depth->values[pixel]);
    for (int k = 1; k < sample->roots.n && !later; k++)
        later = shows_root(examiner, sample, k, pixel);
    if (!later || !may_miss(examiner, found, cosine))
        return;
    found->cause = SETTLED_ROOT;
    found->cosine = cosine;
}

/* Sets the cause SETTLED_INEXACT_ROOT if A shows the surface slightly before or behind the first
 * root [root_tolerance_radii], with the normal and the color of that point. A's depth is a float,
 * so the color may be that of a point within twice the rounding error of it. */
static Status examine_inexact(Examiner *examiner, const PixelSample *sample, size_t pixel,
                              SettledPixel *found, Err *err)
{
    double t = (double)examiner->input->a->depth->values[pixel];
    if (samples_of(examiner) > 1 || !shows_root(examiner, sample, 0, pixel))
        return STATUS_OK;
    /* The colors at the root, and `offset` before and behind it, bound the color of A. */
    double root = sample->roots.t[0], offset = fabs(t - root) + 2 * t * (double)FLT_EPSILON;
    Rgb low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    TRY(examine_lights(examiner, ray_at(sample->ray, root), err));
    for (int k = -1; k <= 1; k++) {
        VisiblePoint hit = surface_at(examiner, sample->ray, root + k * offset);
        Rgb color = color_of_hit(examiner, &hit, SIZE_MAX, 0);
        low = (Rgb){fminf(low.r, color.r), fminf(low.g, color.g), fminf(low.b, color.b)};
        high = (Rgb){fmaxf(high.r, color.r), fmaxf(high.g, color.g), fmaxf(high.b, color.b)};
    }
    if (lies_between(examiner, examiner->input->a, low, high, pixel))
        found->cause = SETTLED_INEXACT_ROOT;
    return STATUS_OK;
}

/* Returns true if A has the color that it would have if more points of this light were visible.
 * Tries 1 to max(1, n_grazing) further points. */
static bool missed_rays_explain(Examiner *examiner, const PixelSample *samples, int index,
                                size_t pixel, const VisiblePoint *seen, size_t light)
{
    const int n_grazing = examiner->blockages[light].n_grazing;
    for (int more = 1; more == 1 || more <= n_grazing; more++)
        if (explains(examiner, samples, index, color_of_hit(examiner, seen, light, more), pixel))
            return true;
    return false;
}

/* Sets the cause SETTLED_SHADOW_ROOT if A is lit as if shadow rays from sample `index` to one light
 * had missed a root. */
static Status examine_shadows(Examiner *examiner, const PixelSample *samples, int index,
                              size_t pixel, SettledPixel *found, Err *err)
{
    const PixelSample *sample = &samples[index];
    VisiblePoint seen;
    TRY(find_hit(examiner, sample->ray, root_of(&sample->roots, 0), &seen, err));
    for (size_t i = 0; i < examiner->input->scene->view.n_lights && seen.t < HUGE_VAL; i++) {
        const LightBlockage *blockage = &examiner->blockages[i];
        if (!may_miss(examiner, found, blockage->cosine) ||
            !missed_rays_explain(examiner, samples, index, pixel, &seen, i))
            continue;
        found->cause = SETTLED_SHADOW_ROOT;
        found->distance_mm = blockage->blocker_mm;
        found->cosine = blockage->cosine;
        return STATUS_OK;
    }
    return STATUS_OK;
}

/* Sets the cause SETTLED_ROOT if A has the color that it would have if the ray of sample `index`
 * had missed its first roots. */
static Status examine_later_roots(Examiner *examiner, const PixelSample *samples, int index,
                                  size_t pixel, SettledPixel *found, Err *err)
{
    const PixelSample *sample = &samples[index];
    double cosine = cosine_at_root(examiner, sample);
    for (int k = 1; k <= sample->roots.n && may_miss(examiner, found, cosine); k++) {
        VisiblePoint seen;
        TRY(find_hit(examiner, sample->ray, root_of(&sample->roots, k), &seen, err));
        if (!explains(examiner, samples, index, seen.color, pixel))
            continue;
        found->cause = SETTLED_ROOT;
        found->cosine = cosine;
        return STATUS_OK;
    }
    return STATUS_OK;
}

/* Looks for the cause of one differing pixel of a blob. Sets no cause if a sample's roots are not
 * complete or if B is not right. If A's id, depth or normal differ (BEYOND_GEOMETRY), tests for a
 * missed root and then for an inexact root of the central ray. If only the color differs, tests for
 * an inexact root, then for missed roots of shadow rays, and last for missed roots of the other
 * samples' rays. The central ray, sample 0, needs no such test: a missed root of it would change
 * the depth. */
static Status examine_samples(Examiner *examiner, PixelSample *samples, size_t pixel,
                              unsigned beyond, SettledPixel *found, Err *err)
{
    int n = samples_of(examiner);
    for (int index = 0; index < n; index++) {
        samples[index].ray = sample_ray(examiner, found->x, found->y, index);
        TRY(examine_sample(examiner, &samples[index], err));
        if (!samples[index].roots.is_complete)
            return STATUS_OK;
    }
    if (samples[0].roots.n > 0)
        found->root_mm = samples[0].roots.t[0];
    if (!native_is_right(examiner, samples, pixel))
        return STATUS_OK;
    if (beyond & BEYOND_GEOMETRY)
        find_missed(examiner, &samples[0], pixel, found);
    if (found->cause == SETTLED_NOT)
        TRY(examine_inexact(examiner, &samples[0], pixel, found, err));
    if (beyond & BEYOND_GEOMETRY)
        return STATUS_OK;
    for (int index = 0; index < n && found->cause == SETTLED_NOT; index++)
        TRY(examine_shadows(examiner, samples, index, pixel, found, err));
    for (int index = 1; index < n && found->cause == SETTLED_NOT; index++)
        TRY(examine_later_roots(examiner, samples, index, pixel, found, err));
    return STATUS_OK;
}

static Status examine_blob(Examiner *examiner, size_t pixel, unsigned beyond, SettledPixel *found,
                           Err *err)
{
    PixelSample *samples;
    TRY(mem_calloc(&samples, (size_t)samples_of(examiner), sizeof *samples, "samples", err));
    Status status = examine_samples(examiner, samples, pixel, beyond, found, err);
    free(samples);
    return status;
}

/* ---- all pixels ------------------------------------------------------------------------------ */

bool explain_applies(const ExplainCase *input)
{
    return proof_method(input) == PROOF_FIELD || input->params->shadows;
}

/* Finds out why a pixel differs, and records it as settled if a cause is proven. */
static Status examine_pixel(Examiner *examiner, size_t pixel, unsigned beyond, Settled *settled,
                            Err *err)
{
    const ExplainCase *input = examiner->input;
    int width = input->scene->view.camera.width;
    SettledPixel found = {.x = (int)(pixel % (size_t)width),
                          .y = (int)(pixel / (size_t)width),
                          .id = input->b->ids->ids[pixel],
                          .a_mm = (double)input->a->depth->values[pixel],
                          .b_mm = (double)input->b->depth->values[pixel],
                          .root_mm = (double)NAN,
                          .distance_mm = (double)NAN,
                          .cosine = (double)NAN};
    if (proof_method(input) == PROOF_FIELD)
        TRY(examine_blob(examiner, pixel, beyond, &found, err));
    else if (!(beyond & BEYOND_GEOMETRY))
        TRY(examine_shadow_cache(examiner, pixel, &found, err));
    settled_note(settled, pixel, &found);
    return STATUS_OK;
}

Status explain_pixels(const ExplainCase *input, Settled *settled, Err *err)
{
    const Camera *camera = &input->scene->view.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    Examiner examiner = {0};
    Settled made = {0};
    Status status;
    bool blob = proof_method(input) == PROOF_FIELD;
    TRY_GOTO(settled_init(&made, pixels, blob ? SETTLED_ROOT : SETTLED_SHADOW_CACHE,
                          blob ? SETTLED_SHADOW_ROOT : SETTLED_SHADOW_CACHE, err));
    for (size_t i = 0; i < pixels; i++) {
        unsigned beyond = pixel_beyond(input->a, input->b, i, input->tolerance);
        if (!beyond)
            continue;
        if (made.examined == MAX_EXAMINED) {
            made.unexamined++;
            continue;
        }
        if (!examiner.input)
            TRY_GOTO(examiner_init(&examiner, input, err));
        TRY_GOTO(examine_pixel(&examiner, i, beyond, &made, err));
    }
    settled_judge(&made);
    *settled = made;
    made = (Settled){0};
done:
    examiner_release(&examiner);
    settled_release(&made);
    return status;
}
