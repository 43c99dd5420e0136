/* Implements functions on the geometry of a scene, primitives or segments of a field: their bounds,
 * copies with other radii or with spheres at ends, and checks of positions and radii. */
#include "scene/geometry.h"

#include <stdlib.h>
#include <string.h>

JointFrame primitive_joint(const Primitive *primitive)
{
    return joint_frame((const Vec3[2]){primitive->a, primitive->b}, primitive->axes,
                       (const double[2]){primitive->radius_mm, primitive->radius_b_mm});
}

PrimitiveFrame primitive_frame(const Primitive *primitive)
{
    PrimitiveFrame frame = {0};
    if (primitive->kind == PRIMITIVE_CYLINDER)
        frame.cylinder = cylinder_frame(primitive->a, primitive->b, primitive->radius_mm);
    else if (primitive->kind == PRIMITIVE_JOINT)
        frame.joint = primitive_joint(primitive);
    return frame;
}

/* The two cut planes must not meet inside the joint. The slack allows for rounding of planes that
 * touch. */
bool primitive_joint_is_solid(const Primitive *joint)
{
    Vec3 span = vec3_sub(joint->b, joint->a);
    double sine = vec3_length(vec3_cross(joint->axes[0], joint->axes[1]));
    double slack = 1e-9 * (joint->radius_mm + joint->radius_b_mm);
    return vec3_dot(span, joint->axes[0]) >= joint->radius_b_mm * sine - slack &&
           vec3_dot(span, joint->axes[1]) >= joint->radius_mm * sine - slack;
}

void geometry_release(Geometry *geometry)
{
    free(geometry->primitives);
    free(geometry->axes);
    free(geometry->segments);
    indexlists_release(&geometry->blend.members);
    indexlists_release(&geometry->blend.groups);
    vesselmesh_release(&geometry->mesh);
    free(geometry->ids);
    *geometry = (Geometry){0};
}

/* The spheres at ends are inside the balls that are added here. */
void geometry_find_bounds(Geometry *geometry)
{
    Box box = box_empty();
    for (size_t i = 0, n = geometry_balls(geometry) - 2 * geometry->n_ends; i < n; i++) {
        Ball ball = geometry_ball(geometry, i);
        box = box_with_ball(box, ball.center, ball.radius);
    }
    geometry->bounds = box;
}

Status geometry_with_scaled_radii(const Geometry *original, const double *factors, Geometry *out,
                                  Err *err)
{
    Geometry made = *original;
    const size_t n = original->n_primitives;
    TRY(mem_calloc(&made.primitives, n, sizeof *made.primitives, "vessels", err));
    Status status = mem_calloc(&made.ids, original->n_ids, sizeof *made.ids, "segments", err);
    if (status != STATUS_OK) {
        free(made.primitives);
        return status;
    }
    memcpy(made.ids, original->ids, original->n_ids * sizeof *made.ids);
    memcpy(made.primitives, original->primitives, n * sizeof *made.primitives);
    for (size_t i = 0; i < n; i++)
        made.primitives[i].radius_mm *= factors[made.primitives[i].segment];
    geometry_find_bounds(&made);
    *out = made;
    return STATUS_OK;
}

size_t geometry_balls(const Geometry *geometry)
{
    return 2 * (geometry->n_primitives + geometry->n_segments);
}

Ball geometry_ball(const Geometry *geometry, size_t number)
{
    size_t i = number / 2;
    bool is_b = number % 2;
    if (i < geometry->n_primitives) {
        const Primitive *primitive = &geometry->primitives[i];
        return is_b ? (Ball){primitive->b, primitive_radius_b(primitive)}
                    : (Ball){primitive->a, primitive->radius_mm};
    }
    const FieldSegment *segment = &geometry->segments[i - geometry->n_primitives];
    return (Ball){is_b ? segment->b : segment->a, 2 * segment->radius_mm};
}

/* Returns the sphere at an end of a cylinder. */
static Primitive end_of(const Primitive *cylinder, Vec3 at)
{
    return (Primitive){.kind = PRIMITIVE_SPHERE,
                       .a = at,
                       .b = at,
                       .radius_mm = cylinder->radius_mm,
                       .segment = cylinder->segment};
}

Status geometry_with_ends(const Geometry *geometry, Primitive **all, size_t *n, Err *err)
{
    size_t count = geometry->n_primitives;
    for (size_t i = 0; i < geometry->n_primitives; i++)
        count += geometry->primitives[i].round_a + geometry->primitives[i].round_b;
    TRY(mem_calloc(all, count, sizeof **all, "primitives", err));
    *n = geometry->n_primitives;
    memcpy(*all, geometry->primitives, *n * sizeof **all);
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *cylinder = &geometry->primitives[i];
        if (cylinder->round_a)
            (*all)[(*n)++] = end_of(cylinder, cylinder->a);
        if (cylinder->round_b)
            (*all)[(*n)++] = end_of(cylinder, cylinder->b);
    }
    return STATUS_OK;
}

static Status check_tube(Vec3 a, Vec3 b, double radius, uint32_t id, Err *err)
{
    if (!vec3_finite(a) || !vec3_finite(b) || !(radius > 0) || !isfinite(radius))
        return err_set(
            err, STATUS_INPUT,
            "the segment of node %u has a position or radius that is not a finite number", id);
    if (vec3_length(a) + radius > SCENE_FARTHEST_MM || vec3_length(b) + radius > SCENE_FARTHEST_MM)
        return err_set(err, STATUS_INPUT,
                       "the segment of node %u is farther than %g mm from the origin", id,
                       SCENE_FARTHEST_MM);
    return STATUS_OK;
}

/* Spheres at the ends of cylinders are not checked: they have the cylinders' positions and
 * radii. */
Status geometry_check(const Geometry *geometry, Err *err)
{
    for (size_t i = 0; i < geometry->n_primitives - geometry->n_ends; i++) {
        const Primitive *primitive = &geometry->primitives[i];
        uint32_t id = geometry->ids[primitive->segment];
        TRY(check_tube(primitive->a, primitive->b, primitive->radius_mm, id, err));
        if (primitive->kind == PRIMITIVE_JOINT)
            TRY(check_tube(primitive->b, primitive->a, primitive->radius_b_mm, id, err));
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        TRY(check_tube(segment->a, segment->b, segment->radius_mm, geometry->ids[segment->segment],
                       err));
    }
    return STATUS_OK;
}
