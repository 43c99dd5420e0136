/* Sums the differences of the pixels of each segment, and makes the ledger from the sums: a table
 * with one entry per segment. Rows are
 * added run by run. A run is a sequence of pixels that show one segment in A and one segment in B,
 * so each sum is found once per run, not once per pixel. If the row is equal in both pictures, a
 * run only adds to the area and to the sum of squares. */
#include "compare/measures/ledger.h"

#include "compare/pixels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Smaller segments are not judged, because rounding and edges dominate them: fewer common pixels
 * for a mean difference, a shorter outline for a shift, fewer pixels for a missing segment. With 64
 * pixels, the rounding of both pictures (0.41 levels) leaves an error of 0.05 levels in the mean,
 * less than half of the limit of tier B. With 8 pixels of outline, one pixel that changes sides
 * counts as a shift of 0.125 px, just below its limit of 0.15 px. Two pixels of a thin segment may
 * change sides at a rounding error. */
enum { LEVELS_MIN_PIXELS = 64, OUTLINE_MIN_PX = 8, MISSING_MIN_PIXELS = 3 };

static uint32_t max_of(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

Status segment_index_init(SegmentIndex *index, const IdPlane *a, const IdPlane *b, Err *err)
{
    SegmentIndex made = {0};
    uint8_t *present = NULL;
    Status status = STATUS_OK;
    size_t n = (size_t)a->width * (size_t)a->height;
    uint32_t last = 0, previous = 0;
    for (size_t i = 0; i < n; i++)
        last = max_of(last, max_of(a->ids[i], b->ids[i]));
    TRY_GOTO(mem_calloc(&present, (size_t)last + 1, 1, "marks of ids", err));
    present[0] = 1;
    for (int side = 0; side < 2; side++) {
        const uint32_t *ids = side ? b->ids : a->ids;
        for (size_t i = 0; i < n; i++) {
            if (ids[i] == previous)
                continue;
            previous = ids[i];
            present[previous] = 1;
        }
    }
    for (size_t id = 0; id <= last; id++)
        made.n += present[id];
    TRY_GOTO(mem_calloc(&made.of_id, (size_t)last + 1, sizeof *made.of_id, "segments", err));
    TRY_GOTO(mem_calloc(&made.ids, made.n, sizeof *made.ids, "segments", err));
    uint32_t next = 0;
    for (uint32_t id = 0; id <= last; id++)
        if (present[id]) {
            made.ids[next] = id;
            made.of_id[id] = next++;
        }
    *index = made;
done:
    free(present);
    if (status != STATUS_OK)
        segment_index_release(&made);
    return status;
}

void segment_index_release(SegmentIndex *index)
{
    free(index->of_id);
    free(index->ids);
    *index = (SegmentIndex){0};
}

void segment_sums_clear(SegmentSums *segments, size_t n)
{
    for (size_t i = 0; i < n; i++)
        segments[i] =
            (SegmentSums){.left = IMAGE_MAX_SIDE, .top = IMAGE_MAX_SIDE, .right = -1, .bottom = -1};
}

/* Extends the bounding box of a segment by a run of pixels in row y. */
static void widen(SegmentSums *segment, int left, int right, int y)
{
    segment->left = left < segment->left ? left : segment->left;
    segment->right = right > segment->right ? right : segment->right;
    segment->top = y < segment->top ? y : segment->top;
    segment->bottom = y > segment->bottom ? y : segment->bottom;
}

/* Counts the pixel sides between labels in a row, and between the row and the one below. */
static void add_edges(SegmentSums *segments, const SegmentIndex *index, const uint32_t *row,
                      const uint32_t *below, int side, int width)
{
    for (int x = 0; x < width; x++) {
        if (row[x] != below[x]) {
            segments[index->of_id[row[x]]].total.edges[side]++;
            segments[index->of_id[below[x]]].total.edges[side]++;
        }
        if (x > 0 && row[x] != row[x - 1]) {
            segments[index->of_id[row[x]]].total.edges[side]++;
            segments[index->of_id[row[x - 1]]].total.edges[side]++;
        }
    }
}

static void add_squares(SegmentSums *segment, const uint16_t *a, size_t n)
{
    uint64_t squares = 0;
    for (size_t i = 0; i < n; i++)
        squares += (uint32_t)a[i] * (uint32_t)a[i];
    segment->total.squares += squares;
}

/* Adds `n` pixels that show one segment in both pictures. */
static void add_common(SegmentSums *segment, const uint16_t *a, const uint16_t *b, int n,
                       int channels)
{
    for (int x = 0; x < n; x++, a += channels, b += channels) {
        int largest = 0;
        for (int c = 0; c < channels; c++) {
            int difference = b[c] - a[c];
            segment->total.signed_codes[c] += difference;
            segment->total.products += (int64_t)a[c] * difference;
            largest = abs(difference) > largest ? abs(difference) : largest;
        }
        segment->total.differing += largest > 0;
        segment->max_code = largest > segment->max_code ? largest : segment->max_code;
    }
}

void segment_sums_add_row(SegmentSums *segments, const SegmentIndex *index,
                          const LabelWindow *window, const uint16_t *a, const uint16_t *b,
                          int channels)
{
    const uint32_t *in_a = window->rows[0][1], *in_b = window->rows[1][1];
    int width = window->labels->width;
    for (int x = 0, end; x < width; x = end) {
        for (end = x + 1; end < width && in_a[end] == in_a[x] && in_b[end] == in_b[x];)
            end++;
        size_t start = (size_t)x * (size_t)channels, n = (size_t)(end - x) * (size_t)channels;
        SegmentSums *of_a = &segments[index->of_id[in_a[x]]],
                    *of_b = &segments[index->of_id[in_b[x]]];
        of_a->total.area[0] += (uint64_t)(end - x);
        of_b->total.area[1] += (uint64_t)(end - x);
        widen(of_a, x, end - 1, window->y);
        if (of_a != of_b) {
            widen(of_b, x, end - 1, window->y);
            of_a->total.differing += (uint64_t)(end - x);
            of_b->total.differing += (uint64_t)(end - x);
            continue;
        }
        of_a->total.common += (uint64_t)(end - x);
        add_squares(of_a, a + start, n);
        if (a != b)
            add_common(of_a, a + start, b + start, end - x, channels);
    }
    add_edges(segments, index, in_a, window->rows[0][2], 0, width);
    add_edges(segments, index, in_b, window->rows[1][2], 1, width);
}

void segment_sums_add(SegmentSums *to, const SegmentSums *from, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        add_integers(&to[i].total, &from[i].total, sizeof to[i].total);
        to[i].max_code = from[i].max_code > to[i].max_code ? from[i].max_code : to[i].max_code;
        if (from[i].right >= from[i].left) {
            widen(&to[i], from[i].left, from[i].right, from[i].top);
            widen(&to[i], from[i].left, from[i].right, from[i].bottom);
        }
    }
}

/* -------------------------------------------------------------------------------------- ledger */

static LedgerEntry make_entry(uint32_t id, const SegmentSums *segment, int channels,
                              double code_levels)
{
    uint64_t edges = segment->total.area[0] ? segment->total.edges[0] : segment->total.edges[1];
    LedgerEntry entry = {.id = id,
                         .area_a = segment->total.area[0],
                         .area_b = segment->total.area[1],
                         .common = segment->total.common,
                         .differing = segment->total.differing,
                         .outline_px = PX_PER_SIDE * (double)edges,
                         .gain = (double)NAN,
                         .max_levels = segment->max_code * code_levels,
                         .left = segment->left,
                         .top = segment->top,
                         .right = segment->right,
                         .bottom = segment->bottom};
    for (int c = 0; c < channels && segment->total.common; c++)
        entry.signed_levels[c] =
            (double)segment->total.signed_codes[c] * code_levels / (double)segment->total.common;
    if (segment->total.squares)
        entry.gain = 1 + (double)segment->total.products / (double)segment->total.squares;
    if (edges)
        entry.moved_px = ((double)entry.area_b - (double)entry.area_a) / entry.outline_px;
    return entry;
}

Status ledger_from_sums(Ledger *ledger, const SegmentIndex *index, const SegmentSums *segments,
                        int channels, double code_levels, Err *err)
{
    Ledger made = {.n = index->n - 1};
    TRY(mem_calloc(&made.entries, made.n, sizeof *made.entries, "entries of the ledger", err));
    for (size_t i = 0; i < made.n; i++)
        made.entries[i] = make_entry(index->ids[i + 1], &segments[i + 1], channels, code_levels);
    *ledger = made;
    return STATUS_OK;
}

void ledger_release(Ledger *ledger)
{
    free(ledger->entries);
    *ledger = (Ledger){0};
}

double ledger_entry_levels(const LedgerEntry *entry)
{
    double worst = 0;
    for (int c = 0; c < 3; c++)
        if (fabs(entry->signed_levels[c]) > fabs(worst))
            worst = entry->signed_levels[c];
    return worst;
}

/* Returns the pixel in the middle of the segment's box. */
static PixelPlace middle_of(const LedgerEntry *entry)
{
    return (PixelPlace){.x = entry->left + (entry->right - entry->left) / 2,
                        .y = entry->top + (entry->bottom - entry->top) / 2,
                        .id_a = entry->area_a ? entry->id : 0,
                        .id_b = entry->area_b ? entry->id : 0};
}

/* Inserts an entry into the sorted list of the segments with most differing pixels. */
static void keep_worst(CompareResult *result, const LedgerEntry *entry)
{
    if (entry->differing == 0)
        return;
    LedgerEntry *kept = result->worst_segments;
    int at = result->n_worst_segments;
    while (at > 0 && kept[at - 1].differing < entry->differing)
        at--;
    if (at == WORST_SEGMENTS)
        return;
    if (result->n_worst_segments < WORST_SEGMENTS)
        result->n_worst_segments++;
    memmove(kept + at + 1, kept + at, (size_t)(result->n_worst_segments - 1 - at) * sizeof *kept);
    kept[at] = *entry;
}

void result_set_segments(const Ledger *ledger, CompareResult *result)
{
    double *values = result->values;
    PixelPlace *places = result->places;
    values[MEASURE_SEGMENTS] = (double)ledger->n;
    values[MEASURE_SEGMENT_LEVELS] = values[MEASURE_SEGMENT_PX] = 0;
    for (size_t i = 0; i < ledger->n; i++) {
        const LedgerEntry *entry = &ledger->entries[i];
        double levels = fabs(ledger_entry_levels(entry)), moved = fabs(entry->moved_px);
        keep_worst(result, entry);
        size_t area = entry->area_a > entry->area_b ? entry->area_a : entry->area_b;
        if ((entry->area_a == 0 || entry->area_b == 0) && area >= MISSING_MIN_PIXELS) {
            if (values[MEASURE_SEGMENTS_MISSING]++ == 0)
                places[PLACE_SEGMENT_MISSING] = middle_of(entry);
        } else if (entry->outline_px >= OUTLINE_MIN_PX && moved > values[MEASURE_SEGMENT_PX]) {
            values[MEASURE_SEGMENT_PX] = moved;
            places[PLACE_SEGMENT_PX] = middle_of(entry);
        }
        if (entry->common >= LEVELS_MIN_PIXELS && levels > values[MEASURE_SEGMENT_LEVELS]) {
            values[MEASURE_SEGMENT_LEVELS] = levels;
            places[PLACE_SEGMENT_LEVELS] = middle_of(entry);
        }
    }
}

void ledger_csv(const Ledger *ledger, Text *out)
{
    text_puts(out, "id,area_a,area_b,common,differing,outline_px,moved_px,signed_levels_r,"
                   "signed_levels_g,signed_levels_b,gain,max_levels,left,top,right,bottom\n");
    for (size_t i = 0; i < ledger->n; i++) {
        const LedgerEntry *entry = &ledger->entries[i];
        text_printf(out, "%u,%zu,%zu,%zu,%zu,%.6g,%.6g,%.6g,%.6g,%.6g,%.9g,%.6g,%d,%d,%d,%d\n",
                    entry->id, entry->area_a, entry->area_b, entry->common, entry->differing,
                    entry->outline_px, entry->moved_px, entry->signed_levels[0],
                    entry->signed_levels[1], entry->signed_levels[2], entry->gain,
                    entry->max_levels, entry->left, entry->top, entry->right, entry->bottom);
    }
}
