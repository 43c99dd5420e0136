/* Writes the vessels of a tree as voxel volumes. Call volumes_name, then volumes_write. */
#ifndef CORCAST_JOB_EXPORT_VOLUMES_H
#define CORCAST_JOB_EXPORT_VOLUMES_H

#include "job/picture/picture.h"
#include "job/work.h"
#include "options/options.h"
#include "voxel/voxel.h"

typedef struct VolumeOptions {
    NumberList voxel; /* value of --spacing: voxel size, mm: one number, or one per axis; empty:
                       * longest side of the tree's bounding box / 256 */
    int depth;        /* type of the samples, a SampleType [voxel/voxel.h] */
    int labels; /* label of a voxel: 0: none; 1: the id of its segment; 2: the Strahler order of the
                 * segment; 3: the index of its tree, from 1 */
    const char *centreline; /* path of a second volume, of the centrelines; NULL: none */
} VolumeOptions;

extern const OptionTable volume_table; /* sets a VolumeOptions */

/* Appends the extensions of all volume formats, separated by commas: ".nii.gz, .nii". */
void volumes_extensions(Text *out);

/* Sets the paths and roles (words for messages) of the output files: the volumes, the tree as CSV,
 * a JSON manifest and, for the density format of POV-Ray, a scene. The names of the additional
 * files are derived from `output`.
 *
 * output  path of the volume.
 * files   zeroed by the caller, who releases it with fileset_release even after an error.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status volumes_name(const VolumeOptions *options, const VolumeFormat *format,
                               const char *output, FileSet *files, Err *err);

/* Writes the volumes and the additional files. Sends a note with the expected cost before the work,
 * and a note with the number of filled voxels and their volume after it.
 *
 * files   volumes_name must have set the paths.
 * Errors  STATUS_USAGE if --spacing is not one or three numbers above 0, or if the extension of the
 *         centreline's file is not that of a volume; STATUS_INPUT if the grid has too many voxels
 *         or the format cannot store the labels; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                                const PictureTree *of, FileSet *files, const Parsed *parsed,
                                Err *err);

#endif
