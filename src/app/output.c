#include "app/commands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void put_shell_word(Text *text, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@%+=:,./_-";
    if (*word && word[strspn(word, plain)] == '\0') {
        text_puts(text, word);
        return;
    }
    text_puts(text, "'");
    for (; *word; word++)
        text_printf(text, *word == '\'' ? "'\\%c'" : "%c", *word);
    text_puts(text, "'");
}

/* *line, cleaned for one line, in *out. */
static Status take_line(Text *line, char **out, Err *err)
{
    Text clean = TEXT_INIT;
    text_puts(&clean, "");
    if (line->chars)
        text_put_line(&clean, line->chars);
    clean.failed = clean.failed || line->failed;
    Status status = text_check(&clean, err);
    text_release(line);
    if (status == STATUS_OK)
        *out = clean.chars;
    else
        text_release(&clean);
    return status;
}

Status shown_name(const char *path, char **out, Err *err)
{
    Text name = TEXT_INIT;
    text_puts(&name, file_name(path));
    return take_line(&name, out, err);
}

Status command_line_text(const char *command, int argc, char **argv, char **out, Err *err)
{
    Text text = TEXT_INIT;
    text_printf(&text, "corcast %s", command);
    for (int i = 0; i < argc; i++) {
        const char *equals = strchr(argv[i], '=');
        size_t kept = equals ? (size_t)(equals + 1 - argv[i]) : 0;
        Text word = TEXT_INIT;
        text_append(&word, argv[i], kept);
        text_puts(&word, file_name(argv[i] + kept));
        text_puts(&text, " ");
        if (word.chars)
            put_shell_word(&text, word.chars);
        text.failed = text.failed || word.failed;
        text_release(&word);
    }
    return take_line(&text, out, err);
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
