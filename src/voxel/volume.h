/* Writes volume files: a table of formats, and streams that are written chunk by chunk.
 *
 * A volume is a grid of voxels with one sample each: a filled fraction, or a label. A file is
 * written in this order: volume_begin writes the header, volume_put each chunk of samples,
 * volume_end the end. volume_pack compresses a chunk before volume_put; several threads may pack
 * chunks of one file at the same time.
 *
 *     VolumeStream stream = {.format = format, .type = SAMPLE_8, .to = file};
 *     TRY(volume_begin(&stream, &grid, true, "vessels", err));
 *     TRY(volume_pack(&stream, samples, n, &chunk, err));
 *     TRY(volume_put(&stream, &chunk, err));
 *     free(chunk.bytes);
 *     volume_end(&stream);
 *
 * Exported by the public header of the module voxel. */
#ifndef CORCAST_VOXEL_VOLUME_H
#define CORCAST_VOXEL_VOLUME_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

/* A grid of box-shaped voxels, x fastest. Lengths are in mm, coordinates right-handed. */
typedef struct VoxelGrid {
    Vec3 first;   /* centre of the first voxel, relative to `origin` */
    Vec3 step;    /* sides of a voxel, above 0 */
    Vec3 origin;  /* position of the grid's origin in the coordinates of the tree; keeps `first`
                   * small if the tree is far from 0 */
    int64_t n[3]; /* number of voxels along each axis, >= 1, below 2^31 */
} VoxelGrid;

/* Types of samples: unsigned integers of 8, 16 or 32 bits, or floats of 32 bits. */
typedef enum SampleType { SAMPLE_8, SAMPLE_16, SAMPLE_FLOAT, SAMPLE_32, SAMPLE_TYPES } SampleType;

/* Returns the size of a sample in bytes. */
size_t sample_size(SampleType type);
/* Returns the sample of a full voxel in a volume of filled fractions: 255, 65535 or 1; 2^32 - 1 for
 * SAMPLE_32, which only labels use. */
double sample_full(SampleType type);

/* Converts n labels in place to samples of type SAMPLE_16 or SAMPLE_32. Every label must fit into
 * the type. */
void volume_labels(SampleType type, uint32_t *labels, size_t n);

/* A file format: one row of `volume_formats`. */
typedef struct VolumeFormat {
    const char *suffix;      /* end of a file's name, such as ".nii.gz" */
    const char *description; /* for the list of formats */
    int64_t max_side;        /* maximum number of voxels along an axis */
    unsigned types;          /* sample types that it can hold: bits 1 << SampleType */
    bool deflated;           /* samples are compressed by gzip */
    bool big_endian;         /* samples are big-endian; else in the machine's byte order */
    bool header_deflated;    /* the header is compressed, as part of the same gzip stream */
    bool is_density;         /* a density file of POV-Ray: holds filled fractions, but no labels */
    /* Appends the header. `is_fraction` is true for filled fractions, false for labels. `about` is
     * one line that describes the volume. */
    void (*put_header)(const VoxelGrid *grid, SampleType type, bool is_fraction, const char *about,
                       Text *out);
} VolumeFormat;

/* The table of formats. A row whose suffix is NULL ends it. */
extern const VolumeFormat volume_formats[];
/* Returns the format of a file by the end of its name, or NULL if no format has this suffix. */
const VolumeFormat *volume_format_find(const char *path);

/* Checks that a format can hold a volume.
 *
 * is_fraction  true for filled fractions, false for labels or centrelines.
 * Errors       STATUS_INFEASIBLE if there are too many voxels along an axis; STATUS_USAGE if the
 *              format has no samples of this type, or holds no labels. */
MUST_CHECK Status volume_check(const VolumeFormat *format, const VoxelGrid *grid, SampleType type,
                               bool is_fraction, Err *err);

/* A file that is being written. The caller sets the first three members, which are borrowed;
 * volume_begin sets the others. */
typedef struct VolumeStream {
    const VolumeFormat *format;
    SampleType type;
    FILE *to;
    uint32_t crc;            /* CRC-32 of all bytes that were compressed so far */
    uint64_t n_uncompressed; /* number of these bytes */
} VolumeStream;

/* Writes the header. `is_fraction` and `about` are those of VolumeFormat.put_header.
 *
 * Errors   STATUS_MEMORY; STATUS_IO from a compressed header. The owner of the file checks at the
 *          end whether all was written [base/file.h]. */
MUST_CHECK Status volume_begin(VolumeStream *stream, const VoxelGrid *grid, bool is_fraction,
                               const char *about, Err *err);
/* Writes the end of the file after the last samples. The owner of the file then checks whether all
 * was written [base/file.h]. */
void volume_end(VolumeStream *stream);

/* Consecutive samples as the file stores them: in its byte order and compressed. */
typedef struct VolumeChunk {
    uint8_t *bytes;        /* owned; free it with free() */
    size_t n;              /* number of bytes */
    size_t n_uncompressed; /* number of bytes before compression */
    uint32_t crc;          /* CRC-32 of the bytes before compression; only of compressed formats */
} VolumeChunk;

/* Converts samples to a chunk of the file.
 *
 * samples  n bytes of samples in the machine's byte order, below 4 GB. They may be changed.
 * out      receives the chunk; free out->bytes with free().
 * Errors   STATUS_MEMORY.
 * Threads  Several threads may convert chunks of one stream at the same time. */
MUST_CHECK Status volume_pack(const VolumeStream *stream, uint8_t *samples, size_t n,
                              VolumeChunk *out, Err *err);
/* Appends the next chunk to the file. Errors: STATUS_IO; the message does not contain the file's
 * name, which the caller adds. */
MUST_CHECK Status volume_put(VolumeStream *stream, const VolumeChunk *chunk, Err *err);

#endif
