/* Who owns what: a Geometry, an Appearance and an Anatomy own their arrays, a View owns nothing. */
#include "scene/scene.h"

#include <stdlib.h>

void anatomy_release(Anatomy *anatomy)
{
    free(anatomy->order);
    free(anatomy->tree);
    free(anatomy->root);
    free(anatomy->path);
    *anatomy = (Anatomy){0};
}

void appearance_release(Appearance *appearance)
{
    free(appearance->colors);
    free(appearance->values);
    colormap_release(&appearance->scale.map);
    *appearance = (Appearance){0};
}

void scene_release(Scene *scene)
{
    geometry_release(&scene->geometry);
    appearance_release(&scene->appearance);
    *scene = (Scene){0};
}
