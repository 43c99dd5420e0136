#include "app/surface_step.h"

#include <float.h>
#include <stdlib.h>

static const double grazing_cosine = 0.05;

typedef struct Step {
    const Scene *scene;
    ErfForm erf;
    double *radii; /* by id */
} Step;

static Status find_radii(Step *step, Err *err)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < step->scene->n_segments; i++)
        largest = step->scene->segments[i].id > largest ? step->scene->segments[i].id : largest;
    TRY(mem_calloc(&step->radii, (size_t)largest + 1, sizeof *step->radii, "radii", err));
    for (size_t i = 0; i < step->scene->n_segments; i++)
        step->radii[step->scene->segments[i].id] = step->scene->segments[i].radius_mm;
    return STATUS_OK;
}

/* How far what is seen at a pixel of the frame may be off along the ray; 0 where nothing is
 * seen. */
static double allowed_at(const Step *step, const Frame *frame, size_t pixel, Vec3 direction)
{
    double depth = (double)frame->depth.values[pixel];
    if (!isfinite(depth))
        return 0;
    const float *n = &frame->normal.values[3 * pixel];
    double cosine = fabs(vec3_dot(vec3((double)n[0], (double)n[1], (double)n[2]), direction));
    if (cosine < grazing_cosine)
        return HUGE_VAL;
    double radius = step->radii[frame->id.ids[pixel]];
    return cell_accuracy(radius) + cell_displacement(radius, step->erf) / cosine +
           depth * (double)FLT_EPSILON;
}

Status surface_step(const Scene *scene, ErfForm erf, const Frame *seen, const Frame *exact,
                    SurfaceCheck *check, Err *err)
{
    const Camera *camera = &scene->camera;
    Step step = {.scene = scene, .erf = erf};
    Plane allowed = {0};
    Status status;
    TRY_GOTO(find_radii(&step, err));
    TRY_GOTO(plane_init(&allowed, camera->width, camera->height, 1, err));
    for (int j = 0; j < camera->height; j++) {
        for (int i = 0; i < camera->width; i++) {
            size_t pixel = (size_t)j * (size_t)camera->width + (size_t)i;
            Vec3 direction = camera_ray(camera, i, j).direction;
            allowed.values[pixel] = (float)fmax(allowed_at(&step, seen, pixel, direction),
                                                allowed_at(&step, exact, pixel, direction));
        }
    }
    const SurfacePlanes planes = {&seen->depth, &exact->depth, &allowed};
    status = surface_check(&planes, check, err);
done:
    plane_release(&allowed);
    free(step.radii);
    return status;
}
