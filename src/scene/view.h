/* A View: camera, lights, ground, background, fade and effects. stage_view [stage/stage.h] builds
 * it. Pixel (i, j) is in column i from the left and row j from the top. World coordinates are
 * right-handed and in mm; colors are linear RGB. */
#ifndef CORCAST_SCENE_VIEW_H
#define CORCAST_SCENE_VIEW_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/appearance.h"
#include "scene/effects.h"

typedef enum Projection { PROJECTION_ORTHOGRAPHIC, PROJECTION_PERSPECTIVE } Projection;

/* A camera of W x H pixels. The ray of pixel (i, j) is defined by
 *     x0 = (i + 1/2) / W - 1/2,  y0 = ((H - 1) - (j - 1/2)) / H - 1/2.
 * An orthographic ray starts at location + x0 right + y0 up and has the direction `direction`. A
 * perspective ray starts at location and has the direction direction + x0 right + y0 up,
 * normalised. This is POV-Ray's camera (tracepixel.cpp of 3.7.0.10), including the order of
 * floating-point operations. */
typedef struct Camera {
    Projection projection;
    Vec3 location;
    Vec3 right;        /* vector across the full width of the picture: in mm (orthographic), or at
                        * distance 1 (perspective) */
    Vec3 up;           /* vector up the full height, in the same unit; right x up is opposite to
                        * direction */
    Vec3 direction;    /* unit */
    int width, height; /* pixels */
} Camera;

/* Returns the ray through a point of the picture; integers i, j are the centre of pixel (i, j). The
 * direction has length 1, so the parameter t of the ray is the depth in mm. Depth is measured from
 * `location` (perspective), or from the plane through `location` (orthographic). */
Ray camera_ray(const Camera *camera, double i, double j);

/* The projection of a point by a camera. */
typedef struct CameraPoint {
    double x, y;     /* pixels from the left and upper edges of the picture: the centre of pixel
                      * (i, j) is at (i + 0.5, j + 0.5), unlike in camera_ray */
    double depth_mm; /* depth, as the parameter t of camera_ray */
    double per_mm;   /* pixels per mm, perpendicular to the view direction, at this depth. 0: the
                      * point is not in front of a perspective camera; all members are then 0 */
} CameraPoint;

/* Projects a point. */
CameraPoint camera_point(const Camera *camera, Vec3 point);

/* Returns a camera of 1 x 1 pixels. Its pixel has the same rays, including those of the
 * antialiasing samples, as pixel (i, j) of `camera`. In perspective, the direction of the result
 * neither has length 1 nor is perpendicular to right and up. */
Camera camera_of_pixel(const Camera *camera, int i, int j);

/* Computes the positions of the n x n additional samples of an antialiased pixel. offsets[0 .. n -
 * 1] are distances from the pixel's centre in pixels, the same for columns and rows. They are equal
 * to POV-Ray's, including rounding [docs/POVRAY.md]. */
void camera_sample_offsets(int n, double *offsets);

/* Computes depths such that no ray of the camera meets the box outside [*near_mm, *far_mm]: those
 * of the ball around the box. *near_mm is at least 0; *far_mm is below 0 if the ball is wholly
 * behind an orthographic camera. */
void camera_depth_range(const Camera *camera, Box box, double *near_mm, double *far_mm);

/* A light: a point light at `location`, or, if `parallel` is true, light that travels in the
 * direction from `location` to `target` everywhere.
 *
 * A point light with samples >= 2 is an area light. `samples` must then be a power of two. Shadows
 * are averaged over a grid of samples x samples points. The grid spans the parallelogram of
 * sides[0] and sides[1], centred at `location`. If `round` is true, the squares of the grid become
 * circles, as in POV-Ray. The shadow of a vessel parallel to a side then has no stripes: all points
 * of a row of the grid have the same distance from the vessel, and the points of a circle do not.
 * Diffuse and specular light are computed from `location` alone. */
typedef struct Light {
    Vec3 location;
    Vec3 target;
    Rgb color;
    bool parallel;
    bool casts_shadows;
    bool round;  /* the points of an area light lie on circles instead of squares */
    int samples; /* points along each side of an area light; 0 or 1: one point */
    Vec3 sides[2];
} Light;

/* Direction and distance from a point to a light. */
typedef struct LightDirection {
    Vec3 towards;    /* unit */
    double distance; /* mm; for a parallel light, to the plane through its `location` */
} LightDirection;

/* Returns direction and distance from `point` to a light. */
LightDirection light_direction(const Light *light, Vec3 point);

/* Returns true if the light casts shadows and is an area light. */
bool light_is_soft(const Light *light);

/* Returns the number of points that shadows are averaged over: 1, or samples x samples. */
int light_points(const Light *light);
/* Returns point k of a light, 0 <= k < light_points(), as a light of its own. Consecutive points
 * form rows along sides[0]. */
Light light_at_point(const Light *light, int k);
/* Returns direction and distance from `point` to point k of a light. */
LightDirection light_direction_to_point(const Light *light, int k, Vec3 point);

/* A plane under or behind the vessels: the points x with normal . x = offset_mm. The ground appears
 * in the colors of a picture only; the images of depth, normals and ids contain vessels only. */
typedef struct Ground {
    bool present; /* false: no ground */
    Vec3 normal;  /* unit, towards the vessels */
    double offset_mm;
    Rgb color;
    Finish finish;
} Ground;

/* Intersects a ray with the ground. Sets *t to the depth in mm. Returns false if there is no
 * intersection between `near_mm` and `far_mm`; *t is then not set. The computation is that of
 * POV-Ray's plane (plane.cpp of 3.7.0.10), including the order of floating-point operations. */
bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t);

/* Depth fading: the fraction of the background's color that is mixed into the color of the vessels.
 * The fraction changes linearly with depth, from `nearest` at near_mm to `farthest` at far_mm, and
 * is constant outside this interval. */
typedef struct Fade {
    double nearest, farthest; /* in [0, 1]; both 0: no fading */
    double near_mm, far_mm;   /* near_mm < far_mm if there is fading */
} Fade;

/* Returns true if there is fading. */
static inline bool fade_is_on(const Fade *fade)
{
    return fade->nearest > 0 || fade->farthest > 0;
}

/* Returns the fraction of the background's color at a depth. */
static inline double fade_at(const Fade *fade, double depth_mm)
{
    if (!fade_is_on(fade))
        return 0;
    double part = (depth_mm - fade->near_mm) / (fade->far_mm - fade->near_mm);
    part = part < 0 ? 0 : part > 1 ? 1 : part;
    return fade->nearest + (fade->farthest - fade->nearest) * part;
}

/* Maximum number of lights of a view; reason of the value not recorded. */
enum { VIEW_MAX_LIGHTS = 64 };

/* All that a picture needs except vessels. A View owns no memory, and does not change after
 * stage_view has built it. */
typedef struct View {
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    Ground ground;
    Rgb background;
    Fade fade;
    bool transparent; /* true: the picture has an alpha channel instead of a background;
                       * `background` is then used by outputs without alpha */
    Effects effects;
} View;

/* Returns true if a light of the view casts soft shadows. */
bool view_has_soft_shadows(const View *view);

/* Returns the view with camera, lights and ground translated by `by`, in mm. */
View view_moved(const View *view, Vec3 by);
/* Returns the view with camera, lights and ground rotated counterclockwise around an axis through
 * `center`, by an angle in radians. `axis` may have any length except 0. */
View view_turned(const View *view, Vec3 center, Vec3 axis, double angle);

/* Checks that camera and ground are finite, that the camera is within SCENE_FARTHEST_MM of the
 * origin, and that the camera's vectors are not zero. Errors: STATUS_INPUT. */
MUST_CHECK Status view_check(const View *view, Err *err);

#endif
