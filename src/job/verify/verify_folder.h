/* Locks the output folder of a verification, and removes the files of an earlier verification. Call
 * verifyfolder_claim before the work and verifyfolder_release at its end. */
#ifndef CORCAST_JOB_VERIFY_VERIFY_FOLDER_H
#define CORCAST_JOB_VERIFY_VERIFY_FOLDER_H

#include "options/files.h"

/* The output folder. Initialise it with the path and lock = -1. */
typedef struct VerifyFolder {
    const char *path; /* borrowed */
    int lock;         /* file descriptor of the locked folder; -1: not claimed */
} VerifyFolder;

/* Locks the folder against other verifications, and removes the files that an earlier verification
 * left in it. If a verification is interrupted, the folder therefore has no verdict about an older
 * tree. Does nothing if the folder does not exist or is claimed already. On a file system without
 * locks, the folder is not locked.
 *
 * files   receives the files that the verification may write.
 * Errors  STATUS_IO if another process has locked the folder, or if a file cannot be removed;
 *         STATUS_USAGE if a file that the verification writes is also read; STATUS_MEMORY. */
MUST_CHECK Status verifyfolder_claim(VerifyFolder *folder, Files *files, Err *err);

/* Unlocks the folder. Does nothing if the folder is not claimed. */
void verifyfolder_release(VerifyFolder *folder);

#endif
