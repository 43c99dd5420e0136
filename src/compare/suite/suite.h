/* A folder of pictures compared with a folder of stored ones: a test suite of any renderer's. A
 * case is a picture of the same name in both, below the folders as deep as it may be. */
#ifndef CORCAST_COMPARE_SUITE_SUITE_H
#define CORCAST_COMPARE_SUITE_SUITE_H

#include "base/base.h"

struct Tolerance;

typedef enum SuiteState {
    SUITE_SAME,    /* byte by byte or pixel by pixel */
    SUITE_WITHIN,  /* differs within the tolerance, or where it is masked */
    SUITE_CHANGED, /* by more, or in size */
    SUITE_NEW,     /* has no reference */
    SUITE_MISSING, /* there is a reference only */
    SUITE_BROKEN,  /* one of the files cannot be read */
    SUITE_STATES
} SuiteState;

/* "same", "within", "changed", "new", "missing", "broken"; the last four fail. */
const char *suite_state_name(SuiteState state);

typedef struct SuiteCase {
    char *name; /* owned; the path below the folders */
    bool is_reference, is_picture;
    SuiteState state;
    char sentence[1100]; /* why it fails; "" when it does not */
    size_t differing, pixels, masked;
    double seconds;
} SuiteCase;

typedef struct Suite {
    SuiteCase *cases; /* owned; by name */
    size_t n, capacity;
    size_t count[SUITE_STATES];
    size_t others; /* files that are no pictures by their names, left alone */
    bool agrees;
} Suite;

/* Judges all cases, each by `tolerance`, what is transparent laid on `background`. Beside a
 * reference NAME.png there may be NAME.mask.png, which is not black where nothing is judged. Broken
 * pictures are cases that fail; STATUS_IO when a folder cannot be read, STATUS_INPUT when there is
 * no picture in either, STATUS_MEMORY. */
MUST_CHECK Status suite_judge(Suite *suite, const char *reference, const char *pictures,
                              const struct Tolerance *tolerance, const float background[3],
                              int threads, Err *err);
void suite_release(Suite *suite);

/* Makes the picture of a case its reference, or removes the reference where there is no picture,
 * and appends case, hash of the new file and reason, separated by tabs, to reference/accepted.tsv.
 * STATUS_INPUT when `name` is not the name of a case that suite_judge would list. */
MUST_CHECK Status suite_accept(const char *reference, const char *pictures, const char *name,
                               const char *reason, Err *err);

/* Appends a line for each case that is not the same, and one about all. */
void suite_text(const Suite *suite, Text *out);
/* New reference, NULL when memory runs out. */
json_t *suite_json(const Suite *suite);
/* Appends JUnit XML, a test case for each case. */
void suite_junit(const Suite *suite, const char *name, double seconds, Text *out);

#endif
