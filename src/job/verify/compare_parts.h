/* The parts of the operation `compare`: reading both images, the test of noisy images, and grading
 * by answers. Private to the files compare*.c. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_PARTS_H
#define CORCAST_JOB_VERIFY_COMPARE_PARTS_H

#include "job/verify/compare.h"

/* Reads both images and their ids, or copies them from options->given. Composites transparent
 * images over options->background, and converts both to one color encoding and one number of bits.
 *
 * plane   what the files contain: colors, depths, normals or ids.
 * sides   A and B; zeroed before; the caller releases them even after an error.
 * Errors  STATUS_INPUT if a file is malformed, or if only one image has floats; STATUS_IO;
 *         STATUS_MEMORY. If several files fail, the error is that of the first one. */
MUST_CHECK Status sides_read(const CompareOptions *options, const Parsed *parsed, PlaneKind plane,
                             ComparedSide sides[2], Err *err);
void sides_release(ComparedSide sides[2]);

/* Sends a note if the image comes from a file with lossy compression, whose colors changed before
 * the comparison. */
void compare_note_lossy(const char *name, const Image *image, const Talk *talk);

/* Returns the image of a side as sRGB: side->shown if it is set, else side->image.picture.
 * Borrowed. */
const Picture *side_shown(const ComparedSide *side);

/* Tests whether the two operands, which are noisy images, have the same mean. The variance of the
 * noise comes from further renderings (--noise) or from a file (--variance). Errors: STATUS_USAGE
 * if --noise names fewer than 2 or more than 64 files; STATUS_INPUT if a file is malformed or sizes
 * differ; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status compare_noisy(const CompareOptions *options, const Parsed *parsed,
                                NoiseResult *result, Err *err);
/* Appends the result as a line of text. */
void noise_text(const NoiseResult *result, Text *out);
/* Returns the result as JSON: a new reference; NULL if memory runs out. */
json_t *noise_json(const NoiseResult *result);

/* Grades image B by the answer A or, if B is an answer, checks that intervals of A and B overlap.
 * Sets made->kind, made->grade, made->agrees and, with options->heat, made->distances. Errors:
 * STATUS_USAGE for an option without effect; STATUS_INPUT if sizes, scenes or sample patterns
 * differ, or if a file is malformed; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status compare_answer(const CompareOptions *options, const Parsed *parsed,
                                 Comparison *made, Err *err);
/* Writes made->distances as a picture to the file `path`. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_write_distances(const char *path, const Comparison *made, Err *err);

#endif
