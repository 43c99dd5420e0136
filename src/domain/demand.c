/* Reads a demand map, which decides how densely terminals fill the parts of a domain. The map is a
 * mask [mask.h] that also stores the values of the voxels. The demand at a point is the value of
 * its voxel relative to the largest value of the map, without interpolation. */
#include "domain/domain.h"

#include "domain/kinds.h"
#include "domain/mask.h"
#include <stdlib.h>

struct Demand {
    char *file; /* owned */
    Mask mask;
    double most; /* the largest value of the map */
};

/* Number of random points of the domain at which demand_check tests the demand, and the minimum
 * mean of the demand there. With less than 1e-4, growth would reject more than 10,000 points
 * for each terminal. Of 20,000 points, 2 are expected at that mean, so that maps with ten times
 * the mean always pass. */
enum { CHECKED_POINTS = 20000 };
static const double least_mean = 1e-4;

/* Reads the values of a NIfTI file, or of a picture with pixels `mm` wide. */
static Status read_values(Demand *demand, double mm, bool has_mm, Err *err)
{
    bool is_nifti = mask_is_nifti(demand->file);
    if (is_nifti == has_mm)
        return err_set(err, STATUS_USAGE,
                       is_nifti ? "`demand` %s: a NIfTI file states its own voxel size; use "
                                  "FILE without a number"
                                : "`demand` %s: a picture needs the width of a pixel in mm, "
                                  "FILE,MM",
                       demand->file);
    if (is_nifti)
        return mask_read_nifti(&demand->mask, demand->file, err);
    return mask_read_picture(&demand->mask, demand->file, mm, err);
}

/* Reads the map `FILE[,MM]`, and finds its largest value. Errors: STATUS_INPUT if no value is above
 * 0. */
static Status load(Demand *demand, const char *spec, Err *err)
{
    double mm = 0, volume;
    TRY(mem_strdup(&demand->file, spec, err));
    bool has_mm = domain_cut_number(demand->file, &mm);
    if (has_mm && !(mm >= DOMAIN_MIN_MM && mm <= DOMAIN_MAX_MM))
        return err_set(err, STATUS_USAGE, "`demand` %s: a pixel must be from %g to %g mm wide",
                       spec, DOMAIN_MIN_MM, DOMAIN_MAX_MM);
    demand->mask.keeps_values = true;
    TRY(read_values(demand, mm, has_mm, err));
    TRY(mask_invert_axes(&demand->mask, demand->file, &volume, err));
    const Mask *mask = &demand->mask;
    for (int64_t i = 0; i < mask->n[0] * mask->n[1] * mask->n[2]; i++)
        if (isfinite(mask->value[i]))
            demand->most = fmax(demand->most, (double)mask->value[i]);
    if (demand->most > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: the demand map is empty: none of its values is above 0",
                   demand->file);
}

Status demand_read(Demand **demand, const char *spec, Err *err)
{
    TRY(mem_calloc(demand, 1, sizeof **demand, "maps", err));
    Status status = load(*demand, spec, err);
    if (status == STATUS_OK)
        return STATUS_OK;
    demand_release(*demand);
    *demand = NULL;
    return status;
}

void demand_release(Demand *demand)
{
    if (!demand)
        return;
    free(demand->file);
    free(demand->mask.bits);
    free(demand->mask.value);
    free(demand);
}

const char *demand_file(const Demand *demand)
{
    return demand->file;
}

double demand_at(const Demand *demand, Vec3 point)
{
    int64_t voxel = mask_voxel(&demand->mask, point);
    if (voxel < 0 || !(demand->mask.value[voxel] > 0))
        return 0;
    return fmin(1, (double)demand->mask.value[voxel] / demand->most);
}

Status demand_check(const Demand *demand, const Domain *domain, Err *err)
{
    Random random;
    double sum = 0;
    random_seed(&random, 1);
    for (int i = 0; i < CHECKED_POINTS; i++)
        sum += demand_at(demand, domain_sample(domain, &random));
    if (sum >= least_mean * CHECKED_POINTS)
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "%s: the demand map does not cover the domain: the demand is 0 at almost all of %d random "
        "points of the domain; the domain extends from x %.4g to %.4g, y %.4g to %.4g, z %.4g to "
        "%.4g mm",
        demand->file, CHECKED_POINTS, domain->bounds.low.x, domain->bounds.high.x,
        domain->bounds.low.y, domain->bounds.high.y, domain->bounds.low.z, domain->bounds.high.z);
}
