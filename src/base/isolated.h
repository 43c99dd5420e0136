/* Runs code of a library in a child process. A failed allocation in that library then cannot harm
 * the program. */
#ifndef CORCAST_BASE_ISOLATED_H
#define CORCAST_BASE_ISOLATED_H

#include "base/status.h"
#include "base/text.h"

/* The work. It appends its result to `bytes`. It runs in the child process, so all its other
 * changes to memory are lost. */
typedef Status IsolatedWork(const void *context, Text *bytes, Err *err);

/* Runs `work` in a child process, and appends the result of the work to `bytes`.
 *
 * subject  the purpose of the memory, for errors: "out of memory: no room for SUBJECT".
 * Errors   those of `work`; STATUS_IO if no pipe can be made; STATUS_MEMORY in these cases:
 *           - no child process can be started;
 *           - the child ends before it has sent its result, for example because the library crashed
 *             after a failed allocation;
 *           - the work returns STATUS_OK, but errno, which is 0 when the work begins, is ENOMEM:
 * the library may have ignored a failed allocation. */
MUST_CHECK Status isolated_run(IsolatedWork *work, const void *context, const char *subject,
                               Text *bytes, Err *err);

#endif
