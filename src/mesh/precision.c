/* Computes the grid to which the points of a mesh are rounded, and refuses trees for which the grid
 * is too coarse.
 *
 * Files of meshes hold coordinates as floats, in world coordinates. Points are rounded before a
 * mesh is proved, so that the mesh that is proved equals the mesh that is written. The distance
 * between neighbouring floats grows with the distance from the origin, until rounding folds
 * triangles over each other. A float has a 24-bit mantissa, hence the step of 2^-24 of the power of
 * two above the largest coordinate. */
#include "mesh/precision.h"

double mesh_max_coordinate(const VesselTree *tree)
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

double mesh_grid(double max_coordinate_mm)
{
    int exponent;
    frexp(max_coordinate_mm, &exponent);
    return ldexp(1, exponent - 24);
}

uint32_t precision_thinnest_segment(const VesselTree *tree)
{
    uint32_t thinnest = 0;
    for (uint32_t i = 1; i < tree->n_segments; i++)
        if (tree->segments[i].radius_mm < tree->segments[thinnest].radius_mm)
            thinnest = i;
    return thinnest;
}

bool precision_explains_crossings(const VesselTree *tree)
{
    /* At 2000 steps per radius, which a vessel of 1 mm has about 8 m from the origin, rounding
     * moves a point by 2.5e-4 radii. That is 1 % of a tolerance of 0.02, so rounding hardly
     * explains crossings in nearer trees. */
    const double far_steps = 2000;
    double radius = tree->segments[precision_thinnest_segment(tree)].radius_mm;
    return radius < far_steps * mesh_grid(mesh_max_coordinate(tree));
}

Status precision_refuse(const VesselTree *tree, uint32_t segment, double grid_mm, Err *err)
{
    double radius = tree->segments[segment].radius_mm;
    return err_set(err, STATUS_INPUT,
                   "the tree reaches %.7g mm from the origin, where neighboring coordinates in "
                   "single precision are %.2g mm apart; that is too coarse for the radius of "
                   "segment %u, %.4g mm; move the tree nearer to the origin",
                   mesh_max_coordinate(tree), grid_mm, tree->ids[segment], radius);
}

Status precision_check(const VesselTree *tree, double max_coordinate_mm, Err *err)
{
    if (tree->n_segments == 0)
        return STATUS_OK;
    uint32_t thinnest = precision_thinnest_segment(tree);
    double grid = mesh_grid(fmax(mesh_max_coordinate(tree), max_coordinate_mm));
    if (tree->segments[thinnest].radius_mm >= PRECISION_MIN_STEPS * grid)
        return STATUS_OK;
    return precision_refuse(tree, thinnest, grid, err);
}
