/* Releases the parts of a scene, and computes colors of an appearance. Geometry, Appearance and
 * Anatomy own their arrays; a View owns nothing. */
#include "scene/scene.h"

#include <stdlib.h>

void anatomy_release(Anatomy *anatomy)
{
    free(anatomy->order);
    free(anatomy->component);
    free(anatomy->root);
    free(anatomy->main_branch);
    *anatomy = (Anatomy){0};
}

void appearance_release(Appearance *appearance)
{
    free(appearance->colors);
    free(appearance->values);
    free(appearance->positions);
    free(appearance->ramp);
    colormap_release(&appearance->scale.map);
    free(appearance->name);
    free(appearance->unit);
    free(appearance->time);
    free(appearance->radius_factors);
    free(appearance->meaning);
    *appearance = (Appearance){0};
}

Appearance appearance_frame(const Appearance *appearance, size_t frame)
{
    Appearance one = *appearance;
    if (one.n_frames > 0) {
        one.colors += frame * one.n_segments;
        one.values += frame * one.n_segments;
        one.radius_factors =
            one.radius_factors ? one.radius_factors + frame * one.n_segments : NULL;
        one.n_values = one.n_segments;
        one.positions = one.positions ? one.positions + frame * one.n_segments : NULL;
    }
    one.n_frames = 0;
    return one;
}

Rgb appearance_blended(const Appearance *appearance, double position)
{
    float rgb[3];
    colorscale_on_ramp(&appearance->scale, appearance->ramp, position, rgb);
    return (Rgb){rgb[0], rgb[1], rgb[2]};
}

void scene_release(Scene *scene)
{
    geometry_release(&scene->geometry);
    appearance_release(&scene->appearance);
    *scene = (Scene){0};
}
