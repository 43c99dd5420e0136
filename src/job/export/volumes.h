/* The vessels of a tree as volumes of voxels, and the options about them. */
#ifndef CORCAST_JOB_EXPORT_VOLUMES_H
#define CORCAST_JOB_EXPORT_VOLUMES_H

#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"
#include "voxel/voxel.h"

typedef struct VolumeOptions {
    NumberList voxel; /* mm: one number, or one for each axis; empty: a 256th of the longest side */
    int depth, labels;      /* choices */
    const char *centreline; /* a file, or NULL */
} VolumeOptions;

extern const OptionTable volume_table; /* sets a VolumeOptions */

/* Appends the extensions of volume files: ".nii.gz, .nii". */
void volumes_extensions(Text *out);

/* Sets the paths and roles of the files that are written for `output`: volumes, and beside them the
 * tree as CSV, a manifest and, of a density file, a scene. `files` is zeroed, except for the taker;
 * fileset_release releases it, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status volumes_name(const VolumeOptions *options, const VolumeFormat *format,
                               const char *output, FileSet *files, Err *err);

/* Writes the volumes and what is beside them. Reports the expected cost, and the result.
 *
 * files   volumes_name has named them.
 * Errors  STATUS_USAGE if a format cannot hold what is wanted; those of stage_geometry,
 *         voxelgrid_make, volume_check, work_make, voxels_write and work_write. */
MUST_CHECK Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                                const PictureTree *of, FileSet *files, const Parsed *parsed,
                                Err *err);

#endif
