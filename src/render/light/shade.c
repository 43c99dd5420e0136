/* Computes the color of a lit surface by POV-Ray's model of finishes and lights: ambient, diffuse,
 * Phong and Blinn (specular) terms.
 *
 * Geometry is in double and color in float, and every product is rounded where POV-Ray 3.7 rounds
 * it (render/trace.cpp; docs/POVRAY.md section 3), so that 8-bit and 16-bit pictures are equal to
 * the last code. A color times a number is computed in double and rounded; a color times a color,
 * and a sum of colors, is computed in float. */
#include "render/light/shade.h"

static Rgb rgb_scale(Rgb color, double factor)
{
    return (Rgb){(float)((double)color.r * factor), (float)((double)color.g * factor),
                 (float)((double)color.b * factor)};
}

static Rgb rgb_multiply(Rgb a, Rgb b)
{
    return (Rgb){a.r * b.r, a.g * b.g, a.b * b.b};
}

static Rgb rgb_add(Rgb a, Rgb b)
{
    return (Rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}

/* Returns the Phong highlight, a power of the cosine between the mirrored view ray and the
 * direction to the light. POV-Ray leaves it out where phong_size is at least 60 and the cosine is
 * below 0.0008. Its power is less than 1e-185 there, which changes no color, so it is computed
 * here. */
static double phong_intensity(const Finish *finish, Vec3 direction, Vec3 normal, Vec3 towards)
{
    double along = vec3_dot(direction, normal);
    Vec3 mirrored = vec3_add_scaled(direction, normal, -2 * along);
    double cosine = vec3_dot(mirrored, towards);
    return cosine > 0 ? (double)finish->phong * elementary_pow(cosine, (double)finish->phong_size)
                      : 0;
}

/* Returns the Blinn highlight, a power of the cosine between the normal and the direction halfway
 * between viewer and light. */
static double specular_intensity(const Finish *finish, Vec3 direction, Vec3 normal, Vec3 towards)
{
    Vec3 halfway = vec3_scale(vec3_sub(towards, direction), 0.5);
    double length = vec3_length(halfway);
    if (!(length > 0))
        return 0;
    double cosine = vec3_dot(halfway, normal) / length;
    float exponent = 1 / finish->roughness;
    return cosine > 0 ? (double)finish->specular * elementary_pow(cosine, (double)exponent) : 0;
}

/* Returns the light that the surface reflects to the viewer from one light, without its ambient
 * term. `cosine` is that of normal and `towards`, the direction to the light. */
static Rgb lit_by(Rgb light, const Finish *finish, Rgb pigment, Vec3 normal, Vec3 direction,
                  Vec3 towards, double cosine)
{
    double diffuse = (double)finish->diffuse;
    diffuse *=
        finish->brilliance == 1 ? cosine : elementary_pow(cosine, (double)finish->brilliance);
    Rgb color = rgb_multiply(rgb_scale(pigment, diffuse), light);
    if (finish->phong > 0)
        color =
            rgb_add(color, rgb_scale(light, phong_intensity(finish, direction, normal, towards)));
    if (finish->specular > 0)
        color = rgb_add(color,
                        rgb_scale(light, specular_intensity(finish, direction, normal, towards)));
    return color;
}

/* Returns the fraction, 0..1, of a light's points that are visible from a shading point. */
static double visible_part(const Light *light, Vec3 point, ShadowTest *shadow, void *context)
{
    int n = light_points(light), reach = 0;
    if (!shadow || !light->casts_shadows)
        return 1;
    for (int k = 0; k < n; k++) {
        LightDirection to_light = light_direction_to_point(light, k, point);
        reach += !shadow(context, point, to_light.towards, to_light.distance);
    }
    return (double)reach / n;
}

Rgb shade(const View *view, const ShadingInput *at, ShadowTest *shadow, void *context)
{
    Rgb color = rgb_scale(at->pigment, (double)at->finish->ambient * at->ambient);
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        Vec3 towards = light_direction(light, at->point).towards;
        double cosine = vec3_dot(at->normal, towards);
        if (cosine < MIN_LIT_COSINE)
            continue;
        double part = at->light_visibility && at->light_visibility[i] >= 0
                          ? (double)at->light_visibility[i]
                          : visible_part(light, at->point, shadow, context);
        if (part > 0)
            color = rgb_add(color, lit_by(rgb_scale(light->color, part), at->finish, at->pigment,
                                          at->normal, at->direction, towards, cosine));
    }
    return color;
}
