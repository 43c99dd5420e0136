/* NIfTI files are read by niftilib, of the format's authors. It prints errors to standard error, so
 * it is told to be quiet, and headers are checked here before it makes an image of one; sizes are
 * checked before voxels are read. It would take the voxels of a.nii.gz from a.nii if there is one,
 * so the file is opened here. */
#include "domain/mask.h"

#include "image/image.h"
#include <errno.h>
#include <nifti2_io.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Status check_count(const char *path, const int64_t n[3], Err *err)
{
    int64_t most = UINT32_MAX;
    for (int axis = 0; axis < 3; axis++) {
        if (n[axis] < 1 || n[axis] > most)
            return err_set(err, STATUS_INPUT,
                           "%s: has %lld x %lld x %lld voxels; it must have at least one and fewer "
                           "than 2^32",
                           path, (long long)n[0], (long long)n[1], (long long)n[2]);
        most /= n[axis];
    }
    return STATUS_OK;
}

Status mask_init(Mask *mask, const char *path, const int64_t n[3], Err *err)
{
    TRY(check_count(path, n, err));
    for (int axis = 0; axis < 3; axis++)
        mask->n[axis] = n[axis];
    size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    if (mask->keeps_values)
        TRY(mem_calloc(&mask->value, voxels, sizeof *mask->value, "voxels", err));
    return mem_calloc(&mask->is_tissue, voxels, 1, "voxels", err);
}

Status mask_read_picture(Mask *mask, const char *path, double mm, Err *err)
{
    Picture picture = {0};
    TRY(picture_read_mask(&picture, path, err));
    const int64_t n[3] = {picture.width, picture.height, 1};
    Status status = STATUS_OK;
    TRY_GOTO(mask_init(mask, path, n, err));
    size_t channels = (size_t)picture.channels;
    for (size_t i = 0; i < (size_t)picture.width * (size_t)picture.height; i++)
        for (size_t c = 0; c < channels; c++) {
            mask->is_tissue[i] |= picture_code(&picture, i * channels + c) != 0;
            if (mask->keeps_values)
                mask->value[i] += (float)picture_code(&picture, i * channels + c);
        }
    mask->corner = vec3(-mm * picture.width / 2, mm * picture.height / 2, 0);
    mask->step[0] = vec3(mm, 0, 0);
    mask->step[1] = vec3(0, -mm, 0);
    mask->step[2] = vec3(0, 0, 1);
done:
    picture_release(&picture);
    return status;
}

/* Sets *value to the voxel as stored; false when numbers of this type are not known. */
static bool stored_value(const nifti_image *image, size_t i, double *value)
{
    switch (image->datatype) {
#define CASE(code, type)                                                                           \
    case code:                                                                                     \
        *value = (double)((const type *)image->data)[i];                                           \
        return true;
        CASE(DT_UINT8, uint8_t)
        CASE(DT_INT8, int8_t)
        CASE(DT_UINT16, uint16_t)
        CASE(DT_INT16, int16_t)
        CASE(DT_UINT32, uint32_t)
        CASE(DT_INT32, int32_t)
        CASE(DT_UINT64, uint64_t)
        CASE(DT_INT64, int64_t)
        CASE(DT_FLOAT32, float)
        CASE(DT_FLOAT64, double)
#undef CASE
    default:
        return false;
    }
}

static double mm_of_unit(int unit)
{
    return unit == NIFTI_UNITS_METER ? 1000 : unit == NIFTI_UNITS_MICRON ? 1e-3 : 1;
}

/* NIfTI puts the index coordinates of a voxel at its middle, Mask at its corner. */
static void place(Mask *mask, const nifti_image *image)
{
    const nifti_dmat44 *form = image->sform_code > 0 ? &image->sto_xyz : &image->qto_xyz;
    double mm = mm_of_unit(image->xyz_units);
    const double(*m)[4] = form->m;
    mask->corner = vec3_scale(vec3(m[0][3], m[1][3], m[2][3]), mm);
    for (int axis = 0; axis < 3; axis++) {
        mask->step[axis] = vec3_scale(vec3(m[0][axis], m[1][axis], m[2][axis]), mm);
        mask->corner = vec3_add_scaled(mask->corner, mask->step[axis], -0.5);
    }
}

static Status ends_early(const char *path, const nifti_image *image, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: ends before all of its %lld x %lld x %lld voxels", path,
                   (long long)image->nx, (long long)image->ny, (long long)image->nz);
}

/* A size that the header gives is checked against the file's before it is used. */
static Status check_size(const char *path, const nifti_image *image, Err *err)
{
    enum { DEFLATE_MAX_RATIO = 1032 };
    double needed = (double)image->nvox * image->nbyper;
    if (needed > file_bytes(path) * (nifti_is_gzfile(path) ? DEFLATE_MAX_RATIO : 1))
        return ends_early(path, image, err);
    return mem_check(needed, path, err);
}

static Status load_voxels(const char *path, nifti_image *image, Err *err)
{
    int64_t size = image->nvox * image->nbyper;
    TRY(mem_calloc(&image->data, (size_t)size, 1, "bytes of voxels", err));
    errno = 0;
    znzFile file = znzopen(path, "rb", nifti_is_gzfile(path));
    bool whole = !znz_isnull(file) &&
                 znzseek(file, (znz_off_t)image->iname_offset, SEEK_SET) >= 0 &&
                 nifti_read_buffer(file, image->data, size, image) == size;
    znzclose(file);
    if (!whole && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    return whole ? STATUS_OK : ends_early(path, image, err);
}

static Status read_voxels(Mask *mask, const char *path, nifti_image *image, Err *err)
{
    const int64_t n[3] = {image->nx, image->ny, image->nz};
    TRY(check_count(path, n, err));
    TRY(check_size(path, image, err));
    TRY(mask_init(mask, path, n, err));
    size_t count = (size_t)image->nvox;
    if (count != (size_t)n[0] * (size_t)n[1] * (size_t)n[2])
        return err_set(err, STATUS_INPUT,
                       "%s: holds more than one volume (%lld dimensions); a mask is a single one",
                       path, (long long)image->ndim);
    TRY(load_voxels(path, image, err));
    bool scaled = image->scl_slope != 0;
    for (size_t i = 0; i < count; i++) {
        double value = 0;
        if (!stored_value(image, i, &value))
            return err_set(err, STATUS_INPUT,
                           "%s: its voxels are of the NIfTI type %s; a mask has whole or real "
                           "numbers",
                           path, nifti_datatype_string(image->datatype));
        if (scaled)
            value = value * (double)image->scl_slope + (double)image->scl_inter;
        mask->is_tissue[i] = value > 0;
        if (mask->keeps_values)
            mask->value[i] = (float)value;
    }
    place(mask, image);
    return STATUS_OK;
}

/* What the library would say in its own words, told to be quiet or not. */
static bool is_named(int datatype, int64_t width)
{
    return datatype != DT_UNKNOWN && datatype != DT_BINARY && width > 0;
}

/* With the voxels in the same file. */
static bool has_good_header(const char *path)
{
    int version = 0;
    void *header = nifti_read_header(path, &version, 0);
    const nifti_1_header *first = header;
    const nifti_2_header *second = header;
    bool good = false;
    if (header && version == 1)
        good = nifti_hdr1_looks_good(first) && NIFTI_ONEFILE(*first) &&
               is_named(first->datatype, first->dim[1]);
    else if (header && version == 2)
        good = nifti_hdr2_looks_good(second) && memcmp(second->magic, "n+2", 4) == 0 &&
               is_named(second->datatype, second->dim[1]);
    free(header);
    return good;
}

Status mask_read_nifti(Mask *mask, const char *path, Err *err)
{
    if (access(path, R_OK) != 0) { /* the library would try other endings of the name */
        static const FileForm form = {.name = "a NIfTI file", .most_bytes = 1e9};
        char *bytes = NULL;
        size_t size = 0;
        TRY(file_read(path, &form, &bytes, &size, err));
        free(bytes);
    }
    nifti_set_debug_level(0);
    errno = 0;
    nifti_image *image = has_good_header(path) ? nifti_image_read(path, 0) : NULL;
    if (!image && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    if (!image)
        return err_set(err, STATUS_INPUT, "%s: is not a NIfTI-1 or NIfTI-2 file", path);
    Status status = read_voxels(mask, path, image, err);
    nifti_image_free(image);
    return status;
}
