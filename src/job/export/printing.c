/* Scales and thickens vessels for 3D printing, and checks that the printer can print them. Lengths
 * of the tree are scaled before they are compared with the nozzle and the bed, which do not scale.
 */
#include "job/export/printing.h"

#include <math.h>

double printing_thinnest_wall(const PrintSettings *settings, const PrintChanges *changes)
{
    const PrintParams *params = &settings->params;
    return params->wall_mm + params->wall_ratio * changes->thinnest_mm / 2;
}

/* Checks that the nozzle can print the thickest vessel and the thinnest wall. */
static Status check_nozzle(const PrintSettings *settings, const PrintChanges *changes, Err *err)
{
    double nozzle = settings->nozzle_mm, wall = printing_thinnest_wall(settings, changes);
    if (changes->widest_mm < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle (%g mm) is wider than the trunk (%.3g mm when printed), so no "
                       "vessel can be printed; enlarge the tree with the key scale= of `print`",
                       nozzle, changes->widest_mm);
    if (print_has_wall(&settings->params) && wall < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle (%g mm) is wider than the thinnest wall (%.3g mm)", nozzle,
                       wall);
    return STATUS_OK;
}

Status printing_prepare(const PrintSettings *settings, VesselTree *vessels, PrintChanges *changes,
                        Err *err)
{
    PrintChanges made = {.thinnest_mm = HUGE_VAL};
    for (size_t i = 0; i < vessels->n_segments; i++)
        made.widest_mm = fmax(made.widest_mm, 2 * settings->scale * vessels->segments[i].radius_mm);
    for (size_t i = 0; i < vessels->n_segments; i++) {
        FieldSegment *segment = &vessels->segments[i];
        segment->a = vec3_scale(segment->a, settings->scale);
        segment->b = vec3_scale(segment->b, settings->scale);
        segment->radius_mm *= settings->scale;
        if (2 * segment->radius_mm < settings->min_diameter_mm) {
            segment->radius_mm = settings->min_diameter_mm / 2;
            made.thickened++;
        }
        made.thinnest_mm = fmin(made.thinnest_mm, 2 * segment->radius_mm);
        made.below_two_nozzles += segment->radius_mm < settings->nozzle_mm;
    }
    TRY(check_nozzle(settings, &made, err));
    *changes = made;
    return STATUS_OK;
}

void printing_size(const VesselMesh *mesh, double size[3])
{
    Box box = box_empty();
    for (size_t i = 0; i < mesh->n_points; i++)
        box = box_with_ball(box, mesh_point(mesh, (uint32_t)i), 0);
    for (int axis = 0; axis < 3; axis++)
        size[axis] = vec3_component(box.high, axis) - vec3_component(box.low, axis);
}

Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh, Err *err)
{
    const double *bed = settings->bed_mm;
    double size[3];
    printing_size(mesh, size);
    bool fits =
        (size[0] <= bed[0] && size[1] <= bed[1]) || (size[1] <= bed[0] && size[0] <= bed[1]);
    if (bed[2] == 0 || (fits && size[2] <= bed[2]))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the print (%.4g x %.4g x %.4g mm) does not fit the bed (%g x %g x %g mm)",
                   size[0], size[1], size[2], bed[0], bed[1], bed[2]);
}
