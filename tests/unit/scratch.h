/* A folder for the files of a test program: `folder`, from before the first test to after the last.
 * The program's group fails if a test leaves a file in it. */
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
