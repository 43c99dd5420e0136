/* Makes the view of a camera for the raster engine, and the grid of sample positions of a tile. In
 * single precision, depths are relative to the middle of the geometry, and positions in a tile to
 * the middle of the tile, so that both stay small. */
#include "render/raster/rasterview.h"

RasterView rasterview_of_camera(const Camera *camera, Box bounds, int antialias)
{
    double width = vec3_length(camera->right), height = vec3_length(camera->up);
    double near, far;
    camera_depth_range(camera, bounds, &near, &far);
    return (RasterView){.eye = viewpoint_of_camera(camera),
                        .left = (0.5 / camera->width - 0.5) * width,
                        .top = (0.5 - 0.5 / camera->height) * height,
                        .step_x = width / camera->width,
                        .step_y = -height / camera->height,
                        .columns = camera->width,
                        .rows = camera->height,
                        .max_offset = antialias > 1 ? 0.5 : 0,
                        .z_middle = (near + far) / 2};
}

Ray rasterview_ray(const RasterView *view, double x, double y)
{
    Vec3 across = vec3_add_scaled(vec3_scale(view->eye.axes[0], x), view->eye.axes[1], y);
    if (view->eye.perspective)
        return (Ray){view->eye.location, vec3_normalized(vec3_add(view->eye.axes[2], across))};
    return (Ray){vec3_add(view->eye.location, across), view->eye.axes[2]};
}

JointFrame rasterview_joint(const RasterView *view, const Primitive *primitive)
{
    JointFrame joint = primitive_joint(primitive);
    joint.base = viewpoint_frame_point(&view->eye, joint.base);
    joint.span = viewpoint_frame_direction(&view->eye, joint.span);
    joint.side = viewpoint_frame_direction(&view->eye, joint.side);
    joint.across = viewpoint_frame_direction(&view->eye, joint.across);
    joint.across_change = viewpoint_frame_direction(&view->eye, joint.across_change);
    return joint;
}

/* Computes the middles of the blocks of `size` samples, and half their extents. */
static void set_blocks(const RasterGrid *grid, int size, float *x, float *y, float half[2])
{
    for (int block = 0; block < TILE_SAMPLES / size; block++) {
        int first = block * size, last = first + size - 1;
        x[block] = (grid->x[first] + grid->x[last]) / 2;
        y[block] = (grid->y[first] + grid->y[last]) / 2;
    }
    half[0] = (grid->x[size - 1] - grid->x[0]) / 2;
    half[1] = (grid->y[0] - grid->y[size - 1]) / 2;
}

RasterGrid rastergrid_make(const RasterView *view, double x, double y)
{
    const double middle = (TILE_SIDE - 1) / 2.0;
    RasterGrid grid;
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        grid.x[sample] = (float)((tile_sample_x(sample) - middle + x) * view->step_x);
        grid.y[sample] = (float)((tile_sample_y(sample) - middle + y) * view->step_y);
    }
    grid.reach =
        (float)((middle + fabs(x)) * view->step_x - (middle + fabs(y)) * view->step_y) * 1.0001f;
    set_blocks(&grid, 8, grid.block8_x, grid.block8_y, grid.block8_half);
    set_blocks(&grid, 4, grid.block4_x, grid.block4_y, grid.block4_half);
    return grid;
}
