/* Reads a mask from a picture or from a NIfTI file (a medical volume image).
 *
 * NIfTI files are read with niftilib, by the authors of the format. This file works around three
 * properties of the library. It prints errors to standard error, so it is set to be quiet. It
 * trusts headers, so they are checked here before it makes an image, and sizes before voxels are
 * read. For a.nii.gz it would read the voxels of a file a.nii, if there is one, so the file is
 * opened here. */
#include "domain/mask.h"

#ifdef CORCAST_PAGE /* the page that grows trees [web/] reads no files */

/* Reports that this build reads no files. */
static Status refuse(const char *path, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: cannot be read: a page in a browser reads no files",
                   path);
}

Status mask_read_picture(Mask *mask, const char *path, double mm, Err *err)
{
    (void)mask, (void)mm;
    return refuse(path, err);
}

Status mask_read_nifti(Mask *mask, const char *path, Err *err)
{
    (void)mask;
    return refuse(path, err);
}

#else

#include "image/image.h"
#include <errno.h>
#include <nifti/nifti2_io.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Maximum number of voxels of a map that keeps their values: a gigabyte of floats. */
static const int64_t most_values = (int64_t)1 << 28;

/* Errors: STATUS_INPUT if there are no voxels or too many to number them. Divides instead of
 * multiplying, so that no product overflows. */
static Status check_count(const Mask *mask, const char *path, const int64_t n[3], Err *err)
{
    int64_t most = mask->keeps_values ? most_values : UINT32_MAX;
    for (int axis = 0; axis < 3; axis++) {
        if (n[axis] < 1 || n[axis] > most)
            return err_set(err, STATUS_INPUT,
                           "%s: has %lld x %lld x %lld voxels; it must have at least one and fewer "
                           "than %s",
                           path, (long long)n[0], (long long)n[1], (long long)n[2],
                           mask->keeps_values ? "2^28, as a map of values" : "2^32");
        most /= n[axis];
    }
    return STATUS_OK;
}

/* Sets up a mask of n[0] x n[1] x n[2] voxels, none of which is tissue. */
static Status init(Mask *mask, const char *path, const int64_t n[3], Err *err)
{
    TRY(check_count(mask, path, n, err));
    for (int axis = 0; axis < 3; axis++)
        mask->n[axis] = n[axis];
    size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    if (mask->keeps_values)
        TRY(mem_calloc(&mask->value, voxels, sizeof *mask->value, "voxels", err));
    return mem_calloc(&mask->bits, mask_words(mask), sizeof *mask->bits, "voxels", err);
}

/* Marks a voxel as tissue. */
static void set_tissue(Mask *mask, size_t voxel)
{
    mask->bits[voxel / 64] |= (uint64_t)1 << voxel % 64;
}

Status mask_read_picture(Mask *mask, const char *path, double mm, Err *err)
{
    Picture picture = {0};
    TRY(picture_read(&picture, path, ALPHA_IS_MASK, err));
    const int64_t n[3] = {picture.width, picture.height, 1};
    Status status = STATUS_OK;
    TRY_GOTO(init(mask, path, n, err));
    size_t channels = (size_t)picture.channels;
    for (size_t i = 0; i < (size_t)picture.width * (size_t)picture.height; i++)
        for (size_t c = 0; c < channels; c++) {
            uint32_t code = picture_code(&picture, i * channels + c);
            if (code != 0)
                set_tissue(mask, i);
            if (mask->keeps_values)
                mask->value[i] += (float)code;
        }
    mask->corner = vec3(-mm * picture.width / 2, mm * picture.height / 2, 0);
    mask->step[0] = vec3(mm, 0, 0);
    mask->step[1] = vec3(0, -mm, 0);
    mask->step[2] = vec3(0, 0, 1);
done:
    picture_release(&picture);
    return status;
}

/* Reads voxel `i` of a buffer that holds numbers of the NIfTI type `datatype`. Returns false for a
 * type that is no real number. */
static bool stored_value(int datatype, const void *buffer, size_t i, double *value)
{
    switch (datatype) {
#define CASE(code, type)                                                                           \
    case code:                                                                                     \
        *value = (double)((const type *)buffer)[i];                                                \
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

/* Returns the length of a NIfTI unit in mm; 1 for unknown units. */
static double mm_of_unit(int unit)
{
    return unit == NIFTI_UNITS_METER ? 1000 : unit == NIFTI_UNITS_MICRON ? 1e-3 : 1;
}

/* Sets the position of the mask in space. Integer index coordinates are the middle of a voxel in
 * NIfTI, and its corner in a Mask, half a step away. */
static void set_position(Mask *mask, const nifti_image *image)
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

/* Reports a file that is too short. */
static Status ends_early(const char *path, const nifti_image *image, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: ends before all of its %lld x %lld x %lld voxels", path,
                   (long long)image->nx, (long long)image->ny, (long long)image->nz);
}

/* Checks the size that the header states against the size of the file. */
static Status check_size(const char *path, const nifti_image *image, Err *err)
{
    enum { DEFLATE_MAX_RATIO = 1032 }; /* of the compression of a .gz file */
    double needed = (double)image->nvox * image->nbyper;
    if (needed > file_bytes(path) * (nifti_is_gzfile(path) ? DEFLATE_MAX_RATIO : 1))
        return ends_early(path, image, err);
    return STATUS_OK;
}

/* Sets the voxels from `first` on from the n numbers of a buffer. */
static void store(Mask *mask, const nifti_image *image, const void *buffer, size_t first, size_t n)
{
    bool scaled = image->scl_slope != 0;
    for (size_t i = 0; i < n; i++) {
        double value = 0;
        stored_value(image->datatype, buffer, i, &value);
        if (scaled)
            value = value * (double)image->scl_slope + (double)image->scl_inter;
        if (value > 0)
            set_tissue(mask, first + i);
        if (mask->keeps_values)
            mask->value[first + i] = (float)value;
    }
}

/* Reads the voxels, one buffer at a time. A mask stores one bit per voxel, so that its memory
 * depends neither on the type of the voxels nor on how well they are compressed. */
static Status load_voxels(Mask *mask, const char *path, nifti_image *image, Err *err)
{
    enum { BUFFER = 1 << 20 }; /* bytes */
    void *buffer = NULL;
    TRY(mem_calloc(&buffer, BUFFER, 1, "bytes of voxels", err));
    errno = 0;
    znzFile file = znzopen(path, "rb", nifti_is_gzfile(path));
    bool whole = !znz_isnull(file) && znzseek(file, (znz_off_t)image->iname_offset, SEEK_SET) >= 0;
    size_t voxels = (size_t)image->nvox, n = BUFFER / (size_t)image->nbyper;
    for (size_t first = 0; whole && first < voxels; first += n) {
        if (n > voxels - first)
            n = voxels - first;
        int64_t bytes = (int64_t)n * image->nbyper;
        whole = nifti_read_buffer(file, buffer, bytes, image) == bytes;
        if (whole)
            store(mask, image, buffer, first, n);
    }
    znzclose(file);
    free(buffer);
    if (!whole && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    return whole ? STATUS_OK : ends_early(path, image, err);
}

/* Checks the image, then reads the tissue of its voxels and the positions of voxels in space. */
static Status read_voxels(Mask *mask, const char *path, nifti_image *image, Err *err)
{
    const int64_t n[3] = {image->nx, image->ny, image->nz};
    static const double zero[2] = {0};
    double value;
    TRY(check_count(mask, path, n, err));
    if (image->nvox != n[0] * n[1] * n[2])
        return err_set(
            err, STATUS_INPUT,
            "%s: holds more than one volume (%lld dimensions); a mask must be one volume", path,
            (long long)image->ndim);
    if (!stored_value(image->datatype, zero, 0, &value))
        return err_set(err, STATUS_INPUT,
                       "%s: its voxels are of the NIfTI type %s; the voxels of a mask must be "
                       "integers or real numbers",
                       path, nifti_datatype_string(image->datatype));
    TRY(check_size(path, image, err));
    TRY(init(mask, path, n, err));
    TRY(load_voxels(mask, path, image, err));
    set_position(mask, image);
    return STATUS_OK;
}

/* The parts of a NIfTI header that are checked. */
typedef struct Header {
    int version;
    int datatype;
    int64_t width;
    double vox_offset;
    bool is_one_file; /* the voxels are in the same file */
} Header;

static int header_bytes(int version)
{
    return version == 1 ? (int)sizeof(nifti_1_header) : (int)sizeof(nifti_2_header);
}

/* Reads a header, and swaps its bytes if the file has the other byte order. Returns false if it is
 * not a NIfTI header. The library checks the type of the voxels before it swaps its bytes, so that
 * check is made here [is_mask_header]. */
static bool read_header(const char *path, Header *out)
{
    int version = 0;
    void *bytes = nifti_read_header(path, &version, 0);
    nifti_1_header *first = bytes;
    nifti_2_header *second = bytes;
    bool good = bytes && (version == 1 || version == 2);
    if (good && first->sizeof_hdr != header_bytes(version))
        swap_nifti_header(bytes, version);
    if (good && version == 1)
        *out = (Header){1, first->datatype, first->dim[1], (double)first->vox_offset,
                        NIFTI_ONEFILE(*first)};
    else if (good)
        *out = (Header){2, second->datatype, second->dim[1], (double)second->vox_offset,
                        memcmp(second->magic, "n+2", 4) == 0};
    good = good && (version == 1 ? nifti_hdr1_looks_good(first) : nifti_hdr2_looks_good(second));
    free(bytes);
    return good;
}

/* Returns true for a header that the library accepts. The library would print its own message for
 * any other header, even if it is set to be quiet. */
static bool is_mask_header(const Header *header)
{
    return header->is_one_file && header->datatype != DT_UNKNOWN && header->datatype != DT_BINARY &&
           header->width > 0;
}

/* Returns true if extensions follow the header: the first of the 4 bytes after it is not 0. */
static bool has_extensions(const char *path, int version)
{
    char extender = 0;
    znzFile file = znzopen(path, "rb", nifti_is_gzfile(path));
    bool read = !znz_isnull(file) && znzseek(file, header_bytes(version), SEEK_SET) >= 0 &&
                znzread(&extender, 1, 1, file) == 1;
    znzclose(file);
    return read && extender != 0;
}

/* Finds where the voxels begin, in bytes: after the header and the 4 bytes that follow it, or at
 * vox_offset. A vox_offset of 0, which many programs write, means after the header. */
static Status find_voxels(const char *path, const Header *header, int64_t *begin, Err *err)
{
    *begin = header_bytes(header->version) + 4;
    double offset = header->vox_offset;
    if (offset == 0 && has_extensions(path, header->version))
        return err_set(
            err, STATUS_INPUT,
            "%s: its vox_offset is 0, but extensions follow the header, so the position of "
            "the voxels is unknown; vox_offset must state it",
            path);
    if (offset == 0)
        return STATUS_OK;
    if (!(offset >= (double)*begin && offset <= 1e15 && offset == floor(offset)))
        return err_set(err, STATUS_INPUT,
                       "%s: its vox_offset is %.9g; it must be 0 or an integer from %lld on", path,
                       offset, (long long)*begin);
    *begin = (int64_t)offset;
    return STATUS_OK;
}

/* Reads a NIfTI file: finds where its voxels begin, then lets nifti_image_read parse the header. */
static Status read_image(Mask *mask, const char *path, Err *err)
{
    Header header;
    errno = 0;
    nifti_image *image = NULL;
    int64_t begin = 0;
    if (read_header(path, &header) && is_mask_header(&header)) {
        TRY(find_voxels(path, &header, &begin, err));
        image = nifti_image_read(path, 0);
    }
    if (!image && errno == ENOMEM)
        return mem_out_of("to read", path, err);
    if (!image)
        return err_set(err, STATUS_INPUT, "%s: is not a NIfTI-1 or NIfTI-2 file", path);
    image->iname_offset = begin;
    Status status = read_voxels(mask, path, image, err);
    nifti_image_free(image);
    return status;
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
    return read_image(mask, path, err);
}

#endif
