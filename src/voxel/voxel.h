/* The door of the room voxel: vessels as volumes, how much of each voxel they fill and which of
 * them it is, in files that other programs read. */
#ifndef CORCAST_VOXEL_VOXEL_H
#define CORCAST_VOXEL_VOXEL_H

#include "base/base.h"
#include "scene/scene.h"
#include "voxel/volume.h" // IWYU pragma: export
#include <stdint.h>

/* STATUS_INFEASIBLE when a side would have 2^31 voxels or more. The grid about a geometry, with a
 * voxel of nothing on each side; the middles of voxels have coordinates, of the tree, that are
 * multiples of `step`, mm, each above 0: trees in a plane lie in the middle of a layer. */
MUST_CHECK Status voxelgrid_make(const Geometry *geometry, Vec3 step, VoxelGrid *out, Err *err);

/* How much work a volume is. */
typedef struct VoxelEstimate {
    double voxels, walls; /* how many there are, and how many of them are partly filled */
    double bytes;         /* of all volumes, in files of these formats: about */
    double memory;        /* bytes, of the whole program */
    double seconds;       /* on the threads asked for, of a processor of 2023 */
} VoxelEstimate;

typedef struct VoxelParams {
    VoxelGrid grid;
    /* The label of each segment, by its number, above 0 [Geometry.segments]; NULL: none. */
    const uint32_t *labels;
    VolumeStream *values;     /* how much of each voxel is filled */
    VolumeStream *label;      /* or NULL: the label of the segment that fills the most of it, of the
                               * voxels that are not 0 in `values` */
    VolumeStream *centreline; /* or NULL: 1 where an axis passes */
    int threads;              /* 0: all processors */
    void (*progress)(double fraction, void *context); /* NULL: none */
    void *context;
} VoxelParams;

typedef struct VoxelReport {
    double union_mm3;  /* what the vessels fill, before rounding to steps of the samples */
    double volume_mm3; /* what the voxels say */
    int64_t filled;    /* voxels that are not 0 */
    size_t claimed;    /* labels that fill the most of no voxel, and were given one */
} VoxelReport;

/* O(number of segments). */
VoxelEstimate voxels_estimate(const Geometry *geometry, const VoxelParams *params);

/* Fills the streams with the volumes of a geometry of cylinders and balls, whose union they show.
 * A voxel that an axis passes is never 0 where it should be above, so that vessels do not break
 * up; else samples are rounded. Every label has a voxel: one that fills the most of none on its
 * axes or next to them is given one of those that it meets there. The same bytes for any number of
 * threads. STATUS_INFEASIBLE, naming an id, when there are more labels than voxels for them;
 * STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status voxels_write(const Geometry *geometry, const VoxelParams *params,
                               VoxelReport *report, Err *err);

#endif
