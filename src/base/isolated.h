/* Runs code of a library in a child process. A failed allocation in that library then cannot harm
 * the program. */
#ifndef CORCAST_BASE_ISOLATED_H
#define CORCAST_BASE_ISOLATED_H

#include "base/status.h"
#include "base/text.h"

/* The work. It appends its result to `bytes`. It runs in the child process, so all its other
 * changes to memory are lost. */
typedef Status IsolatedWork(const void *context, Text *bytes, Err *err);

/* Runs `work` in a child process and appends to `bytes` what the work made.
 *
 * A library may ignore a failed allocation, or crash because of it. A child is therefore taken to
 * have run out of memory in two cases: a signal ended it, or errno is ENOMEM when the work returns.
 *
 * subject  completes the sentence "out of memory: no room for `subject`".
 * Errors   STATUS_MEMORY; the error of the work; STATUS_IO if no pipe can be made.
 *
 * After an error *bytes is unchanged. */
MUST_CHECK Status isolated_run(IsolatedWork *work, const void *context, const char *subject,
                               Text *bytes, Err *err);

#endif
