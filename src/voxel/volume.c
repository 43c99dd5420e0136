/* Writes voxel volumes in several formats. Each format is a row of volume_formats; its header is
 * written by a function that the row names. The x, y and z axes of the tree are taken as right,
 * anterior and superior (RAS), the axes of NIfTI. MetaImage positions are LPS: left, posterior and
 * superior.
 *
 * Chunks are compressed independently of each other. Each ends at a whole byte (Z_FULL_FLUSH), so
 * that consecutive chunks form one stream, as in pigz. The compressed part of the file is one gzip
 * member, which every reader accepts. Its bytes do not depend on which thread made which chunk.
 * zlib can end a chunk in this way, libdeflate cannot. */
#define ZLIB_CONST
#include "voxel/volume.h"

#include <errno.h>
#include <nifti/nifti1.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- samples --------------------------------------------------------------------------------- */

typedef struct Sample {
    const char *name;        /* in messages */
    size_t size;             /* bytes */
    double full_value;       /* the sample of a full voxel */
    short nifti;             /* the type's code in NIfTI */
    const char *nrrd, *meta; /* its names in NRRD and MetaImage */
} Sample;

static const Sample sample_types[SAMPLE_TYPES] = {
    [SAMPLE_8] = {"8 bits", 1, 255, DT_UINT8, "uint8", "MET_UCHAR"},
    [SAMPLE_16] = {"16 bits", 2, 65535, DT_UINT16, "uint16", "MET_USHORT"},
    [SAMPLE_FLOAT] = {"float", 4, 1, DT_FLOAT32, "float", "MET_FLOAT"},
    [SAMPLE_32] = {"32 bits", 4, UINT32_MAX, DT_UINT32, "uint32", "MET_UINT"},
};

size_t sample_size(SampleType type)
{
    return sample_types[type].size;
}

double sample_full(SampleType type)
{
    return sample_types[type].full_value;
}

/* Packs labels of 16 bits from front to back, which overwrites no label before it is read.
 * SAMPLE_32 needs no conversion. */
void volume_labels(SampleType type, uint32_t *labels, size_t n)
{
    for (size_t i = 0; type == SAMPLE_16 && i < n; i++) {
        uint16_t label = (uint16_t)labels[i];
        memcpy((uint8_t *)labels + i * sizeof label, &label, sizeof label);
    }
}

/* ---- headers --------------------------------------------------------------------------------- */

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* Returns the centre of the first voxel in the coordinates of the tree. */
static Vec3 first_center(const VoxelGrid *grid)
{
    return vec3_add(grid->first, grid->origin);
}

/* Appends the header in the machine's byte order, which readers recognise by the field sizeof_hdr.
 * The positions of voxels are stored twice: as a matrix, and as an offset for readers that do not
 * support the matrix. */
static void put_nifti(const VoxelGrid *grid, SampleType type, bool is_fraction, const char *about,
                      Text *out)
{
    static const char no_extension[4] = {0};
    Vec3 first = first_center(grid);
    nifti_1_header header = {.sizeof_hdr = sizeof header, .regular = 'r', .magic = "n+1"};
    header.dim[0] = 3;
    header.pixdim[0] = 1;
    for (int axis = 0; axis < 3; axis++) {
        header.dim[axis + 1] = (short)grid->n[axis];
        header.pixdim[axis + 1] = (float)vec3_component(grid->step, axis);
    }
    for (int i = 4; i < 8; i++)
        header.dim[i] = 1;
    header.datatype = sample_types[type].nifti;
    header.bitpix = (short)(8 * sample_types[type].size);
    header.vox_offset = sizeof header + sizeof no_extension;
    header.scl_slope = is_fraction ? (float)(1 / sample_types[type].full_value) : 1;
    header.intent_code = is_fraction ? NIFTI_INTENT_NONE : NIFTI_INTENT_LABEL;
    header.xyzt_units = NIFTI_UNITS_MM;
    snprintf(header.descrip, sizeof header.descrip, "%s", about);
    header.qform_code = header.sform_code = NIFTI_XFORM_SCANNER_ANAT;
    header.qoffset_x = header.srow_x[3] = (float)first.x;
    header.qoffset_y = header.srow_y[3] = (float)first.y;
    header.qoffset_z = header.srow_z[3] = (float)first.z;
    header.srow_x[0] = header.pixdim[1];
    header.srow_y[1] = header.pixdim[2];
    header.srow_z[2] = header.pixdim[3];
    text_append(out, (const char *)&header, sizeof header);
    text_append(out, no_extension, sizeof no_extension);
}

/* The coordinates of a point as text. */
typedef struct Numbers {
    char x[NUMBER_TEXT_SIZE], y[NUMBER_TEXT_SIZE], z[NUMBER_TEXT_SIZE];
} Numbers;

static Numbers numbers_of(Vec3 v)
{
    Numbers numbers;
    number_text(v.x, numbers.x);
    number_text(v.y, numbers.y);
    number_text(v.z, numbers.z);
    return numbers;
}

static void put_nrrd(const VoxelGrid *grid, SampleType type, bool is_fraction, const char *about,
                     Text *out)
{
    Numbers first = numbers_of(first_center(grid)), step = numbers_of(grid->step);
    text_puts(out, "NRRD0005\n# ");
    text_put_line(out, about);
    text_printf(out, "\ntype: %s\ndimension: 3\nspace: right-anterior-superior\n",
                sample_types[type].nrrd);
    text_printf(out, "sizes: %lld %lld %lld\n", (long long)grid->n[0], (long long)grid->n[1],
                (long long)grid->n[2]);
    text_printf(out, "space directions: (%s,0,0) (0,%s,0) (0,0,%s)\n", step.x, step.y, step.z);
    text_puts(out, "space units: \"mm\" \"mm\" \"mm\"\nkinds: domain domain domain\n");
    text_printf(out, "space origin: (%s,%s,%s)\n", first.x, first.y, first.z);
    text_printf(out, "endian: %s\nencoding: gzip\n", is_little_endian() ? "little" : "big");
    if (is_fraction)
        text_printf(out, "old max: %.0f\nold min: 0\n", sample_types[type].full_value);
    text_puts(out, "\n");
}

/* AnatomicalOrientation names the sides where the x, y and z axes of the voxels begin: left,
 * posterior and inferior, so they lead to the right, anterior and superior, as in the matrix. */
static void put_metaimage(const VoxelGrid *grid, SampleType type, bool is_fraction,
                          const char *about, Text *out)
{
    Vec3 center = first_center(grid);
    Numbers first = numbers_of(vec3(-center.x, -center.y, center.z)), step = numbers_of(grid->step);
    (void)is_fraction;
    text_puts(out, "ObjectType = Image\nNDims = 3\nComment = ");
    text_put_line(out, about);
    text_printf(out, "\nBinaryData = True\nBinaryDataByteOrderMSB = %s\nCompressedData = False\n",
                is_little_endian() ? "False" : "True");
    text_puts(out, "TransformMatrix = -1 0 0 0 -1 0 0 0 1\nCenterOfRotation = 0 0 0\n");
    text_printf(out, "Offset = %s %s %s\nAnatomicalOrientation = LPI\n", first.x, first.y, first.z);
    text_printf(out, "ElementSpacing = %s %s %s\n", step.x, step.y, step.z);
    text_printf(out, "DimSize = %lld %lld %lld\n", (long long)grid->n[0], (long long)grid->n[1],
                (long long)grid->n[2]);
    text_printf(out, "ElementType = %s\nElementDataFile = LOCAL\n", sample_types[type].meta);
}

/* Appends the header of POV-Ray's density file: the three sizes as big-endian 16-bit integers. */
static void put_df3(const VoxelGrid *grid, SampleType type, bool is_fraction, const char *about,
                    Text *out)
{
    (void)type;
    (void)is_fraction;
    (void)about;
    for (int axis = 0; axis < 3; axis++) {
        char size[2] = {(char)(grid->n[axis] >> 8), (char)(grid->n[axis] & 0xff)};
        text_append(out, size, sizeof size);
    }
}

/* ---- formats --------------------------------------------------------------------------------- */

enum {
    /* Maximum number of voxels in a row. A row is in one chunk, and zlib takes less than 4 GB at a
     * time; a row of 4-byte samples of this length is 1 GB. Rows of more than 32767 voxels are
     * rare, so the limit is a safe power of 2, not the largest possible number. */
    MAX_ROW = 1 << 28,
    ANY_SAMPLE = 1 << SAMPLE_8 | 1 << SAMPLE_16 | 1 << SAMPLE_FLOAT | 1 << SAMPLE_32,
    DENSITIES = 1 << SAMPLE_8 | 1 << SAMPLE_16
};

/* The variable part sets flags. It must not be empty: ISO C11 requires an argument for "...". */
#define FORMAT(ending, about, limit, samples, put, ...)                                            \
    {                                                                                              \
        .suffix = ending, .description = about, .max_side = limit, .types = samples,               \
        .put_header = put, __VA_ARGS__                                                             \
    }

const VolumeFormat volume_formats[] = {
    FORMAT(".nii.gz", "NIfTI-1, deflated", INT16_MAX, ANY_SAMPLE, put_nifti, .deflated = true,
           .header_deflated = true),
    FORMAT(".nii", "NIfTI-1", INT16_MAX, ANY_SAMPLE, put_nifti, .deflated = false),
    FORMAT(".nrrd", "NRRD, deflated", MAX_ROW, ANY_SAMPLE, put_nrrd, .deflated = true),
    FORMAT(".mha", "MetaImage", MAX_ROW, ANY_SAMPLE, put_metaimage, .deflated = false),
    FORMAT(".df3", "a density file for POV-Ray", UINT16_MAX, DENSITIES, put_df3, .big_endian = true,
           .is_density = true),
    {0},
};

const VolumeFormat *volume_format_find(const char *path)
{
    size_t length = strlen(path);
    for (const VolumeFormat *format = volume_formats; format->suffix; format++) {
        size_t suffix = strlen(format->suffix);
        if (length > suffix && strcmp(path + length - suffix, format->suffix) == 0)
            return format;
    }
    return NULL;
}

Status volume_check(const VolumeFormat *format, const VoxelGrid *grid, SampleType type,
                    bool is_fraction, Err *err)
{
    for (int axis = 0; axis < 3; axis++)
        if (grid->n[axis] > format->max_side)
            return err_set(
                err, STATUS_INFEASIBLE,
                "`voxel`: %lld x %lld x %lld voxels; %s holds at most %lld along an axis",
                (long long)grid->n[0], (long long)grid->n[1], (long long)grid->n[2], format->suffix,
                (long long)format->max_side);
    if (!is_fraction && format->is_density)
        return err_set(err, STATUS_USAGE, "%s holds no labels and no centrelines", format->suffix);
    if (!(format->types & 1u << type))
        return err_set(err, STATUS_USAGE, "%s has no samples of %s", format->suffix,
                       sample_types[type].name);
    return STATUS_OK;
}

/* ---- streams --------------------------------------------------------------------------------- */

/* The gzip header of RFC 1952 without file name and time; operating system unknown (255). */
static const uint8_t gzip_header[10] = {0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255};
/* An empty last block of deflate. */
static const uint8_t deflate_end[2] = {3, 0};

/* The bytes that precede the samples in the file. */
typedef struct HeaderBytes {
    char *bytes; /* owned */
    size_t size;
} HeaderBytes;

/* Makes the header of a volume in *made, which the caller frees also after an error. */
static Status make_header(const VolumeStream *stream, const VoxelGrid *grid, bool is_fraction,
                          const char *about, HeaderBytes *made, Err *err)
{
    FILE *memory = open_memstream(&made->bytes, &made->size);
    if (!memory)
        return mem_out_of("for", "the header of a volume", err);
    Text header = TEXT_TO(memory);
    stream->format->put_header(grid, stream->type, is_fraction, about, &header);
    Status status = text_flush(&header, err);
    text_release(&header);
    /* When memory runs out, fclose succeeds all the same, but leaves made->bytes NULL. */
    if ((fclose(memory) != 0 || !made->bytes) && status == STATUS_OK)
        status = mem_out_of("for", "the header of a volume", err);
    return status;
}

Status volume_begin(VolumeStream *stream, const VoxelGrid *grid, bool is_fraction,
                    const char *about, Err *err)
{
    const VolumeFormat *format = stream->format;
    VolumeChunk chunk = {0};
    HeaderBytes header = {0};
    Status status;
    stream->crc = (uint32_t)crc32(0, NULL, 0);
    stream->n_uncompressed = 0;
    TRY_GOTO(make_header(stream, grid, is_fraction, about, &header, err));
    if (!format->header_deflated)
        fwrite(header.bytes, 1, header.size, stream->to);
    if (format->deflated)
        fwrite(gzip_header, 1, sizeof gzip_header, stream->to);
    if (format->header_deflated) {
        TRY_GOTO(volume_pack(stream, (uint8_t *)header.bytes, header.size, &chunk, err));
        TRY_GOTO(volume_put(stream, &chunk, err));
    }
done:
    free(chunk.bytes);
    free(header.bytes);
    return status;
}

static void put_little(uint32_t word, FILE *to)
{
    for (int i = 0; i < 4; i++)
        fputc((int)(word >> 8 * i & 0xff), to);
}

void volume_end(VolumeStream *stream)
{
    if (!stream->format->deflated)
        return;
    fwrite(deflate_end, 1, sizeof deflate_end, stream->to);
    put_little(stream->crc, stream->to);
    put_little((uint32_t)stream->n_uncompressed, stream->to);
}

static void swap_bytes(uint8_t *samples, size_t n, size_t size)
{
    for (size_t i = 0; i + size <= n; i += size)
        for (size_t j = 0; j < size / 2; j++) {
            uint8_t byte = samples[i + j];
            samples[i + j] = samples[i + size - 1 - j];
            samples[i + size - 1 - j] = byte;
        }
}

/* Compression level 1 takes a sixth of the time of level 6, and makes files 6 % larger.
 * RAW_WINDOW_BITS is the windowBits of a raw deflate stream with the largest window; MEMORY_LEVEL
 * is zlib's default. */
enum { LEVEL = 1, RAW_WINDOW_BITS = -15, MEMORY_LEVEL = 8 };

static Status deflate_chunk(const uint8_t *samples, size_t n, VolumeChunk *out, Err *err)
{
    z_stream zlib = {0};
    if (deflateInit2(&zlib, LEVEL, Z_DEFLATED, RAW_WINDOW_BITS, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) !=
        Z_OK)
        return mem_out_of("to compress", "voxels", err);
    /* deflateBound holds for Z_FINISH. Z_FULL_FLUSH also writes an empty block of 5 bytes, after up
     * to a byte of padding. 16 covers both. */
    size_t bound = deflateBound(&zlib, n) + 16;
    Status status;
    TRY_GOTO(mem_calloc(&out->bytes, bound, 1, "compressed voxels", err));
    zlib.next_in = samples;
    zlib.avail_in = (uInt)n;
    zlib.next_out = out->bytes;
    zlib.avail_out = (uInt)bound;
    (void)deflate(&zlib, Z_FULL_FLUSH);
    out->n = bound - zlib.avail_out;
    out->crc = (uint32_t)crc32(crc32(0, NULL, 0), samples, (uInt)n);
done:
    deflateEnd(&zlib);
    return status;
}

Status volume_pack(const VolumeStream *stream, uint8_t *samples, size_t n, VolumeChunk *out,
                   Err *err)
{
    VolumeChunk chunk = {.n_uncompressed = n, .n = n};
    if (stream->format->big_endian && is_little_endian())
        swap_bytes(samples, n, sample_types[stream->type].size);
    if (stream->format->deflated) {
        TRY(deflate_chunk(samples, n, &chunk, err));
    } else {
        TRY(mem_calloc(&chunk.bytes, n, 1, "voxels", err));
        memcpy(chunk.bytes, samples, n);
    }
    *out = chunk;
    return STATUS_OK;
}

Status volume_put(VolumeStream *stream, const VolumeChunk *chunk, Err *err)
{
    if (fwrite(chunk->bytes, 1, chunk->n, stream->to) != chunk->n)
        /* The caller puts the name of the file before the message. */
        return err_set(err, STATUS_IO, "cannot be written: %s", strerror(errno));
    stream->crc = (uint32_t)crc32_combine(stream->crc, chunk->crc, (z_off_t)chunk->n_uncompressed);
    stream->n_uncompressed += chunk->n_uncompressed;
    return STATUS_OK;
}
