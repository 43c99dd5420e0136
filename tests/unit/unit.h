/* Included by every unit test: cmocka, the headers that cmocka.h requires before it, and must. */
#ifndef CORCAST_TESTS_UNIT_H
#define CORCAST_TESTS_UNIT_H

#include "base/base.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* A test that repeats one comparison with a slow reference does one in SHARE of the repetitions. A
 * sanitizer finds as much in a tenth, because the rest runs through the same code. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SHARE 10
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SHARE 10
#endif
#endif
#ifndef SHARE
#define SHARE 1
#endif

/* The test fails with the error's sentence unless the status is STATUS_OK. */
static inline void must(Status status, const Err *err)
{
    if (status != STATUS_OK)
        fail_msg("%s", err->text);
}

#endif
