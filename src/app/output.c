#include "app/commands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

Status command_line_text(const char *command, int argc, char **argv, char **out, Err *err)
{
    Text text = TEXT_INIT;
    text_printf(&text, "corcast %s", command);
    for (int i = 0; i < argc; i++) {
        const char *equals = strchr(argv[i], '=');
        int kept = equals ? (int)(equals + 1 - argv[i]) : 0;
        text_printf(&text, " %.*s%s", kept, argv[i], file_name(argv[i] + kept));
    }
    Status status = text_check(&text, err);
    if (status != STATUS_OK) {
        text_release(&text);
        return status;
    }
    *out = text.chars;
    return STATUS_OK;
}

json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

Status json_write(json_t *object, const char *path, Err *err)
{
    char *chars = object ? json_dumps(object, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(object);
    if (!chars)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for the JSON text");
    Text text = TEXT_INIT;
    text_puts(&text, chars);
    text_puts(&text, "\n");
    free(chars);
    Status status = text_check(&text, err);
    if (status == STATUS_OK)
        status = file_write(path, text.chars, text.length, err);
    text_release(&text);
    return status;
}
