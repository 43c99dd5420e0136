/* From where and in what light vessels are seen. Lengths in mm, colours linear RGB, right-handed.
 */
#ifndef CORCAST_SCENE_VIEW_H
#define CORCAST_SCENE_VIEW_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/appearance.h"
#include "scene/effects.h"

typedef enum Projection { PROJECTION_ORTHOGRAPHIC, PROJECTION_PERSPECTIVE } Projection;

/* Pixel (i, j), j from the top, looks along the ray through
 *   x0 = (i + 1/2) / W - 1/2,  y0 = ((H - 1) - (j - 1/2)) / H - 1/2:
 * orthographic: from location + x0 right + y0 up along direction;
 * perspective: from location along direction + x0 right + y0 up, normalised.
 * This is POV-Ray's camera (tracepixel.cpp of 3.7.0.10), order of evaluation included. */
typedef struct Camera {
    Projection projection;
    Vec3 location;
    Vec3 right;        /* full width: mm (orthographic), or per unit of direction (perspective) */
    Vec3 up;           /* full height likewise; right x up points against direction */
    Vec3 direction;    /* unit */
    int width, height; /* pixels */
} Camera;

/* The ray through the point (i + dx, j + dy) of the pixel grid, dx = dy = 0 at the centre of pixel
 * (i, j). Its direction is unit, so that its parameter t is the depth in mm along the ray from the
 * camera point (perspective) or from the plane through location (orthographic). */
Ray camera_ray(const Camera *camera, double i, double j);

/* Where a camera sees a point. */
typedef struct CameraPoint {
    double x, y;     /* pixels from the left and upper edges of the picture */
    double depth_mm; /* as camera_ray has it */
    double per_mm; /* pixels that 1 mm across the view takes there; 0: the point is not in front of
                    * a perspective camera, and nothing else is said of it */
} CameraPoint;

CameraPoint camera_point(const Camera *camera, Vec3 point);

/* A camera of 1 x 1 pixels that sees what pixel (i, j) sees, the further samples of antialiasing
 * included. In perspective its direction is neither unit nor square to right and up. */
Camera camera_of_pixel(const Camera *camera, int i, int j);

/* Where the n x n further samples of an antialiased pixel stand, from its centre, in pixels:
 * offsets[n], the same in both directions; POV-Ray's places [docs/POVRAY.md], summed up as it sums
 * them. */
void camera_sample_offsets(int n, double *offsets);

/* An interval of depth that holds all of the box, whatever the pixel. */
void camera_depth_range(const Camera *camera, Box box, double *near_mm, double *far_mm);

/* A point light at `location`, or, when `parallel`, light that travels from `location` towards
 * `target` everywhere.
 *
 * Area light (not parallel): if `samples` >= 2, a power of two, shadows are averaged over a grid of
 * samples x samples points that spans the parallelogram sides[0] x sides[1], centred at
 * `location`. Diffuse and specular light are computed from `location` alone. */
typedef struct Light {
    Vec3 location;
    Vec3 target;
    Rgb color;
    bool parallel;
    bool casts_shadows;
    int samples; /* 0 or 1: one point */
    Vec3 sides[2];
} Light;

/* The way from a place to a light. */
typedef struct LightWay {
    Vec3 towards;    /* unit */
    double distance; /* mm; of a parallel light, to the plane through `location` */
} LightWay;

LightWay light_way(const Light *light, Vec3 place);

/* Whether the light casts soft shadows, which are averaged over more than one point of it. */
bool light_is_soft(const Light *light);

/* Points that shadows are averaged over: 1, or samples x samples. */
int light_points(const Light *light);
/* Point k of them, 0 <= k < light_points(), row by row along sides[0], as a light of its own; and
 * the way to it. */
Light light_at_point(const Light *light, int k);
LightWay light_way_to_point(const Light *light, int k, Vec3 place);

/* A plane under or behind the vessels: the points x with normal . x = offset_mm. Only colour knows
 * of it; depth, normals and ids are of vessels. */
typedef struct Ground {
    bool present;
    Vec3 normal; /* unit, towards the vessels */
    double offset_mm;
    Rgb color;
    Finish finish;
} Ground;

/* Where a ray meets the ground, if it does so between `near_mm` and `far_mm`; POV-Ray's plane,
 * order of evaluation included (plane.cpp of 3.7.0.10). */
bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t);

enum { VIEW_MAX_LIGHTS = 64 };

/* A value: nothing in it is owned. Constant once made [stage_view]. */
typedef struct View {
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    Ground ground;
    Rgb background;   /* the paper */
    bool transparent; /* there is none; `background` is for those who cannot leave it out */
    Effects effects;
} View;

/* Whether a light of the view casts soft shadows. */
bool view_has_soft_shadows(const View *view);

/* The view with all that is in it moved, or turned about an axis through `center`, by radians: what
 * is seen moves the other way. */
View view_moved(const View *view, Vec3 by);
View view_turned(const View *view, Vec3 center, Vec3 axis, double angle);

/* STATUS_INPUT unless camera and ground are finite, the camera lies within SCENE_FARTHEST_MM of
 * the origin, and its vectors are not zero. */
MUST_CHECK Status view_check(const View *view, Err *err);

#endif
