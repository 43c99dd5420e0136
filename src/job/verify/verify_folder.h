/* The folder that a verification writes into. */
#ifndef CORCAST_JOB_VERIFY_VERIFY_FOLDER_H
#define CORCAST_JOB_VERIFY_VERIFY_FOLDER_H

#include "options/files.h"

/* Initialise with the path and the lock -1. */
typedef struct VerifyFolder {
    const char *path; /* borrowed */
    int lock;         /* file descriptor of the locked folder; -1: not claimed */
} VerifyFolder;

/* If the folder exists and is not claimed yet: locks it against other verifications, and removes
 * what an earlier verification left in it. An interrupted verification thus leaves no verdict, and
 * an old verdict is never taken for one about this tree. A file system without locks gives none.
 *
 * files   receives the files that the verification may write.
 * Errors  STATUS_IO if another process has locked the folder, or a file cannot be removed;
 *         STATUS_USAGE if such a file is also read; STATUS_MEMORY. */
MUST_CHECK Status verifyfolder_claim(VerifyFolder *folder, Files *files, Err *err);

/* Unlocks the folder. */
void verifyfolder_release(VerifyFolder *folder);

#endif
