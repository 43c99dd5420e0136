/* What each pixel of two images shows, and where that differs; private to the room compare. */
#ifndef CORCAST_COMPARE_MEASURES_LABELS_H
#define CORCAST_COMPARE_MEASURES_LABELS_H

#include "compare/result.h"

/* The length of an outline, in pixels, for each pixel side on it: pi / 4, right on average over all
 * directions [Cauchy-Crofton]. */
#define PX_PER_EDGE (PI / 4)

typedef enum LabelSource {
    LABELS_UNKNOWN,
    LABELS_IDS,        /* the ids of id planes */
    LABELS_BACKGROUND, /* 1 where a picture has not the colour of its background, else 0 */
    LABELS_SEEN        /* 1 where the caller says so, else 0 */
} LabelSource;

/* For each pixel of either image, A then B, the id of what is seen, 0 for nothing. Rows are made
 * when they are asked for, so that a mask takes no memory. */
typedef struct Labels {
    LabelSource source;
    int width, height;
    const IdPlane *ids[2];      /* borrowed */
    const Picture *pictures[2]; /* borrowed */
    uint16_t background[2][3];
    uint8_t *seen[2]; /* owned; one a pixel, for the caller to fill */
} Labels;

/* STATUS_INPUT unless both or neither plane is given, and both are of width x height. */
MUST_CHECK Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b,
                                   Err *err);
Labels labels_from_ids(const IdPlane *a, const IdPlane *b);
/* Seen is what differs from the colour that at least three corners of the picture share; unknown
 * when either picture has no such colour. */
Labels labels_from_background(const Picture *a, const Picture *b);
/* Nothing seen, for the caller to say otherwise in `seen`. */
MUST_CHECK Status labels_init_seen(Labels *labels, int width, int height, Err *err);
void labels_release(Labels *labels);

/* Row y of a side: borrowed from its ids, or in `scratch`, which has room for it. */
const uint32_t *labels_row(const Labels *labels, int side, int y, uint32_t *scratch);
/* Slides down the rows of both sides and tells the pixels of the band: those that touch
 * (8-neighbours), in either image, a pixel with another label. */
typedef struct LabelWindow {
    const Labels *labels;
    int y;
    const uint32_t *rows[2][3]; /* the rows y - 1, y, y + 1; beyond an edge, the last one */
    uint8_t *uniform[3];        /* of each row: not 0 where neither side changes beside a pixel */
    uint8_t *band;              /* of row y: 1 for the pixels of the band, else 0 */
    uint32_t *scratch[2][3];
} LabelWindow;

/* Bytes of scratch memory, 4-byte aligned, that a window over images of this width needs; a
 * multiple of 4. */
size_t label_window_size(int width);
/* Opens the window at row `y`; `scratch` is borrowed. */
void label_window_open(LabelWindow *window, const Labels *labels, int y, void *scratch);
/* Moves it down by one row, which must exist. */
void label_window_next(LabelWindow *window);

/* The class of a pixel whose labels differ. `band` is whether it lies in the band. */
PixelClass labels_class(uint32_t a, uint32_t b, bool band);

/* Of each pixel: whether both images show something or neither does, and which one if not. */
typedef enum Coverage { COVERED_ALIKE, COVERED_MISSING, COVERED_EXTRA } Coverage;

/* Adds to the result the largest 8-connected region of missing, or of extra, pixels, and the sum of
 * both; the result has their counts. `coverage`, one Coverage per pixel, is cleared. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status region_take(uint8_t *coverage, const Labels *labels, CompareResult *result,
                              Err *err);

#endif
