/* What every unit test needs: cmocka, the headers that cmocka.h wants before it, and must. */
#ifndef CORCAST_TESTS_UNIT_H
#define CORCAST_TESTS_UNIT_H

#include "base/base.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The test fails with the error's sentence unless the status is STATUS_OK. */
static inline void must(Status status, const Err *err)
{
    if (status != STATUS_OK)
        fail_msg("%s", err->text);
}

#endif
