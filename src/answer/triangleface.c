/* A ray meets a triangle if it passes all three edges on one side. The side is the sign of the
 * determinant of the ray's direction, the vector to a point of the edge, and the edge. In an
 * orthographic view the determinants are linear, so that pixels are cut exactly along edges. The
 * three determinants are also the weights of the opposite points at the hit. */
#include "answer/triangleface.h"

#include <math.h>

static Vec3 corner(const Face *face, int k)
{
    return mesh_point(face->mesh, face->mesh->triangles[face->solid][k % 3]);
}

Face triangle_face(const VesselMesh *mesh, uint32_t triangle, uint32_t segment)
{
    Face face = {.kind = FACE_TRIANGLE,
                 .segment = segment,
                 .solid = triangle,
                 .mesh = mesh,
                 .box = box_empty()};
    face.at = corner(&face, 0);
    face.end = face.at;
    for (int k = 0; k < 3; k++)
        face.box = box_with_ball(face.box, corner(&face, k), 0);
    const Form3 a = form3_exact(face.at);
    face.axis = form3_unit(form3_cross(form3_sub(form3_exact(corner(&face, 1)), a),
                                       form3_sub(form3_exact(corner(&face, 2)), a)));
    return face;
}

/* Sets sides[k] to the determinant of the edge from point k to the next point. It is negative
 * where a ray that comes from outside passes the edge on the inner side. */
static void find_sides(const Face *face, const Beam *beam, Form sides[3])
{
    for (int k = 0; k < 3; k++) {
        const Form3 from = form3_exact(corner(face, k)), to = form3_exact(corner(face, k + 1));
        sides[k] = form3_dot(beam->direction,
                             form3_cross(form3_sub(from, beam->origin), form3_sub(to, from)));
    }
}

/* Tests a single ray in plain doubles. Returns true if it surely misses the triangle. The margin is
 * far above rounding errors. */
static bool surely_misses(const Face *face, const Beam *beam)
{
    if (!form_is_constant(beam->origin.x) || !form_is_constant(beam->origin.y) ||
        !form_is_constant(beam->direction.x) || !form_is_constant(beam->direction.y))
        return false;
    const Vec3 origin = vec3(beam->origin.x.c, beam->origin.y.c, beam->origin.z.c);
    const Vec3 direction = vec3(beam->direction.x.c, beam->direction.y.c, beam->direction.z.c);
    bool is_in = false, is_out = false;
    for (int k = 0; k < 3; k++) {
        const Vec3 from = vec3_sub(corner(face, k), origin);
        const Vec3 edge = vec3_sub(corner(face, k + 1), corner(face, k));
        const double side = vec3_dot(direction, vec3_cross(from, edge));
        const double margin = 1e-12 * vec3_length(direction) * vec3_length(edge) *
                              (vec3_length(from) + vec3_length(origin));
        is_in |= side < -margin;
        is_out |= side > margin;
    }
    return is_in && is_out;
}

/* Adds an edge. Returns false if no ray of the beam is inside it. */
static bool add_side(FaceHit *hit, Form side)
{
    if (form_high(side) < 0)
        return false;
    if (!(form_low(side) >= 0))
        hit->edges[hit->n_edges++] = side;
    return true;
}

/* Encloses the depth of a hit where the triangle is seen edge-on: it is between the depths at which
 * the ray is nearest to the triangle's points. */
static Form depth_of_points(const Face *face, const Beam *beam)
{
    Form hull = form_of(0, 0);
    for (int k = 0; k < 3; k++) {
        const Form3 to = form3_sub(form3_exact(corner(face, k)), beam->origin);
        const Form depth = form_mul(form3_dot(to, beam->unit), beam->inverse);
        hull = k == 0 ? depth : form_hull(hull, depth);
    }
    return hull;
}

bool triangle_hit(const Face *face, const Beam *beam, FaceHit *hit)
{
    Form sides[3];
    if (surely_misses(face, beam))
        return false;
    const Form facing = form3_dot(face->axis, beam->direction);
    find_sides(face, beam, sides);
    if (!(form_high(facing) < 0) && !(form_low(facing) > 0)) {
        hit->depth = depth_of_points(face, beam);
        hit->edges[hit->n_edges++] = form_of(0, (double)INFINITY);
        return true;
    }
    const bool is_front = form_high(facing) < 0;
    for (int k = 0; k < 3; k++)
        if (!add_side(hit, is_front ? form_neg(sides[k]) : sides[k]))
            return false;
    const Form height = form3_dot(face->axis, form3_sub(form3_exact(face->at), beam->origin));
    hit->depth = form_mul(height, form_inverse(facing));
    return true;
}

/* Returns the interpolated normal of the triangle's points; it is not turned to the viewer. */
static Form3 interpolated_normal(const Face *face, const Beam *beam)
{
    const VesselMesh *mesh = face->mesh;
    Form sides[3];
    Form3 sum = form3_of(0, 0, 0);
    find_sides(face, beam, sides);
    for (int k = 0; k < 3; k++) {
        const float *n = mesh->normals[mesh->triangles[face->solid][(k + 2) % 3]];
        const Form3 normal = form3_unit(form3_of((double)n[0], (double)n[1], (double)n[2]));
        sum = form3_add(sum, form3_mul(normal, sides[k]));
    }
    return form3_unit(sum); /* the sign does not matter: the normal is turned to the viewer */
}

Form3 triangle_normal(const Face *face, const Beam *beam)
{
    const Form3 n =
        mesh_is_cap(face->mesh, face->solid) ? face->axis : interpolated_normal(face, beam);
    const Form3 turned = normal_against(n, beam->unit);
    return (Form3){form_known(turned.x, -1, 1), form_known(turned.y, -1, 1),
                   form_known(turned.z, -1, 1)};
}
