/* Volumes in files: a table of formats, and streams that are filled part by part. */
#ifndef CORCAST_VOXEL_VOLUME_H
#define CORCAST_VOXEL_VOLUME_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* Box-shaped voxels across the axes, x fastest. */
typedef struct VoxelGrid {
    Vec3 first;   /* the middle of the first voxel, mm, right-handed */
    Vec3 step;    /* > 0 */
    Vec3 origin;  /* where the origin of `first` lies in the coordinates of the tree */
    int64_t n[3]; /* >= 1, below 2^31 */
} VoxelGrid;

typedef enum SampleType { SAMPLE_8, SAMPLE_16, SAMPLE_FLOAT, SAMPLE_32, SAMPLE_TYPES } SampleType;

/* Bytes of a sample. */
size_t sample_size(SampleType type);
/* What a full voxel is in a volume of how much is filled: 255, 65535 or 1. */
double sample_full(SampleType type);

typedef struct VolumeFormat {
    const char *suffix; /* ".nii.gz" */
    const char *description;
    int64_t most;   /* voxels along an axis */
    unsigned types; /* bits 1 << SampleType */
    bool deflated, big_endian;
    bool header_deflated; /* as the samples */
    bool is_density; /* it is for POV-Ray: it holds how much of voxels is filled, and no labels */
    /* Appends what stands before the samples; `parts`: full voxels are sample_full, not labels. */
    void (*put_header)(const VoxelGrid *grid, SampleType type, bool parts, const char *about,
                       Text *out);
} VolumeFormat;

/* A row without a suffix ends them. */
extern const VolumeFormat volume_formats[];
/* The format of a file of this name, or NULL. */
const VolumeFormat *volume_format_find(const char *path);

/* STATUS_INFEASIBLE when a format cannot hold the grid's number of voxels along an axis,
 * STATUS_USAGE when it has no samples of this type, or no labels and `parts` is false. */
MUST_CHECK Status volume_check(const VolumeFormat *format, const VoxelGrid *grid, SampleType type,
                               bool parts, Err *err);

/* A file on its way; `to` and `path`, for sentences, are borrowed. */
typedef struct VolumeStream {
    const VolumeFormat *format;
    SampleType type;
    FILE *to;
    const char *path;
    uint32_t crc; /* of deflated samples and header, so far */
    uint64_t plain;
} VolumeStream;

/* Begins a file with its header; `about` is a line that says what it is. STATUS_MEMORY. */
MUST_CHECK Status volume_begin(VolumeStream *stream, const VoxelGrid *grid, bool parts,
                               const char *about, Err *err);
/* Behind the last samples. Whether the file took all, its owner asks [base/file.h]. */
void volume_end(VolumeStream *stream);

/* Samples as the file has them. */
typedef struct VolumePart {
    uint8_t *bytes; /* owned */
    size_t n, plain;
    uint32_t crc;
} VolumePart;

/* Makes a part of `n` bytes of samples in the machine's order, in *out (owned; free its bytes).
 * Threads may make parts of one stream at the same time; the samples are changed. STATUS_MEMORY. */
MUST_CHECK Status volume_pack(const VolumeStream *stream, uint8_t *samples, size_t n,
                              VolumePart *out, Err *err);
/* Appends the next part. STATUS_IO when the file takes no more. */
MUST_CHECK Status volume_put(VolumeStream *stream, const VolumePart *part, Err *err);

#endif
