/* Counts the pixels of two pictures by class, and sums their differences. Threads count bands of
 * rows. Each band has its own sums, all of integers, which are added in order, so the result does
 * not depend on the number of threads. Rows and blocks of pixels that are equal in both pictures
 * take a short path, because most pictures that are compared are nearly equal. */
#include "compare/measures/pixel_counts.h"

#include "compare/measures/wide.h"
#include "compare/pixels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows in a band, and pixels in a block of a row. BAND_ROWS affects the speed only. BLOCK must be
 * so small that the sums of take_differences over a block fit into their types. */
enum { BAND_ROWS = 32, BLOCK = 32 };

/* The row that is counted. */
typedef struct PixelRow {
    const LabelWindow *window;
    const uint16_t *a, *b; /* codes; the same pointer if the rows are equal. Then the codes may be
                            * undefined, because nothing reads them */
    int y;
} PixelRow;

/* ------------------------------------------------------------------------------------- classes */

/* Returns the class of a pixel whose labels agree. A pixel whose geometry agrees is in shadow on
 * one side if one side is over 1.5 times as bright. */
static PixelClass class_of_shading(const PixelCounter *counting, const PixelRow *row, int x,
                                   bool seen, int difference)
{
    size_t pixel = (size_t)row->y * (size_t)counting->labels->width + (size_t)x;
    bool known = counting->a->depth && counting->a->normal;
    if (known && seen &&
        geometry_differs(counting->a, counting->b, pixel, counting->geometry_mm,
                         counting->geometry_deg))
        return PIXEL_GEOMETRY;
    if (known && seen && difference > 1) {
        double sum_a = 0, sum_b = 0;
        int channels = counting->a->picture->channels;
        for (int c = 0; c < channels; c++) {
            sum_a += row->a[x * channels + c];
            sum_b += row->b[x * channels + c];
        }
        if (sum_a > 1.5 * sum_b || sum_b > 1.5 * sum_a)
            return PIXEL_SHADOW;
    }
    return difference > 1 ? PIXEL_SHADING : difference == 1 ? PIXEL_ROUNDING : PIXEL_IDENTICAL;
}

/* Counts a pixel whose largest difference over the channels is `difference` codes. */
static void count_pixel(const PixelCounter *counting, const PixelRow *row, int x, int difference,
                        PixelSums *sums)
{
    const LabelWindow *window = row->window;
    uint32_t in_a = window->rows[0][1][x], in_b = window->rows[1][1][x];
    bool band = window->band[x];
    bool common = in_a && in_b, beyond = difference > counting->beyond;
    size_t pixel = (size_t)row->y * (size_t)counting->labels->width + (size_t)x;
    bool settled = counting->settled && counting->settled[pixel];
    PixelClass pixel_class = settled ? PIXEL_SETTLED
                             : in_a != in_b
                                 ? labels_class(in_a, in_b, band)
                                 : class_of_shading(counting, row, x, common, difference);
    sums->total.classes[pixel_class]++;
    if (counting->classes)
        counting->classes[pixel] = (uint8_t)pixel_class;
    count_label((LabelPair){in_a, in_b, band, settled}, pixel, counting->coverage,
                sums->total.counts);
    sums->total.counts[COUNT_DIFFERING] += difference > 0;
    beyond = beyond && !settled;
    sums->total.counts[COUNT_BEYOND] += beyond && (common || !counting->common_only);
    sums->total.counts[COUNT_BAND_BEYOND] += beyond && band;
    sums->total.counts[COUNT_INTERIOR_BEYOND] += beyond && !band;
    if (!band && !settled && difference > sums->interior_max)
        sums->interior_max = difference;
    if (!settled && difference > sums->unsettled_max)
        sums->unsettled_max = difference;
}

/* Counts the pixels [from, to) of a row, which are equal in color and label, and whose geometry is
 * not compared. */
static void count_equal(const LabelWindow *window, int from, int to, PixelSums *sums)
{
    const uint32_t *label = window->rows[0][1];
    unsigned common = 0, band = 0;
    for (int x = from; x < to; x++) {
        common += label[x] != 0;
        band += window->band[x];
    }
    sums->total.counts[COUNT_COMMON] += common;
    sums->total.counts[COUNT_BAND] += band;
    sums->total.classes[PIXEL_IDENTICAL] += (size_t)(to - from);
}

/* Per pixel of a block: the largest |difference| over the channels, and the sum of differences. */
typedef struct Differences {
    int largest[BLOCK], sum[BLOCK];
} Differences;

/* Computes the differences of n pixels, and adds them to the sums. In a block, squares fit in 64
 * bits, and all other sums in 32. */
static inline void take_differences(const uint16_t *a, const uint16_t *b, int n, int channels,
                                    Differences *out, PixelSums *sums)
{
    uint64_t squares = 0;
    uint32_t total = 0;
    int signed_codes[3] = {0};
    for (int x = 0; x < n; x++) {
        int largest = 0, sum = 0;
        for (int c = 0; c < channels; c++) {
            int difference = b[x * channels + c] - a[x * channels + c], size = abs(difference);
            signed_codes[c] += difference;
            total += (uint32_t)size;
            squares += (uint32_t)size * (uint32_t)size;
            largest = size > largest ? size : largest;
            sum += difference;
        }
        out->largest[x] = largest;
        out->sum[x] = sum;
    }
    sums->total.squares += squares;
    sums->total.abs += total;
    for (int c = 0; c < channels; c++)
        sums->total.signed_codes[c] += signed_codes[c];
}

/* Finds the differences of the pixels [from, to) of a row, and adds to the sums of colors. */
static void count_differences(const PixelRow *row, int from, int to, int channels, Differences *out,
                              PixelSums *sums)
{
    const uint16_t *a = row->a + from * channels, *b = row->b + from * channels;
    const int n = to - from;
    unsigned brighter = 0, darker = 0;
    if (channels == 3)
        take_differences(a, b, n, 3, out, sums);
    else
        take_differences(a, b, n, 1, out, sums);
    for (int x = 0; x < n; x++) {
        brighter += out->sum[x] > 0;
        darker += out->sum[x] < 0;
    }
    sums->total.brighter += brighter;
    sums->total.darker += darker;
    for (int x = 0; x < n; x++)
        if (out->largest[x] > sums->max) {
            sums->max = out->largest[x];
            sums->worst = (PixelPlace){.x = from + x, .y = row->y};
        }
}

/* Counts the pixels [from, to) of a row as count_pixel does, without branches. Their labels agree,
 * and neither settled pixels, classes nor geometry are wanted. */
static void count_colors(const PixelCounter *counting, const PixelRow *row, int from, int to,
                         const Differences *differences, PixelSums *sums)
{
    const uint32_t *label = row->window->rows[0][1] + from;
    const uint8_t *band = row->window->band + from;
    const int n = to - from;
    unsigned rounding = 0, shading = 0, common = 0, in_band = 0;
    unsigned beyond = 0, band_beyond = 0, interior_beyond = 0;
    int interior_max = sums->interior_max, unsettled_max = sums->unsettled_max;
    for (int x = 0; x < n; x++) {
        int difference = differences->largest[x], off_band = band[x] ? 0 : difference;
        unsigned is_beyond = difference > counting->beyond, is_common = label[x] != 0;
        rounding += difference == 1;
        shading += difference > 1;
        common += is_common;
        in_band += band[x];
        beyond += is_beyond & (is_common | !counting->common_only);
        band_beyond += is_beyond & band[x];
        interior_beyond += is_beyond & !band[x];
        interior_max = off_band > interior_max ? off_band : interior_max;
        unsettled_max = difference > unsettled_max ? difference : unsettled_max;
    }
    sums->total.classes[PIXEL_ROUNDING] += rounding;
    sums->total.classes[PIXEL_SHADING] += shading;
    sums->total.classes[PIXEL_IDENTICAL] += (unsigned)n - rounding - shading;
    sums->total.counts[COUNT_DIFFERING] += rounding + shading;
    sums->total.counts[COUNT_COMMON] += common;
    sums->total.counts[COUNT_BAND] += in_band;
    sums->total.counts[COUNT_BEYOND] += beyond;
    sums->total.counts[COUNT_BAND_BEYOND] += band_beyond;
    sums->total.counts[COUNT_INTERIOR_BEYOND] += interior_beyond;
    sums->interior_max = interior_max;
    sums->unsettled_max = unsettled_max;
}

static bool labels_equal(const PixelRow *row, int from, int to)
{
    const uint32_t *in_a = row->window->rows[0][1], *in_b = row->window->rows[1][1];
    size_t n = (size_t)(to - from);
    return in_a == in_b || memcmp(in_a + from, in_b + from, n * sizeof *in_a) == 0;
}

static bool codes_equal(const PixelRow *row, int from, int to, int channels)
{
    size_t start = (size_t)from * (size_t)channels, n = (size_t)(to - from) * (size_t)channels;
    return row->a == row->b || memcmp(row->a + start, row->b + start, n * sizeof *row->a) == 0;
}

/* Counts a row by blocks, most of which are equal even in rows that are not. */
static void count_blocks(const PixelCounter *counting, const PixelRow *row, PixelSums *sums)
{
    int width = counting->labels->width, channels = counting->a->picture->channels;
    bool geometry = counting->a->depth && counting->a->normal;
    bool colors = !counting->settled && !counting->classes;
    for (int from = 0, to; from < width; from = to) {
        to = from + BLOCK < width ? from + BLOCK : width;
        bool plain = !geometry && labels_equal(row, from, to);
        if (plain && codes_equal(row, from, to, channels)) {
            count_equal(row->window, from, to, sums);
            continue;
        }
        Differences differences;
        count_differences(row, from, to, channels, &differences, sums);
        if (plain && colors)
            count_colors(counting, row, from, to, &differences, sums);
        else
            for (int x = from; x < to; x++)
                count_pixel(counting, row, x, differences.largest[x - from], sums);
    }
}

/* ---------------------------------------------------------------------------------------- sums */

static int larger_int(int a, int b)
{
    return a > b ? a : b;
}

/* Counts the pixel sides between vessels and background, in a row and to the row below. */
static void count_silhouette(const uint32_t *row, const uint32_t *below, int width, PixelSums *sums)
{
    unsigned edges = 0;
    for (int x = 0; x < width; x++)
        edges += (row[x] != 0) != (below[x] != 0);
    for (int x = 0; x + 1 < width; x++)
        edges += (row[x] != 0) != (row[x + 1] != 0);
    sums->total.silhouette += edges;
}

/* Adds the pixels that show a vessel in both to the sums of the least squares fit. */
static void add_regression(const PixelRow *row, int width, int channels, PixelSums *sums)
{
    const uint32_t *in_a = row->window->rows[0][1], *in_b = row->window->rows[1][1];
    for (int x = 0; x < width; x++) {
        if (!in_a[x] || !in_b[x])
            continue;
        for (int i = x * channels; i < (x + 1) * channels; i++) {
            int64_t a = row->a[i], d = row->b[i] - a;
            sums->total.line.a += (uint64_t)a;
            sums->total.line.aa += (uint64_t)(a * a);
            sums->total.line.d += d;
            sums->total.line.ad += a * d;
            sums->total.line.dd += (uint64_t)(d * d);
        }
        sums->total.line.n += (uint64_t)channels;
    }
}

static void count_row(const PixelCounter *counting, const PixelRow *row, PixelSums *sums,
                      SegmentSums *segments)
{
    int width = counting->labels->width, channels = counting->a->picture->channels;
    count_blocks(counting, row, sums);
    if (counting->labels->source == LABELS_UNKNOWN)
        return;
    count_silhouette(row->window->rows[0][1], row->window->rows[0][2], width, sums);
    if (!counting->index)
        return;
    add_regression(row, width, channels, sums);
    segment_sums_add_row(segments, counting->index, row->window, row->a, row->b, channels);
}

/* Counts the rows of one band. A row that is equal in both pictures is read only if its codes are
 * needed. */
static void count_band(size_t index, int worker, void *context)
{
    PixelCounter *counting = context;
    const Picture *a = counting->a->picture, *b = counting->b->picture;
    uint8_t *scratch = counting->scratch + (size_t)worker * counting->scratch_size;
    uint16_t *codes[2] = {(uint16_t *)(scratch + label_window_size(a->width))};
    codes[1] = codes[0] + picture_stride(a);
    SegmentSums *segments =
        counting->index ? counting->segments + (size_t)worker * counting->index->n : NULL;
    int top = (int)index * BAND_ROWS;
    int bottom = top + BAND_ROWS < a->height ? top + BAND_ROWS : a->height;
    LabelWindow window;
    label_window_open(&window, counting->labels, top, scratch);
    for (int y = top; y < bottom; y++) {
        bool equal = picture_rows_equal(a, b, y, 0, a->width);
        bool read = !equal || counting->index || counting->a->depth;
        PixelRow row = {.window = &window, .y = y};
        row.a = read ? picture_row(a, y, codes[0]) : codes[0];
        row.b = equal ? row.a : picture_row(b, y, codes[1]);
        count_row(counting, &row, &counting->sums[index], segments);
        if (y + 1 < bottom)
            label_window_next(&window);
    }
}

WIDE static void count_band_wide(size_t index, int worker, void *context)
{
    count_band(index, worker, context);
}

static void add_sums(PixelSums *to, const PixelSums *from)
{
    add_integers(&to->total, &from->total, sizeof to->total);
    to->interior_max = larger_int(to->interior_max, from->interior_max);
    to->unsettled_max = larger_int(to->unsettled_max, from->unsettled_max);
    if (from->max > to->max) {
        to->max = from->max;
        to->worst = from->worst;
    }
}

Status count_pixels(PixelCounter *counting, Err *err)
{
    int bands = (counting->labels->height + BAND_ROWS - 1) / BAND_ROWS;
    int threads = threads_available();
    threads = threads < bands ? threads : bands;
    const Picture *a = counting->a->picture;
    size_t segments = counting->index ? (size_t)threads * counting->index->n : 0;
    counting->scratch_size = label_window_size(a->width) + 2 * picture_stride(a) * sizeof(uint16_t);
    TRY(mem_calloc(&counting->sums, (size_t)bands, sizeof *counting->sums, "sums of rows", err));
    TRY(mem_calloc(&counting->segments, segments, sizeof *counting->segments, "sums of segments",
                   err));
    TRY(mem_calloc(&counting->coverage, (size_t)a->width * (size_t)a->height, 1, "pixel marks",
                   err));
    TRY(mem_calloc(&counting->scratch, (size_t)threads, counting->scratch_size, "rows", err));
    segment_sums_clear(counting->segments, segments);
    threads_for((size_t)bands, threads, wide_usable() ? count_band_wide : count_band, counting);
    for (int i = 1; i < bands; i++)
        add_sums(&counting->sums[0], &counting->sums[i]);
    for (int t = 1; t < threads && counting->index; t++)
        segment_sums_add(counting->segments, counting->segments + (size_t)t * counting->index->n,
                         counting->index->n);
    return STATUS_OK;
}

void counting_release(PixelCounter *counting)
{
    free(counting->coverage);
    free(counting->sums);
    free(counting->segments);
    free(counting->scratch);
}
