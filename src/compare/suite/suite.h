/* Regression test of a renderer: compares a folder of pictures with a folder of reference pictures.
 * Each path of a picture below one of the folders is a case; subfolders of any depth are read. A
 * pattern is a list of case names, separated by commas, with the wildcards * ? [...]; '*' also
 * matches '/'.
 *
 * suite_judge compares the pictures, and suite_text or suite_json report the result. suite_accept
 * turns pictures into new references. */
#ifndef CORCAST_COMPARE_SUITE_SUITE_H
#define CORCAST_COMPARE_SUITE_SUITE_H

#include "compare/result.h"

typedef enum SuiteState {
    SUITE_SAME,    /* the files have the same bytes, or all pixels are equal and none is masked */
    SUITE_WITHIN,  /* the differences are within the tolerance, or pixels are masked */
    SUITE_CHANGED, /* the differences exceed the tolerance, or size or bit depth differ */
    SUITE_NEW,     /* there is no reference */
    SUITE_MISSING, /* there is only a reference */
    SUITE_EXPIRED, /* the last day of one of its references [suite_judge] has passed */
    SUITE_BROKEN,  /* a file cannot be read, or the mask does not fit */
    SUITE_STATES
} SuiteState;

/* Returns "same", "within", "changed", "new", "missing", "expired" or "broken". A case in one of
 * the last five states fails. */
const char *suite_state_name(SuiteState state);

/* One case: a picture, and its reference of the same name. */
typedef struct SuiteCase {
    char *name; /* path below the folders; owned */
    /* the folder of references has the file; the folder of pictures has the file */
    bool is_reference, is_picture;
    SuiteState state;
    char sentence[1100]; /* why the case fails; "" if it passes */
    char *agreed;     /* file name of the further reference that the picture agrees with; NULL: it
                       * agrees with the main reference, or with none; owned */
    bool is_selected; /* the pattern of the run selects the case */
    bool is_pair;     /* the picture has the size and depth of the reference, and was compared */
    /* Counts of pixels that differ, of all pixels and of masked pixels; 0 unless is_pair. */
    size_t differing, pixels, masked;
    double seconds; /* duration of this case */
} SuiteCase;

/* A mask, a tolerance file, a list of references or a further reference that no case needed. */
typedef struct Companion {
    char *name;      /* path below the folder of references; owned */
    const char *why; /* why no case needed it: "no picture has this name" */
} Companion;

typedef struct Suite {
    SuiteCase *cases; /* sorted by name; owned */
    size_t n, capacity;
    size_t count[SUITE_STATES];  /* number of cases in each state */
    ARRAY(Companion) companions; /* unused files; owned */
    size_t others; /* number of files that are neither pictures nor belong to a case; accepted.tsv
                    * is not counted */
    bool agrees;   /* no case fails */
} Suite;

/* The folders of a suite, and how their pictures are compared. All members are borrowed. */
typedef struct SuiteFolders {
    const char *reference, *pictures;
    const char *only;                /* pattern of the cases that are compared; NULL: all cases */
    bool is_accepting;               /* the folder of references need not exist */
    const Tolerance *tolerance;      /* tolerance of cases without a tolerance file */
    const Tolerance *case_tolerance; /* tolerance that a case with a tolerance file starts from; the
                                      * file replaces some of its limits */
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
 * suite     release it with suite_release.
 * threads   0: all processors.
 * Errors    STATUS_IO if a folder cannot be read; STATUS_INPUT if neither folder has a picture that
 *           is to be compared; STATUS_MEMORY. A file that cannot be read is a failed case, not an
 *           error. */
MUST_CHECK Status suite_judge(Suite *suite, const SuiteFolders *folders, int threads, Err *err);
void suite_release(Suite *suite);

/* The pictures that become references, and the facts stored with them. All strings are borrowed. */
typedef struct Acceptance {
    const char *cases;  /* pattern of cases, as SuiteFolders.only; "all" selects all */
    const char *reason; /* why the pictures are accepted */
    const char *label;  /* the picture becomes the further reference NAME.ref-LABEL; NULL: it
                         * replaces the reference */
    /* machine that drew the pictures, and last day of the reference ("2027-03-01" or "never"), for
     * NAME.references.ini; both NULL: no entry there */
    const char *machine, *expires;
} Acceptance;

/* Turns pictures into the new references of their cases. A name without wildcards accepts its case,
 * even if it passes. A wildcard or "all" accepts the selected cases that fail.
 *
 * For an accepted case, copies its picture over its reference or, with a label, to a further
 * reference. Removes a reference that has no picture. Removes expired further references of the
 * case. Appends a line per file to reference/accepted.tsv: the file, the SHA-256 of the new file or
 * "removed", and the reason, separated by tabs.
 *
 * out     receives a line per accepted case, or a line that no case had to be accepted.
 * Errors  STATUS_INPUT, before any file is changed, in these cases: a name or wildcard selects no
 *         case; a wildcard selects a broken case; a case that gets a label lacks its reference or
 *         its picture; a label or date is malformed. STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_accept(const SuiteFolders *folders, const Acceptance *acceptance,
                               int threads, Text *out, Err *err);

/* Appends a line for each case that is not SUITE_SAME, a line for each unused file, and a line of
 * totals. If memory runs out, `out` records it. */
void suite_text(const Suite *suite, Text *out);
/* Returns the suite as JSON: a new reference; NULL if memory runs out. */
json_t *suite_json(const Suite *suite);
/* Appends the shell command that accepts a case. Its reason is '...', for the user to replace. */
void suite_accept_command(const SuiteFolders *folders, const SuiteCase *entry, Text *out);
/* Appends the suite as a JUnit test suite `name` in XML, with one test case for each case.
 * `seconds` is the duration of the run. */
void suite_junit(const Suite *suite, const char *name, double seconds, Text *out);

#endif
