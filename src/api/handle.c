/* Makes and checks the handles of the library, and begins and ends its calls. A handle begins with
 * a magic number that identifies its type. Passing a handle of another type is thereby an error and
 * not a crash. Freed memory must not be read, so the use of a freed handle is detected only in a
 * debug build (CORCAST_DEBUG), which keeps the memory of freed handles in a linked list. */
#include "api/handle.h"

#include "options/templates.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static const char *const kind_names[] = {
    [HANDLE_ERROR] = "corcast_error",   [HANDLE_OPTIONS] = "corcast_options",
    [HANDLE_REPORT] = "corcast_report", [HANDLE_TREE] = "corcast_tree",
    [HANDLE_SCENE] = "corcast_scene",   [HANDLE_IMAGE] = "corcast_image",
    [HANDLE_MESH] = "corcast_mesh"};

/* Random numbers: it is unlikely that other data begins with one of them. The magic number of a
 * kind is MAGIC plus the kind. */
#define MAGIC 0x63c7a91e5f02d84bu
#define MAGIC_FREED 0xe10b4d7a92c66f35u

/* ---- handles --------------------------------------------------------------------------------- */

Status handle_new(void *out, HandleKind kind, size_t size, Err *err)
{
    Handle *handle;
    TRY(mem_calloc(&handle, 1, size, kind_names[kind], err));
    handle->magic = MAGIC + (uint64_t)kind;
    memcpy(out, &handle, sizeof handle);
    return STATUS_OK;
}

bool handle_is(const void *handle, HandleKind kind)
{
    return handle && ((const Handle *)handle)->magic == MAGIC + (uint64_t)kind;
}

Status handle_check(const void *handle, HandleKind kind, const char *name, Err *err)
{
    if (handle_is(handle, kind))
        return STATUS_OK;
    if (!handle)
        return err_set(err, STATUS_USAGE, "%s is NULL; it must be a %s", name, kind_names[kind]);
    const bool freed = ((const Handle *)handle)->magic == MAGIC_FREED;
    return err_set(err, STATUS_USAGE, "%s is not a %s%s", name, kind_names[kind],
                   freed ? ": it was freed" : "");
}

#ifdef CORCAST_DEBUG
typedef struct FreedHandle {
    Handle handle;
    struct FreedHandle *next;
} FreedHandle;

static _Atomic(FreedHandle *) freed_handles;

static void give_back(void *handle)
{
    FreedHandle *freed = handle;
    freed->next = atomic_load(&freed_handles);
    while (!atomic_compare_exchange_weak(&freed_handles, &freed->next, freed))
        ;
}
#else
static void give_back(void *handle)
{
    free(handle);
}
#endif

/* `volatile` keeps the compiler from leaving out the write before `free`. */
void handle_free(void *handle)
{
    *(volatile uint64_t *)&((Handle *)handle)->magic = MAGIC_FREED;
    give_back(handle);
}

/* ---- other arguments ------------------------------------------------------------------------- */

Status argument_check(const void *argument, const char *name, Err *err)
{
    return argument ? STATUS_OK : err_set(err, STATUS_USAGE, "%s is NULL", name);
}

Status path_check(const char *path, const char *name, Err *err)
{
    TRY(argument_check(path, name, err));
    if (*path == '\0')
        return err_set(err, STATUS_USAGE, "%s is empty; it must be the name of a file", name);
    if (strcmp(path, "-") == 0)
        return err_set(err, STATUS_USAGE,
                       "%s is \"-\": the library does not use the standard streams", name);
    return STATUS_OK;
}

/* ---- calls ----------------------------------------------------------------------------------- */

/* newlocale cannot fail here: the locale "C" needs no memory. */
Call call_begin(corcast_error *error)
{
    Call call = {.error = handle_is(error, HANDLE_ERROR) ? error : NULL};
    call.templates = templates_set(NULL);
    call.caller_locale = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
    return call;
}

int call_end(Call *call, Status status)
{
    freelocale(uselocale(call->caller_locale));
    (void)templates_set(call->templates);
    if (call->error) {
        call->error->err = call->err;
        call->error->status = status;
        if (status == STATUS_OK)
            call->error->err.text[0] = '\0';
    }
    return status_exit(status);
}

locale_t callback_begin(locale_t caller_locale)
{
    return uselocale(caller_locale);
}

void callback_end(locale_t library_locale)
{
    uselocale(library_locale);
}
