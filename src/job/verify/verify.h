/* The operation `verify`: draws a tree with POV-Ray and with corcast, and compares the pictures. */
#ifndef CORCAST_JOB_VERIFY_VERIFY_H
#define CORCAST_JOB_VERIFY_VERIFY_H

#include "job/verify/verification.h"
#include "options/options.h"

/* Describes the operation. Its options set a VerifyOptions. */
extern const Command command_verify;

/* Checks the options, reads the tree, draws it with both programs and, if options->witness is set,
 * with Tachyon, and compares the pictures. Writes scenes, image planes (color, depth, normals, ids)
 * and the report into the folder options->folder, which is created if it is missing. Removes the
 * files of an earlier verification from the folder first. A difference is not an error:
 * result->agrees is then false.
 *
 * result  set on success; release it with verification_release.
 * Errors  STATUS_USAGE if options exclude each other or have no effect; STATUS_INPUT if the tree
 *         cannot be used, or neither program shows a vessel; STATUS_TOOL if POV-Ray or Tachyon is
 *         missing or fails; STATUS_INFEASIBLE if POV-Ray cannot store the scene; STATUS_CANCELLED;
 *         STATUS_IO, also if another verification is writing into the folder; STATUS_MEMORY. */
MUST_CHECK Status verify_run(VerifyOptions *options, Parsed *parsed, Verification *result,
                             Err *err);

/* Appends the verdict and the main measures as text, one line per plane. If memory runs out, `out`
 * records it. */
void verify_text(const Verification *result, Text *out);
/* Returns the content of report.json: a new reference, or NULL if memory runs out. */
json_t *verify_json(const Verification *result);

#endif
