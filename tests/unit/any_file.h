/* Reads files of tests as bytes. */
#ifndef CORCAST_TESTS_ANY_FILE_H
#define CORCAST_TESTS_ANY_FILE_H

#include "base/base.h"

static const FileForm any_file = {.name = "a file of a test", .most_bytes = 1e9};

#endif
