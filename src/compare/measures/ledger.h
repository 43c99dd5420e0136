/* Sums, for each segment, the differences between the pixels of the images A and B, and makes the
 * Ledger [result.h], the table of segments, from the sums. All sums are integers of codes, so the
 * result does not depend on the order of summation. Private to the module compare.
 *
 * Make a SegmentIndex of both id planes. Clear one array of SegmentSums per thread, add rows to the
 * arrays, and add the arrays. Then call ledger_from_sums and result_set_segments. */
#ifndef CORCAST_COMPARE_MEASURES_LEDGER_H
#define CORCAST_COMPARE_MEASURES_LEDGER_H

#include "compare/measures/labels.h"

/* Sums over the pixels of a segment. All members are integers of 64 bits, so that add_integers can
 * add them as an array. Index 0 is A, index 1 is B; a and b are codes of A and B. */
typedef struct SegmentTotals {
    uint64_t area[2];        /* number of pixels that show the segment */
    uint64_t edges[2];       /* number of pixel sides between the segment and another label */
    uint64_t common;         /* number of pixels that show the segment in both images */
    uint64_t differing;      /* number of pixels that show the segment in A or B, and differ */
    int64_t signed_codes[3]; /* per channel: sum of b - a over common pixels */
    uint64_t squares;        /* sum of a^2 over common pixels and all channels */
    int64_t products;        /* sum of a (b - a) over common pixels and all channels */
} SegmentTotals;

/* Everything that is summed over one segment. */
typedef struct SegmentSums {
    SegmentTotals total;
    int max_code;                 /* largest |b - a| of a common pixel */
    int left, top, right, bottom; /* bounding box in both images, inclusive; right < left: empty */
} SegmentSums;

/* Maps the ids that occur in either plane to indices: index 0 is the background, then ids ascend.
 */
typedef struct SegmentIndex {
    uint32_t *of_id; /* of_id[id]: index of the id; owned */
    uint32_t *ids;   /* ids[index]; owned */
    size_t n;        /* number of indices, with the background */
} SegmentIndex;

/* Makes the index of two id planes of one size. Release it with segment_index_release. `index` is
 * set on success only. Errors: STATUS_MEMORY. */
MUST_CHECK Status segment_index_init(SegmentIndex *index, const IdPlane *a, const IdPlane *b,
                                     Err *err);
void segment_index_release(SegmentIndex *index);

/* Sets `n` sums to the sums over no pixel. */
void segment_sums_clear(SegmentSums *segments, size_t n);
/* Adds the middle row of a window over id planes to the sums, which are ordered by `index`. `a` and
 * `b` are the codes of this row. The caller may pass one pointer twice if the rows are equal, which
 * saves time. */
void segment_sums_add_row(SegmentSums *segments, const SegmentIndex *index,
                          const LabelWindow *window, const uint16_t *a, const uint16_t *b,
                          int channels);
/* Adds `n` sums `from` to the `n` sums `to`. */
void segment_sums_add(SegmentSums *to, const SegmentSums *from, size_t n);

/* Makes the ledger of all segments, without the background. Release it with ledger_release.
 *
 * code_levels   levels per code: 1 for 8-bit codes, 1/257 for 16-bit codes.
 * ledger        set on success only.
 * Errors        STATUS_MEMORY. */
MUST_CHECK Status ledger_from_sums(Ledger *ledger, const SegmentIndex *index,
                                   const SegmentSums *segments, int channels, double code_levels,
                                   Err *err);
/* Sets the measures of segments, the pixels PLACE_SEGMENT_... that show them, and the list of the
 * segments that differ most. */
void result_set_segments(const Ledger *ledger, CompareResult *result);

#endif
