/* Makes a block with the vessels as channels. The boundary of the solid consists of the faces of
 * the casing (the block without channels), of the surface of the vessels with its normals reversed,
 * and of the walls of the ports that connect the two. So no boolean operation is needed. */
#include "print/block.h"

#include <stdlib.h>

/* Returns the maximum distance of vessels from the axis through `middle`, mm. */
static double radius_about_axis(const VesselTree *tree, Vec3 middle, int axis)
{
    double reach = 0;
    for (size_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            const FieldSegment *segment = &tree->segments[i];
            Vec3 from = vec3_sub(segment_end(segment, end), middle);
            double along = vec3_component(from, axis);
            reach = fmax(reach,
                         sqrt(fmax(vec3_dot(from, from) - along * along, 0)) + segment->radius_mm);
        }
    return reach;
}

/* Returns the coordinate axis most nearly parallel to the first segment. */
static int axis_of(const VesselTree *tree)
{
    Vec3 span = vec3_sub(tree->segments[0].b, tree->segments[0].a);
    int best = 0;
    for (int axis = 1; axis < 3; axis++)
        if (fabs(vec3_component(span, axis)) > fabs(vec3_component(span, best)))
            best = axis;
    return best;
}

Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out, Err *err)
{
    Casing casing = {.is_round = block->is_round, .axis = axis_of(tree)};
    Box box = vesseltree_box(tree, 0);
    Vec3 middle = box_center(box);
    double minimum[3], size[3], half[3]; /* mm; half: of the corners of the casing */
    for (int axis = 0; axis < 3; axis++) {
        bool is_radial = casing.is_round && axis != casing.axis;
        double own = is_radial ? 2 * radius_about_axis(tree, middle, casing.axis)
                               : vec3_component(box.high, axis) - vec3_component(box.low, axis);
        minimum[axis] = own + 2 * block->margin_mm;
        size[axis] = casing.is_round ? block->size_mm[is_radial ? 0 : 1] : block->size_mm[axis];
        if (size[axis] == 0)
            size[axis] = minimum[axis];
        /* A round casing is a prism whose inscribed circle has the wanted diameter. */
        half[axis] = 0.5 * size[axis] / (is_radial ? elementary_cos(PI / CASING_SIDES) : 1);
    }
    for (int axis = 0; axis < 3; axis++)
        if (size[axis] < minimum[axis])
            return err_set(err, STATUS_INPUT,
                           "the block of %.4g x %.4g x %.4g mm is smaller than the vessels with "
                           "a margin of %g mm, %.4g x %.4g x %.4g mm",
                           size[0], size[1], size[2], block->margin_mm, minimum[0], minimum[1],
                           minimum[2]);
    casing.box.low = vec3_sub(middle, vec3(half[0], half[1], half[2]));
    casing.box.high = vec3_add(middle, vec3(half[0], half[1], half[2]));
    *out = casing;
    return STATUS_OK;
}

/* Adds the faces of the casing, with a hole for each port. */
static Status add_faces(Solid *solid, const Casing *casing, const Ports *ports, Err *err)
{
    CasingHole *holes;
    TRY(mem_calloc(&holes, ports->n, sizeof *holes, "ports", err));
    for (size_t i = 0; i < ports->n; i++) {
        const Port *port = &ports->items[i];
        holes[i] = (CasingHole){port->face, port->end->end == 1, port->points, port->end->n};
    }
    Status status = casing_add(solid, casing, holes, ports->n, err);
    free(holes);
    return status;
}

Status block_add(Solid *solid, const BlockInput *input, SeamGraph *seams, size_t *n_ports, Err *err)
{
    Ports ports = {0};
    Status status;
    TRY_GOTO(ports_find(input->tree, input->ends, input->casing, input->block, &ports, err));
    if (input->block->ports != PORTS_NONE && ports.n == 0)
        TRY_GOTO(err_set(err, STATUS_INFEASIBLE,
                         "no port is possible: no vessel end has a clear path to a face of the "
                         "block; a wider margin may help"));
    TRY_GOTO(solid_surface(solid, input->mesh, input->ends, (SurfaceUse){.turned = true}, err));
    TRY_GOTO(ports_add(input->tree, &ports, solid, err));
    TRY_GOTO(add_faces(solid, input->casing, &ports, err));
    seams_add_surface(seams, MESH_FRAME);
    for (size_t i = 0; i < ports.n; i++)
        seams_add_ring(seams, ports.items[i].end->segment, MESH_FRAME);
    *n_ports = ports.n;
done:
    ports_release(&ports);
    return status;
}
