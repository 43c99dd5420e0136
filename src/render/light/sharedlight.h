/* Light that the samples of a pixel share: the part of the sky that a surface sees, and the parts
 * of area lights, found once for what the centre of a pixel sees. */
#ifndef CORCAST_RENDER_SHAREDLIGHT_H
#define CORCAST_RENDER_SHAREDLIGHT_H

#include "render/job.h"
#include "scene/scene.h"
#include <math.h>

typedef enum PlaceKind { PLACE_VESSEL, PLACE_GROUND } PlaceKind;

/* What the centre of a pixel sees. */
typedef struct PixelPlace {
    float at[3];     /* mm from SharedLight.origin */
    float normal[3]; /* unit, facing the viewer */
    float size;      /* mm that a pixel is wide there, across the view */
    PlaceKind kind;
} PixelPlace;

/* In SharedLight.numbers: nothing is seen. */
#define PLACE_NONE UINT32_MAX

/* Constant once made [render/sky/share.h]. */
typedef struct SharedLight {
    int width, first, rows; /* pixels: the picture's width, and `rows` rows from `first` on */
    int side;               /* samples of the drawing that a pixel's side has, mostly 1 */
    Vec3 origin;
    uint32_t
        *numbers; /* owned, as all that follows; of each pixel, row by row, that of its place */
    PixelPlace *places;            /* of each number */
    float *open;                   /* of each pixel that sees something, the part of the sky that
                                    * its place sees; NULL: all */
    float *parts[VIEW_MAX_LIGHTS]; /* likewise of each light; NULL: it is no area light */
} SharedLight;

/* Where a place is, mm from SharedLight.origin. */
static inline Vec3 pixelplace_point(const PixelPlace *place)
{
    return vec3((double)place->at[0], (double)place->at[1], (double)place->at[2]);
}

/* Whether b is of the surface that a is of: of the same kind, and each within 5 / 4 of a pixel's
 * width of the other's tangent plane. */
static inline bool places_are_of_one(const PixelPlace *a, const PixelPlace *b)
{
    float off_a = 0, off_b = 0, most = 1.25f * a->size;
    if (a->kind != b->kind)
        return false;
    for (int c = 0; c < 3; c++) {
        float way = b->at[c] - a->at[c];
        off_a += way * a->normal[c];
        off_b += way * b->normal[c];
    }
    /* In one go: which of these fails is hard to foresee. */
    return (fabsf(off_a) < most) & (fabsf(off_b) < most);
}

/* The pixel at (column, row) of the picture, counted from the first of the rows that there are;
 * PLACE_NONE outside these, and where nothing is seen. */
static inline uint32_t sharedlight_at(const SharedLight *shared, int column, int row)
{
    row -= shared->first;
    if (column < 0 || column >= shared->width || row < 0 || row >= shared->rows)
        return PLACE_NONE;
    size_t pixel = (size_t)row * (size_t)shared->width + (size_t)column;
    return shared->numbers[pixel] == PLACE_NONE ? PLACE_NONE : (uint32_t)pixel;
}

/* The pixel whose light a sample takes, which is at (i, j) of the drawing and sees `seen`. The
 * sample takes the light of the pixel that it lies in if that pixel shows the same surface; else,
 * of the pixels at most two away that show the same kind of surface, the light of the one whose
 * place is nearest to `seen`. PLACE_NONE if there is none. */
uint32_t sharedlight_pixel(const SharedLight *shared, double i, double j, const PixelPlace *seen);

/* A place at a point of the world. `mm_a_pixel` as in PixelPlace.size. */
PixelPlace sharedlight_place(const SharedLight *shared, PlaceKind kind, Vec3 point, Vec3 normal,
                             double mm_a_pixel);

/* The width, mm, of a pixel at a distance along the camera's ray. */
double sharedlight_pixel_mm(const Camera *camera, double t);

/* What samples share with a pixel: the part of the sky that its place sees, and that of a light, or
 * -1 of one that is no area light that casts shadows. PLACE_NONE: all of both. */
static inline float sharedlight_open(const SharedLight *shared, uint32_t pixel)
{
    return shared->open && pixel != PLACE_NONE ? shared->open[pixel] : 1;
}

static inline float sharedlight_part(const SharedLight *shared, size_t light, uint32_t pixel)
{
    if (!shared->parts[light])
        return -1;
    return pixel != PLACE_NONE ? shared->parts[light][pixel] : 1;
}

void sharedlight_free(SharedLight *shared);

#endif
