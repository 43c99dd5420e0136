/* Files of meshes hold coordinates as floats, in world coordinates. Points are rounded before a
 * mesh is proved, so that what is proved is what is written. The farther from the origin, the wider
 * the steps, until they fold triangles over each other. */
#include "mesh/precision.h"

double mesh_reach(const VesselTree *tree)
{
    double farthest = 0;
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *segment = &tree->segments[i];
        for (int axis = 0; axis < 3; axis++)
            farthest = fmax(farthest,
                            2 * segment->radius_mm + fmax(fabs(vec3_component(segment->a, axis)),
                                                          fabs(vec3_component(segment->b, axis))));
    }
    return farthest;
}

double mesh_grid(double reach_mm)
{
    int exponent;
    frexp(reach_mm, &exponent);
    return ldexp(1, exponent - 24);
}

uint32_t reach_thinnest(const VesselTree *tree)
{
    uint32_t thinnest = 0;
    for (uint32_t i = 1; i < tree->n_segments; i++)
        if (tree->segments[i].radius_mm < tree->segments[thinnest].radius_mm)
            thinnest = i;
    return thinnest;
}

bool precision_is_short(const VesselTree *tree)
{
    const double far_steps = 2000;
    double radius = tree->segments[reach_thinnest(tree)].radius_mm;
    return radius < far_steps * mesh_grid(mesh_reach(tree));
}

Status reach_refuse(const VesselTree *tree, uint32_t segment, double grid_mm, Err *err)
{
    double radius = tree->segments[segment].radius_mm;
    return err_set(err, STATUS_INPUT,
                   "the tree reaches %.7g mm from the origin, where the single precision of a mesh "
                   "places points to %.2g mm; that is too coarse for the radius of segment %u, "
                   "%.4g mm; move the tree nearer to the origin",
                   mesh_reach(tree), grid_mm, tree->ids[segment], radius);
}

Status reach_check(const VesselTree *tree, double reach_mm, Err *err)
{
    if (tree->n_segments == 0)
        return STATUS_OK;
    uint32_t thinnest = reach_thinnest(tree);
    double grid = mesh_grid(fmax(mesh_reach(tree), reach_mm));
    if (tree->segments[thinnest].radius_mm >= REACH_LEAST_STEPS * grid)
        return STATUS_OK;
    return reach_refuse(tree, thinnest, grid, err);
}
