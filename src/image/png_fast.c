/* Reads and writes the common form of PNG: 8 or 16 bits, no palette, not interlaced. This file
 * calls such a PNG plain.
 *
 * Reading: the IDAT chunks are concatenated and inflated in one call of libdeflate, directly into
 * the picture. Undoing the filters moves each row over the filter bytes before it, so that no
 * second copy of the picture is needed. Unusual or invalid files are left to libpng, which supports
 * all of PNG and reports errors.
 *
 * Writing: rows are divided into stripes, which threads filter and deflate independently. A stripe
 * does not refer to data before it and ends at a whole byte. The concatenated stripes are therefore
 * one valid zlib stream, as pigz makes it. The checksum of the stream is combined from the
 * checksums of the stripes. The number of rows in a stripe depends only on the width of the
 * picture, so the bytes do not depend on the number of threads. Only a few stripes are in memory at
 * a time, because the system takes longer to provide memory than the threads take to compress it.
 * The stripes are deflated by ISA-L, which is five times as fast as zlib and makes files about 10 %
 * larger. */
#include "image/png_fast.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- reading: chunks ------------------------------------------------------------------------- */

/* Sizes in bytes [PNG 3, section 5]. CHUNK_FRAME is the length, the type and the checksum around
 * the data of a chunk. */
enum { CHUNK_FRAME = 12, IHDR_SIZE = 13, SIGNATURE_SIZE = 8 };
/* Types of filters, the first byte of a row [PNG 3, section 9]. */
enum { FILTER_NONE, FILTER_SUB, FILTER_UP, FILTER_AVERAGE, FILTER_PAETH };

typedef struct PlainPng {
    uint32_t width, height;
    int bits, samples;   /* bits per sample; samples per pixel, 1 to 4 */
    size_t pixel, row;   /* bytes of a pixel; of a row without its filter byte */
    uint8_t *compressed; /* owned */
    size_t size;         /* bytes in `compressed` */
} PlainPng;

/* Reads the data of the chunk IHDR. Returns false if the picture is not plain, or has more pixels
 * than the file can hold. */
static bool read_header(PlainPng *plain, const uint8_t *data, size_t file_size)
{
    static const int samples_of_type[] = {1, 0, 3, 0, 2, 0, 4};
    int bits = data[8], type = data[9];
    if ((bits != 8 && bits != 16) || type > 6 || samples_of_type[type] == 0)
        return false;
    if (data[10] != 0 || data[11] != 0 || data[12] != 0) /* compression, filter, interlace */
        return false;
    *plain = (PlainPng){.width = image_u32(data),
                        .height = image_u32(data + 4),
                        .bits = bits,
                        .samples = samples_of_type[type],
                        .compressed = plain->compressed};
    if (plain->width < 1 || plain->width > IMAGE_MAX_SIDE || plain->height < 1 ||
        plain->height > IMAGE_MAX_SIDE)
        return false;
    plain->pixel = (size_t)plain->samples * (size_t)bits / 8;
    plain->row = plain->width * plain->pixel;
    return plain->row <= file_size * DEFLATE_MAX_RATIO / plain->height;
}

/* Returns true if a chunk's type, four letters, is in a list of types separated by blanks. */
static bool is_one_of(const uint8_t *type, const char *types)
{
    for (; strlen(types) >= 4; types += types[4] ? 5 : 4)
        if (memcmp(type, types, 4) == 0)
            return true;
    return false;
}

/* Reads the header and collects the compressed data. `compressed` must have space for the whole
 * file. Returns false for a file that is not plain. */
static bool read_chunks(PlainPng *plain, const ImageBytes *file)
{
    size_t at = SIGNATURE_SIZE;
    bool is_srgb = false;         /* there is an sRGB chunk */
    bool has_other_space = false; /* a chunk may state another color space */
    for (bool first = true;; first = false) {
        if (file->size - at < CHUNK_FRAME)
            return false;
        const uint8_t *chunk = file->bytes + at, *type = chunk + 4, *data = chunk + 8;
        size_t length = image_u32(chunk);
        if (length > file->size - at - CHUNK_FRAME ||
            libdeflate_crc32(0, type, length + 4) != image_u32(data + length))
            return false;
        bool header = memcmp(type, "IHDR", 4) == 0;
        if (header != first ||
            (header && (length != IHDR_SIZE || !read_header(plain, data, file->size))))
            return false;
        if (memcmp(type, "IDAT", 4) == 0) {
            memcpy(plain->compressed + plain->size, data, length);
            plain->size += length;
        } else if (memcmp(type, "IEND", 4) == 0) {
            return is_srgb || !has_other_space;
        } else if (!header && memcmp(type, "PLTE", 4) != 0 &&
                   (!(type[0] & 32) || is_one_of(type, "tRNS acTL cICP iCCP"))) {
            /* Transparency, animation, a color profile, or an unknown critical chunk: the first
             * letter of critical chunks is a capital, without bit 32. */
            return false;
        }
        is_srgb |= is_one_of(type, "sRGB");
        has_other_space |= is_one_of(type, "gAMA cHRM");
        at += length + CHUNK_FRAME;
    }
}

/* ---- reading: filters ------------------------------------------------------------------------ */

/* Returns the one of three neighbours of a byte that is nearest to left + up - corner, the Paeth
 * predictor. */
static inline uint8_t paeth(int left, int up, int corner)
{
    int to_left = abs(up - corner), to_up = abs(left - corner);
    int to_corner = abs(left + up - 2 * corner);
    int nearest = to_up <= to_corner ? up : corner;
    return (uint8_t)(to_left <= to_up && to_left <= to_corner ? left : nearest);
}

/* Undoes a filter. `in` must not be at a lower address than `out` if both are in one buffer. `up`
 * is the unfiltered row before this one; all 0 for the first row. `pixel` is the number of bytes
 * per pixel. Callers pass a constant, so that the inlined loop over the samples of a pixel is
 * vectorised. */
static inline void unfilter(int filter, const uint8_t *in, const uint8_t *up, uint8_t *out,
                            size_t n, size_t pixel)
{
    switch (filter) {
    case FILTER_NONE:
        memmove(out, in, n);
        break;
    case FILTER_SUB:
        memmove(out, in, pixel);
        for (size_t i = pixel; i < n; i++)
            out[i] = (uint8_t)(in[i] + out[i - pixel]);
        break;
    case FILTER_UP:
        for (size_t i = 0; i < n; i++)
            out[i] = (uint8_t)(in[i] + up[i]);
        break;
    case FILTER_AVERAGE:
        for (size_t i = 0; i < pixel; i++)
            out[i] = (uint8_t)(in[i] + up[i] / 2);
        for (size_t i = pixel; i < n; i++)
            out[i] = (uint8_t)(in[i] + (out[i - pixel] + up[i]) / 2);
        break;
    default:
        for (size_t i = 0; i < pixel; i++)
            out[i] = (uint8_t)(in[i] + up[i]);
        for (size_t i = pixel; i < n; i += pixel)
            for (size_t c = i; c < i + pixel; c++)
                out[c] = (uint8_t)(in[c] + paeth(out[c - pixel], up[c], up[c - pixel]));
        break;
    }
}

/* Undoes the filter of a row. Returns false if the filter is unknown. */
static bool unfilter_row(const PlainPng *plain, const uint8_t *in, const uint8_t *up, uint8_t *out)
{
#define UNFILTER(pixel_bytes)                                                                      \
    case pixel_bytes:                                                                              \
        unfilter(in[0], in + 1, up, out, plain->row, pixel_bytes);                                 \
        return true
    switch (in[0] > FILTER_PAETH ? 0 : plain->pixel) {
        UNFILTER(1);
        UNFILTER(2);
        UNFILTER(3);
        UNFILTER(4);
        UNFILTER(6);
        UNFILTER(8);
    default:
        return false;
    }
#undef UNFILTER
}

/* Inflates into `rows`, which must have space for the rows with their filter bytes, and undoes the
 * filters. The rows without filter bytes then begin at `rows`. `zeros` is the row above the first
 * row. */
static bool inflate_rows(const PlainPng *plain, uint8_t *rows, const uint8_t *zeros)
{
    struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        return false;
    bool sound =
        libdeflate_zlib_decompress(inflater, plain->compressed, plain->size, rows,
                                   plain->height * (plain->row + 1), NULL) == LIBDEFLATE_SUCCESS;
    libdeflate_free_decompressor(inflater);
    for (size_t y = 0; y < plain->height && sound; y++) {
        uint8_t *out = rows + y * plain->row;
        sound = unfilter_row(plain, rows + y * (plain->row + 1), y ? out - plain->row : zeros, out);
    }
    return sound;
}

/* ---- reading: picture ------------------------------------------------------------------------ */

void png_swap_codes(uint16_t *codes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint8_t bytes[2];
        memcpy(bytes, &codes[i], sizeof bytes);
        codes[i] = (uint16_t)(bytes[0] << 8 | bytes[1]);
    }
}

static bool decode(const PlainPng *plain, Picture *picture, const uint8_t *zeros)
{
    const int width = (int)plain->width, height = (int)plain->height;
    size_t size = plain->height * (plain->row + 1);
    if (image_check_memory(width, height, size, NULL) != STATUS_OK)
        return false;
    uint8_t *rows = malloc(size);
    if (!rows || !inflate_rows(plain, rows, zeros)) {
        free(rows);
        return false;
    }
    *picture = (Picture){
        .width = width, .height = height, .channels = plain->samples, .bits = plain->bits};
    if (plain->bits == 8) {
        picture->codes8 = rows;
    } else {
        picture->codes16 = (uint16_t *)(void *)rows;
        png_swap_codes(picture->codes16, plain->height * plain->row / 2);
    }
    return true;
}

bool png_decode_plain(const ImageBytes *file, Picture *picture)
{
    PlainPng plain = {.compressed = malloc(file->size)};
    bool sound = plain.compressed && read_chunks(&plain, file);
    uint8_t *zeros = sound ? calloc(plain.row, 1) : NULL;
    sound = zeros && decode(&plain, picture, zeros);
    free(zeros);
    free(plain.compressed);
    return sound;
}

/* ---- writing: stripes ------------------------------------------------------------------------ */

/* STRIPE_BYTES is the size of a stripe before compression, including filter bytes. Larger stripes
 * hardly compress better: 512 KiB saves 0.5 %. One call compresses STRIPES_PER_THREAD stripes per
 * thread: several, because a thread that finishes early takes another stripe. GATHERED_BYTES limits
 * the size of the stripes of one call, and so the memory. */
enum { STRIPE_BYTES = 1 << 18, STRIPES_PER_THREAD = 4, GATHERED_BYTES = 1 << 23 };
/* Number of bytes of a stripe that are deflated separately [deflate_rows]. It must be far below
 * several hundred; a small number costs nothing. */
enum { FIRST_BYTES = 16 };
/* Compression level of ISA-L. Level 1 makes files 1 to 4 % larger in nearly the same time. Level 3
 * takes twice the time, and its output depends on the processor. */
enum { LEVEL = 2, LEVEL_BYTES = ISAL_DEF_LVL2_DEFAULT };

/* The zlib header [RFC 1950]: a window of 32 KiB, compression level "fast". */
static const uint8_t zlib_header[] = {0x78, 0x5e};
/* An empty last block. */
static const uint8_t deflate_end[] = {3, 0};
enum { HEADER_SIZE = sizeof zlib_header, END_SIZE = sizeof deflate_end + 4 };

/* A compressed stripe. */
typedef struct PngStripe {
    uint8_t *bytes; /* borrowed; the buffer has space for the zlib header before them and for the
                     * end of the stream after them */
    size_t n;
    uint32_t adler; /* checksum of the uncompressed bytes */
} PngStripe;

typedef struct StripeWorker {
    uint8_t *filtered; /* owned; the rows of a stripe, each after its filter byte */
    uint8_t *level;    /* owned; workspace of ISA-L: LEVEL_BYTES */
} StripeWorker;

struct PngDeflater {
    int threads;
    bool up;
    size_t line;           /* bytes of a row with its filter byte */
    int stripe_rows;       /* rows of a full stripe */
    int rows_at_once;      /* rows of a full call of pngdeflater_rows */
    const uint8_t *rows;   /* borrowed; the rows of the current call */
    uint8_t *above;        /* owned; the row above them */
    int n_rows, left;      /* rows of the current call; rows of the image after them */
    size_t capacity;       /* bytes per stripe in `packed` */
    uint8_t *packed;       /* owned */
    PngStripe *stripes;    /* owned; of the current call */
    StripeWorker *workers; /* owned */
    bool has_begun;        /* bytes have been passed on */
    uint32_t adler;        /* checksum of the rows that have been passed on */
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Returns the bytes of a stripe, the rows that one thread compresses at a time. */
static size_t stripe_size(const PngDeflater *self)
{
    return self->line * (size_t)self->stripe_rows;
}

static int count_stripes(const PngDeflater *self, int rows)
{
    return (rows + self->stripe_rows - 1) / self->stripe_rows;
}

/* Returns the maximum size of `n` bytes after deflate. A stored block adds 5 bytes per 65,535
 * bytes, and each of the two flushes of deflate_rows adds about as much. The 64 bytes allow for the
 * flushes. */
static size_t deflated_size(size_t n)
{
    return n + n / 65535 * 5 + 64;
}

/* Sets the number of rows per stripe and per call. Neither exceeds the height of the image. */
static void measure(PngDeflater *self, int height)
{
    int rows = (int)(STRIPE_BYTES / self->line);
    self->stripe_rows = rows < 1 ? 1 : rows;
    int stripes =
        smaller((int)(GATHERED_BYTES / stripe_size(self)), self->threads * STRIPES_PER_THREAD);
    self->rows_at_once = smaller(self->stripe_rows * (stripes < 1 ? 1 : stripes), height);
    self->stripe_rows = smaller(self->stripe_rows, self->rows_at_once);
    self->capacity = HEADER_SIZE + deflated_size(stripe_size(self)) + END_SIZE;
    self->threads = smaller(self->threads, count_stripes(self, self->rows_at_once));
}

static Status open_workers(PngDeflater *self, Err *err)
{
    TRY(mem_calloc(&self->workers, (size_t)self->threads, sizeof *self->workers,
                   "threads for a PNG", err));
    for (int i = 0; i < self->threads; i++) {
        StripeWorker *worker = &self->workers[i];
        TRY(mem_calloc(&worker->filtered, 1, stripe_size(self), "rows of a PNG", err));
        TRY(mem_calloc(&worker->level, 1, LEVEL_BYTES, "stripes of a PNG", err));
    }
    return STATUS_OK;
}

Status pngdeflater_open(PngDeflater **out, const ImageForm *form, bool up, Err *err)
{
    PngDeflater *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "stripes of a PNG", err));
    *out = self;
    self->threads = form->packing.threads ? form->packing.threads : threads_available();
    self->up = up;
    self->line = 1 + (size_t)form->width * (size_t)form->channels * (size_t)(form->bits / 8);
    self->left = form->height;
    self->adler = libdeflate_adler32(0, NULL, 0);
    measure(self, form->height);
    size_t n = (size_t)count_stripes(self, self->rows_at_once);
    TRY(mem_calloc(&self->above, self->line - 1, 1, "rows of a PNG", err));
    TRY(mem_calloc(&self->stripes, n, sizeof *self->stripes, "stripes of a PNG", err));
    TRY(mem_calloc(&self->packed, n, self->capacity, "stripes of a PNG", err));
    return open_workers(self, err);
}

int pngdeflater_rows_at_once(const PngDeflater *self)
{
    return self->rows_at_once;
}

void pngdeflater_free(PngDeflater *self)
{
    if (!self)
        return;
    for (int i = 0; self->workers && i < self->threads; i++) {
        free(self->workers[i].filtered);
        free(self->workers[i].level);
    }
    free(self->workers);
    free(self->above);
    free(self->packed);
    free(self->stripes);
    free(self);
}

/* Returns a row of the current call; -1 is the row above the first. */
static const uint8_t *row_at(const PngDeflater *self, int row)
{
    return row < 0 ? self->above : self->rows + (size_t)row * (self->line - 1);
}

/* Writes a row of the current call to `line`, after its filter byte. */
static void filter_row(const PngDeflater *self, int row, uint8_t *restrict line)
{
    const uint8_t *restrict bytes = row_at(self, row), *restrict above = row_at(self, row - 1);
    size_t n = self->line - 1;
    *line++ = self->up ? FILTER_UP : FILTER_NONE;
    if (!self->up)
        memcpy(line, bytes, n);
    else
        for (size_t i = 0; i < n; i++)
            line[i] = (uint8_t)(bytes[i] - above[i]);
}

/* Returns the number of rows in stripe `i` of the current call. */
static int rows_of(const PngDeflater *self, size_t i)
{
    return smaller(self->stripe_rows, self->n_rows - (int)i * self->stripe_rows);
}

/* Deflates the next `n` bytes of a stream and ends the output at a whole byte. isal_deflate fails,
 * or leaves input, only if the output buffer is too small, and deflated_size makes it large
 * enough. */
static void deflate_next(struct isal_zstream *stream, size_t n, uint16_t flush)
{
    stream->avail_in = (uint32_t)n;
    stream->flush = flush;
    if (isal_deflate(stream) != COMP_OK || stream->avail_in > 0)
        abort();
}

/* Deflates the `n` filtered bytes of a worker's stripe to `out`. Returns the number of bytes
 * written. The first bytes are deflated separately, because of a defect of ISA-L 2.30. If its first
 * call gets several hundred bytes, it hashes the address of the stream instead of the third byte,
 * so that the output depends on addresses. With few first bytes, ISA-L clears only a part of its
 * hash table. The whole table is therefore cleared here. */
static size_t deflate_rows(const PngDeflater *self, const StripeWorker *worker, size_t n,
                           uint8_t *out)
{
    struct isal_zstream stream = {0}; /* isal_deflate_init sets all members except hist_bits */
    isal_deflate_init(&stream);
    memset(worker->level, 0, LEVEL_BYTES);
    stream.level = LEVEL;
    stream.level_buf = worker->level;
    stream.level_buf_size = LEVEL_BYTES;
    stream.next_in = worker->filtered;
    stream.next_out = out;
    stream.avail_out = (uint32_t)(self->capacity - HEADER_SIZE - END_SIZE);
    if (n > FIRST_BYTES)
        deflate_next(&stream, FIRST_BYTES, SYNC_FLUSH);
    deflate_next(&stream, n > FIRST_BYTES ? n - FIRST_BYTES : n, FULL_FLUSH);
    return stream.total_out;
}

static void deflate_stripe(size_t i, int worker, void *context)
{
    PngDeflater *self = context;
    const StripeWorker *work = &self->workers[worker];
    int n = rows_of(self, i);
    for (int row = 0; row < n; row++)
        filter_row(self, (int)i * self->stripe_rows + row,
                   work->filtered + (size_t)row * self->line);
    PngStripe *stripe = &self->stripes[i];
    size_t size = (size_t)n * self->line;
    stripe->bytes = self->packed + i * self->capacity + HEADER_SIZE;
    stripe->n = deflate_rows(self, work, size, stripe->bytes);
    stripe->adler = libdeflate_adler32(libdeflate_adler32(0, NULL, 0), work->filtered, size);
}

/* Puts the zlib header before the first stripe. */
static void put_header(PngDeflater *self, PngStripe *stripe)
{
    stripe->bytes -= HEADER_SIZE;
    stripe->n += HEADER_SIZE;
    memcpy(stripe->bytes, zlib_header, HEADER_SIZE);
    self->has_begun = true;
}

/* Appends the end of the deflate stream and the big-endian checksum to the last stripe. */
static void put_end(const PngDeflater *self, PngStripe *stripe)
{
    memcpy(stripe->bytes + stripe->n, deflate_end, sizeof deflate_end);
    stripe->n += sizeof deflate_end;
    for (int shift = 24; shift >= 0; shift -= 8)
        stripe->bytes[stripe->n++] = (uint8_t)(self->adler >> shift & 255);
}

void pngdeflater_rows(PngDeflater *self, const uint8_t *rows, int n_rows, PngTakeBytes *take,
                      void *context)
{
    self->rows = rows;
    self->n_rows = n_rows;
    self->left -= n_rows;
    size_t n = (size_t)count_stripes(self, n_rows);
    threads_for(n, self->threads, deflate_stripe, self);
    for (size_t i = 0; i < n; i++) {
        PngStripe *stripe = &self->stripes[i];
        self->adler = (uint32_t)adler32_combine(self->adler, stripe->adler,
                                                (z_off_t)((size_t)rows_of(self, i) * self->line));
        if (!self->has_begun)
            put_header(self, stripe);
        if (self->left == 0 && i == n - 1)
            put_end(self, stripe);
        take(context, stripe->bytes, stripe->n);
    }
    memcpy(self->above, row_at(self, n_rows - 1), self->line - 1);
}
