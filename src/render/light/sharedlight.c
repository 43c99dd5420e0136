/* A vessel thinner than a pixel may be seen by a sample and by the centre of no pixel near it: such
 * a sample sees all of the sky and of the lights, which is about right of what is that thin and
 * alone. */
#include "render/light/sharedlight.h"

#include <math.h>
#include <stdlib.h>

enum { SEARCHED = 2 }; /* pixels to each side */

static float distance2(const PixelPlace *a, const PixelPlace *b)
{
    float sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (b->at[c] - a->at[c]) * (b->at[c] - a->at[c]);
    return sum;
}

/* That of the window about (column, row) whose place is nearest to what is seen. */
static uint32_t nearest_pixel(const SharedLight *shared, int column, int row,
                              const PixelPlace *seen)
{
    uint32_t nearest = PLACE_NONE;
    float least = HUGE_VALF;
    for (int j = row - SEARCHED; j <= row + SEARCHED; j++)
        for (int i = column - SEARCHED; i <= column + SEARCHED; i++) {
            uint32_t pixel = sharedlight_at(shared, i, j);
            if (pixel == PLACE_NONE)
                continue;
            const PixelPlace *place = &shared->places[shared->numbers[pixel]];
            float far = distance2(place, seen);
            if (place->kind == seen->kind && far < least) {
                least = far;
                nearest = pixel;
            }
        }
    return nearest;
}

uint32_t sharedlight_pixel(const SharedLight *shared, double i, double j, const PixelPlace *seen)
{
    int column = (int)floor((i + 0.5) / shared->side);
    int row = (int)floor((j + 0.5) / shared->side);
    uint32_t own = sharedlight_at(shared, column, row);
    if (own != PLACE_NONE && places_are_of_one(&shared->places[shared->numbers[own]], seen))
        return own;
    return nearest_pixel(shared, column, row, seen);
}

PixelPlace sharedlight_place(const SharedLight *shared, PlaceKind kind, Vec3 point, Vec3 normal,
                             double mm_a_pixel)
{
    Vec3 at = vec3_sub(point, shared->origin);
    return (PixelPlace){.at = {(float)at.x, (float)at.y, (float)at.z},
                        .normal = {(float)normal.x, (float)normal.y, (float)normal.z},
                        .size = (float)mm_a_pixel,
                        .kind = kind};
}

double sharedlight_pixel_mm(const Camera *camera, double t)
{
    double width = vec3_length(camera->right) / camera->width;
    return camera->projection == PROJECTION_PERSPECTIVE ? t * width : width;
}

void sharedlight_free(SharedLight *shared)
{
    if (!shared)
        return;
    for (int i = 0; i < VIEW_MAX_LIGHTS; i++)
        free(shared->parts[i]);
    free(shared->open);
    free(shared->places);
    free(shared->numbers);
    free(shared);
}
