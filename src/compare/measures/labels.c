/* Finds the labels of pixels, row by row, and the pixels at edges, which form the band. A label
 * states what a pixel shows: a segment's id, or only whether it shows a vessel.
 *
 * A pixel is not at an edge if its label equals the labels of its eight neighbours, in both images.
 * This holds if each of the three rows is uniform at the pixel, and the middle label equals those
 * above and below. Both tests are elementwise over rows, so the compiler vectorises them, and a
 * window needs three rows. */
#include "compare/measures/labels.h"

#include <stdlib.h>
#include <string.h>

Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b, Err *err)
{
    if (!a && !b)
        return STATUS_OK;
    if (!a || !b)
        return err_set(err, STATUS_INPUT,
                       "only one of the two images has an id plane; give both or none");
    const IdPlane *planes[] = {a, b};
    for (int i = 0; i < 2; i++)
        if (planes[i]->width != width || planes[i]->height != height)
            return err_set(err, STATUS_INPUT,
                           "an id plane of %d x %d pixels does not fit images of %d x %d",
                           planes[i]->width, planes[i]->height, width, height);
    return STATUS_OK;
}

Labels labels_from_ids(const IdPlane *a, const IdPlane *b)
{
    return (Labels){.source = LABELS_IDS, .width = a->width, .height = a->height, .ids = {a, b}};
}

/* Returns true if at least three corners share a color. *background receives the index of its first
 * code. */
static bool find_background(const Picture *picture, size_t *background)
{
    size_t channels = (size_t)picture->channels, row = picture_stride(picture);
    size_t bottom = ((size_t)picture->height - 1) * row;
    const size_t corners[] = {0, row - channels, bottom, bottom + row - channels};
    for (int i = 0; i < 2; i++) {
        int sharing = 0;
        for (int j = 0; j < 4; j++) {
            bool equal = true;
            for (size_t c = 0; c < channels; c++)
                equal = equal && picture_code(picture, corners[i] + c) ==
                                     picture_code(picture, corners[j] + c);
            sharing += equal;
        }
        *background = corners[i];
        if (sharing >= 3)
            return true;
    }
    return false;
}

Labels labels_from_background(const Picture *a, const Picture *b)
{
    Labels labels = {
        .source = LABELS_BACKGROUND, .width = a->width, .height = a->height, .pictures = {a, b}};
    for (int side = 0; side < 2; side++) {
        size_t first;
        if (!find_background(labels.pictures[side], &first))
            return (Labels){.source = LABELS_UNKNOWN, .width = a->width, .height = a->height};
        for (size_t c = 0; c < (size_t)a->channels; c++)
            labels.background[side][c] = picture_code(labels.pictures[side], first + c);
    }
    return labels;
}

Status labels_init_given(Labels *labels, int width, int height, Err *err)
{
    size_t n = (size_t)width * (size_t)height;
    Labels made = {.source = LABELS_GIVEN, .width = width, .height = height};
    TRY(mem_calloc(&made.given[0], 2 * n, 1, "pixel labels", err));
    made.given[1] = made.given[0] + n;
    *labels = made;
    return STATUS_OK;
}

void labels_release(Labels *labels)
{
    free(labels->given[0]);
    *labels = (Labels){0};
}

/* Sets out[x] to 1 if the codes of a pixel differ from those of the background. The number of
 * channels is a constant in each use, so that the compiler vectorises the loop. */
#define FILL_FOREGROUND(codes, channels)                                                           \
    for (size_t x = 0; x < width; x++, codes += (channels)) {                                      \
        unsigned differs = 0;                                                                      \
        for (size_t c = 0; c < (channels); c++)                                                    \
            differs |= (unsigned)(codes[c] ^ background[c]);                                       \
        out[x] = differs != 0;                                                                     \
    }

static void fill_foreground(const Labels *labels, int side, int y, uint32_t *restrict out)
{
    const Picture *picture = labels->pictures[side];
    const uint16_t *background = labels->background[side];
    size_t width = (size_t)labels->width, start = (size_t)y * picture_stride(picture);
    const uint8_t *codes8 = picture->bits == 8 ? picture->codes8 + start : NULL;
    const uint16_t *codes16 = picture->bits == 8 ? NULL : picture->codes16 + start;
    if (codes8 && picture->channels == 3)
        FILL_FOREGROUND(codes8, 3)
    else if (codes8)
        FILL_FOREGROUND(codes8, 1)
    else if (picture->channels == 3)
        FILL_FOREGROUND(codes16, 3)
    else
        FILL_FOREGROUND(codes16, 1)
}

/* Returns row y of a side: borrowed from its ids, or in `scratch`. */
static const uint32_t *labels_row(const Labels *labels, int side, int y, uint32_t *scratch)
{
    size_t width = (size_t)labels->width, start = (size_t)y * width;
    switch (labels->source) {
    case LABELS_IDS:
        return labels->ids[side]->ids + start;
    case LABELS_BACKGROUND:
        fill_foreground(labels, side, y, scratch);
        return scratch;
    case LABELS_GIVEN:
        for (size_t x = 0; x < width; x++)
            scratch[x] = labels->given[side][start + x];
        return scratch;
    case LABELS_UNKNOWN:
        break;
    }
    memset(scratch, 0, width * sizeof *scratch);
    return scratch;
}

PixelClass labels_class(uint32_t a, uint32_t b, bool band)
{
    return band ? PIXEL_EDGE : b == 0 ? PIXEL_MISSING : a == 0 ? PIXEL_EXTRA : PIXEL_WRONG_SEGMENT;
}

/* -------------------------------------------------------------------------------------- window */

/* A pixel's class depends on its row and the rows above and below. */
enum { WINDOW_ROWS = 3 };

size_t label_window_size(int width)
{
    size_t bytes = (size_t)width * (2 * WINDOW_ROWS * sizeof(uint32_t) + WINDOW_ROWS + 1);
    return (bytes + 3) / 4 * 4;
}

/* Sets uniform[x] to 1 if the label is equal to those at the left and the right, in both images. */
static void fill_uniform(const uint32_t *restrict a, const uint32_t *restrict b,
                         uint8_t *restrict uniform, size_t width)
{
    size_t last = width - 1, second = width > 1, before = last - second;
    for (size_t x = 1; x < last; x++)
        uniform[x] = (uint8_t)((a[x - 1] == a[x]) & (a[x] == a[x + 1]) & (b[x - 1] == b[x]) &
                               (b[x] == b[x + 1]));
    uniform[0] = a[0] == a[second] && b[0] == b[second];
    uniform[last] = a[before] == a[last] && b[before] == b[last];
}

/* Loads row y, or the nearest one of the image, into slot 0, 1 or 2. A row that is equal in both
 * pictures is computed once. */
static void load_row(LabelWindow *window, int slot, int y)
{
    const Labels *labels = window->labels;
    int row = y < 0 ? 0 : y < labels->height ? y : labels->height - 1;
    window->rows[0][slot] = labels_row(labels, 0, row, window->scratch[0][slot]);
    bool shared =
        labels->source == LABELS_BACKGROUND &&
        memcmp(labels->background[0], labels->background[1], sizeof labels->background[0]) == 0 &&
        picture_rows_equal(labels->pictures[0], labels->pictures[1], row, 0, labels->width);
    window->rows[1][slot] =
        shared ? window->rows[0][slot] : labels_row(labels, 1, row, window->scratch[1][slot]);
    fill_uniform(window->rows[0][slot], window->rows[1][slot], window->uniform[slot],
                 (size_t)labels->width);
}

/* Sets band[x] to 1 for the pixels of the middle row that are at an edge. */
static void fill_band(const LabelWindow *window)
{
    const uint32_t *const *a = window->rows[0], *const *b = window->rows[1];
    uint8_t *const *uniform = window->uniform;
    uint8_t *band = window->band;
    size_t width = (size_t)window->labels->width;
    for (size_t x = 0; x < width; x++) {
        unsigned level = (a[0][x] == a[1][x]) & (a[2][x] == a[1][x]) & (b[0][x] == b[1][x]) &
                         (b[2][x] == b[1][x]);
        band[x] = (uint8_t)(1 ^ (level & uniform[0][x] & uniform[1][x] & uniform[2][x]));
    }
}

void label_window_open(LabelWindow *window, const Labels *labels, int y, void *scratch)
{
    *window = (LabelWindow){.labels = labels, .y = y};
    uint32_t *next = scratch;
    for (int side = 0; side < 2; side++)
        for (int slot = 0; slot < WINDOW_ROWS; slot++, next += labels->width)
            window->scratch[side][slot] = next;
    uint8_t *bytes = (uint8_t *)next;
    for (int slot = 0; slot < WINDOW_ROWS; slot++, bytes += labels->width)
        window->uniform[slot] = bytes;
    window->band = bytes;
    for (int slot = 0; slot < WINDOW_ROWS; slot++)
        load_row(window, slot, y - 1 + slot);
    fill_band(window);
}

void label_window_next(LabelWindow *window)
{
    uint8_t *first = window->uniform[0];
    for (int slot = 0; slot + 1 < WINDOW_ROWS; slot++)
        window->uniform[slot] = window->uniform[slot + 1];
    window->uniform[WINDOW_ROWS - 1] = first;
    for (int side = 0; side < 2; side++) {
        uint32_t *scratch = window->scratch[side][0];
        for (int slot = 0; slot + 1 < WINDOW_ROWS; slot++) {
            window->rows[side][slot] = window->rows[side][slot + 1];
            window->scratch[side][slot] = window->scratch[side][slot + 1];
        }
        window->scratch[side][WINDOW_ROWS - 1] = scratch;
    }
    window->y++;
    load_row(window, WINDOW_ROWS - 1, window->y + 1);
    fill_band(window);
}
