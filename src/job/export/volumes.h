/* Writes the vessels of a tree as voxel volumes. Declares the options for volumes. */
#ifndef CORCAST_JOB_EXPORT_VOLUMES_H
#define CORCAST_JOB_EXPORT_VOLUMES_H

#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"
#include "voxel/voxel.h"

typedef struct VolumeOptions {
    NumberList voxel; /* voxel size, mm: one number, or one per axis; empty: longest side / 256 */
    int depth;        /* choice: type of the samples, a SampleType */
    int labels;       /* choice: 0: no labels; 1: label is the id of the segment; 2: its Strahler
                       * order; 3: the number of its tree */
    const char *centreline; /* path of the centreline volume; NULL: none */
} VolumeOptions;

extern const OptionTable volume_table; /* sets a VolumeOptions */

/* Appends the extensions of volume files: ".nii.gz, .nii". */
void volumes_extensions(Text *out);

/* Sets the paths and roles of the output files: the volumes, the tree as CSV, a JSON manifest and,
 * for density files, a scene. The names of the additional files are derived from `output`.
 *
 * output   path of the volume.
 * files    zeroed by the caller, who releases it with fileset_release even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status volumes_name(const VolumeOptions *options, const VolumeFormat *format,
                               const char *output, FileSet *files, Err *err);

/* Writes the volumes and the additional files. Before that, sends a note with the expected cost;
 * afterwards, a note with the number of filled voxels and their volume.
 *
 * files    volumes_name must have set the paths.
 * Errors   STATUS_USAGE if --spacing is not one or three numbers above 0, or if the extension of
 *          the centreline's file is not that of a volume; the errors of stage_geometry,
 *          voxelgrid_make, volume_check, work_make, voxels_write and work_write. */
MUST_CHECK Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                                const PictureTree *of, FileSet *files, const Parsed *parsed,
                                Err *err);

#endif
