/* A folder for the files of a test program. `folder` exists from before the first test until
 * after the last. The program's group fails if a test leaves a file in the folder. */
#ifndef CORCAST_TESTS_SCRATCH_H
#define CORCAST_TESTS_SCRATCH_H

#include <stdlib.h>
#include <unistd.h>

static char folder[] = "/tmp/corcast-test-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

#endif
