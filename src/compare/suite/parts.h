/* The parts of a suite that its files share. Private to the module compare. */
#ifndef CORCAST_COMPARE_SUITE_PARTS_H
#define CORCAST_COMPARE_SUITE_PARTS_H

#include "compare/suite/suite.h"

/* Returns true if `pattern` selects the case `name`. A pattern is a name, "all", or names and
 * wildcards (* ? [...]) separated by commas; '*' also stands for '/'. NULL selects all. */
bool suite_selects(const char *pattern, const char *name);
/* Lists the cases of both folders by name, and the files that belong to cases. */
MUST_CHECK Status suite_list(Suite *suite, const SuiteFolders *folders, Err *err);
/* Removes the files that this run needed from suite->companions. */
void suite_find_unused(Suite *suite, const char *only);
/* Compares the cases of a listed suite that are selected, and sets their states. */
void suite_judge_selected(Suite *suite, const SuiteFolders *folders, int threads);

/* A reference and a picture in memory. Zero before suite_pair_read. */
typedef struct SuitePair {
    Image images[2];
    Picture alphas[2]; /* empty where the image is opaque */
    size_t masked;     /* pixels */
} SuitePair;

/* Reads a reference and a picture, and gives masked pixels of the picture the reference's codes.
 *
 * paths    of the reference and of the picture.
 * mask     path of the mask; NULL, or no such file: nothing is masked.
 * pair     release it with suite_pair_release, also after an error.
 * Errors   STATUS_INPUT for a bad file, and for a mask that does not fit or hides every pixel;
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status suite_pair_read(SuitePair *pair, const char *const paths[2], const char *mask,
                                  const float background[3], Err *err);
void suite_pair_release(SuitePair *pair);
/* Compares the two pictures of a pair. `result` borrows the tolerance. Errors: those of
 * compare_pictures. */
MUST_CHECK Status suite_pair_compare(const SuitePair *pair, const Tolerance *tolerance,
                                     CompareResult *result, Err *err);
/* Reads the tolerance of the case at `path` of the folder of references: that of the suite, or the
 * limits of its file. `name` receives the name of the tolerance, or stays NULL; the caller frees
 * it. */
MUST_CHECK Status suite_tolerance(const SuiteFolders *folders, const char *path,
                                  Tolerance *tolerance, char **name, Err *err);

#endif
