/* Voxels of tissue in space; pixels are voxels in a single layer. Private to the room domain. */
#ifndef CORCAST_DOMAIN_MASK_H
#define CORCAST_DOMAIN_MASK_H

#include "domain/domain.h"
#include <stdint.h>

/* The voxel (i, j, k), each from 0 to n - 1, fills the points whose index coordinates are in
 * [i, i + 1) x [j, j + 1) x [k, k + 1). */
struct Mask {
    int64_t n[3];    /* below 2^32 in all */
    uint64_t *bits;  /* bit v % 64 of word v / 64: voxel v is tissue; i runs fastest; owned */
    Vec3 corner;     /* of the index coordinates 0 0 0, mm */
    Vec3 step[3];    /* from one voxel to the next along i, j, k, mm */
    Vec3 inverse[3]; /* rows of the inverse of the matrix whose columns the steps are */
    float *value;    /* of each voxel, where readers are to keep it: else NULL; owned */
    bool keeps_values;
    uint32_t *before; /* per word of bits: number of voxels of tissue in the words before; owned */
    size_t n_tissue;
};

/* Returns the number of words of `bits`. */
static inline size_t mask_words(const Mask *mask)
{
    return ((size_t)mask->n[0] * (size_t)mask->n[1] * (size_t)mask->n[2] + 63) / 64;
}

/* Readers fill n, bits, corner and step of a zeroed mask. STATUS_INPUT naming the file.
 * A picture: black is not tissue; a pixel is `mm` wide, the middle of the picture is the origin,
 * the first row is at the top. */
MUST_CHECK Status mask_read_picture(Mask *mask, const char *path, double mm, Err *err);
/* NIfTI-1 or -2: what is above 0 is tissue; world coordinates are those of the sform or, without
 * one, of the qform. */
MUST_CHECK Status mask_read_nifti(Mask *mask, const char *path, Err *err);

/* The inverse of the voxels' axes, which are to be of a sensible length and to span space, and a
 * voxel's volume, mm^3. STATUS_INPUT naming the file. */
MUST_CHECK Status mask_invert_axes(Mask *mask, const char *file, double *volume, Err *err);
/* The number of the voxel that holds the point, mm; -1 off the mask. In two dimensions z is not
 * looked at. */
int64_t mask_voxel(const Mask *mask, Vec3 point);
/* Whether the file's name is that of a NIfTI file. */
bool mask_is_nifti(const char *file);

#endif
