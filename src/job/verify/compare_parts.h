/* The parts of the operation `compare`: the two sides, the noise test, and the grading by answers.
 * Private to the files compare*.c. */
#ifndef CORCAST_JOB_VERIFY_COMPARE_PARTS_H
#define CORCAST_JOB_VERIFY_COMPARE_PARTS_H

#include "job/verify/compare.h"

/* Reads or copies both images and their ids, composites transparent images over
 * options->background, and converts them so that they have one encoding and one number of bits.
 *
 * sides   zeroed before; the caller releases them even after an error.
 * Errors  STATUS_INPUT if a file is bad, or one image holds floats and the other integers;
 *         STATUS_IO; STATUS_MEMORY. If several files fail, the error is that of the first. */
MUST_CHECK Status sides_read(const CompareOptions *options, const Parsed *parsed, PlaneKind plane,
                             ComparedSide sides[2], Err *err);
void sides_release(ComparedSide sides[2]);

/* Sends a note if the file of an image is lossy, so that its colors changed before the comparison.
 */
void compare_note_loss(const char *name, const Image *image, const Talk *talk);

/* Returns the image of a side as sRGB; borrowed. */
const Picture *side_shown(const ComparedSide *side);

/* Tests whether two noisy images, the operands, have the same mean. Errors: STATUS_USAGE if --noise
 * names fewer than 2 or more than 64 files; STATUS_INPUT if a file is bad; the errors of
 * compare_noise; STATUS_MEMORY. */
MUST_CHECK Status compare_noisy(const CompareOptions *options, const Parsed *parsed,
                                NoiseResult *result, Err *err);
/* Appends the result as a line of text. */
void noise_text(const NoiseResult *result, Text *out);
/* Returns the result as JSON: a new reference; NULL if memory runs out. */
json_t *noise_json(const NoiseResult *result);

/* Grades image B by the answer A, or checks the answers A and B against each other. Sets
 * made->kind, made->grade, made->agrees and, with options->heat, made->distances. Errors:
 * STATUS_USAGE for an option without effect; STATUS_INPUT if sizes, scenes or patterns differ, or a
 * file is bad; STATUS_MEMORY. */
MUST_CHECK Status compare_answer(const CompareOptions *options, const Parsed *parsed,
                                 Comparison *made, Err *err);
/* Writes made->distances as a picture to the file `path`. Errors: STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status compare_write_distances(const char *path, const Comparison *made, Err *err);

#endif
