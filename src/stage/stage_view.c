/* Builds a view: places the camera, the ground and the lights.
 *
 * A camera that frames a subject shows exactly the balls around the ends of its vessels. The
 * distance of an orthographic camera changes no picture, only the depths that are reported. The
 * camera is placed in front of the middle of the framed box, at the length of the diagonal of the
 * box around the framed box and the subject.
 *
 * The look defines ground and lights in the camera's axes and in sizes of the tree. */
#include "stage/subject.h"

ViewParams view_defaults(void)
{
    return (ViewParams){.width = 1000,
                        .height = 1000,
                        .projection = PROJECTION_ORTHOGRAPHIC,
                        .view = VIEW_FRONT,
                        .angle_deg = 30,
                        .margin = 0.05};
}

/* ---- the camera ------------------------------------------------------------------------------ */

/* Converts a vector from a world whose y axis is up to a world with the up axis `up_axis`. */
static Vec3 upright(UpAxis up_axis, Vec3 v)
{
    return up_axis == UP_Z ? vec3(v.x, -v.z, v.y) : v;
}

void view_axes(const ViewParams *params, Vec3 *direction, Vec3 *up)
{
    static const struct {
        Vec3 direction, up;
    } axes[] = {
        [VIEW_FRONT] = {{0, 0, -1}, {0, 1, 0}}, [VIEW_BACK] = {{0, 0, 1}, {0, 1, 0}},
        [VIEW_LEFT] = {{1, 0, 0}, {0, 1, 0}},   [VIEW_RIGHT] = {{-1, 0, 0}, {0, 1, 0}},
        [VIEW_TOP] = {{0, -1, 0}, {0, 0, -1}},  [VIEW_BOTTOM] = {{0, 1, 0}, {0, 0, 1}},
        [VIEW_ISO] = {{-1, -1, -1}, {0, 1, 0}},
    };
    *direction = vec3_normalized(upright(params->up_axis, axes[params->view].direction));
    *up = upright(params->up_axis, axes[params->view].up);
    if (params->turn_deg == 0 && params->rise_deg == 0)
        return;
    Vec3 axis = upright(params->up_axis, vec3(0, 1, 0));
    double turn = params->turn_deg * DEGREE, rise = params->rise_deg * DEGREE;
    *direction = vec3_rotated(*direction, axis, turn);
    *up = vec3_rotated(*up, axis, turn);
    Vec3 right = vec3_normalized(vec3_cross(*direction, *up));
    *up = vec3_rotated(vec3_cross(right, *direction), right, -rise);
    *direction = vec3_rotated(*direction, right, -rise);
}

/* Sets the direction of the camera and an up vector `sky`, which need not be perpendicular to the
 * direction. */
static Status camera_direction(const ViewParams *params, Vec3 center, Vec3 *direction, Vec3 *sky,
                               Err *err)
{
    view_axes(params, direction, sky);
    if (!params->has_location)
        return STATUS_OK;
    Vec3 target = params->has_look_at ? params->look_at : center;
    Vec3 span = vec3_sub(target, params->location);
    if (!isfinite(vec3_length(span)))
        return err_set(err, STATUS_USAGE,
                       "`location` and `look_at` (%s) are farther apart than 1e150 mm",
                       params->has_look_at ? "as specified" : "the center of the tree");
    if (!(vec3_length(span) > 0))
        return err_set(err, STATUS_USAGE,
                       "`location` and `look_at` are the same point, so the camera has no "
                       "direction; give two different points");
    *direction = vec3_normalized(span);
    *sky = upright(params->up_axis, vec3(0, 1, 0));
    return STATUS_OK;
}

/* Sets direction, right and up of the camera; right and up are unit vectors perpendicular to the
 * direction. */
static Status aim_camera(const ViewParams *params, Vec3 center, Camera *camera, Err *err)
{
    Vec3 sky;
    TRY(camera_direction(params, center, &camera->direction, &sky, err));
    if (params->has_up)
        sky = params->up;
    Vec3 across = vec3_cross(camera->direction, sky);
    if (!(vec3_length(across) > 1e-9 * vec3_length(sky)) && !params->has_up) {
        sky = upright(params->up_axis, vec3(0, 0, -1)); /* the camera looks along the up axis */
        across = vec3_cross(camera->direction, sky);
    }
    if (!(vec3_length(across) > 1e-9 * vec3_length(sky)))
        return err_set(err, STATUS_USAGE,
                       "`up` points along the camera's direction; give a vector that does not");
    camera->right = vec3_normalized(across);
    camera->up = vec3_cross(camera->right, camera->direction);
    return STATUS_OK;
}

typedef struct ViewExtent {
    double low_x, high_x, low_y, high_y;
} ViewExtent;

/* Sets *low and *high to the range of a box along `along`, if `along` is a coordinate axis or its
 * opposite. Otherwise returns false. */
static bool extent_of_box(Box box, Vec3 along, double *low, double *high)
{
    for (int axis = 0; axis < 3; axis++) {
        double part = vec3_component(along, axis);
        if (fabs(part) != 1 || vec3_dot(along, along) != 1)
            continue;
        double ends[] = {vec3_component(box.low, axis), vec3_component(box.high, axis)};
        *low = part > 0 ? ends[0] : -ends[1];
        *high = part > 0 ? ends[1] : -ends[0];
        return true;
    }
    return false;
}

/* Returns the range of the balls in the picture plane, whose axes are `right` and `up`. For a tree
 * and a camera along a coordinate axis, which most cameras are, this is the range of the tree's
 * box. The box of a geometry may be smaller than its balls, so the balls themselves are used
 * there. */
static ViewExtent extent_along(const Framed *framed, Vec3 right, Vec3 up)
{
    ViewExtent extent;
    if (framed->subject->tree && extent_of_box(framed->box, right, &extent.low_x, &extent.high_x) &&
        extent_of_box(framed->box, up, &extent.low_y, &extent.high_y))
        return extent;
    extent = (ViewExtent){INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (size_t i = 0; i < framed_segments(framed); i++) {
        Ball ends[2];
        for (int k = framed_ends(framed, i, ends); k-- > 0;) {
            double x = vec3_dot(ends[k].center, right), y = vec3_dot(ends[k].center, up);
            extent.low_x = fmin(extent.low_x, x - ends[k].radius);
            extent.high_x = fmax(extent.high_x, x + ends[k].radius);
            extent.low_y = fmin(extent.low_y, y - ends[k].radius);
            extent.high_y = fmax(extent.high_y, y + ends[k].radius);
        }
    }
    return extent;
}

/* Returns the minimum distance from the middle, against the direction of view, at which a pinhole
 * camera shows every ball whole. tan_x and tan_y are the half width and the half height of its
 * picture at unit distance. */
static double framing_distance(const Framed *framed, const Camera *camera, double tan_x,
                               double tan_y)
{
    Vec3 center = box_center(framed->box);
    double slant_x = sqrt(1 + tan_x * tan_x), slant_y = sqrt(1 + tan_y * tan_y);
    double distance = 0;
    for (size_t i = 0; i < framed_segments(framed); i++) {
        Ball ends[2];
        for (int k = framed_ends(framed, i, ends); k-- > 0;) {
            Vec3 from = vec3_sub(ends[k].center, center);
            double towards = -vec3_dot(from, camera->direction), r = ends[k].radius;
            double wide = (fabs(vec3_dot(from, camera->right)) + r * slant_x) / tan_x;
            double high = (fabs(vec3_dot(from, camera->up)) + r * slant_y) / tan_y;
            distance = fmax(distance, towards + fmax(wide, high));
        }
    }
    return distance;
}

/* Minimum distance of an orthographic camera from the middle of the vessels. POV-Ray does not show
 * surfaces nearer to a camera than 0.01 mm [docs/POVRAY.md, sections 4 and 6]. Reason for the
 * larger value not recorded. */
static const double least_distance_mm = 0.05;

/* Places a camera that shows the framed extent. The pixels of params->room are free at the right
 * and at the lower edge, so the camera is shifted by half of them. */
static void place_orthographic(const ViewParams *params, const Framed *framed, Camera *camera)
{
    double aspect = (double)params->width / params->height, used = 1 - 2 * params->margin;
    Vec3 right = camera->right, up = camera->up, direction = camera->direction;
    Vec3 center = box_center(framed->box);
    Box all = box_union(framed->box, framed->subject->box);
    /* If position and height are specified, nothing is framed. */
    bool placed = params->has_look_at && params->height_mm > 0;
    ViewExtent extent = placed ? (ViewExtent){0} : extent_along(framed, right, up);
    double wide = extent.high_x - extent.low_x, high = extent.high_y - extent.low_y;
    double room_x = (double)params->room[0] / params->width;
    double room_y = (double)params->room[1] / params->height;
    double least = fmax(high / (1 - room_y), wide / (1 - room_x) / aspect) / used;
    double height = params->height_mm > 0 ? params->height_mm : least;
    double x = (extent.low_x + extent.high_x) / 2, y = (extent.low_y + extent.high_y) / 2;
    if (params->has_look_at) {
        x = vec3_dot(params->look_at, right);
        y = vec3_dot(params->look_at, up);
    }
    x += room_x / 2 * height * aspect;
    y -= room_y / 2 * height;
    Vec3 middle = vec3_add_scaled(vec3_scale(right, x), up, y);
    double distance = fmax(vec3_distance(all.low, all.high), least_distance_mm);
    middle = vec3_add_scaled(middle, direction, vec3_dot(center, direction) - distance);
    camera->location = params->has_location ? params->location : middle;
    camera->right = vec3_scale(right, height * aspect);
    camera->up = vec3_scale(up, height);
}

/* Places a camera that shows all balls. The view stays centered on the target, so the pixels of
 * params->room are free at opposite edges, too. */
static void place_perspective(const ViewParams *params, const Framed *framed, Camera *camera)
{
    double aspect = (double)params->width / params->height, used = 1 - 2 * params->margin;
    double tan_x = elementary_tan(params->angle_deg * DEGREE / 2), tan_y = tan_x / aspect;
    double room_x = (double)params->room[0] / params->width;
    double room_y = (double)params->room[1] / params->height;
    Vec3 target = params->has_look_at ? params->look_at : box_center(framed->box);
    camera->location = params->location;
    if (!params->has_location) {
        double distance = framing_distance(framed, camera, tan_x * used * (1 - 2 * room_x),
                                           tan_y * used * (1 - 2 * room_y));
        camera->location = vec3_add_scaled(target, camera->direction, -distance);
    }
    camera->right = vec3_scale(camera->right, 2 * tan_x);
    camera->up = vec3_scale(camera->up, 2 * tan_y);
}

/* ---- ground and lights ------------------------------------------------------------------------
 */

/* Converts a vector from the camera's axes (right, up, towards the viewer) to world coordinates. */
static Vec3 from_camera(const Camera *camera, Vec3 v)
{
    Vec3 world = vec3_scale(vec3_normalized(camera->right), v.x);
    world = vec3_add_scaled(world, vec3_normalized(camera->up), v.y);
    return vec3_add_scaled(world, camera->direction, -v.z);
}

/* Places the ground at the lowest point of all balls along the ground's normal, lowered by the gap
 * of the look. The ground has no highlights, so its phong size and roughness have no effect. */
static Ground place_ground(const LookGround *look, const Camera *camera, const Subject *subject)
{
    if (!look->present)
        return (Ground){0};
    Vec3 normal = look->in_world ? look->normal : from_camera(camera, look->normal);
    Ground ground = {.present = true,
                     .normal = vec3_normalized(normal),
                     .offset_mm = HUGE_VAL,
                     .color = look->color,
                     .finish = {.ambient = (float)look->ambient,
                                .diffuse = (float)look->diffuse,
                                .brilliance = 1,
                                .phong_size = 40,
                                .roughness = 0.05f}};
    for (size_t i = 0; i < subject_segments(subject); i++) {
        Ball ends[2];
        for (int k = subject_ends(subject, i, ends); k-- > 0;)
            ground.offset_mm =
                fmin(ground.offset_mm, vec3_dot(ground.normal, ends[k].center) - ends[k].radius);
    }
    ground.offset_mm -= look->gap * vec3_distance(subject->box.low, subject->box.high) / 2;
    return ground;
}

/* Places a light in the world. Parallel lights are ten diagonals of the box away, in front of
 * everything that they light. POV-Ray has no parallel area lights. A parallel light with a size
 * therefore becomes an area light at that distance if it casts shadows, and stays parallel if it
 * does not. */
static Light place_light(const LookLight *light, const Camera *camera, Box bounds, bool shadows)
{
    Vec3 right = vec3_normalized(camera->right), up = vec3_normalized(camera->up);
    Vec3 center = box_center(bounds), direction = light->direction;
    double diagonal = vec3_distance(bounds.low, bounds.high);
    double unit = light->is_point ? diagonal / 2 : 10 * diagonal;
    bool is_area = light->size > 0 && (light->is_point || shadows);
    if (!light->is_point)
        direction = vec3_normalized(direction);
    Vec3 offset = from_camera(camera, direction);
    Light placed = {.location = vec3_add_scaled(center, offset, unit),
                    .target = center,
                    .color = light->color,
                    .parallel = !light->is_point && !is_area,
                    .casts_shadows = shadows};
    if (is_area) {
        /* The sides of the area light are perpendicular to the direction to the tree; if possible,
         * one side is horizontal in the picture. */
        Vec3 towards = vec3_normalized(offset), level = vec3_cross(up, towards);
        level = vec3_length(level) > 1e-6 ? vec3_normalized(level) : right;
        placed.round = light->round;
        placed.samples = light->samples;
        placed.sides[0] = vec3_scale(level, light->size * unit);
        placed.sides[1] = vec3_scale(vec3_cross(towards, level), light->size * unit);
    }
    return placed;
}

/* ---- effects --------------------------------------------------------------------------------- */

/* Fading starts at the depth of the nearest vessel axis and ends at the depth of the farthest
 * vessel axis. If these depths differ by less than this fraction of the diagonal of the vessels'
 * box, fading extends over that length instead: a flat tree viewed face-on then does not fade.
 * Reason for 1/3 not recorded. */
static const double least_fade = 1.0 / 3;

static Fade place_fade(const Look *look, const Camera *camera, const Subject *subject)
{
    double diagonal = vec3_distance(subject->box.low, subject->box.high);
    Fade fade = {look->fade_nearest, look->fade_farthest, INFINITY, -INFINITY};
    if (!fade_is_on(&fade))
        return (Fade){0};
    for (size_t i = 0; i < subject_segments(subject); i++) {
        Ball ends[2];
        for (int k = subject_ends(subject, i, ends); k-- > 0;) {
            Vec3 from = vec3_sub(ends[k].center, camera->location);
            double depth = camera->projection == PROJECTION_PERSPECTIVE
                               ? vec3_length(from)
                               : vec3_dot(from, camera->direction);
            fade.near_mm = fmin(fade.near_mm, depth);
            fade.far_mm = fmax(fade.far_mm, depth);
        }
    }
    fade.far_mm = fmax(fade.far_mm, fade.near_mm + least_fade * diagonal);
    return fade;
}

/* Returns the largest diameter of a vessel. */
static double thickest_mm(const Geometry *geometry)
{
    double radius = 0;
    for (size_t i = 0; i < geometry->n_primitives - geometry->n_ends; i++)
        radius = fmax(radius, geometry->primitives[i].radius_mm);
    for (size_t i = 0; i < geometry->n_segments; i++)
        radius = fmax(radius, geometry->segments[i].radius_mm);
    return 2 * radius;
}

static Effects place_effects(const Look *look, const Camera *camera, const Subject *subject)
{
    double thousandth_px = fmin(camera->width, camera->height) / 1000;
    double diameter = look->effects.xray_per_diameter > 0 ? thickest_mm(subject->geometry) : 0;
    return look_effects(look, thousandth_px, diameter);
}

/* Places ground and lights around the subject, in the axes of the camera. */
static void place_surroundings(const Look *look, const ViewParams *params, const Subject *subject,
                               View *view)
{
    view->ground = place_ground(&look->ground, &view->camera, subject);
    view->n_lights = (size_t)look->n_lights;
    for (size_t i = 0; i < view->n_lights; i++)
        view->lights[i] =
            place_light(&look->lights[i], &view->camera, subject->box, params->shadows);
}

Box stage_box(const ViewParams *params, const Geometry *geometry)
{
    ViewParams unknown = *params;
    unknown.box = NULL; /* subject_of then computes the box */
    return subject_of(&unknown, geometry).box;
}

Status stage_view(const Look *look, const ViewParams *params, const Geometry *geometry, View *view,
                  Err *err)
{
    const Subject subject = subject_of(params, geometry);
    View made = {.background = look->background,
                 .transparent = params->transparent,
                 .camera = {.projection = params->projection,
                            .width = params->width,
                            .height = params->height}};
    ViewParams near = *params; /* moved to the origin, like the geometry */
    near.location = vec3_sub(params->location, geometry->origin);
    near.look_at = vec3_sub(params->look_at, geometry->origin);
    TRY(aim_camera(&near, box_center(subject.box), &made.camera, err));
    place_surroundings(look, params, &subject, &made);
    const Framed framed = framed_of(&subject, params->domain);
    if (params->projection == PROJECTION_ORTHOGRAPHIC)
        place_orthographic(&near, &framed, &made.camera);
    else
        place_perspective(&near, &framed, &made.camera);
    made.fade = place_fade(look, &made.camera, &subject);
    made.effects = place_effects(look, &made.camera, &subject);
    TRY(view_check(&made, err));
    *view = made;
    return STATUS_OK;
}
