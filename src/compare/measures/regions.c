/* Finds regions of pixels that only one of the two images shows, by flood fill with a stack. A
 * pixel is cleared from the map when it is pushed, so it is pushed once. Missing and extra pixels
 * make separate regions, because a shifted edge is missing on one side and extra on the other. */
#include "compare/measures/labels.h"
#include "compare/pixels.h"

#include <stdlib.h>

/* A flood fill: the map of pixels, and the pixels that are still to be visited. */
typedef struct Fill {
    int width, height;
    uint8_t *coverage; /* borrowed */
    ARRAY(size_t) stack;
} Fill;

static Status push(Fill *fill, size_t pixel, Err *err)
{
    fill->coverage[pixel] = COVERED_ALIKE;
    return ARRAY_PUSH(&fill->stack, "pixels of a region", err, pixel);
}

/* Pushes the neighbours of a pixel that are covered in this way. */
static Status push_neighbours(Fill *fill, size_t pixel, uint8_t coverage, Err *err)
{
    int x = (int)(pixel % (size_t)fill->width), y = (int)(pixel / (size_t)fill->width);
    for (int row = y - 1; row <= y + 1; row++)
        for (int column = x - 1; column <= x + 1; column++) {
            if (row < 0 || row >= fill->height || column < 0 || column >= fill->width)
                continue;
            size_t there = (size_t)row * (size_t)fill->width + (size_t)column;
            if (fill->coverage[there] == coverage)
                TRY(push(fill, there, err));
        }
    return STATUS_OK;
}

/* Counts the pixels of the region that contains pixel `start`, and clears them. */
static Status region_size(Fill *fill, size_t start, size_t *size, Err *err)
{
    uint8_t coverage = fill->coverage[start];
    *size = 0;
    TRY(push(fill, start, err));
    while (fill->stack.n > 0) {
        size_t pixel = fill->stack.items[--fill->stack.n];
        ++*size;
        TRY(push_neighbours(fill, pixel, coverage, err));
    }
    return STATUS_OK;
}

Status result_set_region(uint8_t *coverage, const Labels *labels, CompareResult *result, Err *err)
{
    double *values = result->values;
    size_t n = (size_t)labels->width * (size_t)labels->height, found = 0, largest = 0;
    Fill fill = {.width = labels->width, .height = labels->height, .coverage = coverage};
    Status status = STATUS_OK;
    values[MEASURE_UNCOMMON_PIXELS] = values[MEASURE_MISSING_PIXELS] + values[MEASURE_EXTRA_PIXELS];
    for (size_t i = 0; i < n && values[MEASURE_UNCOMMON_PIXELS] > 0; i++) {
        if (coverage[i] == COVERED_ALIKE)
            continue;
        TRY_GOTO(region_size(&fill, i, &found, err));
        if (found <= largest)
            continue;
        largest = found;
        result->places[PLACE_REGION] = pixel_place(i, labels->width);
    }
    values[MEASURE_LARGEST_REGION] = (double)largest;
done:
    ARRAY_RELEASE(&fill.stack);
    return status;
}

void result_set_counts(const uint64_t counts[PIXEL_COUNTS], bool labelled, CompareResult *result)
{
    static const MeasureId ids[PIXEL_COUNTS] = {[COUNT_DIFFERING] = MEASURE_DIFFERING_PIXELS,
                                                [COUNT_BEYOND] = MEASURE_BEYOND_PIXELS,
                                                [COUNT_SETTLED] = MEASURE_SETTLED_PIXELS,
                                                [COUNT_COMMON] = MEASURE_COMMON_PIXELS,
                                                [COUNT_MISSING] = MEASURE_MISSING_PIXELS,
                                                [COUNT_EXTRA] = MEASURE_EXTRA_PIXELS,
                                                [COUNT_BAND] = MEASURE_BAND_PIXELS,
                                                [COUNT_BAND_BEYOND] = MEASURE_BAND_BEYOND,
                                                [COUNT_INTERIOR_BEYOND] = MEASURE_INTERIOR_BEYOND};
    double *values = result->values, band = (double)counts[COUNT_BAND];
    for (int i = 0; i < (labelled ? PIXEL_COUNTS : COUNT_COMMON); i++)
        if (ids[i] != MEASURE_NONE)
            values[ids[i]] = (double)counts[i];
    result->has_mask = labelled;
    if (!labelled)
        return;
    values[MEASURE_INTERIOR_PIXELS] = values[MEASURE_PIXELS] - band;
    values[MEASURE_EDGE_MISMATCH] = band > 0 ? (double)counts[COUNT_BAND_DIFFERS] / band : 0;
    values[MEASURE_EDGE_MISMATCH_PERCENT] = 100 * values[MEASURE_EDGE_MISMATCH];
    values[MEASURE_MISMATCH_FRACTION] = values[MEASURE_DIFFERING_PIXELS] / values[MEASURE_PIXELS];
}
