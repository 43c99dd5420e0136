/* Regions of pixels that only one of the two images shows. They are filled with an explicit stack;
 * a pixel leaves the map when it is pushed, so that it is pushed once. Missing and extra pixels
 * make separate regions: a shifted edge is missing on one side and extra on the other. */
#include "compare/measures/labels.h"
#include "compare/pixels.h"

#include <stdlib.h>

typedef struct Fill {
    int width, height;
    uint8_t *coverage; /* borrowed */
    size_t *stack;     /* owned */
    size_t capacity, depth;
} Fill;

static Status push(Fill *fill, size_t pixel, Err *err)
{
    TRY(mem_reserve(&fill->stack, &fill->capacity, fill->depth + 1, sizeof *fill->stack,
                    "pixels of a region", err));
    fill->coverage[pixel] = COVERED_ALIKE;
    fill->stack[fill->depth++] = pixel;
    return STATUS_OK;
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

static Status region_size(Fill *fill, size_t start, size_t *size, Err *err)
{
    uint8_t coverage = fill->coverage[start];
    *size = 0;
    TRY(push(fill, start, err));
    while (fill->depth > 0) {
        size_t pixel = fill->stack[--fill->depth];
        ++*size;
        TRY(push_neighbours(fill, pixel, coverage, err));
    }
    return STATUS_OK;
}

Status region_take(uint8_t *coverage, const Labels *labels, CompareResult *result, Err *err)
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
        result->places[PLACE_REGION] = place_of(i, labels->width);
    }
    values[MEASURE_LARGEST_REGION] = (double)largest;
done:
    free(fill.stack);
    return status;
}
