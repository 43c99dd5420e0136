/* Regions of pixels that only one of the two images shows. They are filled with an explicit stack;
 * a pixel leaves the map when it is pushed, so that it is pushed once. Missing and extra pixels
 * make separate regions: a shifted edge is missing on one side and extra on the other. */
#include "compare/measures/labels.h"

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

Status largest_region(uint8_t *coverage, int width, int height, size_t *size, PixelPlace *at,
                      Err *err)
{
    Fill fill = {.width = width, .height = height, .coverage = coverage};
    size_t n = (size_t)width * (size_t)height;
    Status status = STATUS_OK;
    *size = 0;
    *at = (PixelPlace){.x = -1, .y = -1};
    for (size_t i = 0; i < n && status == STATUS_OK; i++) {
        if (coverage[i] == COVERED_ALIKE)
            continue;
        size_t found;
        status = region_size(&fill, i, &found, err);
        if (status == STATUS_OK && found > *size) {
            *size = found;
            *at = (PixelPlace){.x = (int)(i % (size_t)width), .y = (int)(i / (size_t)width)};
        }
    }
    free(fill.stack);
    return status;
}
