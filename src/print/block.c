/* What is left of a block is bounded by its faces and by the vessels' surface turned inside out;
 * ports join the two, so that no boolean is needed. */
#include "print/block.h"

#include <stdlib.h>

static Box box_of(const VesselTree *tree)
{
    Box box = box_empty();
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *segment = &tree->segments[i];
        box = box_with_ball(box, segment->a, segment->radius_mm);
        box = box_with_ball(box, segment->b, segment->radius_mm);
    }
    return box;
}

/* How far vessels are from the axis of a cylinder about the middle of their box. */
static double reach_about(const VesselTree *tree, Vec3 middle, int axis)
{
    double reach = 0;
    for (size_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            const FieldSegment *segment = &tree->segments[i];
            Vec3 from = vec3_sub(end ? segment->b : segment->a, middle);
            double along = vec3_component(from, axis);
            reach = fmax(reach,
                         sqrt(fmax(vec3_dot(from, from) - along * along, 0)) + segment->radius_mm);
        }
    return reach;
}

/* A cylinder stands along the axis that the first vessel is nearest to. */
static int axis_of(const VesselTree *tree)
{
    Vec3 way = vec3_sub(tree->segments[0].b, tree->segments[0].a);
    int best = 0;
    for (int axis = 1; axis < 3; axis++)
        if (fabs(vec3_component(way, axis)) > fabs(vec3_component(way, best)))
            best = axis;
    return best;
}

Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out, Err *err)
{
    Casing casing = {.is_round = block->is_round, .axis = axis_of(tree)};
    Box box = box_of(tree);
    Vec3 middle = vec3_scale(vec3_add(box.low, box.high), 0.5);
    double least[3], size[3], half[3];
    for (int axis = 0; axis < 3; axis++) {
        bool across = casing.is_round && axis != casing.axis;
        double own = across ? 2 * reach_about(tree, middle, casing.axis)
                            : vec3_component(box.high, axis) - vec3_component(box.low, axis);
        least[axis] = own + 2 * block->margin_mm;
        size[axis] = casing.is_round ? block->size_mm[across ? 0 : 1] : block->size_mm[axis];
        if (size[axis] == 0)
            size[axis] = least[axis];
        half[axis] = 0.5 * size[axis] / (across ? elementary_cos(PI / CASING_SIDES) : 1);
    }
    for (int axis = 0; axis < 3; axis++)
        if (size[axis] < least[axis])
            return err_set(err, STATUS_INPUT,
                           "the block of %.4g x %.4g x %.4g mm is smaller than the vessels with "
                           "a margin of %g mm, %.4g x %.4g x %.4g mm",
                           size[0], size[1], size[2], block->margin_mm, least[0], least[1],
                           least[2]);
    casing.box.low = vec3_sub(middle, vec3(half[0], half[1], half[2]));
    casing.box.high = vec3_add(middle, vec3(half[0], half[1], half[2]));
    *out = casing;
    return STATUS_OK;
}

/* The block with a hole for each port. */
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

Status block_add(Solid *solid, const VesselTree *tree, const VesselMesh *mesh, CutEnds *ends,
                 const PrintBlock *block, const Casing *casing, Seams *seams, size_t *n_ports,
                 Err *err)
{
    Ports ports = {0};
    Status status;
    TRY_GOTO(ports_find(tree, ends, casing, block, &ports, err));
    if (block->ports != PORTS_NONE && ports.n == 0)
        TRY_GOTO(err_set(err, STATUS_INFEASIBLE,
                         "no end of a vessel can be led to a face of the block; a wider margin "
                         "may help"));
    TRY_GOTO(solid_surface(solid, mesh, ends, true, 0, err));
    TRY_GOTO(ports_add(tree, &ports, solid, err));
    TRY_GOTO(add_faces(solid, casing, &ports, err));
    seams_add(seams, MESH_FRAME);
    for (size_t i = 0; i < ports.n; i++)
        seams_ring(seams, ports.items[i].end->segment, MESH_FRAME);
    *n_ports = ports.n;
done:
    ports_release(&ports);
    return status;
}
