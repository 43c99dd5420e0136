/* The position and orientation of a camera or of a light, and conversions between world coordinates
 * and the frame of the viewpoint. Lengths are in mm. */
#ifndef CORCAST_RENDER_TILE_VIEWPOINT_H
#define CORCAST_RENDER_TILE_VIEWPOINT_H

#include "scene/scene.h"

/* A viewpoint. In its frame, x points right, y up and z along the view direction; the origin is
 * `location`. Lines of sight are parallel to z or, in perspective, pass through `location`. */
typedef struct Viewpoint {
    Vec3 location;
    Vec3 axes[3]; /* x, y and z axis of the frame, in world coordinates: orthonormal, left-handed */
    bool perspective;
} Viewpoint;

/* Returns the viewpoint of a camera. */
static inline Viewpoint viewpoint_of_camera(const Camera *camera)
{
    return (Viewpoint){
        camera->location,
        {vec3_normalized(camera->right), vec3_normalized(camera->up), camera->direction},
        camera->projection == PROJECTION_PERSPECTIVE};
}

/* Converts a direction from world coordinates to the frame. */
static inline Vec3 viewpoint_frame_direction(const Viewpoint *eye, Vec3 v)
{
    return vec3(vec3_dot(v, eye->axes[0]), vec3_dot(v, eye->axes[1]), vec3_dot(v, eye->axes[2]));
}

/* Converts a direction from the frame to world coordinates. */
static inline Vec3 viewpoint_world_direction(const Viewpoint *eye, Vec3 v)
{
    Vec3 world = vec3_add_scaled(vec3_scale(eye->axes[0], v.x), eye->axes[1], v.y);
    return vec3_add_scaled(world, eye->axes[2], v.z);
}

/* Converts a point from world coordinates to the frame. */
static inline Vec3 viewpoint_frame_point(const Viewpoint *eye, Vec3 point)
{
    return viewpoint_frame_direction(eye, vec3_sub(point, eye->location));
}

/* Converts a point from the frame to world coordinates. */
static inline Vec3 viewpoint_world_point(const Viewpoint *eye, Vec3 point)
{
    return vec3_add(eye->location, viewpoint_world_direction(eye, point));
}

#endif
