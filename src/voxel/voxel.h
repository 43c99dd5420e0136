/* The public header of the module voxel: writes vessels as volumes for other programs.
 *
 * A volume stores one of three values per voxel: the fraction that vessels fill, the label of the
 * vessel that fills most of the voxel, or whether a vessel's axis passes through it. voxels_write
 * writes up to three files at the same time. The vessels are the union of a geometry's cylinders
 * and balls.
 *
 *     TRY(voxelgrid_make(&geometry, vec3(0.1, 0.1, 0.1), &params.grid, err));
 *     TRY(volume_begin(params.fraction, &params.grid, true, "vessels", err));
 *     TRY(voxels_write(&geometry, &params, &report, err));
 *
 * voxels_write ends the streams; the caller closes the files. */
#ifndef CORCAST_VOXEL_VOXEL_H
#define CORCAST_VOXEL_VOXEL_H

#include "base/base.h"
#include "scene/scene.h"
#include "voxel/volume.h" // IWYU pragma: export
#include <stdint.h>

/* Makes the grid around a geometry, with one layer of empty voxels on each side. The coordinates of
 * voxel centres, in the tree, are multiples of `step`. A tree in the plane z = 0 is therefore in
 * the middle of a layer, and the grids of several trees fit together.
 *
 * step     sides of a voxel, mm, each above 0.
 * Errors   STATUS_INFEASIBLE if a side would have 2^31 voxels or more. */
MUST_CHECK Status voxelgrid_make(const Geometry *geometry, Vec3 step, VoxelGrid *out, Err *err);

/* The expected cost of volumes. */
typedef struct VoxelEstimate {
    double voxels;         /* number of voxels */
    double partial_voxels; /* number of partly filled voxels */
    double bytes;          /* size of all files */
    double memory;         /* bytes, of the whole program */
    double seconds;        /* on `threads` threads of a processor of 2023 */
} VoxelEstimate;

/* Parameters of voxels_write. All pointers are borrowed. */
typedef struct VoxelParams {
    VoxelGrid grid;
    const uint32_t *labels; /* per segment index: its label, above 0; needed if `label` is set */
    VolumeStream *fraction; /* receives the filled fraction of each voxel; never NULL */
    VolumeStream *label; /* receives the label of the segment that fills most of the voxel, if the
                          * voxel is not 0 in `fraction`; NULL: not wanted */
    VolumeStream *centreline; /* receives 1 where a vessel axis passes; NULL: not wanted */
    int threads;              /* number of threads; 0: one per processor */
    /* Returns false to stop. NULL: none. `context` is passed to it. */
    bool (*progress)(double fraction, void *context);
    void *context;
} VoxelParams;

/* Results of voxels_write. */
typedef struct VoxelReport {
    double union_mm3;         /* volume of the vessels, before quantization to sample values */
    double volume_mm3;        /* volume of the written samples */
    int64_t filled;           /* number of voxels that are not 0 */
    size_t n_reserved_labels; /* number of labels for which a voxel was reserved, because they are
                               * the largest part of no voxel on or next to their axes */
} VoxelReport;

/* Returns the expected cost of voxels_write. Does not write anything, and cannot fail. O(number of
 * primitives). */
VoxelEstimate voxels_estimate(const Geometry *geometry, const VoxelParams *params);

/* Writes the samples of all streams, and ends the streams [volume_end]. The caller must have called
 * volume_begin for each stream, and closes the files. The bytes do not depend on `threads`.
 *
 * Samples are rounded to the nearest value of the sample type. If a vessel axis passes through a
 * voxel, a sample of an integer type is at least 1, so that vessels stay connected. Every label has
 * at least one voxel: if a label is the largest part of no voxel on or next to its axes, one of
 * these voxels is reserved for it.
 *
 * report   receives the sums.
 * Errors   STATUS_INFEASIBLE, with the id of a segment, if its label cannot get a voxel;
 *          STATUS_CANCELLED if `progress` returned false; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status voxels_write(const Geometry *geometry, const VoxelParams *params,
                               VoxelReport *report, Err *err);

#endif
