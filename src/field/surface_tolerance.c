/* Computes, per pixel, how far POV-Ray's depth of an isosurface may be from the exact depth.
 *
 * POV-Ray's root finder stops within the accuracy of its cell, measured along the ray. The terms
 * that the cells leave out move the surface along its normal by cell_displacement. Along the ray
 * that is the displacement divided by the cosine between ray and normal. Depths are stored in
 * single precision. */
#include "field/field.h"

#include <float.h>
#include <stdlib.h>

/* Minimum cosine between ray and normal in the division: rays within 3 degrees of the tangent plane
 * may pass on either side of the surface, so no tolerance compares their depths. A smaller value
 * would only make the tolerance of such pixels larger. */
static const double grazing_cosine = 0.05;

/* Makes an array with the radius of each id. */
static Status radii_by_id(const Geometry *geometry, double **out, Err *err)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < geometry->n_ids; i++)
        largest = geometry->ids[i] > largest ? geometry->ids[i] : largest;
    double *radii = NULL;
    TRY(mem_calloc(&radii, (size_t)largest + 1, sizeof *radii, "radii", err));
    for (size_t i = 0; i < geometry->n_segments; i++)
        radii[geometry->ids[geometry->segments[i].segment]] = geometry->segments[i].radius_mm;
    *out = radii;
    return STATUS_OK;
}

/* Returns the tolerance of the depth at a pixel, mm: 0 where no surface is visible, infinite for a
 * grazing ray. */
static double tolerance_at(const SurfacePlanes *sight, size_t pixel, Vec3 direction,
                           const double *radii, ErfForm erf)
{
    double depth = (double)sight->depth[pixel];
    if (!isfinite(depth))
        return 0;
    const float *n = &sight->normal[3 * pixel];
    double cosine = fabs(vec3_dot(vec3((double)n[0], (double)n[1], (double)n[2]), direction));
    if (cosine < grazing_cosine)
        return HUGE_VAL;
    double radius = radii[sight->ids[pixel]];
    return cell_accuracy(radius) + cell_displacement(radius, erf) / cosine +
           depth * (double)FLT_EPSILON;
}

Status surface_tolerance(const Geometry *geometry, const Camera *camera, ErfForm erf,
                         const SurfacePlanes *povray, const SurfacePlanes *exact, float *allowed,
                         Err *err)
{
    double *radii = NULL;
    TRY(radii_by_id(geometry, &radii, err));
    for (int j = 0; j < camera->height; j++) {
        for (int i = 0; i < camera->width; i++) {
            size_t pixel = (size_t)j * (size_t)camera->width + (size_t)i;
            Vec3 direction = camera_ray(camera, i, j).direction;
            allowed[pixel] = (float)fmax(tolerance_at(povray, pixel, direction, radii, erf),
                                         tolerance_at(exact, pixel, direction, radii, erf));
        }
    }
    free(radii);
    return STATUS_OK;
}
