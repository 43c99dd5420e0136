/* Replaces the functions of the operating system and of libraries that a web page does not have.
 * These functions take the place of those in src/base and of Jansson when corcast is compiled to
 * WebAssembly. A page has one thread and no files, so reading a file is an error that says so.
 * Values of JSON, which only reports and manifests need, cannot be made, as if memory had run out.
 */
#include "base/base.h"
#include "voxel/voxel.h"

/* ---- the system ------------------------------------------------------------------------------ */

int system_processors(ProcessorSet *allowed)
{
    return allowed->count = 1;
}

bool system_start_thread(pthread_t *thread, const ProcessorSet *allowed, int number,
                         void *(*run)(void *), void *argument)
{
    (void)thread, (void)allowed, (void)number, (void)run, (void)argument;
    return false;
}

void system_join_thread(pthread_t thread)
{
    (void)thread;
}

void system_allow_processors(const ProcessorSet *allowed)
{
    (void)allowed;
}

void system_prefer_huge_pages(void *memory, size_t size)
{
    (void)memory, (void)size;
}

void system_return_memory(void)
{
}

bool system_own_file(char *path, size_t size)
{
    (void)size;
    path[0] = '\0';
    return false;
}

/* ---- files ----------------------------------------------------------------------------------- */

static Status refuse(const char *path, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: cannot be read: a page in a browser reads no files",
                   path);
}

Status file_read(const char *path, const FileForm *form, char **bytes, size_t *size, Err *err)
{
    (void)form, (void)bytes, (void)size;
    return refuse(path, err);
}

Status file_read_memory(const MemoryFile *file, const FileForm *form, char **bytes, size_t *size,
                        Err *err)
{
    (void)form, (void)bytes, (void)size;
    return refuse(file->name, err);
}

Status file_to_text(const char *path, const FileForm *form, char *bytes, size_t *size, Err *err)
{
    (void)form, (void)bytes, (void)size;
    return refuse(path, err);
}

Status file_resolve(const char *path, char **out, Err *err)
{
    return mem_strdup(out, path, err);
}

Status outfile_check(const char *path, Err *err)
{
    (void)path, (void)err;
    return STATUS_OK;
}

Status outfile_check_space(const OutFile *file, double bytes, Err *err)
{
    (void)file, (void)bytes, (void)err;
    return STATUS_OK;
}

const VolumeFormat volume_formats[] = {{0}};

const VolumeFormat *volume_format_find(const char *path)
{
    (void)path;
    return NULL;
}

/* ---- JSON ------------------------------------------------------------------------------------ */

#define NO_JSON(function, ...)                                                                     \
    json_t *function(__VA_ARGS__)                                                                  \
    {                                                                                              \
        return NULL;                                                                               \
    }

NO_JSON(json_object, void)
NO_JSON(json_array, void)
NO_JSON(json_true, void)
NO_JSON(json_false, void)
NO_JSON(json_null, void)
NO_JSON(json_integer, json_int_t value)
NO_JSON(json_pack, const char *format, ...)
NO_JSON(json_number, double value)
NO_JSON(json_count, uint64_t n)
NO_JSON(json_text, const char *chars)
NO_JSON(json_with_item, json_t *array, json_t *item)
NO_JSON(json_with_members, json_t *object, const JsonMember *members, size_t n)

void json_delete(json_t *json)
{
    (void)json;
}
