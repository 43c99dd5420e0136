/* Looks up the visibility of ambient light and area lights, which is known per pixel, for the
 * samples of a pixel. A sample uses its own pixel if that shows the same surface, otherwise the
 * nearest pixel around it that shows the same kind of surface. If there is none, the sample hits a
 * vessel thinner than a pixel, far from all others, and its visibilities are 1, which is about
 * right. */
#include "render/light/visibility.h"

#include <math.h>
#include <stdlib.h>

bool softshadows_are_on(const View *view, const RenderParams *params)
{
    return params->shadows && view_has_soft_shadows(view);
}

/* Pixels to each side in which a pixel of the same surface is searched. A vessel that is at least a
 * pixel wide covers a pixel's centre within one pixel of each of its samples; the second pixel is
 * for narrower vessels. A larger number would take the visibility of farther surfaces. */
enum { SEARCH_PIXELS = 2 };

static float distance2(const ShadingPoint *a, const ShadingPoint *b)
{
    float sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (b->position[c] - a->position[c]) * (b->position[c] - a->position[c]);
    return sum;
}

/* Returns the pixel, among those within SEARCH_PIXELS of (column, row), whose shading point is on
 * the same kind of surface as `hit` and nearest to it. Returns NO_HIT if there is none. */
static uint32_t nearest_pixel(const PixelVisibility *visibility, int column, int row,
                              const ShadingPoint *hit)
{
    uint32_t nearest = NO_HIT;
    float smallest = HUGE_VALF;
    for (int j = row - SEARCH_PIXELS; j <= row + SEARCH_PIXELS; j++)
        for (int i = column - SEARCH_PIXELS; i <= column + SEARCH_PIXELS; i++) {
            uint32_t pixel = pixelvisibility_at(visibility, i, j);
            if (pixel == NO_HIT)
                continue;
            const ShadingPoint *point = &visibility->points[visibility->point_index[pixel]];
            float squared = distance2(point, hit);
            if (point->surface == hit->surface && squared < smallest) {
                smallest = squared;
                nearest = pixel;
            }
        }
    return nearest;
}

uint32_t pixelvisibility_find_pixel(const PixelVisibility *visibility, double i, double j,
                                    const ShadingPoint *hit)
{
    int column = (int)floor((i + 0.5) / visibility->samples_per_side);
    int row = (int)floor((j + 0.5) / visibility->samples_per_side);
    uint32_t own = pixelvisibility_at(visibility, column, row);
    if (own != NO_HIT &&
        shadingpoints_share_surface(&visibility->points[visibility->point_index[own]], hit))
        return own;
    return nearest_pixel(visibility, column, row, hit);
}

ShadingPoint shadingpoint_of(const PixelVisibility *visibility, SurfaceKind surface, Vec3 point,
                             Vec3 normal, double pixel_mm)
{
    Vec3 at = vec3_sub(point, visibility->origin);
    return (ShadingPoint){.position = {(float)at.x, (float)at.y, (float)at.z},
                          .normal = {(float)normal.x, (float)normal.y, (float)normal.z},
                          .pixel_mm = (float)pixel_mm,
                          .surface = surface};
}

double pixelvisibility_pixel_mm(const Camera *camera, double t)
{
    double width = vec3_length(camera->right) / camera->width;
    return camera->projection == PROJECTION_PERSPECTIVE ? t * width : width;
}

void pixelvisibility_free(PixelVisibility *visibility)
{
    if (!visibility)
        return;
    for (int i = 0; i < VIEW_MAX_LIGHTS; i++)
        free(visibility->lights[i]);
    free(visibility->ambient);
    free(visibility->points);
    free(visibility->point_index);
    free(visibility);
}
