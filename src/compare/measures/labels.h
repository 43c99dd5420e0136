/* Finds the label of each pixel of two images: the id of the visible segment, or 0 for the
 * background. The labels determine the coverage (whether A, B, both or neither show a vessel) and
 * the edges: a pixel is at an edge if one of its 8 neighbours has another label in A or in B. The
 * pixels at edges form the band. Private to the module compare.
 *
 * Make Labels and open a LabelWindow at a row. The window has the labels of three rows, and the
 * edges of the middle row; move it down row by row. Call count_label for each pixel of the middle
 * row, and add the other counts of PixelCount. Then call result_set_counts, and after that
 * result_set_region with the coverage. */
#ifndef CORCAST_COMPARE_MEASURES_LABELS_H
#define CORCAST_COMPARE_MEASURES_LABELS_H

#include "compare/result.h"

/* Ratio of the length of an outline, in pixels, to the number of pixel sides along it. The mean of
 * the ratio over all directions is pi / 4 [Cauchy-Crofton]. */
#define PX_PER_SIDE (PI / 4)

typedef enum LabelSource {
    LABELS_UNKNOWN,    /* all labels are 0 */
    LABELS_IDS,        /* the ids of id planes */
    LABELS_BACKGROUND, /* 0 for the color of a picture's background, else 1 */
    LABELS_GIVEN       /* 0 or 1 in Labels.given, set by the caller */
} LabelSource;

/* The labels of two images of one size. Index 0 is A, index 1 is B. The labels of ids and of
 * backgrounds are computed row by row when they are used, and take no memory. */
typedef struct Labels {
    LabelSource source;
    int width, height;
    const IdPlane *ids[2];      /* LABELS_IDS; borrowed */
    const Picture *pictures[2]; /* LABELS_BACKGROUND; borrowed */
    uint16_t background[2][3];  /* LABELS_BACKGROUND: codes of the background */
    uint8_t *given[2];          /* LABELS_GIVEN: per pixel, 0 or 1; owned */
} Labels;

/* Checks that `a` and `b` are both NULL or both not NULL, and that they have width x height pixels.
 * Errors: STATUS_INPUT. */
MUST_CHECK Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b,
                                   Err *err);
/* Returns the labels of two id planes of one size. The planes must not be NULL. */
Labels labels_from_ids(const IdPlane *a, const IdPlane *b);
/* Returns the labels of two pictures of equal size, channels (1 or 3) and bits. The background is
 * the color that at least three corners of a picture share. The labels are LABELS_UNKNOWN if either
 * picture has no such color. */
Labels labels_from_background(const Picture *a, const Picture *b);
/* Makes labels of the source LABELS_GIVEN that are all 0. The caller changes labels->given, and
 * releases the labels with labels_release. `labels` is set on success only. Errors: STATUS_MEMORY.
 */
MUST_CHECK Status labels_init_given(Labels *labels, int width, int height, Err *err);
void labels_release(Labels *labels);

/* Three rows of labels of both images, and the edges of the middle row. The row pointers point into
 * the scratch memory or the ids. */
typedef struct LabelWindow {
    const Labels *labels; /* borrowed */
    int y;                /* the middle row */
    /* rows[image][k]: the labels of row y - 1 + k. A row outside the image has the labels of the
     * nearest row. */
    const uint32_t *rows[2][3];
    uint8_t *uniform[3]; /* uniform[k][x]: 1 if pixel x of row y - 1 + k has the same label as its
                          * left and its right neighbour, in both images; else 0 */
    uint8_t *band;       /* band[x]: 1 if pixel x of row y is at an edge; else 0 */
    uint32_t *scratch[2][3];
} LabelWindow;

/* Returns the bytes of scratch memory that a window over images of this width needs, a multiple
 * of 4. The memory must be 4-byte aligned. */
size_t label_window_size(int width);
/* Opens the window at row `y`. `scratch` is borrowed until the last use of the window. */
void label_window_open(LabelWindow *window, const Labels *labels, int y, void *scratch);
/* Moves the window down to row y + 1, which must exist. */
void label_window_next(LabelWindow *window);

/* Returns the class of a pixel whose labels differ. `band` is true if the pixel is at an edge. */
PixelClass labels_class(uint32_t a, uint32_t b, bool band);

/* The images that show a vessel at a pixel. */
typedef enum Coverage {
    COVERED_ALIKE,   /* both or neither */
    COVERED_MISSING, /* only A */
    COVERED_EXTRA    /* only B */
} Coverage;

/* Counts of pixels. The counts from COUNT_COMMON on need labels. count_label computes the counts
 * that its comment lists; the caller computes the others.
 *
 * A pixel is settled if A is known to be wrong there [Tolerance.settled]. A pixel is beyond the
 * tolerance if it is not settled, and differs by more than the tolerance allows for one pixel. */
typedef enum PixelCount {
    COUNT_DIFFERING,
    COUNT_BEYOND,
    COUNT_SETTLED,
    COUNT_COMMON,       /* show a vessel in both images */
    COUNT_MISSING,      /* show a vessel in A only, and are not settled */
    COUNT_EXTRA,        /* show a vessel in B only, and are not settled */
    COUNT_BAND,         /* at edges */
    COUNT_BAND_DIFFERS, /* at edges, with different labels */
    COUNT_BAND_BEYOND,
    COUNT_INTERIOR_BEYOND, /* not at edges */
    PIXEL_COUNTS
} PixelCount;

/* The labels of a pixel, for count_label. */
typedef struct LabelPair {
    uint32_t a, b;
    bool band, settled;
} LabelPair;

/* Adds a pixel to the counts that depend on its labels: COUNT_SETTLED, COUNT_COMMON, COUNT_MISSING,
 * COUNT_EXTRA, COUNT_BAND and COUNT_BAND_DIFFERS. Sets coverage[pixel] if the pixel is missing or
 * extra, and not settled; the caller has zeroed `coverage`. */
static inline void count_label(LabelPair labels, size_t pixel, uint8_t *coverage,
                               uint64_t counts[PIXEL_COUNTS])
{
    const bool in_a = labels.a != 0, in_b = labels.b != 0;
    if (in_a != in_b && !labels.settled) {
        coverage[pixel] = in_a ? COVERED_MISSING : COVERED_EXTRA;
        counts[COUNT_MISSING] += in_a;
        counts[COUNT_EXTRA] += in_b;
    }
    counts[COUNT_SETTLED] += labels.settled;
    counts[COUNT_COMMON] += in_a && in_b;
    counts[COUNT_BAND] += labels.band;
    counts[COUNT_BAND_DIFFERS] += labels.band && labels.a != labels.b;
}

/* Sets the measures of a result that are computed from counts, including the measures of edges. If
 * `labelled` is false, the labels are unknown, and only the counts before COUNT_COMMON are used. */
void result_set_counts(const uint64_t counts[PIXEL_COUNTS], bool labelled, CompareResult *result);

/* Sets MEASURE_UNCOMMON_PIXELS, MEASURE_LARGEST_REGION and PLACE_REGION. A region is an 8-connected
 * set of pixels that are all missing or all extra. Call result_set_counts first, because
 * MEASURE_UNCOMMON_PIXELS is the sum of its missing and extra pixels.
 *
 * coverage  per pixel: a Coverage. Afterwards all pixels are COVERED_ALIKE.
 * labels    provides the size of the images.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status result_set_region(uint8_t *coverage, const Labels *labels, CompareResult *result,
                                    Err *err);

#endif
