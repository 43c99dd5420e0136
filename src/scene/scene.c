/* Who owns what: a Geometry and an Appearance own their arrays, a View owns nothing. */
#include "scene/scene.h"

#include <stdlib.h>

void appearance_release(Appearance *appearance)
{
    free(appearance->colors);
    colormap_release(&appearance->scale.map);
    *appearance = (Appearance){0};
}

void scene_release(Scene *scene)
{
    geometry_release(&scene->geometry);
    appearance_release(&scene->appearance);
    *scene = (Scene){0};
}
