/* Implements the errors of the library and the function that returns its version. An error has a
 * sentence and the kind of the failure. */
#include "api/handle.h"

#include <stdio.h>

#define TEXT_OF(number) #number
#define VERSION_OF(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)
_Static_assert(sizeof VERSION_OF(CORCAST_VERSION_MAJOR, CORCAST_VERSION_MINOR,
                                 CORCAST_VERSION_PATCH) == sizeof CORCAST_VERSION,
               "the header and base/version.h state one version");

const char *corcast_version(void)
{
    return VERSION_OF(CORCAST_VERSION_MAJOR, CORCAST_VERSION_MINOR, CORCAST_VERSION_PATCH);
}

corcast_error *corcast_error_new(void)
{
    corcast_error *error = NULL;
    Err err;
    return handle_new(&error, HANDLE_ERROR, sizeof *error, &err) == STATUS_OK ? error : NULL;
}

const char *corcast_error_text(const corcast_error *error)
{
    return handle_is(error, HANDLE_ERROR) ? error->err.text : "";
}

const char *corcast_error_kind(const corcast_error *error)
{
    static const char *const kinds[] = {[STATUS_OK] = "",
                                        [STATUS_DIFFERS] = "differs",
                                        [STATUS_USAGE] = "usage",
                                        [STATUS_INPUT] = "input",
                                        [STATUS_INFEASIBLE] = "infeasible",
                                        [STATUS_IO] = "io",
                                        [STATUS_MEMORY] = "memory",
                                        [STATUS_TOOL] = "tool",
                                        [STATUS_INTERRUPTED] = "interrupted",
                                        [STATUS_CANCELLED] = "cancelled"};
    return handle_is(error, HANDLE_ERROR) ? kinds[error->status] : "";
}

void corcast_error_free(corcast_error *error)
{
    if (handle_is(error, HANDLE_ERROR))
        handle_free(error);
}
