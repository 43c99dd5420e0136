/* A mask: a domain that consists of the voxels of an image that are tissue. A picture is a mask
 * with a single layer of voxels. Private to the module domain.
 *
 * mask.c calls a reader and mask_invert_axes, counts the tissue voxels (tissue_before, n_tissue),
 * and releases the mask with its domain [DomainOps.release], also after an error. The demand map
 * [demand.c] uses a mask without these counts. */
#ifndef CORCAST_DOMAIN_MASK_H
#define CORCAST_DOMAIN_MASK_H

#include "domain/domain.h"
#include <stdint.h>

/* The voxel (i, j, k), each from 0 to n - 1, fills the points whose index coordinates are in
 * [i, i + 1) x [j, j + 1) x [k, k + 1). */
struct Mask {
    int64_t n[3];      /* voxels along i, j and k; their product is below 2^32 */
    uint64_t *bits;    /* bit v % 64 of word v / 64: voxel v is tissue; i runs fastest; owned */
    Vec3 corner;       /* the point with index coordinates (0, 0, 0), mm */
    Vec3 step[3];      /* from one voxel to the next along i, j, k, mm */
    Vec3 inverse[3];   /* rows of the inverse of the matrix that has the steps as columns, 1/mm */
    float *value;      /* per voxel: value of the image if keeps_values is set, else NULL; owned */
    bool keeps_values; /* set by the caller before reading: the reader sets `value` */
    uint32_t *tissue_before; /* per word of bits: number of tissue voxels before it; owned */
    size_t n_tissue;         /* number of tissue voxels */
};

/* Returns the number of words of `bits`. */
static inline size_t mask_words(const Mask *mask)
{
    return ((size_t)mask->n[0] * (size_t)mask->n[1] * (size_t)mask->n[2] + 63) / 64;
}

/* The two readers set n, bits, corner and step of a mask, and `value` if keeps_values is set.
 * Before the call, all members except keeps_values must be zero. After an error some arrays may be
 * set. Errors: STATUS_INPUT with the name of the file, STATUS_IO, STATUS_MEMORY. */

/* Reads a picture. Black pixels are not tissue; all other pixels are. A pixel is `mm` mm wide. The
 * origin is the middle of the picture, and the first row has the largest y. */
MUST_CHECK Status mask_read_picture(Mask *mask, const char *path, double mm, Err *err);
/* Reads a NIfTI-1 or NIfTI-2 file. Voxels with a value above 0 are tissue. Positions are the world
 * coordinates by the sform or, if the file has none, by the qform. */
MUST_CHECK Status mask_read_nifti(Mask *mask, const char *path, Err *err);

/* Sets mask->inverse from mask->step, and *volume to the volume of a voxel, mm^3. Errors:
 * STATUS_INPUT with the name of the file, if the inverse or the volume is not finite: a step has
 * the length 0 or is extremely long, or the three steps lie in a plane. */
MUST_CHECK Status mask_invert_axes(Mask *mask, const char *file, double *volume, Err *err);
/* Returns the index of the voxel that holds a point (mm), or -1 if the point is outside the mask. A
 * mask of two dimensions ignores z. */
int64_t mask_voxel(const Mask *mask, Vec3 point);
/* Returns true if the file's name has the extension of a NIfTI file. */
bool mask_is_nifti(const char *file);

#endif
