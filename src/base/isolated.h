/* Work by a library that memory failures break, done in a process of its own. */
#ifndef CORCAST_BASE_ISOLATED_H
#define CORCAST_BASE_ISOLATED_H

#include "base/status.h"
#include "base/text.h"

/* Appends the result to `bytes`. Runs in the child process: what it changes in memory is lost when
 * it returns. */
typedef Status IsolatedWork(const void *context, Text *bytes, Err *err);

/* Runs `work` in a child process and appends to `bytes` what the work made.
 *
 * A library may ignore a failed allocation, or may crash because of one. A child that ends by a
 * signal, and a child in which the last error of the C library (errno) is ENOMEM when the work
 * returns, both ran out of memory.
 *
 * subject  completes the sentence "out of memory: no room for `subject`".
 * Errors   STATUS_MEMORY; the error of the work; STATUS_IO when there is no pipe. *bytes is left as
 * it was. */
MUST_CHECK Status isolated_run(IsolatedWork *work, const void *context, const char *subject,
                               Text *bytes, Err *err);

#endif
