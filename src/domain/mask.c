/* The domain of the tissue voxels of an image.
 *
 * The index coordinates of a point come from the inverse of the affine map of the voxels; their
 * integer parts are its voxel. Sampling draws a random tissue voxel, and then a random point in it.
 * A segment is followed from voxel to voxel (Amanatides & Woo, Eurographics 1987). Along each axis
 * it takes exactly as many steps as there are voxels between its two ends. It therefore always ends
 * in the right voxel, even if crossing points are rounded. */
#include "domain/mask.h"

#include "domain/kinds.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Returns true if the voxel is in the image and is tissue. */
static bool is_tissue(const Mask *mask, const int64_t voxel[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (voxel[axis] < 0 || voxel[axis] >= mask->n[axis])
            return false;
    size_t number = (size_t)((voxel[2] * mask->n[1] + voxel[1]) * mask->n[0] + voxel[0]);
    return mask->bits[number / 64] >> number % 64 & 1;
}

/* Computes the index coordinates of a point. */
static void index_of(const Mask *mask, Vec3 point, double index[3])
{
    Vec3 from = vec3_sub(point, mask->corner);
    for (int axis = 0; axis < 3; axis++)
        index[axis] = vec3_dot(mask->inverse[axis], from);
}

/* Returns the point with these index coordinates. */
static Vec3 point_at(const Mask *mask, const double index[3])
{
    Vec3 point = mask->corner;
    for (int axis = 0; axis < 3; axis++)
        point = vec3_add_scaled(point, mask->step[axis], index[axis]);
    return point;
}

/* Sets the three indices of the voxel with this number. */
static void voxel_of(const Mask *mask, uint32_t number, int64_t voxel[3])
{
    voxel[0] = number % mask->n[0];
    voxel[1] = number / mask->n[0] % mask->n[1];
    voxel[2] = number / mask->n[0] / mask->n[1];
}

/* Returns the middle of a voxel; in two dimensions, its projection to the plane z = 0. */
static Vec3 middle_of(const Domain *domain, uint32_t number)
{
    int64_t voxel[3];
    voxel_of(domain->mask, number, voxel);
    const double index[3] = {(double)voxel[0] + 0.5, (double)voxel[1] + 0.5,
                             domain->dimension == 3 ? (double)voxel[2] + 0.5 : 0};
    return point_at(domain->mask, index);
}

/* Returns true if a tissue voxel has a point within `reach`, mm, of `point`. `index` has the index
 * coordinates of the point. The nearest point of a voxel is taken to be the one with the nearest
 * index coordinates, which is exact if the voxels are bricks. */
static bool is_near(const Mask *mask, Vec3 point, const double index[3], double reach)
{
    int64_t low[3], high[3], voxel[3];
    for (int axis = 0; axis < 3; axis++) {
        double extent = reach * vec3_length(mask->inverse[axis]);
        low[axis] = (int64_t)fmax(floor(index[axis] - extent), 0);
        high[axis] = (int64_t)fmin(floor(index[axis] + extent), (double)mask->n[axis] - 1);
    }
    for (voxel[2] = low[2]; voxel[2] <= high[2]; voxel[2]++)
        for (voxel[1] = low[1]; voxel[1] <= high[1]; voxel[1]++)
            for (voxel[0] = low[0]; voxel[0] <= high[0]; voxel[0]++) {
                if (!is_tissue(mask, voxel))
                    continue;
                double nearest[3];
                for (int axis = 0; axis < 3; axis++)
                    nearest[axis] =
                        fmin(fmax(index[axis], (double)voxel[axis]), (double)voxel[axis] + 1);
                if (vec3_distance(point_at(mask, nearest), point) <= reach)
                    return true;
            }
    return false;
}

/* Tests whether a point is inside [DomainOps]: its voxel is tissue, or one within the tolerance is.
 * */
static bool mask_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    if (!box_contains(domain->own_bounds, point, tolerance_mm))
        return false;
    double index[3];
    index_of(domain->mask, point, index);
    const int64_t voxel[3] = {(int64_t)floor(index[0]), (int64_t)floor(index[1]),
                              (int64_t)floor(index[2])};
    return is_tissue(domain->mask, voxel) ||
           (tolerance_mm > 0 && is_near(domain->mask, point, index, tolerance_mm));
}

/* A walk from voxel to voxel along the line from + t along, 0 <= t <= 1, in index coordinates. */
typedef struct VoxelWalk {
    double from[3], along[3], inverse[3]; /* inverse: 1 / along */
    int64_t voxel[3], last[3];            /* the present voxel, and that of the line's end */
} VoxelWalk;

/* Returns the t at which the line leaves its present voxel, and sets *axis to the axis along which
 * it steps to the next one. In the last voxel, returns 1 and sets *axis to -1. */
static double exit_of_voxel(const VoxelWalk *walk, int *axis)
{
    double first = 1;
    *axis = -1;
    for (int i = 0; i < 3; i++) {
        if (walk->voxel[i] == walk->last[i])
            continue;
        double face = (double)walk->voxel[i] + (walk->along[i] > 0);
        double t = (face - walk->from[i]) * walk->inverse[i];
        if (*axis < 0 || t < first) {
            first = t;
            *axis = i;
        }
    }
    return first;
}

/* DomainOps.holds_segment. Stretches shorter than the slack may be outside of the tissue. */
static bool mask_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    if (!box_contains(domain->own_bounds, a, domain->slack_mm) ||
        !box_contains(domain->own_bounds, b, domain->slack_mm))
        return false;
    VoxelWalk walk;
    double to[3], ignored = domain->slack_mm / vec3_distance(a, b), entered = 0;
    index_of(domain->mask, a, walk.from);
    index_of(domain->mask, b, to);
    for (int axis = 0; axis < 3; axis++) {
        walk.along[axis] = to[axis] - walk.from[axis];
        walk.inverse[axis] = 1 / walk.along[axis];
        walk.voxel[axis] = (int64_t)floor(walk.from[axis]);
        walk.last[axis] = (int64_t)floor(to[axis]);
    }
    for (int axis = 0; axis >= 0;) {
        double left = exit_of_voxel(&walk, &axis);
        if (left - entered > ignored && !is_tissue(domain->mask, walk.voxel))
            return false;
        if (axis >= 0)
            walk.voxel[axis] += walk.along[axis] > 0 ? 1 : -1;
        entered = left;
    }
    return true;
}

/* Returns the voxel of tissue with the rank `pick`, from 0: finds its word by bisection, and then
 * its bit. */
static uint32_t tissue_voxel(const Mask *mask, size_t pick)
{
    size_t low = 0, high = mask_words(mask) - 1;
    while (low < high) {
        size_t middle = (low + high + 1) / 2;
        if (mask->tissue_before[middle] <= pick)
            low = middle;
        else
            high = middle - 1;
    }
    uint64_t word = mask->bits[low];
    for (size_t i = mask->tissue_before[low]; i < pick; i++)
        word &= word - 1;
    return (uint32_t)(64 * low) + (uint32_t)__builtin_ctzll(word);
}

/* Returns a random point of the tissue [DomainOps]: of a random tissue voxel, each with the same
 * probability, a random point. */
static Vec3 mask_sample(const Domain *domain, Random *random)
{
    const Mask *mask = domain->mask;
    size_t pick = (size_t)(random_uniform(random) * (double)mask->n_tissue);
    int64_t voxel[3];
    voxel_of(mask, tissue_voxel(mask, pick), voxel);
    double index[3] = {0};
    for (int axis = 0; axis < domain->dimension; axis++)
        index[axis] = (double)voxel[axis] + random_uniform(random);
    return point_at(mask, index);
}

/* Minimum volume of a voxel relative to a brick with the same edges. With less, the three axes lie
 * in a plane, and the inverse of the affine map would lose six or more digits. Real images are near
 * 1. */
static const double least_upright = 1e-6;

Status mask_invert_axes(Mask *mask, const char *file, double *volume, Err *err)
{
    const Vec3 *step = mask->step;
    double brick = 1;
    for (int axis = 0; axis < 3; axis++) {
        double length = vec3_length(step[axis]);
        if (!(length >= DOMAIN_MIN_MM && length <= DOMAIN_MAX_MM))
            return err_set(err, STATUS_INPUT,
                           "%s: the sform or qform is wrong: a voxel is %.4g mm long along axis "
                           "%d; it must be from %g to %g mm",
                           file, length, axis + 1, DOMAIN_MIN_MM, DOMAIN_MAX_MM);
        brick *= length;
    }
    Vec3 across[3] = {vec3_cross(step[1], step[2]), vec3_cross(step[2], step[0]),
                      vec3_cross(step[0], step[1])};
    double determinant = vec3_dot(step[0], across[0]);
    *volume = fabs(determinant);
    if (!(*volume >= least_upright * brick))
        return err_set(err, STATUS_INPUT,
                       "%s: the voxels' axes do not span space; the sform or qform is wrong", file);
    for (int axis = 0; axis < 3; axis++)
        mask->inverse[axis] = vec3_scale(across[axis], 1 / determinant);
    return STATUS_OK;
}

/* Counts the tissue voxels, and sets mask->tissue_before for sampling. */
static Status count_tissue(Domain *domain, Err *err)
{
    Mask *mask = domain->mask;
    size_t words = mask_words(mask);
    TRY(mem_calloc(&mask->tissue_before, words, sizeof *mask->tissue_before, "voxels", err));
    for (size_t i = 0; i < words; i++) {
        mask->tissue_before[i] = (uint32_t)mask->n_tissue;
        mask->n_tissue += (size_t)__builtin_popcountll(mask->bits[i]);
    }
    if (mask->n_tissue > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: the mask is empty: none of its %zu %s is above 0",
                   domain->file, (size_t)(mask->n[0] * mask->n[1] * mask->n[2]),
                   domain->dimension == 2 ? "pixels" : "voxels");
}

/* Visits the voxels of tissue in ascending order. Starts zeroed. */
typedef struct TissueWalk {
    size_t words;  /* of the mask, visited so far */
    uint64_t rest; /* bits of the last word that are not visited */
} TissueWalk;

/* Sets *voxel to the next voxel of the walk. Returns false if there is none. */
static bool next_tissue(const Mask *mask, TissueWalk *walk, uint32_t *voxel)
{
    while (walk->rest == 0) {
        if (walk->words == mask_words(mask))
            return false;
        walk->rest = mask->bits[walk->words++];
    }
    *voxel = (uint32_t)(64 * (walk->words - 1)) + (uint32_t)__builtin_ctzll(walk->rest);
    walk->rest &= walk->rest - 1;
    return true;
}

/* Sets the bounds of the tissue, and the inlet: of the tissue voxels whose middles have the largest
 * y, the middle of the one that is halfway through their list. */
static void find_extent(Domain *domain)
{
    const Mask *mask = domain->mask;
    Vec3 half = vec3(0, 0, 0);
    for (int axis = 0; axis < domain->dimension; axis++)
        half = vec3_add_scaled(
            half,
            vec3(fabs(mask->step[axis].x), fabs(mask->step[axis].y), fabs(mask->step[axis].z)),
            0.5);
    Box middles = box_empty();
    size_t highest = 0;
    uint32_t voxel;
    for (TissueWalk walk = {0}; next_tissue(mask, &walk, &voxel);) {
        Vec3 middle = middle_of(domain, voxel);
        highest = middle.y > middles.high.y ? 1 : highest + (middle.y == middles.high.y);
        middles = box_with_ball(middles, middle, 0);
    }
    size_t skipped = highest / 2;
    for (TissueWalk walk = {0}; next_tissue(mask, &walk, &voxel);) {
        domain->inlet = middle_of(domain, voxel);
        if (domain->inlet.y == middles.high.y && skipped-- == 0)
            break;
    }
    domain->bounds = (Box){vec3_sub(middles.low, half), vec3_add(middles.high, half)};
}

static bool ends_in(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcasecmp(text + length - tail, end) == 0;
}

bool mask_is_nifti(const char *file)
{
    return ends_in(file, ".nii") || ends_in(file, ".nii.gz");
}

int64_t mask_voxel(const Mask *mask, Vec3 point)
{
    double index[3];
    int64_t number = 0;
    index_of(mask, point, index);
    for (int axis = 2; axis >= 0; axis--) {
        if (!(index[axis] >= 0 && index[axis] < (double)mask->n[axis]))
            return -1;
        number = number * mask->n[axis] + (int64_t)index[axis];
    }
    return number;
}

/* Reads the mask of a NIfTI file, or of a picture whose pixels are parameter[0] mm wide. */
static Status read_file(Domain *domain, Err *err)
{
    bool is_nifti = mask_is_nifti(domain->file);
    if (is_nifti && domain->n_parameters > 0)
        return err_set(err, STATUS_USAGE,
                       "a NIfTI file has its own units; use mask:FILE without a number");
    if (!is_nifti && domain->n_parameters == 0)
        return err_set(err, STATUS_USAGE,
                       "a picture needs the width of a pixel in mm; use mask:FILE,MM, as in "
                       "mask:%s,0.5",
                       domain->file);
    domain->dimension = is_nifti ? 3 : 2;
    domain->unit_is_guessed = false;
    if (is_nifti)
        return mask_read_nifti(domain->mask, domain->file, err);
    return mask_read_picture(domain->mask, domain->file, domain->parameter[0], err);
}

/* Reads the domain `mask:FILE[,MM]` [DomainOps]. */
static Status mask_load(Domain *domain, const char *values, Err *err)
{
    TRY(domain_load_file_name(domain, values, err));
    TRY(mem_calloc(&domain->mask, 1, sizeof *domain->mask, "masks", err));
    TRY(read_file(domain, err));
    double volume = 0;
    TRY(mask_invert_axes(domain->mask, domain->file, &volume, err));
    TRY(count_tissue(domain, err));
    find_extent(domain);
    TRY(domain_check_point(domain->file, 0, domain->bounds.low, err));
    TRY(domain_check_point(domain->file, 0, domain->bounds.high, err));
    domain->volume = volume * (double)domain->mask->n_tissue;
    return STATUS_OK;
}

static void mask_release(Domain *domain)
{
    if (!domain->mask)
        return;
    free(domain->mask->bits);
    free(domain->mask->tissue_before);
    free(domain->mask);
}

const DomainOps mask_ops = {
    .shape = {"mask", "FILE[,MM]",
              "image with pixels MM mm wide, in which all pixels except black are tissue; or a "
              "NIfTI file"},
    .load = mask_load,
    .inside = mask_inside,
    .holds_segment = mask_holds_segment,
    .sample = mask_sample,
    .release = mask_release,
};
