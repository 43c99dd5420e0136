#include "app/commands.h"

#include <string.h>

bool is_one_of(const char *word, const char *const *words)
{
    while (*words && strcmp(*words, word) != 0)
        words++;
    return *words;
}

void put_shell_word(Text *text, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@%+=:,./_-";
    if (!word || (*word && word[strspn(word, plain)] == '\0')) {
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
    text_put_line(&clean, text_chars(line));
    text_release(line);
    Status status = text_take(&clean, out, err);
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
        put_shell_word(&text, text_chars(&word));
        text_release(&word);
    }
    return take_line(&text, out, err);
}

Status json_write(json_t *object, const char *path, Err *err)
{
    Text text = TEXT_INIT;
    text_json(&text, object, 2);
    text_puts(&text, "\n");
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}
