/* The public header of the module voxel: writes vessels as volumes for other programs. A volume
 * holds the filled fraction of each voxel, the vessel that fills most of it, or the centrelines. */
#ifndef CORCAST_VOXEL_VOXEL_H
#define CORCAST_VOXEL_VOXEL_H

#include "base/base.h"
#include "scene/scene.h"
#include "voxel/volume.h" // IWYU pragma: export
#include <stdint.h>

/* Makes the grid around a geometry, with one layer of empty voxels on each side. The coordinates of
 * voxel centres, in the tree, are multiples of `step` (mm, each > 0); a tree in a plane thus lies
 * in the middle of a layer. Errors: STATUS_INFEASIBLE if a side would have 2^31 voxels or more. */
MUST_CHECK Status voxelgrid_make(const Geometry *geometry, Vec3 step, VoxelGrid *out, Err *err);

/* Estimated work for a volume. */
typedef struct VoxelEstimate {
    double voxels;         /* number of voxels */
    double partial_voxels; /* number of partly filled voxels */
    double bytes;          /* size of all files */
    double memory;         /* bytes, of the whole program */
    double seconds;        /* on `threads` threads of a processor of 2023 */
} VoxelEstimate;

typedef struct VoxelParams {
    VoxelGrid grid;
    const uint32_t *labels;   /* per segment index: its label, > 0; NULL: none */
    VolumeStream *values;     /* receives the filled fraction of each voxel */
    VolumeStream *label;      /* receives the label of the segment that fills most of the voxel, if
                               * the voxel is not 0 in `values`; NULL: not wanted */
    VolumeStream *centreline; /* receives 1 where a vessel axis passes; NULL: not wanted */
    int threads;              /* 0: all processors */
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *context;
} VoxelParams;

typedef struct VoxelReport {
    double union_mm3;      /* volume of the vessels, before rounding to steps of the samples */
    double volume_mm3;     /* volume of the written samples */
    int64_t filled;        /* number of voxels that are not 0 */
    size_t n_given_voxels; /* number of labels that fill most of no voxel and were given one */
} VoxelReport;

/* Estimates the work of voxels_write. O(number of segments). */
VoxelEstimate voxels_estimate(const Geometry *geometry, const VoxelParams *params);

/* Fills the streams with volumes of the union of cylinders and balls of a geometry.
 *
 * Samples are rounded. An integer sample of a voxel that a vessel axis passes is at least 1, so
 * that vessels stay connected. Every label has at least one voxel: a label that fills most of no
 * voxel on or next to its axes is given one of the voxels there. The bytes do not depend on
 * `threads`.
 *
 * Errors  STATUS_INFEASIBLE, naming an id, if there are more labels than voxels for them;
 * STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status voxels_write(const Geometry *geometry, const VoxelParams *params,
                               VoxelReport *report, Err *err);

#endif
