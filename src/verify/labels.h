/* What each pixel of two images shows, and where that differs; private to the room verify. */
#ifndef CORCAST_VERIFY_LABELS_H
#define CORCAST_VERIFY_LABELS_H

#include "verify/verify.h"

/* For each pixel of either image the id of what is seen, 0 for nothing; ids, or, where only a mask
 * is known, 1. `a` and `b` are NULL when nothing is known. */
typedef struct Labels {
    int width, height;
    const uint32_t *a, *b; /* borrowed from id planes, or in `owned` */
    uint32_t *owned;
} Labels;

/* STATUS_INPUT unless both or neither plane is given, and both are of width x height. */
MUST_CHECK Status labels_check_ids(int width, int height, const IdPlane *a, const IdPlane *b,
                                   Err *err);
void labels_from_ids(Labels *labels, const IdPlane *a, const IdPlane *b);
/* All 0; for the caller to fill `owned`: A's width * height labels, then B's. */
MUST_CHECK Status labels_init(Labels *labels, int width, int height, Err *err);
/* Seen is what differs from the colour that at least three corners of the picture share; unknown
 * when either picture has no such colour. */
MUST_CHECK Status labels_from_background(Labels *labels, const Picture *a, const Picture *b,
                                         Err *err);
void labels_release(Labels *labels);

/* Whether (x, y) touches, in either image, a pixel with another label. */
bool labels_in_band(const Labels *labels, int x, int y);
/* Whether the labels of a pixel differ; if so counts it in its class. `band` is labels_in_band. */
bool labels_classify(const Labels *labels, size_t pixel, bool band, ClassCounts *classes);
/* Fills in what labels alone tell: coverage, regions, the band. */
MUST_CHECK Status labels_measure(const Labels *labels, CompareResult *result, Err *err);

/* Holds the result against its tolerance: rules, agrees, reason. */
void compare_judge(CompareResult *result);

#endif
