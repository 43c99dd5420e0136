/* The vessels of a tree as volumes, for the command that writes them: the options of `export` about
 * voxels. */
#ifndef CORCAST_JOB_EXPORT_VOLUMES_H
#define CORCAST_JOB_EXPORT_VOLUMES_H

#include "base/base.h"
#include "job/picture/picture.h"
#include "options/options.h"
#include "voxel/voxel.h"

typedef struct VolumeOptions {
    NumberList voxel; /* mm: one number, or one for each axis; empty: a 256th of the longest side */
    int depth, labels;      /* choices */
    const char *centreline; /* a file, or NULL */
} VolumeOptions;

extern const OptionTable volume_table; /* sets a VolumeOptions */

/* Appends the extensions of volumes: ".nii.gz, .nii". */
void volumes_extensions(Text *out);

/* Takes note of the files beside `output`. */
MUST_CHECK Status volumes_note(const VolumeOptions *options, const VolumeFormat *format,
                               const char *output, Files *files, Err *err);

/* Writes the volumes, and beside them the tree as CSV and a manifest: all take their names, or none
 * does. Says on standard error, unless quiet, how much work it is, and what is to be known of them.
 * STATUS_USAGE when a format cannot hold what is asked, STATUS_INFEASIBLE, STATUS_IO and
 * STATUS_MEMORY when that is too much, before the work; else as stage_geometry and voxels_write. */
MUST_CHECK Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                                const PictureTree *of, const char *output, const Parsed *parsed,
                                Err *err);

#endif
