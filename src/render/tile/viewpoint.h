/* From where and along which axes a picture, or a light, looks at the scene. */
#ifndef CORCAST_RENDER_VIEWPOINT_H
#define CORCAST_RENDER_VIEWPOINT_H

#include "scene/scene.h"

/* A frame of its own: x to the right, y up, z along the view, mm from the location. Lines of sight
 * are parallel to z, or in perspective lead through the location. */
typedef struct Viewpoint {
    Vec3 location;
    Vec3 axes[3]; /* right, up and along the view: orthonormal, left-handed */
    bool perspective;
} Viewpoint;

static inline Viewpoint viewpoint_of_camera(const Camera *camera)
{
    return (Viewpoint){
        camera->location,
        {vec3_normalized(camera->right), vec3_normalized(camera->up), camera->direction},
        camera->projection == PROJECTION_PERSPECTIVE};
}

/* A direction of the world in the frame, and back. */
static inline Vec3 viewpoint_frame_direction(const Viewpoint *eye, Vec3 v)
{
    return vec3(vec3_dot(v, eye->axes[0]), vec3_dot(v, eye->axes[1]), vec3_dot(v, eye->axes[2]));
}

static inline Vec3 viewpoint_world_direction(const Viewpoint *eye, Vec3 v)
{
    Vec3 world = vec3_add_scaled(vec3_scale(eye->axes[0], v.x), eye->axes[1], v.y);
    return vec3_add_scaled(world, eye->axes[2], v.z);
}

/* A point of the world in the frame, and back. */
static inline Vec3 viewpoint_frame_point(const Viewpoint *eye, Vec3 point)
{
    return viewpoint_frame_direction(eye, vec3_sub(point, eye->location));
}

static inline Vec3 viewpoint_world_point(const Viewpoint *eye, Vec3 place)
{
    return vec3_add(eye->location, viewpoint_world_direction(eye, place));
}

#endif
