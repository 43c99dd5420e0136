/* Rows are gathered until there are some dozens of stripes, which threads then deflate apart from
 * each other. A stripe has no window before it and ends at a byte (Z_FULL_FLUSH), so that one
 * behind the other they are one zlib stream, as pigz makes it, which every reader takes; the
 * stream's checksum is put together of the stripes'. How many rows are a stripe follows from the
 * picture's width alone, and nothing is handed over before its turn: the bytes depend neither on
 * the threads nor on how many rows come at a time. zlib can end a part so; libdeflate, which would
 * take half the time, cannot. The 32 KiB before a stripe as its window make files 1 to 8 % smaller
 * and take a tenth more time. */
#define ZLIB_CONST
#include "image/png_stripes.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Of rows with their filter bytes. Larger stripes are hardly compressed better: by 0.5 % with 512
 * KiB. */
enum { STRIPE_BYTES = 1 << 18, GATHERED_BYTES = 1 << 23 };
/* Level 3 takes two thirds of the time of level 6, which is zlib's usual one, for files of the same
 * size: what makes level 6 slower, looking for a longer match one byte on, is of no use where
 * pixels repeat. */
enum { LEVEL = 3, RAW = -15, MEMORY_LEVEL = 8, FLUSH_ROOM = 16 };
enum { FILTER_NONE = 0, FILTER_UP = 2 };

/* RFC 1950: a window of 32 KiB, made by a fast algorithm. */
static const uint8_t zlib_header[] = {0x78, 0x5e};
/* An empty last block. */
static const uint8_t deflate_end[] = {3, 0};
enum { HEADER_SIZE = sizeof zlib_header, END_SIZE = sizeof deflate_end + 4 };

typedef struct Stripe {
    uint8_t *bytes; /* borrowed; with room for what is around the stream before and behind */
    size_t n;
    uint32_t adler;
    Status status;
} Stripe;

struct PngStripes {
    int bits, threads;
    bool up;
    size_t line;                     /* bytes of a row with its filter byte */
    int stripe_rows, room_rows;      /* of a stripe, in `lines` */
    int rows;                        /* in `lines` */
    int left;                        /* rows of the picture that have not come */
    size_t room;                     /* for a stripe in `packed` */
    uint8_t *lines, *above, *packed; /* owned; `above` the last row as it was before the filter */
    Stripe *stripes;                 /* owned; one for each of `lines` */
    bool begun;                      /* something is handed over */
    uint32_t adler;                  /* of that */
};

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* A stripe of whole rows, as many stripes as are gathered, and no more than the picture has. */
static void measure(PngStripes *self, const ImageForm *form)
{
    self->line = 1 + (size_t)form->width * (size_t)form->channels * (size_t)(form->bits / 8);
    int rows = (int)(STRIPE_BYTES / self->line);
    self->stripe_rows = rows < 1 ? 1 : rows;
    int stripes = (int)(GATHERED_BYTES / (self->line * (size_t)self->stripe_rows));
    self->room_rows = least(self->stripe_rows * (stripes < 1 ? 1 : stripes), form->height);
    self->stripe_rows = least(self->stripe_rows, self->room_rows);
    self->room =
        HEADER_SIZE + compressBound(self->line * (size_t)self->stripe_rows) + FLUSH_ROOM + END_SIZE;
}

static int count_stripes(const PngStripes *self, int rows)
{
    return (rows + self->stripe_rows - 1) / self->stripe_rows;
}

Status pngstripes_open(PngStripes **out, const ImageForm *form, bool up, Err *err)
{
    PngStripes *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "stripes of a PNG", err));
    *out = self;
    self->bits = form->bits;
    self->threads = form->packing.threads;
    self->up = up;
    self->left = form->height;
    self->adler = (uint32_t)adler32(0, NULL, 0);
    measure(self, form);
    size_t n = (size_t)count_stripes(self, self->room_rows);
    TRY(mem_calloc(&self->lines, (size_t)self->room_rows, self->line, "rows of a PNG", err));
    TRY(mem_calloc(&self->above, 1, self->line, "rows of a PNG", err));
    TRY(mem_calloc(&self->stripes, n, sizeof *self->stripes, "stripes of a PNG", err));
    return mem_calloc(&self->packed, n, self->room, "stripes of a PNG", err);
}

void pngstripes_free(PngStripes *self)
{
    if (!self)
        return;
    free(self->lines);
    free(self->above);
    free(self->packed);
    free(self->stripes);
    free(self);
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* The bytes of row `y` of the codes; those of 16 bits go with the high byte first. */
static void put_codes(const PngStripes *self, const void *codes, int y, uint8_t *bytes)
{
    size_t n = self->line - 1;
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

static void subtract_above(uint8_t *restrict bytes, uint8_t *restrict above, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint8_t byte = bytes[i];
        bytes[i] = (uint8_t)(byte - above[i]);
        above[i] = byte;
    }
}

static void gather(PngStripes *self, const void *codes, int y)
{
    uint8_t *line = self->lines + (size_t)self->rows * self->line;
    put_codes(self, codes, y, line + 1);
    line[0] = self->up ? FILTER_UP : FILTER_NONE;
    if (self->up)
        subtract_above(line + 1, self->above, self->line - 1);
    self->rows++;
    self->left--;
}

/* ---- stripes --------------------------------------------------------------------------------- */

/* The bytes of rows in stripe `i` of those that are gathered. */
static size_t plain_size(const PngStripes *self, size_t i)
{
    int first = (int)i * self->stripe_rows;
    return (size_t)least(self->stripe_rows, self->rows - first) * self->line;
}

static void deflate_stripe(size_t i, int worker, void *context)
{
    (void)worker;
    PngStripes *self = context;
    Stripe *stripe = &self->stripes[i];
    size_t n = plain_size(self, i);
    z_stream zlib = {.next_in = self->lines + i * (size_t)self->stripe_rows * self->line,
                     .avail_in = (uInt)n,
                     .next_out = self->packed + i * self->room + HEADER_SIZE,
                     .avail_out = (uInt)(self->room - HEADER_SIZE - END_SIZE)};
    *stripe = (Stripe){.bytes = self->packed + i * self->room + HEADER_SIZE,
                       .adler = (uint32_t)adler32(adler32(0, NULL, 0), zlib.next_in, (uInt)n),
                       .status = STATUS_MEMORY};
    if (deflateInit2(&zlib, LEVEL, Z_DEFLATED, RAW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) != Z_OK)
        return;
    (void)deflate(&zlib, Z_FULL_FLUSH);
    stripe->n = zlib.total_out;
    stripe->status = STATUS_OK;
    deflateEnd(&zlib);
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
static Status pack(PngStripes *self, PngTakeBytes *take, void *context, Err *err)
{
    size_t n = (size_t)count_stripes(self, self->rows);
    threads_for(n, self->threads, deflate_stripe, self);
    for (size_t i = 0; i < n; i++) {
        Stripe *stripe = &self->stripes[i];
        if (stripe->status != STATUS_OK)
            return mem_out_of("to compress", "the PNG", err);
        self->adler =
            (uint32_t)adler32_combine(self->adler, stripe->adler, (z_off_t)plain_size(self, i));
        if (!self->begun)
            put_header(self, stripe);
        if (self->left == 0 && i == n - 1)
            put_end(self, stripe);
        take(context, stripe->bytes, stripe->n);
    }
    self->rows = 0;
    return STATUS_OK;
}

Status pngstripes_rows(PngStripes *self, const void *codes, int n, PngTakeBytes *take,
                       void *context, Err *err)
{
    for (int y = 0; y < n; y++) {
        gather(self, codes, y);
        if (self->rows == self->room_rows || self->left == 0)
            TRY(pack(self, take, context, err));
    }
    return STATUS_OK;
}
