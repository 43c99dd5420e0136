/* Makes light views (the projection of the geometry from a light to a grid of tiles) and the
 * projections of shading points to them.
 *
 * The grid is the smallest rectangle that contains the projected corners of the geometry's bounding
 * box, widened by a factor of 1.0001 for rounding. If all queried points lie in a part of the grid,
 * lists are made for the tiles of this part only. The grid does not depend on the part, so the
 * results are the same to the last bit. */
#include "render/light/lightview.h"

/* Minimum distance of a point light from the middle of the scene, in radii of the scene. At this
 * distance, the scene lies within asin(1 / 1.16) = 59.6 degrees of the view axis. For a nearer
 * light, tiles at the edge of the view would be much smaller than those in its middle. */
static const double min_distance_in_radii = 1.16;

double lightview_radius(const Geometry *geometry)
{
    return vec3_distance(box_center(geometry->bounds), geometry->bounds.high);
}

/* Returns true if light and geometry are on the same side of the ground, or there is no ground. */
static bool is_before_ground(const Ground *ground, const Light *light, Vec3 center)
{
    Vec3 towards = light_direction(light, center).towards;
    double above = vec3_dot(ground->normal, center) - ground->offset_mm;
    double to_light = light->parallel
                          ? vec3_dot(ground->normal, towards)
                          : vec3_dot(ground->normal, light->location) - ground->offset_mm;
    return !ground->present || above * to_light > 0;
}

bool lightview_sees_all(const Geometry *geometry, const View *view, const Light *light)
{
    Vec3 center = box_center(geometry->bounds);
    double distance = vec3_distance(light->location, center);
    return (light->parallel || distance > min_distance_in_radii * lightview_radius(geometry)) &&
           is_before_ground(&view->ground, light, center);
}

static Vec3 corner(const Box *box, int number)
{
    return vec3(number & 1 ? box->high.x : box->low.x, number & 2 ? box->high.y : box->low.y,
                number & 4 ? box->high.z : box->low.z);
}

/* Returns the viewpoint of a light that looks at the middle of the geometry. A parallel light looks
 * along its direction. */
static Viewpoint eye_of(const Geometry *geometry, const Light *light)
{
    Viewpoint eye = {.location = light->location, .perspective = !light->parallel};
    Vec3 target = light->parallel ? light->target : box_center(geometry->bounds);
    eye.axes[2] = vec3_normalized(vec3_sub(target, light->location));
    /* 0.6: the angle between the view axis and the other vector is at least 36 degrees. */
    Vec3 other = fabs(eye.axes[2].x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    eye.axes[0] = vec3_normalized(vec3_cross(eye.axes[2], other));
    eye.axes[1] = vec3_cross(eye.axes[0], eye.axes[2]);
    return eye;
}

/* Returns the bounds of a world box in the view's plane; infinite if part of the box may be behind
 * the viewpoint. */
static Box seen_box(const Viewpoint *eye, const Box *world)
{
    Box box = box_empty();
    for (int i = 0; i < 8; i++) {
        Vec3 at = viewpoint_frame_point(eye, corner(world, i));
        if (eye->perspective && at.z <= 0)
            return (Box){vec3(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL), vec3(HUGE_VAL, HUGE_VAL, HUGE_VAL)};
        if (eye->perspective)
            at = vec3(at.x / at.z, at.y / at.z, at.z);
        box = box_with_ball(box, at, 0);
    }
    return box;
}

/* Returns the tiles between two positions, both in tiles, and one more tile to either side for
 * rounding. A position outside the grid counts as the nearest tile. */
static TileSpan tiles_between(double from, double to, int tiles)
{
    return (TileSpan){(int)max_of(min_of(from - 1, tiles - 1), 0),
                      (int)max_of(min_of(to + 1, tiles - 1), 0)};
}

LightView lightview_of(const Geometry *geometry, const Light *light, int tiles, const Box *queried)
{
    LightView view = {.eye = eye_of(geometry, light), .tiles = tiles};
    const int samples = tiles * TILE_SIDE;
    Box box = seen_box(&view.eye, &geometry->bounds);
    view.step_x = (box.high.x - box.low.x) * 1.0001 / samples;
    view.step_y = -(box.high.y - box.low.y) * 1.0001 / samples;
    view.left = (box.low.x + box.high.x) / 2 - (samples - 1) / 2.0 * view.step_x;
    view.top = (box.low.y + box.high.y) / 2 - (samples - 1) / 2.0 * view.step_y;
    view.z_middle = (box.low.z + box.high.z) / 2;
    view.columns = view.rows = (TileSpan){0, tiles - 1};
    if (queried) {
        Box seen = seen_box(&view.eye, queried);
        double per_x = 1 / (TILE_SIDE * view.step_x), per_y = 1 / (TILE_SIDE * view.step_y);
        view.columns = tiles_between((seen.low.x - view.left) * per_x,
                                     (seen.high.x - view.left) * per_x, tiles);
        view.rows =
            tiles_between((seen.high.y - view.top) * per_y, (seen.low.y - view.top) * per_y, tiles);
    }
    return view;
}

LightProjection lightview_projection(const LightView *view, const Viewpoint *camera, double slack)
{
    LightProjection aim = {.perspective = view->eye.perspective,
                           .left = view->left - view->step_x / 2,
                           .top = view->top - view->step_y / 2,
                           .per_x = 1 / (TILE_SIDE * view->step_x),
                           .per_y = 1 / (TILE_SIDE * view->step_y),
                           .columns = view->tiles,
                           .rows = view->tiles,
                           .slack = slack,
                           .z_middle = view->z_middle,
                           .offset = viewpoint_frame_point(&view->eye, camera->location)};
    for (int i = 0; i < 3; i++)
        aim.axes[i] = viewpoint_frame_direction(camera, view->eye.axes[i]);
    return aim;
}
