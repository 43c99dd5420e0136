#include "app/templates.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_folder(const char *path)
{
    return access(path, X_OK) == 0;
}

Status templates_folder(char **folder, Err *err)
{
    const char *given = getenv("CORCAST_TEMPLATES");
    if (given)
        return mem_strdup(folder, given, err);
    char program[4096];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length > 0) {
        program[length] = '\0';
        program[file_name(program) - program] = '\0';
        static const char *const places[] = {"../templates", "../../templates",
                                             "../share/corcast/templates"};
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            char *path = NULL;
            TRY(file_join(program, places[i], &path, err));
            if (is_folder(path)) {
                *folder = path;
                return STATUS_OK;
            }
            free(path);
        }
    }
    return err_set(err, STATUS_IO,
                   "the templates folder was found neither beside the program nor where it is "
                   "installed; name it in CORCAST_TEMPLATES");
}

Status template_file(const char *option, const char *folder, const char *value,
                     const char *extension, char **path, Err *err)
{
    if (strchr(value, '/'))
        return mem_strdup(path, value, err);
    char *templates = NULL, *found = NULL;
    Text name = TEXT_INIT;
    text_printf(&name, "%s/%s%s", folder, value, extension);
    Status status = text_check(&name, err);
    if (status == STATUS_OK)
        status = templates_folder(&templates, err);
    if (status == STATUS_OK)
        status = file_join(templates, name.chars, &found, err);
    if (status == STATUS_OK && access(found, R_OK) != 0)
        status = err_set(err, STATUS_USAGE,
                         "--%s: '%s' is not a file of %s/%s; write a path with a '/' for one of "
                         "your own",
                         option, value, templates, folder);
    text_release(&name);
    free(templates);
    if (status == STATUS_OK)
        *path = found;
    else
        free(found);
    return status;
}
