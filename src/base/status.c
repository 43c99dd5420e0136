/* Stores the sentence of an error, and converts a status to the exit code of the program. A
 * sentence that is too long for Err is cut at its end; a prefix is written in front of a copy. */
#include "base/status.h"

#include <stdio.h>
#include <string.h>

Status err_set(Err *err, Status status, const char *format, ...)
{
    if (err) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(err->text, sizeof err->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

Status err_cancelled(Err *err)
{
    return err_set(err, STATUS_CANCELLED, "stopped by the caller");
}

void err_prefix(Err *err, const char *format, ...)
{
    if (!err)
        return;
    char sentence[sizeof err->text];
    memcpy(sentence, err->text, sizeof sentence);
    va_list arguments;
    va_start(arguments, format);
    int used = vsnprintf(err->text, sizeof err->text, format, arguments);
    va_end(arguments);
    if (used >= 0 && (size_t)used < sizeof err->text)
        snprintf(err->text + used, sizeof err->text - (size_t)used, "%s", sentence);
}

int status_exit(Status status)
{
    static const int exits[] = {
#define X(name, exit_status, meaning) exit_status,
        STATUS_TABLE(X)
#undef X
    };
    return exits[status];
}
