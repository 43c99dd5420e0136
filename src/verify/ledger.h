/* The account of each segment while two images are walked; private to the room verify. Everything
 * is kept in whole codes, so that accounts of parts of the images add up to the same in any
 * order. */
#ifndef CORCAST_VERIFY_LEDGER_H
#define CORCAST_VERIFY_LEDGER_H

#include "verify/labels.h"

typedef struct Account {
    uint64_t area[2], edges[2]; /* pixels; sides of pixels that border on something else */
    uint64_t common, differing;
    int64_t signed_codes[3]; /* B - A over common pixels */
    uint64_t squares;        /* a a, and ... */
    int64_t products;        /* ... a (b - a), all channels */
    int max_code;
    int left, top, right, bottom; /* right < left: empty */
} Account;

/* Which account a segment has. */
typedef struct SegmentIndex {
    uint32_t *of_id; /* owned; from id to account number */
    uint32_t *ids;   /* owned; from account number to id, ascending; the first is 0 */
    size_t n;
} SegmentIndex;

MUST_CHECK Status segment_index_init(SegmentIndex *index, const IdPlane *a, const IdPlane *b,
                                     Err *err);
void segment_index_release(SegmentIndex *index);

/* Accounts without pixels. */
void accounts_clear(Account *accounts, size_t n);
/* Books row y of a window over id planes; the codes of that row are `a` and `b`, which are the same
 * pointer where the rows are equal. */
void accounts_book(Account *accounts, const SegmentIndex *index, const LabelWindow *window,
                   const uint16_t *a, const uint16_t *b, int channels);
/* Adds `from` to `to`. */
void accounts_add(Account *to, const Account *from, size_t n);

/* The ledger that the accounts make; a code is `code_levels` 8-bit levels. */
MUST_CHECK Status ledger_from_accounts(Ledger *ledger, const SegmentIndex *index,
                                       const Account *accounts, int channels, double code_levels,
                                       Err *err);
/* Fills in what the result says of segments. */
void ledger_summarise(const Ledger *ledger, CompareResult *result);

#endif
