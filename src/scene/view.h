/* A View: camera, lights, ground, background, fade and effects. The image has its origin at the
 * upper left: pixel (i, j) is in column i and row j, and integers are the centres of pixels. World
 * coordinates are right-handed and in mm, colors are linear RGB. */
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
    Vec3 up;           /* full height in the same unit; right x up points against direction */
    Vec3 direction;    /* unit */
    int width, height; /* pixels */
} Camera;

/* Returns the ray through a point of the picture. Integers i, j are the centre of pixel (i, j). The
 * direction is unit, so the parameter t of the ray is the depth in mm: from `location`
 * (perspective), or from the plane through `location` (orthographic). */
Ray camera_ray(const Camera *camera, double i, double j);

/* The projection of a point by a camera. */
typedef struct CameraPoint {
    double x, y;     /* pixels from the left and upper edges of the picture */
    double depth_mm; /* as the parameter of camera_ray */
    double per_mm;   /* pixels per mm across the view at this depth; 0: the point is not in front
                      * of a perspective camera, and the other members are undefined */
} CameraPoint;

/* Projects a point. */
CameraPoint camera_point(const Camera *camera, Vec3 point);

/* Returns a camera of 1 x 1 pixels whose pixel is pixel (i, j) of `camera`, antialiasing samples
 * included. The direction of a perspective result is neither unit nor perpendicular to right and
 * up. */
Camera camera_of_pixel(const Camera *camera, int i, int j);

/* Computes the positions of the n x n additional samples of an antialiased pixel: offsets[n] from
 * its centre in pixels, the same in both directions. They are POV-Ray's, rounding included
 * [docs/POVRAY.md]. */
void camera_sample_offsets(int n, double *offsets);

/* Computes an interval of depths that holds the box for every pixel. */
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

/* Direction and distance from a point to a light. */
typedef struct LightDirection {
    Vec3 towards;    /* unit */
    double distance; /* mm; for a parallel light, to the plane through its `location` */
} LightDirection;

/* Returns direction and distance from `place` to a light. */
LightDirection light_direction(const Light *light, Vec3 place);

/* Returns true if the light casts shadows that are averaged over more than one of its points. */
bool light_is_soft(const Light *light);

/* Returns the number of points that shadows are averaged over: 1, or samples x samples. */
int light_points(const Light *light);
/* Returns point k of a light, 0 <= k < light_points(), as a light of its own. Points are in rows
 * along sides[0]. */
Light light_at_point(const Light *light, int k);
/* Returns direction and distance from `place` to point k of a light. */
LightDirection light_direction_to_point(const Light *light, int k, Vec3 place);

/* A plane under or behind the vessels: the points x with normal . x = offset_mm. It appears in
 * colors only; planes of depth, normals and ids show vessels alone. */
typedef struct Ground {
    bool present;
    Vec3 normal; /* unit, towards the vessels */
    double offset_mm;
    Rgb color;
    Finish finish;
} Ground;

/* Intersects a ray with the ground. Returns false if there is no intersection between `near_mm` and
 * `far_mm`; *t is then not set. This is POV-Ray's plane, order of evaluation included (plane.cpp of
 * 3.7.0.10). */
bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t);

/* The fraction of the background's color that is mixed into the vessels. It changes linearly with
 * the depth along the ray, from `nearest` at near_mm to `farthest` at far_mm. */
typedef struct Fade {
    double nearest, farthest; /* in [0, 1]; both 0: no fading */
    double near_mm, far_mm;   /* near_mm < far_mm if there is fading */
} Fade;

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

enum { VIEW_MAX_LIGHTS = 64 };

/* A value that owns nothing. Immutable once made [stage_view]. */
typedef struct View {
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    Ground ground;
    Rgb background;
    Fade fade;
    bool transparent; /* the picture has no background; `background` is for outputs without alpha */
    Effects effects;
} View;

/* Returns true if a light of the view casts soft shadows. */
bool view_has_soft_shadows(const View *view);

/* Returns the view with camera, lights and ground moved by `by`. */
View view_moved(const View *view, Vec3 by);
/* Returns the view turned around an axis through `center`, by an angle in radians. */
View view_turned(const View *view, Vec3 center, Vec3 axis, double angle);

/* Checks that camera and ground are finite, that the camera lies within SCENE_FARTHEST_MM of the
 * origin, and that its vectors are not zero. Errors: STATUS_INPUT. */
MUST_CHECK Status view_check(const View *view, Err *err);

#endif
