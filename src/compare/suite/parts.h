/* The steps of suite_judge and suite_accept: list the cases, compare them, find unused files. Also
 * reads the files and pictures of one case. Private to the module compare. */
#ifndef CORCAST_COMPARE_SUITE_PARTS_H
#define CORCAST_COMPARE_SUITE_PARTS_H

#include "compare/suite/suite.h"

/* Returns true if `pattern` selects the case `name`. A pattern is one or more names, separated by
 * commas. A name may contain the wildcards * ? [...]; '*' also matches '/'. "all" and NULL select
 * every case. */
bool suite_selects(const char *pattern, const char *name);
/* Checks that each part of a pattern selects a case of the suite. Errors: STATUS_INPUT, which names
 * the part. */
MUST_CHECK Status suite_check_pattern(const Suite *suite, const SuiteFolders *folders,
                                      const char *pattern, Err *err);
/* Lists the cases of both folders in suite->cases, sorted by name. Lists only cases that are
 * selected by the pattern folders->only. Lists in suite->companions the files that accompany a
 * reference NAME.png: masks, tolerance files, lists of references, and further references, any of
 * which a picture may match instead of NAME.png [suite.h].
 *
 * suite    zeroed before; release it with suite_release even after an error.
 * Errors   STATUS_IO if a folder cannot be read; STATUS_INPUT for more than 1,000,000 pictures,
 *          because links can repeat a folder without end; STATUS_MEMORY. */
MUST_CHECK Status suite_list(Suite *suite, const SuiteFolders *folders, Err *err);
/* Reduces suite->companions to the unused files. Removes from the list the files that a case of
 * this run needed. Sets Companion.why of the remaining files: the reason why a file is unused.
 *
 * only  the pattern by which suite_list listed the cases; NULL: all cases were listed. With a
 *       pattern, files that belong to no listed case are removed from the list, too. */
void suite_find_unused(Suite *suite, const char *only);
/* Compares the cases whose SuiteCase.is_selected is true; the caller sets it. Sets state, sentence
 * and seconds of these cases. A case has the state SUITE_BROKEN, and an error sentence, if one of
 * its files cannot be read or if memory runs out. `threads` is the maximum number of threads; 0:
 * all processors. */
void suite_judge_selected(Suite *suite, const SuiteFolders *folders, int threads);

/* A reference (index 0) and a picture (index 1) in memory. Zero before suite_pair_read. */
typedef struct SuitePair {
    Image images[2];
    Picture alphas[2]; /* zeroed if the image is opaque */
    size_t masked;     /* number of pixels that are not compared */
} SuitePair;

/* Reads a reference and a picture. Copies the masked pixels of the reference into the picture, so
 * that they do not differ.
 *
 * pair        release it with suite_pair_release even after an error.
 * paths       paths of the reference and of the picture.
 * mask        path of the mask; NULL, or no such file: nothing is masked.
 * background  red, green and blue in linear light; transparent pixels are composited over it.
 * Errors      STATUS_INPUT for a malformed file, and for a mask that has another size than the
 *             pictures or hides every pixel; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_pair_read(SuitePair *pair, const char *const paths[2], const char *mask,
                                  const float background[3], Err *err);
void suite_pair_release(SuitePair *pair);
/* Compares the two pictures of a pair. `result` borrows the tolerance. Errors: those of
 * compare_pictures. */
MUST_CHECK Status suite_pair_compare(const SuitePair *pair, const Tolerance *tolerance,
                                     CompareResult *result, Err *err);
/* The files of a case. Zero before suite_files_find. */
typedef struct SuiteFiles {
    char *reference, *picture, *mask; /* paths; owned */
    Tolerance tolerance;              /* set by suite_files_tolerance */
    char *tolerance_name;             /* borrowed by `tolerance`; owned */
} SuiteFiles;

/* Sets the paths of the files of a case. The files need not exist. Release *files with
 * suite_files_release even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status suite_files_find(const SuiteFolders *folders, const SuiteCase *entry,
                                   SuiteFiles *files, Err *err);
/* Sets files->tolerance and files->tolerance_name. Without a tolerance file beside the reference,
 * the tolerance is folders->tolerance. With a tolerance file, the tolerance is
 * folders->case_tolerance, except for the limits that the file states. Errors: those of
 * tolerance_read: STATUS_INPUT, STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status suite_files_tolerance(const SuiteFolders *folders, SuiteFiles *files, Err *err);
void suite_files_release(SuiteFiles *files);

#endif
