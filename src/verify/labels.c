/* Regions are filled with an explicit stack; a pixel is marked when it is pushed, so that it is
 * pushed once. Missing and extra pixels make separate regions: a shifted edge is missing on one
 * side and extra on the other. */
#include "verify/labels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b, Err *err)
{
    if (!a && !b)
        return STATUS_OK;
    if (!a || !b)
        return err_set(err, STATUS_INPUT, "only one of the two images has an id plane");
    const IdPlane *planes[] = {a, b};
    for (int i = 0; i < 2; i++)
        if (planes[i]->width != width || planes[i]->height != height)
            return err_set(err, STATUS_INPUT,
                           "an id plane of %d x %d pixels does not fit images of %d x %d",
                           planes[i]->width, planes[i]->height, width, height);
    return STATUS_OK;
}

void labels_from_ids(Labels *labels, const IdPlane *a, const IdPlane *b)
{
    *labels = (Labels){.width = a->width, .height = a->height, .a = a->ids, .b = b->ids};
}

Status labels_init(Labels *labels, int width, int height, Err *err)
{
    size_t n = (size_t)width * (size_t)height;
    uint32_t *owned;
    TRY(mem_calloc(&owned, 2 * n, sizeof *owned, "pixel labels", err));
    *labels =
        (Labels){.width = width, .height = height, .a = owned, .b = owned + n, .owned = owned};
    return STATUS_OK;
}

void labels_release(Labels *labels)
{
    free(labels->owned);
    *labels = (Labels){0};
}

/* The colour that three corners share, or NULL. Borrowed. */
static const uint16_t *background_of(const Picture *picture)
{
    size_t channels = (size_t)picture->channels, size = channels * sizeof(uint16_t);
    size_t right = (size_t)picture->width - 1;
    size_t bottom = ((size_t)picture->height - 1) * (size_t)picture->width;
    const size_t corners[] = {0, right, bottom, bottom + right};
    for (int i = 0; i < 2; i++) {
        const uint16_t *candidate = picture->codes + corners[i] * channels;
        int sharing = 0;
        for (int j = 0; j < 4; j++)
            sharing += memcmp(candidate, picture->codes + corners[j] * channels, size) == 0;
        if (sharing >= 3)
            return candidate;
    }
    return NULL;
}

static void fill_seen(const Picture *picture, const uint16_t *background, uint32_t *labels)
{
    size_t n = (size_t)picture->width * (size_t)picture->height;
    size_t channels = (size_t)picture->channels;
    for (size_t i = 0; i < n; i++)
        labels[i] =
            memcmp(picture->codes + i * channels, background, channels * sizeof *background) != 0;
}

Status labels_from_background(Labels *labels, const Picture *a, const Picture *b, Err *err)
{
    const uint16_t *of_a = background_of(a), *of_b = background_of(b);
    *labels = (Labels){.width = a->width, .height = a->height};
    if (!of_a || !of_b)
        return STATUS_OK;
    TRY(labels_init(labels, a->width, a->height, err));
    fill_seen(a, of_a, labels->owned);
    fill_seen(b, of_b, labels->owned + (size_t)a->width * (size_t)a->height);
    return STATUS_OK;
}

bool labels_in_band(const Labels *labels, int x, int y)
{
    size_t width = (size_t)labels->width;
    size_t here = (size_t)y * width + (size_t)x;
    int left = x > 0 ? x - 1 : 0, right = x + 1 < labels->width ? x + 1 : x;
    int top = y > 0 ? y - 1 : 0, bottom = y + 1 < labels->height ? y + 1 : y;
    for (int row = top; row <= bottom; row++)
        for (int column = left; column <= right; column++) {
            size_t there = (size_t)row * width + (size_t)column;
            if (labels->a[there] != labels->a[here] || labels->b[there] != labels->b[here])
                return true;
        }
    return false;
}

bool labels_classify(const Labels *labels, size_t pixel, bool band, ClassCounts *classes)
{
    uint32_t a = labels->a[pixel], b = labels->b[pixel];
    if (a == b)
        return false;
    if (band)
        classes->edge++;
    else if (b == 0)
        classes->missing++;
    else if (a == 0)
        classes->extra++;
    else
        classes->wrong_segment++;
    return true;
}

typedef enum Coverage { COVERED_ALIKE, COVERED_MISSING, COVERED_EXTRA } Coverage;

static Coverage coverage_at(const Labels *labels, size_t pixel)
{
    bool a = labels->a[pixel] != 0, b = labels->b[pixel] != 0;
    return a == b ? COVERED_ALIKE : a ? COVERED_MISSING : COVERED_EXTRA;
}

/* Pixels of the regions being filled. */
typedef struct Fill {
    uint8_t *marked; /* owned; one a pixel */
    size_t *stack;   /* owned */
    size_t capacity, depth;
} Fill;

static Status fill_push(Fill *fill, size_t pixel, Err *err)
{
    TRY(mem_reserve(&fill->stack, &fill->capacity, fill->depth + 1, sizeof *fill->stack,
                    "pixels of a region", err));
    fill->marked[pixel] = 1;
    fill->stack[fill->depth++] = pixel;
    return STATUS_OK;
}

/* Pushes the unmarked neighbours of a pixel that are covered like it. */
static Status fill_neighbours(Fill *fill, const Labels *labels, size_t pixel, Err *err)
{
    int width = labels->width;
    int x = (int)(pixel % (size_t)width), y = (int)(pixel / (size_t)width);
    for (int row = y - 1; row <= y + 1; row++)
        for (int column = x - 1; column <= x + 1; column++) {
            if (row < 0 || row >= labels->height || column < 0 || column >= width)
                continue;
            size_t there = (size_t)row * (size_t)width + (size_t)column;
            if (!fill->marked[there] && coverage_at(labels, there) == coverage_at(labels, pixel))
                TRY(fill_push(fill, there, err));
        }
    return STATUS_OK;
}

static Status region_size(Fill *fill, const Labels *labels, size_t start, size_t *size, Err *err)
{
    *size = 0;
    TRY(fill_push(fill, start, err));
    while (fill->depth > 0) {
        size_t pixel = fill->stack[--fill->depth];
        ++*size;
        TRY(fill_neighbours(fill, labels, pixel, err));
    }
    return STATUS_OK;
}

static Status find_largest_region(const Labels *labels, CompareResult *result, Err *err)
{
    size_t n = (size_t)labels->width * (size_t)labels->height;
    Fill fill = {0};
    Status status = mem_calloc(&fill.marked, n, 1, "pixel marks", err);
    for (size_t i = 0; i < n && status == STATUS_OK; i++) {
        if (fill.marked[i] || coverage_at(labels, i) == COVERED_ALIKE)
            continue;
        size_t size;
        status = region_size(&fill, labels, i, &size, err);
        if (status == STATUS_OK && size > result->largest_region) {
            result->largest_region = size;
            result->largest_region_at = (PixelPlace){.x = (int)(i % (size_t)labels->width),
                                                     .y = (int)(i / (size_t)labels->width)};
        }
    }
    free(fill.marked);
    free(fill.stack);
    return status;
}

Status labels_measure(const Labels *labels, CompareResult *result, Err *err)
{
    if (!labels->a)
        return STATUS_OK;
    result->has_mask = true;
    size_t band = 0, band_differs = 0, i = 0;
    for (int y = 0; y < labels->height; y++)
        for (int x = 0; x < labels->width; x++, i++) {
            Coverage coverage = coverage_at(labels, i);
            result->missing_pixels += coverage == COVERED_MISSING;
            result->extra_pixels += coverage == COVERED_EXTRA;
            result->common_pixels += coverage == COVERED_ALIKE && labels->a[i] != 0;
            if (labels_in_band(labels, x, y)) {
                band++;
                band_differs += labels->a[i] != labels->b[i];
            }
        }
    result->edge_mismatch_fraction = band ? (double)band_differs / (double)band : 0;
    if (result->missing_pixels + result->extra_pixels == 0)
        return STATUS_OK;
    return find_largest_region(labels, result, err);
}
