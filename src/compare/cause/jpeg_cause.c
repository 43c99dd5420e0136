/* Tests whether B is A compressed as JPEG, by compressing blocks of A. The cosine transform of each
 * 8 x 8 block is rounded to multiples of the quantisation steps of a quality. The steps are those
 * of the standard [ITU-T T.81, annex K], scaled as libjpeg scales them by a quality from 1 to 100.
 * Only the luma is compared, because colors may be subsampled, and only pixels of which no channel
 * of B is black or white, because those may be clipped. */
#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* SIDE: pixels along a block of JPEG. BLOCKS: maximum number of blocks that are compressed, at each
 * of QUALITIES qualities; it bounds the cost, and 400 blocks have 25600 pixels to judge from. */
enum { SIDE = 8, CELLS = SIDE * SIDE, BLOCKS = 400, QUALITIES = 100 };

/* The quantisation steps of luma at quality 50, row by row. */

static const unsigned char luma_steps[CELLS] = {
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};

/* A block of both pictures, in levels of luma. */
typedef struct Block {
    double a[CELLS], b[CELLS];
    double coefficients[CELLS]; /* cosine transform of `a` */
    bool clipped[CELLS];
} Block;

typedef struct JpegBlocks {
    Block *blocks; /* owned */
    size_t n;
    double cosines[SIDE][SIDE]; /* [frequency][position] */
} JpegBlocks;

/* Returns quantisation step `i` at a quality, by the formula of libjpeg. */
static double step_of(int quality, int i)
{
    int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
    int step = (luma_steps[i] * scale + 50) / 100;
    return step < 1 ? 1 : step > 255 ? 255 : step;
}

static double luma_at(const Picture *picture, int x, int y)
{
    const double level = 1.0 / codes_per_level(picture);
    if (picture->channels == 1)
        return level * code_at(picture, x, y, 0);
    return level * (0.299 * code_at(picture, x, y, 0) + 0.587 * code_at(picture, x, y, 1) +
                    0.114 * code_at(picture, x, y, 2));
}

static bool is_clipped(const Picture *picture, int x, int y)
{
    for (int c = 0; c < picture->channels; c++) {
        int code = code_at(picture, x, y, c);
        if (code == 0 || code == largest_code(picture))
            return true;
    }
    return false;
}

/* The cosine transform of a block, or its inverse. */
static void transform(const JpegBlocks *self, const double in[CELLS], bool inverse,
                      double out[CELLS])
{
    double rows[CELLS] = {0};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int u = 0; u < SIDE; u++)
                rows[y * SIDE + u] +=
                    (inverse ? self->cosines[x][u] : self->cosines[u][x]) * in[y * SIDE + x];
    for (int v = 0; v < SIDE; v++)
        for (int u = 0; u < SIDE; u++) {
            double sum = 0;
            for (int y = 0; y < SIDE; y++)
                sum += (inverse ? self->cosines[y][v] : self->cosines[v][y]) * rows[y * SIDE + u];
            out[v * SIDE + u] = sum;
        }
}

/* Returns true if the codes of A vary in a block. A flat block is the same for all qualities. */
static bool has_detail(const Picture *a, int left, int top)
{
    for (int i = 0; i < CELLS; i++)
        if (pixels_apart(a, left, top, a, left + i % SIDE, top + i / SIDE) > 0)
            return true;
    return false;
}

/* Appends a block of both pictures, with the cosine transform of A. */
static void take_block(JpegBlocks *self, const Picture *a, const Picture *b, int left, int top)
{
    Block *block = &self->blocks[self->n++];
    for (int i = 0; i < CELLS; i++) {
        const int x = left + i % SIDE, y = top + i / SIDE;
        block->a[i] = round(luma_at(a, x, y)) - 128; /* libjpeg transforms integers */
        block->b[i] = luma_at(b, x, y) - 128;
        block->clipped[i] = is_clipped(b, x, y);
    }
    transform(self, block->a, false, block->coefficients);
}

/* Takes BLOCKS blocks with detail, spread over the picture. */
static Status take_blocks(JpegBlocks *self, const Picture *a, const Picture *b, Err *err)
{
    size_t n = 0, seen = 0;
    TRY(mem_calloc(&self->blocks, BLOCKS, sizeof *self->blocks, "blocks", err));
    for (int u = 0; u < SIDE; u++)
        for (int x = 0; x < SIDE; x++)
            self->cosines[u][x] = sqrt((u ? 2 : 1) / (double)SIDE) *
                                  elementary_cos(PI * (2 * x + 1) * u / (2 * SIDE));
    for (int y = 0; y + SIDE <= a->height; y += SIDE)
        for (int x = 0; x + SIDE <= a->width; x += SIDE)
            n += has_detail(a, x, y);
    for (int y = 0; y + SIDE <= a->height; y += SIDE)
        for (int x = 0; x + SIDE <= a->width; x += SIDE)
            if (has_detail(a, x, y) && seen++ * BLOCKS / n >= self->n && self->n < BLOCKS)
                take_block(self, a, b, x, y);
    return STATUS_OK;
}

/* Counts of pixels. */
typedef struct JpegFit {
    size_t beyond;  /* A and B differ by more than rounding */
    size_t misfits; /* the compressed A and B differ by more than rounding */
} JpegFit;

/* Compresses a block of A at a quality, and compares it with B. */
static void add_fit(const JpegBlocks *self, const Block *block, int quality, JpegFit *fit)
{
    const double slack = 1.5; /* levels; codes, colors and transforms are rounded */
    double rounded[CELLS], made[CELLS];
    for (int i = 0; i < CELLS; i++) {
        double step = step_of(quality, i);
        rounded[i] = step * round(block->coefficients[i] / step);
    }
    transform(self, rounded, true, made);
    for (int i = 0; i < CELLS; i++)
        if (!block->clipped[i]) {
            fit->beyond += fabs(block->b[i] - block->a[i]) > slack;
            fit->misfits += fabs(block->b[i] - made[i]) > slack;
        }
}

Status cause_jpeg(const Picture *a, const Picture *b, Sentence *out, Err *err)
{
    JpegBlocks self = {0};
    double least = 0.2; /* other qualities than the right one leave more than 0.8 */
    int found = 0;
    TRY(take_blocks(&self, a, b, err));
    for (int quality = 1; quality <= QUALITIES; quality++) {
        JpegFit fit = {0};
        for (size_t i = 0; i < self.n; i++)
            add_fit(&self, &self.blocks[i], quality, &fit);
        /* Fewer than 64 differing pixels decide nothing. */
        double part = fit.beyond >= 64 ? (double)fit.misfits / (double)fit.beyond : 1;
        if (part < least) {
            least = part;
            found = quality;
        }
    }
    free(self.blocks);
    if (found)
        snprintf(out->text, out->size, "B is A compressed as JPEG (quality about %d)", found);
    return STATUS_OK;
}
