/* Sums over the pixels of each segment, from which the ledger is made; private to the room compare.
 * All are whole numbers of codes, so that the sums of parts of the images add up to the same in any
 * order. */
#ifndef CORCAST_COMPARE_MEASURES_LEDGER_H
#define CORCAST_COMPARE_MEASURES_LEDGER_H

#include "compare/measures/labels.h"

/* Of one segment; A before B. */
typedef struct SegmentSums {
    uint64_t area[2], edges[2]; /* pixels; sides of pixels that border on something else */
    uint64_t common, differing;
    int64_t signed_codes[3]; /* B - A over common pixels */
    uint64_t squares;        /* a a, and ... */
    int64_t products;        /* ... a (b - a), all channels */
    int max_code;
    int left, top, right, bottom; /* right < left: empty */
} SegmentSums;

/* Numbers the ids that occur in either plane. */
typedef struct SegmentIndex {
    uint32_t *of_id; /* owned; from id to number */
    uint32_t *ids;   /* owned; from number to id, ascending; the first is 0, the background */
    size_t n;
} SegmentIndex;

MUST_CHECK Status segment_index_init(SegmentIndex *index, const IdPlane *a, const IdPlane *b,
                                     Err *err);
void segment_index_release(SegmentIndex *index);

/* Sums over no pixels. */
void segment_sums_clear(SegmentSums *segments, size_t n);
/* Adds row y of a window over id planes; the codes of that row are `a` and `b`, which are the same
 * pointer where the rows are equal. */
void segment_sums_add_row(SegmentSums *segments, const SegmentIndex *index,
                          const LabelWindow *window, const uint16_t *a, const uint16_t *b,
                          int channels);
/* Adds `from` to `to`. */
void segment_sums_add(SegmentSums *to, const SegmentSums *from, size_t n);

/* Makes the ledger (owned) from the sums; a code is `code_levels` 8-bit levels. */
MUST_CHECK Status ledger_from_sums(Ledger *ledger, const SegmentIndex *index,
                                   const SegmentSums *segments, int channels, double code_levels,
                                   Err *err);
/* Fills in the measures of segments in the result: how many there are, those that only one image
 * shows, the ones that differ most. */
void ledger_summarise(const Ledger *ledger, CompareResult *result);

#endif
