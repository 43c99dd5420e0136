/* Reads files of lines "name = value" in sections "[section]".
 *
 * The file is read as a whole, and split into lines in memory. Names and values point into it. A
 * ';' begins a comment only at the beginning of a line or value, or after a blank, because values
 * may contain one. */
#include "base/ini.h"

#include "base/file.h"
#include <stdlib.h>
#include <string.h>

static void cut_comment(char *line)
{
    for (char *at = line; (at = strchr(at, ';')); at++)
        if (at == line || at[-1] == '=' || strchr(TEXT_BLANKS, at[-1])) {
            *at = '\0';
            return;
        }
}

static Status read_line(char *line, const char **section, IniTake *take, void *user, Err *err)
{
    line = text_trim(line);
    cut_comment(line);
    line = text_trim(line);
    if (*line == '\0' || *line == '#')
        return STATUS_OK;
    size_t length = strlen(line);
    if (*line == '[' && line[length - 1] == ']') {
        line[length - 1] = '\0';
        *section = text_trim(line + 1);
        return take(user, *section, NULL, NULL, err);
    }
    char *equals = strchr(line, '=');
    if (!equals || equals == line)
        return err_set(err, STATUS_INPUT, "'%.40s' is neither name = value nor [section]", line);
    *equals = '\0';
    return take(user, *section, text_trim(line), text_trim(equals + 1), err);
}

Status ini_read(const char *path, const char *what, IniTake *take, void *user, char **text,
                Err *err)
{
    const FileForm form = {.name = what, .most_bytes = 1e6, .is_text = true};
    char *bytes = NULL;
    const char *section = "";
    size_t size, number = 0;
    TRY(file_read(path, &form, &bytes, &size, err));
    Status status = STATUS_OK;
    for (char *rest = bytes, *line; status == STATUS_OK && (line = text_line(&rest)); number++)
        status = read_line(line, &section, take, user, err);
    if (status != STATUS_OK)
        err_prefix(err, "%s:%zu: ", strcmp(path, "-") ? path : "standard input", number);
    if (status == STATUS_OK && text)
        *text = bytes;
    else
        free(bytes);
    return status;
}
