/* Takes the paths of files apart and joins them, as texts. Nothing here looks at the disk. */
#include "base/file.h"

#include "base/memory.h"
#include <string.h>

const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *file_extension(const char *path)
{
    const char *name = file_name(path);
    const char *dot = strrchr(name, '.');
    return dot && dot != name ? dot + 1 : "";
}

Status file_with_suffix(const char *path, const char *suffix, char **out, Err *err)
{
    const char *extension = file_extension(path);
    size_t stem = *extension ? (size_t)(extension - 1 - path) : strlen(path);
    return mem_printf(out, err, "%.*s%s", (int)stem, path, suffix);
}

Status file_beside(const char *path, const char *name, char **out, Err *err)
{
    return mem_printf(out, err, "%.*s%s", (int)(file_name(path) - path), path, name);
}

Status file_join(const char *folder, const char *name, char **out, Err *err)
{
    size_t length = strlen(folder);
    const char *slash = length && folder[length - 1] == '/' ? "" : "/";
    return mem_printf(out, err, "%s%s%s", folder, slash, name);
}
