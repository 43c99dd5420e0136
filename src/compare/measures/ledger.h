/* Sums over the pixels of each segment, from which the ledger is made. All sums are integers of
 * codes, so that the result does not depend on the order of adding. Private to the module compare.
 */
#ifndef CORCAST_COMPARE_MEASURES_LEDGER_H
#define CORCAST_COMPARE_MEASURES_LEDGER_H

#include "compare/measures/labels.h"

/* Sums over the pixels of a segment: integers of 64 bits alone, so that they are added as an array.
 * Index 0 is A, index 1 is B. */
typedef struct SegmentTotals {
    uint64_t area[2], edges[2]; /* pixels; sides of pixels that border on something else */
    uint64_t common, differing;
    int64_t signed_codes[3]; /* B - A over common pixels */
    uint64_t squares;        /* of a, all channels */
    int64_t products;        /* a (b - a), all channels */
} SegmentTotals;

/* What is known about one segment. */
typedef struct SegmentSums {
    SegmentTotals total;
    int max_code;
    int left, top, right, bottom; /* right < left: empty */
} SegmentSums;

/* Indices of the ids that occur in either plane. */
typedef struct SegmentIndex {
    uint32_t *of_id; /* owned; index of each id */
    uint32_t *ids;   /* owned; ascending; the first is 0, the background */
    size_t n;
} SegmentIndex;

MUST_CHECK Status segment_index_init(SegmentIndex *index, const IdPlane *a, const IdPlane *b,
                                     Err *err);
void segment_index_release(SegmentIndex *index);

/* Sets `n` sums to those over no pixel. */
void segment_sums_clear(SegmentSums *segments, size_t n);
/* Adds the middle row of a window over id planes. `a` and `b` are the codes of that row; they are
 * the same pointer if the rows are equal. */
void segment_sums_add_row(SegmentSums *segments, const SegmentIndex *index,
                          const LabelWindow *window, const uint16_t *a, const uint16_t *b,
                          int channels);
/* Adds `from` to `to`. */
void segment_sums_add(SegmentSums *to, const SegmentSums *from, size_t n);

/* Makes the ledger, which the caller releases. A code is `code_levels` levels. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status ledger_from_sums(Ledger *ledger, const SegmentIndex *index,
                                   const SegmentSums *segments, int channels, double code_levels,
                                   Err *err);
/* Adds the measures of segments to the result, and the segments that differ most. */
void ledger_summarise(const Ledger *ledger, CompareResult *result);

#endif
