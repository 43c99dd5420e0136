/* What each pixel of two images shows, and where that differs. Private to the module compare. */
#ifndef CORCAST_COMPARE_MEASURES_LABELS_H
#define CORCAST_COMPARE_MEASURES_LABELS_H

#include "compare/result.h"

/* Length of an outline in pixels for each side of a pixel on it: pi / 4, the mean over all
 * directions [Cauchy-Crofton]. */
#define PX_PER_EDGE (PI / 4)

typedef enum LabelSource {
    LABELS_UNKNOWN,
    LABELS_IDS,        /* the ids of id planes */
    LABELS_BACKGROUND, /* 0 for the color of a picture's background, else 1 */
    LABELS_SEEN        /* 0 or 1, set by the caller */
} LabelSource;

/* Labels of the pixels of both images: the id of what a pixel shows, 0 for nothing. Index 0 is A,
 * index 1 is B. Rows are computed when they are used, so that a mask takes no memory. */
typedef struct Labels {
    LabelSource source;
    int width, height;
    const IdPlane *ids[2];      /* borrowed */
    const Picture *pictures[2]; /* borrowed */
    uint16_t background[2][3];
    uint8_t *seen[2]; /* owned; per pixel, filled by the caller */
} Labels;

/* Errors: STATUS_INPUT unless both or neither plane is given, and both have width x height pixels.
 */
MUST_CHECK Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b,
                                   Err *err);
Labels labels_from_ids(const IdPlane *a, const IdPlane *b);
/* A pixel shows something if it has another color than three corners of its picture share. The
 * labels are unknown if either picture has no such color. */
Labels labels_from_background(const Picture *a, const Picture *b);
/* No pixel shows anything; the caller changes `seen`. Release with labels_release. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status labels_init_seen(Labels *labels, int width, int height, Err *err);
void labels_release(Labels *labels);
/* Three rows of both sides, which move down the images. The band are the pixels at edges: they
 * touch (8-neighbours), in either image, a pixel with another label. */
typedef struct LabelWindow {
    const Labels *labels;
    int y;
    const uint32_t *rows[2][3]; /* rows y - 1, y, y + 1; beyond the image the nearest row */
    uint8_t *uniform[3];        /* per row: not 0 if the neighbours left and right are equal */
    uint8_t *band;              /* of row y: 1 in the band, else 0 */
    uint32_t *scratch[2][3];
} LabelWindow;

/* Returns the size of the scratch memory that a window over images of this width needs: bytes, a
 * multiple of 4. The memory is 4-byte aligned. */
size_t label_window_size(int width);
/* Opens the window at row `y`; `scratch` is borrowed. */
void label_window_open(LabelWindow *window, const Labels *labels, int y, void *scratch);
/* Moves it down by one row, which must exist. */
void label_window_next(LabelWindow *window);

/* Returns the class of a pixel whose labels differ. `band` is true in the band. */
PixelClass labels_class(uint32_t a, uint32_t b, bool band);

/* Whether one image alone shows something at a pixel: A (missing) or B (extra). */
typedef enum Coverage { COVERED_ALIKE, COVERED_MISSING, COVERED_EXTRA } Coverage;

/* Pixels that all comparisons count. Those from COUNT_COMMON on need labels. */
typedef enum PixelCount {
    COUNT_DIFFERING,
    COUNT_BEYOND,
    COUNT_SETTLED,
    COUNT_COMMON,
    COUNT_MISSING,
    COUNT_EXTRA,
    COUNT_BAND,
    COUNT_BAND_DIFFERS, /* in the band, with different labels */
    COUNT_BAND_BEYOND,
    COUNT_INTERIOR_BEYOND,
    PIXEL_COUNTS
} PixelCount;

/* Sets the measures that are counts, and those of edges. `labelled` is false if the labels are
 * unknown. */
void counts_take(const uint64_t counts[PIXEL_COUNTS], bool labelled, CompareResult *result);

/* Adds to the result the largest 8-connected region of missing, or of extra, pixels, and the sum of
 * both; the result has their counts. `coverage`, one Coverage per pixel, is cleared. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status region_take(uint8_t *coverage, const Labels *labels, CompareResult *result,
                              Err *err);

#endif
