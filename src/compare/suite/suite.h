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
    SUITE_EXPIRED, /* the last day of one of its references is over */
    SUITE_BROKEN,  /* a file cannot be read, or the mask does not fit */
    SUITE_STATES
} SuiteState;

/* Returns "same", "within", "changed", "new", "missing", "expired" or "broken". A case in one of
 * the last five states fails. */
const char *suite_state_name(SuiteState state);

/* One picture that is compared with its reference of the same name. */
typedef struct SuiteCase {
    char *name;                    /* path below the folders; owned */
    bool is_reference, is_picture; /* the file is in the folder of references; of pictures */
    SuiteState state;
    char sentence[1100]; /* why the case fails; "" if it passes */
    char *agreed;        /* further reference that the picture agrees with; NULL: none; owned */
    bool is_selected;    /* the case is compared, or accepted */
    bool is_pair;        /* the picture has the size and depth of the reference, and was compared */
    size_t differing, pixels, masked; /* pixels; 0 if none were compared */
    double seconds;                   /* duration of this case */
} SuiteCase;

/* A file of the folder of references that belongs to a case but that no case needed. */
typedef struct Companion {
    char *name;      /* path below the folder; owned */
    const char *why; /* a sentence without its subject */
} Companion;

typedef struct Suite {
    SuiteCase *cases; /* sorted by name; owned */
    size_t n, capacity;
    size_t count[SUITE_STATES];
    Companion *companions; /* unused masks, tolerances and references; owned */
    size_t n_companions, companion_capacity;
    size_t others; /* files with other names, except accepted.tsv */
    bool agrees;   /* no case fails */
} Suite;

/* The folders of a suite, and how their pictures are compared. All members are borrowed. */
typedef struct SuiteFolders {
    const char *reference, *pictures;
    const char *only;  /* pattern of the cases that are compared; NULL: all cases */
    bool is_accepting; /* the folder of references need not exist */
    const Tolerance *tolerance;
    const Tolerance *case_tolerance; /* limits that the tolerance file of a case starts from */
    const float *background; /* red, green and blue in linear light, 0..1; transparent pixels are
                              * composited over it */
} SuiteFolders;

/* Compares all cases with their references. Files beside a reference NAME.png change how its case
 * is judged:
 *
 *   NAME.mask.png         pixels that are not black in it are not compared
 *   NAME.tolerance.ini    limits of this case (tolerance_read)
 *   NAME.references.ini   further references NAME.ref-LABEL.png, each with a reason, a machine and
 *                         a last day; the case passes if its picture agrees with any of them, and
 *                         fails when the last day of any of them is over
 *
 * suite     is set on success; release it with suite_release.
 * threads   0: all processors.
 * Errors    STATUS_IO if a folder cannot be read; STATUS_INPUT if neither folder has a picture that
 *           is to be compared; STATUS_MEMORY. A file that cannot be read is a failed case, not an
 *           error. */
MUST_CHECK Status suite_judge(Suite *suite, const SuiteFolders *folders, int threads, Err *err);
void suite_release(Suite *suite);

/* Which pictures become references, and as what. All strings are borrowed. */
typedef struct Acceptance {
    const char *cases;  /* a name, or names and wildcards separated by commas, or "all" */
    const char *reason; /* stored with the reference */
    const char *label;  /* the picture becomes the further reference NAME.ref-LABEL; NULL: it
                         * replaces  the reference */
    const char *machine, *expires; /* stored with the reference; NULL: not stored */
} Acceptance;

/* Accepts cases: copies their pictures over their references, or removes a reference that has no
 * picture, and removes expired further references. A case that is named is always accepted; of the
 * cases that a wildcard or "all" selects, those that fail. Appends a line per file to
 * reference/accepted.tsv: file, hash of the new file (SHA-256, or "removed") and the reason,
 * separated by tabs.
 *
 * out      receives a line per accepted case.
 * Errors   STATUS_INPUT if a name or wildcard selects no case, if a case is broken, and if a label
 *          or date is malformed; nothing is accepted then. STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_accept(const SuiteFolders *folders, const Acceptance *acceptance,
                               int threads, Text *out, Err *err);

/* Appends a line for each case that is not SUITE_SAME, and a line of totals. `out` fails if memory
 * runs out. */
void suite_text(const Suite *suite, Text *out);
/* Returns the suite as JSON. The caller releases it. Returns NULL if memory runs out. */
json_t *suite_json(const Suite *suite);
/* Appends the shell command that accepts a case; the user completes the reason. */
void suite_accept_command(const SuiteFolders *folders, const SuiteCase *entry, Text *out);
/* Appends the suite as JUnit XML, one test case for each case. */
void suite_junit(const Suite *suite, const char *name, double seconds, Text *out);

#endif
