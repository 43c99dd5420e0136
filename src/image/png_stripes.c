/* Rows are gathered until there are some stripes for each thread, which threads then filter and
 * deflate apart from each other. A stripe reaches back to nothing before it and ends at a byte, so
 * that one behind the other they are one zlib stream, as pigz makes it, which every reader takes;
 * the stream's checksum is put together of the stripes'. How many rows are a stripe follows from
 * the picture's width alone, and nothing is handed over before its turn: the bytes depend neither
 * on the threads nor on how many rows come at a time. Few stripes are gathered, since the system
 * takes longer to hand out memory than threads to compress it. ISA-L deflates them, five times as
 * fast as zlib and for files a tenth larger. */
#include "image/png_stripes.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Of rows with their filter bytes. Larger stripes are hardly compressed better: by 0.5 % with 512
 * KiB. */
enum { STRIPE_BYTES = 1 << 18, STRIPES_A_THREAD = 4, GATHERED_BYTES = 1 << 23 };
enum { FIRST_BYTES = 16 };
enum { FILTER_NONE = 0, FILTER_UP = 2 };
/* Level 1 makes files 1 to 4 % larger in nearly the same time; level 3 takes twice the time, and
 * its bytes depend on the processor. */
enum { LEVEL = 2, LEVEL_BYTES = ISAL_DEF_LVL2_DEFAULT };

/* RFC 1950: a window of 32 KiB, made by a fast algorithm. */
static const uint8_t zlib_header[] = {0x78, 0x5e};
/* An empty last block. */
static const uint8_t deflate_end[] = {3, 0};
enum { HEADER_SIZE = sizeof zlib_header, END_SIZE = sizeof deflate_end + 4 };

typedef struct Stripe {
    uint8_t *bytes; /* borrowed; with room for what is around the stream before and behind */
    size_t n;
    uint32_t adler;
} Stripe;

typedef struct Worker {
    uint8_t *filtered; /* owned; the rows of a stripe, each behind its filter byte */
    uint8_t *level;    /* owned; what ISA-L works in: LEVEL_BYTES */
} Worker;

struct PngStripes {
    int bits, threads;
    bool up;
    size_t line;                /* bytes of a row with its filter byte */
    int stripe_rows, room_rows; /* of a stripe, in `rows` */
    int n_rows;                 /* gathered */
    int left;                   /* rows of the picture that have not come */
    size_t room;                /* for a stripe in `packed` */
    uint8_t *rows, *packed;     /* owned; the first row is the one above those that are gathered */
    Stripe *stripes;            /* owned */
    Worker *workers;            /* owned */
    bool begun;                 /* something is handed over */
    uint32_t adler;             /* of that */
};

static int least(int a, int b)
{
    return a < b ? a : b;
}

static size_t stripe_size(const PngStripes *self)
{
    return self->line * (size_t)self->stripe_rows;
}

static int count_stripes(const PngStripes *self, int rows)
{
    return (rows + self->stripe_rows - 1) / self->stripe_rows;
}

/* For a stripe in deflate's format: 5 bytes for each 65,535 that are stored as they are, and the
 * flush. */
static size_t deflated_room(size_t n)
{
    return n + n / 65535 * 5 + 64;
}

/* A stripe of whole rows, as many stripes as are gathered, and no more than the picture has. */
static void measure(PngStripes *self, const ImageForm *form)
{
    int rows = (int)(STRIPE_BYTES / self->line);
    self->stripe_rows = rows < 1 ? 1 : rows;
    int stripes =
        least((int)(GATHERED_BYTES / stripe_size(self)), self->threads * STRIPES_A_THREAD);
    self->room_rows = least(self->stripe_rows * (stripes < 1 ? 1 : stripes), form->height);
    self->stripe_rows = least(self->stripe_rows, self->room_rows);
    self->room = HEADER_SIZE + deflated_room(stripe_size(self)) + END_SIZE;
    self->threads = least(self->threads, count_stripes(self, self->room_rows));
}

static Status open_workers(PngStripes *self, Err *err)
{
    TRY(mem_calloc(&self->workers, (size_t)self->threads, sizeof *self->workers,
                   "threads for a PNG", err));
    for (int i = 0; i < self->threads; i++) {
        Worker *worker = &self->workers[i];
        TRY(mem_calloc(&worker->filtered, 1, stripe_size(self), "rows of a PNG", err));
        TRY(mem_calloc(&worker->level, 1, LEVEL_BYTES, "stripes of a PNG", err));
    }
    return STATUS_OK;
}

Status pngstripes_open(PngStripes **out, const ImageForm *form, bool up, Err *err)
{
    PngStripes *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "stripes of a PNG", err));
    *out = self;
    self->bits = form->bits;
    self->threads = form->packing.threads ? form->packing.threads : threads_available();
    self->up = up;
    self->line = 1 + (size_t)form->width * (size_t)form->channels * (size_t)(form->bits / 8);
    self->left = form->height;
    self->adler = libdeflate_adler32(0, NULL, 0);
    measure(self, form);
    size_t n = (size_t)count_stripes(self, self->room_rows);
    TRY(mem_calloc(&self->rows, (size_t)self->room_rows + 1, self->line - 1, "rows of a PNG", err));
    TRY(mem_calloc(&self->stripes, n, sizeof *self->stripes, "stripes of a PNG", err));
    TRY(mem_calloc(&self->packed, n, self->room, "stripes of a PNG", err));
    return open_workers(self, err);
}

void pngstripes_free(PngStripes *self)
{
    if (!self)
        return;
    for (int i = 0; self->workers && i < self->threads; i++) {
        free(self->workers[i].filtered);
        free(self->workers[i].level);
    }
    free(self->workers);
    free(self->rows);
    free(self->packed);
    free(self->stripes);
    free(self);
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Row `row` of those that are gathered; -1: the one above them. */
static uint8_t *row_at(const PngStripes *self, int row)
{
    return self->rows + (size_t)(row + 1) * (self->line - 1);
}

/* Takes row `y` of the codes; those of 16 bits go with the high byte first. */
static void gather(PngStripes *self, const void *codes, int y)
{
    size_t n = self->line - 1;
    uint8_t *bytes = row_at(self, self->n_rows++);
    self->left--;
    if (self->bits == 8) {
        memcpy(bytes, (const uint8_t *)codes + (size_t)y * n, n);
        return;
    }
    const uint16_t *row = (const uint16_t *)codes + (size_t)y * (n / 2);
    for (size_t i = 0; i < n / 2; i++) {
        bytes[2 * i] = (uint8_t)(row[i] >> 8);
        bytes[2 * i + 1] = (uint8_t)(row[i] & 255);
    }
}

static void filter_row(const PngStripes *self, int row, uint8_t *restrict line)
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

/* ---- stripes --------------------------------------------------------------------------------- */

/* The rows in stripe `i` of those that are gathered. */
static int rows_of(const PngStripes *self, size_t i)
{
    return least(self->stripe_rows, self->n_rows - (int)i * self->stripe_rows);
}

/* Deflates the next bytes of a stream up to a whole byte. It fails, or leaves some, only for want
 * of room, of which there is enough. */
static void deflate_next(struct isal_zstream *stream, size_t n, uint16_t flush)
{
    stream->avail_in = (uint32_t)n;
    stream->flush = flush;
    if (isal_deflate(stream) != COMP_OK || stream->avail_in > 0)
        abort();
}

/* The first bytes go by themselves: where ISA-L 2.30 begins with several hundred, it enters the
 * third into its table of matches by a hash of the stream's address, and what it writes depends on
 * where memory is. ISA-L then clears as much of the table as the first bytes need; here all of it
 * is cleared. */
static size_t deflate_rows(const PngStripes *self, const Worker *worker, size_t n, uint8_t *out)
{
    struct isal_zstream stream = {0}; /* isal_deflate_init sets all but hist_bits */
    isal_deflate_init(&stream);
    memset(worker->level, 0, LEVEL_BYTES);
    stream.level = LEVEL;
    stream.level_buf = worker->level;
    stream.level_buf_size = LEVEL_BYTES;
    stream.next_in = worker->filtered;
    stream.next_out = out;
    stream.avail_out = (uint32_t)(self->room - HEADER_SIZE - END_SIZE);
    if (n > FIRST_BYTES)
        deflate_next(&stream, FIRST_BYTES, SYNC_FLUSH);
    deflate_next(&stream, n > FIRST_BYTES ? n - FIRST_BYTES : n, FULL_FLUSH);
    return stream.total_out;
}

static void deflate_stripe(size_t i, int worker, void *context)
{
    PngStripes *self = context;
    const Worker *work = &self->workers[worker];
    int n = rows_of(self, i);
    for (int row = 0; row < n; row++)
        filter_row(self, (int)i * self->stripe_rows + row,
                   work->filtered + (size_t)row * self->line);
    Stripe *stripe = &self->stripes[i];
    size_t size = (size_t)n * self->line;
    stripe->bytes = self->packed + i * self->room + HEADER_SIZE;
    stripe->n = deflate_rows(self, work, size, stripe->bytes);
    stripe->adler = libdeflate_adler32(libdeflate_adler32(0, NULL, 0), work->filtered, size);
}

static void put_header(PngStripes *self, Stripe *stripe)
{
    stripe->bytes -= HEADER_SIZE;
    stripe->n += HEADER_SIZE;
    memcpy(stripe->bytes, zlib_header, HEADER_SIZE);
    self->begun = true;
}

static void put_end(const PngStripes *self, Stripe *stripe)
{
    memcpy(stripe->bytes + stripe->n, deflate_end, sizeof deflate_end);
    stripe->n += sizeof deflate_end;
    for (int shift = 24; shift >= 0; shift -= 8)
        stripe->bytes[stripe->n++] = (uint8_t)(self->adler >> shift & 255);
}

/* Compresses what is gathered and hands it over. */
static void pack(PngStripes *self, PngTakeBytes *take, void *context)
{
    size_t n = (size_t)count_stripes(self, self->n_rows);
    threads_for(n, self->threads, deflate_stripe, self);
    for (size_t i = 0; i < n; i++) {
        Stripe *stripe = &self->stripes[i];
        self->adler = (uint32_t)adler32_combine(self->adler, stripe->adler,
                                                (z_off_t)((size_t)rows_of(self, i) * self->line));
        if (!self->begun)
            put_header(self, stripe);
        if (self->left == 0 && i == n - 1)
            put_end(self, stripe);
        take(context, stripe->bytes, stripe->n);
    }
    memcpy(row_at(self, -1), row_at(self, self->n_rows - 1), self->line - 1);
    self->n_rows = 0;
}

void pngstripes_rows(PngStripes *self, const void *codes, int n, PngTakeBytes *take, void *context)
{
    for (int y = 0; y < n; y++) {
        gather(self, codes, y);
        if (self->n_rows == self->room_rows || self->left == 0)
            pack(self, take, context);
    }
}
