/* Regression test of a renderer: compares a folder of pictures with a folder of reference pictures.
 * A case is the file name of a picture, with its path below the folder; subfolders of any depth are
 * read. */
#ifndef CORCAST_COMPARE_SUITE_SUITE_H
#define CORCAST_COMPARE_SUITE_SUITE_H

#include "compare/result.h"

typedef enum SuiteState {
    SUITE_SAME,    /* same bytes, or same pixels without a mask */
    SUITE_WITHIN,  /* within the tolerance, or differs only under the mask */
    SUITE_CHANGED, /* beyond the tolerance, or another size or depth */
    SUITE_NEW,     /* there is no reference */
    SUITE_MISSING, /* there is only a reference */
    SUITE_BROKEN,  /* a file cannot be read, or the mask does not fit */
    SUITE_STATES
} SuiteState;

/* Returns "same", "within", "changed", "new", "missing" or "broken". A case in one of the last four
 * states fails. */
const char *suite_state_name(SuiteState state);

/* One picture that is compared with its reference of the same name. */
typedef struct SuiteCase {
    char *name;                    /* path below the folders; owned */
    bool is_reference, is_picture; /* the file is in the folder of references; of pictures */
    SuiteState state;
    char sentence[1100];              /* why the case fails; "" if it passes */
    size_t differing, pixels, masked; /* pixels; 0 if none were compared */
    double seconds;                   /* duration of this case */
} SuiteCase;

typedef struct Suite {
    SuiteCase *cases; /* sorted by name; owned */
    size_t n, capacity;
    size_t count[SUITE_STATES];
    size_t others; /* files whose names are not those of pictures, masks or accepted.tsv */
    bool agrees;   /* no case fails */
} Suite;

/* The folders of a suite, and how their pictures are compared. All members are borrowed. */
typedef struct SuiteFolders {
    const char *reference, *pictures;
    const Tolerance *tolerance;
    const float *background; /* red, green and blue in linear light, 0..1; transparent pixels are
                              * composited over it */
} SuiteFolders;

/* Compares all cases with their references. If a reference NAME.png has a mask, NAME.mask.png
 * beside it, pixels that are not black in the mask are not compared.
 *
 * suite     is set on success; release it with suite_release.
 * threads   0: all processors.
 * Errors    STATUS_IO if a folder cannot be read; STATUS_INPUT if neither folder has a picture;
 *           STATUS_MEMORY. A file that cannot be read is a failed case, not an error. */
MUST_CHECK Status suite_judge(Suite *suite, const SuiteFolders *folders, int threads, Err *err);
void suite_release(Suite *suite);

/* Accepts a case: copies its picture over its reference, or removes the reference if there is no
 * picture. Appends a line to reference/accepted.tsv: case, hash of the new file (SHA-256, or
 * "removed") and `reason`, separated by tabs. Errors: STATUS_INPUT if there is no such case;
 * STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_accept(const char *reference, const char *pictures, const char *name,
                               const char *reason, Err *err);

/* Appends a line for each case that is not SUITE_SAME, and a line of totals. `out` fails if memory
 * runs out. */
void suite_text(const Suite *suite, Text *out);
/* Returns the suite as JSON. The caller releases it. Returns NULL if memory runs out. */
json_t *suite_json(const Suite *suite);
/* Appends the suite as JUnit XML, one test case for each case. */
void suite_junit(const Suite *suite, const char *name, double seconds, Text *out);

#endif
