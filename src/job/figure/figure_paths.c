/* Makes the paths in a figure's recipe start at the recipe's folder. The kind of an option states
 * whether its value is a path. Four options of kind text contain a path, each in its own form. */
#include "job/figure/figure_paths.h"

#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

Status figure_path(const char *folder, const char *path, char **out, Err *err)
{
    const bool is_fixed = path[0] == '/' || strcmp(path, "-") == 0;
    return mem_printf(out, err, "%s%s", is_fixed ? "" : folder, path);
}

/* Returns the path in the description of a domain, such as mesh:FILE; NULL if there is none. */
static const char *path_of_domain(const char *value)
{
    static const char *const shapes[] = {"polygon:", "mask:", "mesh:", "surface:"};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (strncmp(value, shapes[i], strlen(shapes[i])) == 0)
            return value + strlen(shapes[i]);
    return NULL;
}

/* Returns the position in `value` where a path begins; NULL if there is none. `from_folder` is the
 * value with the folder before it. */
static const char *find_path(const Option *option, const char *value, const char *from_folder)
{
    size_t length;
    const char *column;
    if (option->kind == OPTION_INPUT)
        return value;
    if (option->kind == OPTION_LOOKUP)
        return strchr(value, '/') ? value : NULL;
    if (strcmp(option->name, "domain") == 0)
        return path_of_domain(value);
    if (strcmp(option->name, "color-by") == 0)
        return values_parse(from_folder, &length, &column) ? value : NULL;
    if (strcmp(option->name, "flow-split") == 0)
        return strcasecmp(file_extension(value), "csv") == 0 ? value : NULL;
    return strcmp(option->name, "demand") == 0 && strcmp(value, "even") != 0 ? value : NULL;
}

static Status rebase_value(Parsed *parsed, const Setting *setting, const char *folder, Err *err)
{
    const char *value = *(const char *const *)(setting->base + setting->option->where);
    char *from_folder = NULL, *path = NULL, *changed = NULL;
    Status status;
    if (!value)
        return STATUS_OK;
    TRY_GOTO(figure_path(folder, value, &from_folder, err));
    const char *begin = find_path(setting->option, value, from_folder);
    if (!begin)
        goto done;
    TRY_GOTO(figure_path(folder, begin, &path, err));
    TRY_GOTO(mem_printf(&changed, err, "%.*s%s", (int)(begin - value), value, path));
    status = options_set(parsed, setting->option->name, changed, err);
done:
    free(changed);
    free(from_folder);
    free(path);
    return status;
}

Status figure_resolve_paths(Parsed *parsed, const char *folder, bool (*is_fixed)(const Setting *),
                            Err *err)
{
    for (size_t i = 0; *folder && i < parsed->n_settings; i++) {
        const Setting *setting = &parsed->settings[i];
        const OptionKind kind = setting->option->kind;
        if ((kind == OPTION_INPUT || kind == OPTION_LOOKUP || kind == OPTION_TEXT) &&
            strcmp(setting->option->name, "recipe") != 0 && !(is_fixed && is_fixed(setting)))
            TRY(rebase_value(parsed, setting, folder, err));
    }
    return STATUS_OK;
}
