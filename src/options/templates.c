/* Finds the templates folder and the files in it. Without a folder from templates_set, the search
 * starts at the file that contains this code, the program or the library: first beside the build
 * folder, then where `make install` copies the templates. On a system that does not state the path
 * of this file, such as Linux without /proc, the search uses the prefix of the build (PREFIX). */
#include "options/templates.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_folder(const char *path)
{
    return access(path, X_OK) == 0;
}

/* Removes the last `n` components of a path, but not its root. */
static void cut_components(char *path, int n)
{
    for (; n > 0 && strrchr(path, '/') > path; n--)
        *strrchr(path, '/') = '\0';
}

/* The folder of templates_set; each thread has its own. */
static _Thread_local const char *chosen;

const char *templates_set(const char *folder)
{
    const char *before = chosen;
    chosen = folder;
    return before;
}

/* Copies the folder of templates_set. Returns STATUS_IO if it has no folder "looks". */
static Status take_chosen(char **folder, Err *err)
{
    char *looks = NULL;
    TRY(file_join(chosen, "looks", &looks, err));
    const bool has_looks = is_folder(looks);
    free(looks);
    if (has_looks)
        return mem_strdup(folder, chosen, err);
    return err_set(err, STATUS_IO,
                   "CORCAST_TEMPLATES: '%s' is not a folder of templates: it has no folder 'looks'",
                   chosen);
}

/* Sets *folder to the folder `path` of `parent` if it exists, to NULL if it does not. */
static Status try_folder(const char *parent, const char *path, char **folder, Err *err)
{
    TRY(file_join(parent, path, folder, err));
    if (!is_folder(*folder)) {
        free(*folder);
        *folder = NULL;
    }
    return STATUS_OK;
}

Status templates_folder(char **folder, Err *err)
{
    /* The folders to try, beside a program in build/ or bin/, and beside a library one folder
     * deeper. */
    static const struct {
        int up; /* number of components to remove from the path of the row before */
        const char *path;
    } places[] = {{2, "templates"},
                  {0, "share/corcast/templates"},
                  {1, "templates"},
                  {0, "share/corcast/templates"}};
    char self[PATH_MAX];
    char *found = NULL;
    if (chosen && *chosen)
        return take_chosen(folder, err);
    const size_t n = system_own_file(self, sizeof self) ? sizeof places / sizeof *places : 0;
    for (size_t i = 0; i < n && !found; i++) {
        cut_components(self, places[i].up);
        TRY(try_folder(self, places[i].path, &found, err));
    }
    if (!found)
        TRY(try_folder(CORCAST_PREFIX, "share/corcast/templates", &found, err));
    if (!found)
        return err_set(err, STATUS_IO,
                       "the templates folder was found neither beside the program nor in "
                       "'" CORCAST_PREFIX "/share/corcast'; name it in CORCAST_TEMPLATES");
    *folder = found;
    return STATUS_OK;
}

/* Appends the names, without extension, of the files in the folder that have the extension. The
 * string `between` separates the names, and `before_last` precedes the last one. */
static void list_names(const char *folder, const char *extension, const char *between,
                       const char *before_last, Text *out)
{
    struct dirent **entries = NULL;
    int n = scandir(folder, &entries, NULL, alphasort);
    const char *last = NULL;
    if (n < 0 && errno == ENOMEM)
        text_puts(out, NULL);
    for (int i = 0; i < n; i++) {
        char *name = entries[i]->d_name;
        size_t length = strlen(name), ending = strlen(extension);
        if (length <= ending || strcmp(name + length - ending, extension) != 0)
            continue;
        name[length - ending] = '\0';
        if (last)
            text_printf(out, "%s%s", out->length ? between : "", last);
        last = name;
    }
    text_printf(out, "%s%s", out->length ? before_last : "", last ? last : "none");
    for (int i = 0; i < n; i++)
        free(entries[i]);
    free(entries);
}

Status templates_path(const char *name, char **path, Err *err)
{
    char *folder = NULL;
    TRY(templates_folder(&folder, err));
    Status status = file_join(folder, name, path, err);
    free(folder);
    return status;
}

Status template_names(const char *folder, const char *extension, Text *lines, Err *err)
{
    char *place = NULL;
    TRY(templates_path(folder, &place, err));
    list_names(place, extension, "\n", "\n", lines);
    text_puts(lines, "\n");
    free(place);
    return text_check(lines, err);
}

/* Returns STATUS_USAGE with the unknown name and the names that exist. */
static Status refuse_name(const char *what, const char *value, const char *folder,
                          const char *extension, Err *err)
{
    Text names = TEXT_INIT;
    list_names(folder, extension, ", ", " or ", &names);
    Status status = text_check(&names, err);
    if (status == STATUS_OK)
        status = err_set(
            err, STATUS_USAGE,
            "%s '%s' is unknown; available: %s; for a file of your own, give a path with a '/'",
            what, value, text_chars(&names));
    text_release(&names);
    return status;
}

Status template_find(const char *what, const char *folder, const char *value, const char *extension,
                     char **path, Err *err)
{
    if (strchr(value, '/'))
        return mem_strdup(path, value, err);
    char *place = NULL, *found = NULL;
    Text name = TEXT_INIT;
    Status status = STATUS_OK;
    text_printf(&name, "%s%s", value, extension);
    TRY_GOTO(text_check(&name, err));
    TRY_GOTO(templates_path(folder, &place, err));
    TRY_GOTO(file_join(place, text_chars(&name), &found, err));
    if (access(found, R_OK) != 0) {
        status = refuse_name(what, value, place, extension, err);
        goto done;
    }
    *path = found;
    found = NULL;
done:
    text_release(&name);
    free(place);
    free(found);
    return status;
}

Status template_file(const char *option, const char *folder, const char *value,
                     const char *extension, char **path, Err *err)
{
    char what[64];
    snprintf(what, sizeof what, "--%s:", option);
    return template_find(what, folder, value, extension, path, err);
}
