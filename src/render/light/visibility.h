/* Visibility that all samples of a pixel share: the ambient visibility of the surface, and the
 * visibility of each area light. It is computed once per pixel, at the point where the ray through
 * the pixel's centre hits, by pixelvisibility_compute [bandvisibility.h]. A sample then finds the
 * pixel whose visibility it uses by pixelvisibility_find_pixel. */
#ifndef CORCAST_RENDER_LIGHT_VISIBILITY_H
#define CORCAST_RENDER_LIGHT_VISIBILITY_H

#include "render/job.h"
#include "scene/scene.h"
#include <math.h>

/* Returns true if shadows are on and at least one area light of the view casts soft shadows. */
bool softshadows_are_on(const View *view, const RenderParams *params);

typedef enum SurfaceKind { SURFACE_VESSEL, SURFACE_GROUND } SurfaceKind;

/* The point at which a ray hits a surface. */
typedef struct ShadingPoint {
    float position[3]; /* mm, relative to PixelVisibility.origin */
    float normal[3];   /* unit, facing the viewer */
    float pixel_mm;    /* width of a pixel at this point, mm, across the view direction */
    SurfaceKind surface;
} ShadingPoint;

/* Index that means "no pixel" or "no shading point": the pixel's centre ray hits nothing, or its
 * row is not stored. */
#define NO_HIT UINT32_MAX

/* The visibility of the pixels of some rows of an image. Immutable after pixelvisibility_compute.
 * All arrays are owned. A "pixel" is an index into them: pixels are stored row by row, from row
 * `first_row` of the image on. */
typedef struct PixelVisibility {
    int width;                      /* pixels per row: the image's width */
    int first_row, rows;            /* the rows of the image that are stored */
    int samples_per_side;           /* samples along a pixel's side in the sample grid that
                                     * pixelvisibility_find_pixel is asked about, usually 1 */
    Vec3 origin;                    /* mm */
    uint32_t *point_index;          /* per pixel: index of its shading point in `points`, or
                                     * NO_HIT */
    ShadingPoint *points;           /* one per pixel that is not NO_HIT */
    float *ambient;                 /* per pixel: ambient visibility, 0 to 1; set only where
                                     * point_index is not NO_HIT; NULL: 1 everywhere */
    float *lights[VIEW_MAX_LIGHTS]; /* per pixel: visibility of the light, 0 to 1; set as `ambient`;
                                     * NULL: the light is not an area light that casts shadows */
} PixelVisibility;

/* Returns the point's position in mm, relative to PixelVisibility.origin. */
static inline Vec3 shadingpoint_position(const ShadingPoint *point)
{
    return vec3((double)point->position[0], (double)point->position[1], (double)point->position[2]);
}

/* Returns true if a and b count as points of the same surface. Both must be on vessels or both on
 * the ground, and each must be less than 5/4 of a's pixel width from the other's tangent plane. The
 * factor 5/4 decides how much a surface may bend between pixels that share visibility. With a
 * larger one, vessels that pass close behind each other share; with a smaller one, thin vessels,
 * which bend within a pixel, have no neighbours to share with. */
static inline bool shadingpoints_share_surface(const ShadingPoint *a, const ShadingPoint *b)
{
    float off_a = 0, off_b = 0, limit = 1.25f * a->pixel_mm;
    if (a->surface != b->surface)
        return false;
    for (int c = 0; c < 3; c++) {
        float delta = b->position[c] - a->position[c];
        off_a += delta * a->normal[c];
        off_b += delta * b->normal[c];
    }
    /* `&` avoids a branch: which of the two tests fails is unpredictable. */
    return (fabsf(off_a) < limit) & (fabsf(off_b) < limit);
}

/* Returns the pixel at (column, row) of the image. Returns NO_HIT if the row is not stored, the
 * column is outside the image, or the pixel's centre ray hits nothing. */
static inline uint32_t pixelvisibility_at(const PixelVisibility *visibility, int column, int row)
{
    row -= visibility->first_row;
    if (column < 0 || column >= visibility->width || row < 0 || row >= visibility->rows)
        return NO_HIT;
    size_t pixel = (size_t)row * (size_t)visibility->width + (size_t)column;
    return visibility->point_index[pixel] == NO_HIT ? NO_HIT : (uint32_t)pixel;
}

/* Returns the index of the pixel whose visibility a sample uses.
 *
 * i, j     column and row of the sample in the sample grid; integers are centres of samples.
 * hit      the point that the sample hits.
 *
 * If the pixel that contains the sample shows the same surface, the result is this pixel. Otherwise
 * it is one of the pixels at most two columns and two rows away that show the same SurfaceKind: the
 * pixel whose shading point is nearest to `hit` in space. Returns NO_HIT if there is no such
 * pixel. */
uint32_t pixelvisibility_find_pixel(const PixelVisibility *visibility, double i, double j,
                                    const ShadingPoint *hit);

/* Returns a shading point. `position` is in world coordinates, mm; `normal` and `pixel_mm` are as
 * in ShadingPoint. */
ShadingPoint shadingpoint_of(const PixelVisibility *visibility, SurfaceKind surface, Vec3 position,
                             Vec3 normal, double pixel_mm);

/* Returns the width of a pixel, mm, at the distance `t` mm along a camera ray. For an orthographic
 * camera the width does not depend on t. */
double pixelvisibility_pixel_mm(const Camera *camera, double t);

/* Returns the ambient visibility of a pixel; 1 for NO_HIT. */
static inline float pixelvisibility_ambient(const PixelVisibility *visibility, uint32_t pixel)
{
    return visibility->ambient && pixel != NO_HIT ? visibility->ambient[pixel] : 1;
}

/* Returns the visibility of a light at a pixel; 1 for NO_HIT; -1 for a light that is not an area
 * light that casts shadows. */
static inline float pixelvisibility_light(const PixelVisibility *visibility, size_t light,
                                          uint32_t pixel)
{
    if (!visibility->lights[light])
        return -1;
    return pixel != NO_HIT ? visibility->lights[light][pixel] : 1;
}

/* Frees the visibility and its arrays. NULL is allowed. */
void pixelvisibility_free(PixelVisibility *visibility);

#endif
