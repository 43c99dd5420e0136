/* Computes which part of a box a body (a cylinder or a ball) fills, and where a line meets the
 * body.
 *
 * The volume of a cylinder or a ball in a box is exact, by the divergence theorem. Take a vector
 * field whose divergence is 1 in the body and 0 elsewhere. The volume is the flux of the field
 * through the faces of the box.
 *
 * For a cylinder, the field points along the axis. Its magnitude is the height along the axis,
 * clamped to the two ends, inside the infinite cylinder, and 0 outside. So no flux passes the
 * cylinder's side. Projected along the axis, the faces of the box are parallelograms, which are
 * intersected with a disc. The height is linear on each face, or constant where it is clamped.
 *
 * For a ball about the origin, the field is x / 3 inside, and x / 3 (r / |x|)^3 outside, where its
 * divergence is 0. disc.h has both integrals. */
#include "voxel/body.h"

#include "voxel/disc.h"

Body body_make(Vec3 a, Vec3 b, double radius, uint32_t segment)
{
    Body body = {.start = a, .radius = radius, .segment = segment};
    body.length = vec3_distance(a, b);
    if (body.length > 0) {
        body.axis = vec3_scale(vec3_sub(b, a), 1 / body.length);
        vec3_perpendiculars(body.axis, &body.u, &body.v);
    }
    return body;
}

/* Returns the extent of a disc perpendicular to the axis along each coordinate, in units of its
 * radius. */
static Vec3 disc_reach(Vec3 axis)
{
    return vec3(sqrt(fmax(0, 1 - axis.x * axis.x)), sqrt(fmax(0, 1 - axis.y * axis.y)),
                sqrt(fmax(0, 1 - axis.z * axis.z)));
}

Box body_box(const Body *body)
{
    Vec3 end = vec3_add_scaled(body->start, body->axis, body->length);
    Box box = box_with_ball(box_with_ball(box_empty(), body->start, 0), end, 0);
    Vec3 reach =
        vec3_scale(body_is_ball(body) ? vec3(1, 1, 1) : disc_reach(body->axis), body->radius);
    return (Box){vec3_sub(box.low, reach), vec3_add(box.high, reach)};
}

/* Returns the extent of the cell from its centre along a direction, times the direction's length.
 */
static double support(const VoxelCell *cell, Vec3 direction)
{
    return cell->half.x * fabs(direction.x) + cell->half.y * fabs(direction.y) +
           cell->half.z * fabs(direction.z);
}

static double excess_beyond(double distance, double half)
{
    return distance > half ? distance - half : 0;
}

static double square(double x)
{
    return x * x;
}

bool body_meets(const Body *body, const VoxelCell *cell)
{
    Vec3 from = vec3_sub(cell->center, body->start);
    if (body_is_ball(body))
        return square(excess_beyond(fabs(from.x), cell->half.x)) +
                   square(excess_beyond(fabs(from.y), cell->half.y)) +
                   square(excess_beyond(fabs(from.z), cell->half.z)) <
               square(body->radius);
    double along = vec3_dot(from, body->axis);
    if (fabs(along - body->length / 2) >= body->length / 2 + support(cell, body->axis))
        return false;
    Vec3 across = vec3_add_scaled(from, body->axis, -along);
    double distance = vec3_length(across);
    return distance * distance < (distance * body->radius) + support(cell, across) ||
           distance < body->radius;
}

static Vec3 cell_corner(const VoxelCell *cell, int corner)
{
    return vec3(cell->center.x + (corner & 1 ? cell->half.x : -cell->half.x),
                cell->center.y + (corner & 2 ? cell->half.y : -cell->half.y),
                cell->center.z + (corner & 4 ? cell->half.z : -cell->half.z));
}

static bool ball_holds(const Body *ball, const VoxelCell *cell)
{
    Vec3 from = vec3_sub(cell->center, ball->start);
    return square(fabs(from.x) + cell->half.x) + square(fabs(from.y) + cell->half.y) +
               square(fabs(from.z) + cell->half.z) <=
           square(ball->radius);
}

bool body_holds(const Body *body, const VoxelCell *cell)
{
    if (body_is_ball(body))
        return ball_holds(body, cell);
    for (int corner = 0; corner < 8; corner++) {
        Vec3 from = vec3_sub(cell_corner(cell, corner), body->start);
        double along = vec3_dot(from, body->axis);
        if (along < 0 || along > body->length ||
            vec3_dot(from, from) - along * along > square(body->radius))
            return false;
    }
    return true;
}

/* ---- a cylinder in a box --------------------------------------------------------------------- */

/* A point in the coordinates of the cylinder: across the axis, and along it from the point of the
 * axis that is nearest to the cell's centre. */
typedef struct AxisPoint {
    DiscPoint at;
    double height;
} AxisPoint;

/* In the plane of a face, the height is level + slope_u u + slope_v v. */
typedef struct FacePlane {
    double level, slope_u, slope_v;
} FacePlane;

/* Maximum number of corners of a face that is cut by two parallel planes: each cut adds one corner
 * to the 4. */
enum { MAX_CORNERS = 6 };

typedef struct CellFace {
    AxisPoint corner[MAX_CORNERS];
    int n;
} CellFace;

static AxisPoint between(AxisPoint p, AxisPoint q, double height)
{
    double t = (height - p.height) / (q.height - p.height);
    return (AxisPoint){{p.at.u + t * (q.at.u - p.at.u), p.at.v + t * (q.at.v - p.at.v)}, height};
}

/* Returns the part of the face on one side of a height: above it if `side` is 1, below if -1. */
static CellFace cut_face(const CellFace *face, double height, int side)
{
    CellFace out = {.n = 0};
    for (int i = 0; i < face->n; i++) {
        AxisPoint p = face->corner[i], q = face->corner[(i + 1) % face->n];
        bool has_p = side * (p.height - height) >= 0, has_q = side * (q.height - height) >= 0;
        if (has_p)
            out.corner[out.n++] = p;
        if (has_p != has_q)
            out.corner[out.n++] = between(p, q, height);
    }
    return out;
}

/* Returns the flux through a face whose height is linear. */
static double flux(const CellFace *face, double radius, FacePlane plane)
{
    DiscIntegrals part = {0};
    for (int i = 0; i < face->n; i++)
        discintegrals_add(&part, face->corner[i].at, face->corner[(i + 1) % face->n].at, radius);
    return plane.level * part.one + plane.slope_u * part.u + plane.slope_v * part.v;
}

/* Returns the flux through a face whose height is clamped to [low, high]. */
static double clamped_flux(const CellFace *face, double radius, FacePlane plane, double low,
                           double high)
{
    double least = face->corner[0].height, most = least;
    for (int i = 1; i < face->n; i++) {
        least = fmin(least, face->corner[i].height);
        most = fmax(most, face->corner[i].height);
    }
    if (low <= least && most <= high)
        return flux(face, radius, plane);
    CellFace below = cut_face(face, low, -1), above = cut_face(face, high, 1);
    CellFace middle = cut_face(face, low, 1);
    middle = cut_face(&middle, high, -1);
    return flux(&below, radius, (FacePlane){low, 0, 0}) + flux(&middle, radius, plane) +
           flux(&above, radius, (FacePlane){high, 0, 0});
}

/* Per axis: the corners of the face towards high coordinates, counterclockwise seen from outside.
 * Bit k of a corner is set if it has the high coordinate along axis k. */
static const uint8_t face_corners[3][4] = {{1, 3, 7, 5}, {2, 6, 7, 3}, {4, 5, 7, 6}};

/* Minimum cosine between a face's normal and the axis. Other faces are left out, which loses less
 * than this fraction of the cell. */
static const double min_cosine = 1e-7;

/* Returns the volume of a cylinder in a cell: the flux through the six faces of the cell. */
static double cylinder_volume(const Body *body, const VoxelCell *cell)
{
    Vec3 from = vec3_sub(cell->center, body->start);
    double along = vec3_dot(from, body->axis), volume = 0;
    Vec3 base = vec3_add_scaled(body->start, body->axis, along);
    AxisPoint corners[8];
    for (int i = 0; i < 8; i++) {
        Vec3 p = vec3_sub(cell_corner(cell, i), base);
        corners[i] =
            (AxisPoint){{vec3_dot(p, body->u), vec3_dot(p, body->v)}, vec3_dot(p, body->axis)};
    }
    for (int axis = 0; axis < 3; axis++) {
        double rise = vec3_component(body->axis, axis);
        FacePlane plane = {.slope_u = -vec3_component(body->u, axis) / rise,
                           .slope_v = -vec3_component(body->v, axis) / rise};
        for (int side = -1; side <= 1 && fabs(rise) > min_cosine; side += 2) {
            double face_offset = vec3_component(vec3_sub(cell->center, base), axis) +
                                 side * vec3_component(cell->half, axis);
            CellFace face = {.n = 4};
            plane.level = face_offset / rise;
            for (int i = 0; i < 4; i++)
                face.corner[i] = corners[face_corners[axis][i] ^ (side < 0 ? 1 << axis : 0)];
            volume += side * clamped_flux(&face, body->radius, plane, -along, body->length - along);
        }
    }
    return volume;
}

/* ---- a ball in a box ------------------------------------------------------------------------- */

/* Returns the volume of a ball in a cell: the flux through the six faces, edge by edge. */
static double ball_volume(const Body *ball, const VoxelCell *cell)
{
    Vec3 from = vec3_sub(cell->center, ball->start);
    double volume = 0;
    for (int axis = 0; axis < 3; axis++) {
        int first = (axis + 1) % 3, second = (axis + 2) % 3;
        double u = vec3_component(from, first), u_half = vec3_component(cell->half, first);
        double v = vec3_component(from, second), v_half = vec3_component(cell->half, second);
        const DiscPoint corner[4] = {{u - u_half, v - v_half},
                                     {u + u_half, v - v_half},
                                     {u + u_half, v + v_half},
                                     {u - u_half, v + v_half}};
        for (int side = -1; side <= 1; side += 2) {
            double out = side * vec3_component(from, axis) + vec3_component(cell->half, axis);
            for (int i = 0; i < 4 && out != 0; i++)
                volume +=
                    out / 3 * ballcone_edge(corner[i], corner[(i + 1) % 4], ball->radius, out);
        }
    }
    return volume;
}

double body_fraction(const Body *body, const VoxelCell *cell)
{
    if (!body_meets(body, cell))
        return 0;
    if (body_holds(body, cell))
        return 1;
    double volume = body_is_ball(body) ? ball_volume(body, cell) : cylinder_volume(body, cell);
    return fmin(fmax(volume / cell_volume(cell), 0), 1);
}

/* ---- lines ----------------------------------------------------------------------------------- */

/* Narrows the interval [*low, *high] of t to where 0 <= from + rise t <= length. */
static void clip_heights(double from, double rise, double length, double *low, double *high)
{
    double inverse = 1 / rise, to_start = -from * inverse, to_end = (length - from) * inverse;
    if (rise == 0) {
        if (from < 0 || from > length)
            *high = -INFINITY;
        return;
    }
    *low = fmax(*low, fmin(to_start, to_end));
    *high = fmin(*high, fmax(to_start, to_end));
}

bool body_chord(const Body *body, Vec3 at, int axis, double wider, double longer, double *low,
                double *high)
{
    Vec3 from = vec3_sub(at, body->start);
    double radius = body->radius + wider, rise = vec3_component(body->axis, axis);
    double height = vec3_dot(from, body->axis);
    double a = 1 - rise * rise, b = vec3_component(from, axis) - height * rise;
    double c = vec3_dot(from, from) - height * height - radius * radius;
    double root2 = b * b - a * c;
    if (a < 1e-14) { /* the line is parallel to the axis: it is all inside or all outside */
        *low = c < 0 ? -INFINITY : INFINITY;
        *high = -*low;
    } else if (root2 > 0) {
        double root = sqrt(root2);
        *low = (-b - root) / a;
        *high = (-b + root) / a;
    } else {
        return false;
    }
    if (!body_is_ball(body))
        clip_heights(height + longer, rise, body->length + 2 * longer, low, high);
    return *low < *high;
}

bool body_axis_in(const Body *body, const VoxelCell *cell, double *from, double *to)
{
    *from = 0;
    *to = body->length;
    if (body_is_ball(body))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        double rise = vec3_component(body->axis, axis), half = vec3_component(cell->half, axis);
        double face_offset = vec3_component(vec3_sub(body->start, cell->center), axis);
        if (rise == 0 && !(face_offset >= -half && face_offset < half))
            return false;
        clip_heights(face_offset + half, rise, 2 * half, from, to);
    }
    return *from <= *to;
}
