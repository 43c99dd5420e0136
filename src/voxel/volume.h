/* Volume files: a table of formats, and streams that are written part by part. */
#ifndef CORCAST_VOXEL_VOLUME_H
#define CORCAST_VOXEL_VOLUME_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* A grid of box-shaped voxels, x fastest. Lengths are in mm, coordinates right-handed. */
typedef struct VoxelGrid {
    Vec3 first;   /* centre of the first voxel */
    Vec3 step;    /* sides of a voxel, > 0 */
    Vec3 origin;  /* position of the origin of `first` in the coordinates of the tree */
    int64_t n[3]; /* number of voxels along each axis, >= 1, below 2^31 */
} VoxelGrid;

typedef enum SampleType { SAMPLE_8, SAMPLE_16, SAMPLE_FLOAT, SAMPLE_32, SAMPLE_TYPES } SampleType;

/* Returns the size of a sample in bytes. */
size_t sample_size(SampleType type);
/* Returns the sample of a full voxel in a volume of filled fractions: 255, 65535 or 1. */
double sample_full(SampleType type);

/* A file format: one row of `volume_formats`. */
typedef struct VolumeFormat {
    const char *suffix; /* ".nii.gz" */
    const char *description;
    int64_t max_side; /* maximum number of voxels along an axis */
    unsigned types;   /* sample types that it can hold: bits 1 << SampleType */
    bool deflated, big_endian;
    bool header_deflated; /* the header is compressed with the samples */
    bool is_density;      /* for POV-Ray: holds filled fractions, and no labels */
    /* Appends the header. `is_fraction`: the samples are filled fractions, not labels. `about`: a
     * line that describes the volume. */
    void (*put_header)(const VoxelGrid *grid, SampleType type, bool is_fraction, const char *about,
                       Text *out);
} VolumeFormat;

/* The table of formats. A row without a suffix ends it. */
extern const VolumeFormat volume_formats[];
/* Returns the format of a file by the end of its name, or NULL. */
const VolumeFormat *volume_format_find(const char *path);

/* Checks that a format can hold a volume. Errors: STATUS_INFEASIBLE if there are too many voxels
 * along an axis; STATUS_USAGE if the format has no samples of this type, or if `is_fraction` is
 * false and it holds no labels. */
MUST_CHECK Status volume_check(const VolumeFormat *format, const VoxelGrid *grid, SampleType type,
                               bool is_fraction, Err *err);

/* A file that is being written. The caller sets the first three members; all are borrowed. */
typedef struct VolumeStream {
    const VolumeFormat *format;
    SampleType type;
    FILE *to;
    uint32_t crc;            /* checksum of what was compressed so far */
    uint64_t n_uncompressed; /* its size before compression */
} VolumeStream;

/* Writes the header. `is_fraction` and `about` as VolumeFormat.put_header. Errors: STATUS_MEMORY.
 */
MUST_CHECK Status volume_begin(VolumeStream *stream, const VoxelGrid *grid, bool is_fraction,
                               const char *about, Err *err);
/* Writes what follows the last samples. The owner of the file checks whether all was written
 * [base/file.h]. */
void volume_end(VolumeStream *stream);

/* Samples in the form in which the file holds them. */
typedef struct VolumeChunk {
    uint8_t *bytes;           /* owned */
    size_t n, n_uncompressed; /* number of bytes, and of bytes before compression */
    uint32_t crc;
} VolumeChunk;

/* Converts `n` bytes of samples in the machine's byte order to a part of the file. Changes the
 * samples. Several threads may convert parts of one stream at the same time. Free out->bytes.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status volume_pack(const VolumeStream *stream, uint8_t *samples, size_t n,
                              VolumeChunk *out, Err *err);
/* Appends the next part to the file. Errors: STATUS_IO; the sentence does not name the file. */
MUST_CHECK Status volume_put(VolumeStream *stream, const VolumeChunk *part, Err *err);

#endif
