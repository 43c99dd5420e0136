#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Arrays from this size on, in bytes, ask for huge pages, of this size. */
enum { LARGE = 8 << 20, HUGE_PAGE = 2 << 20 };

static Status out_of_memory(size_t count, size_t size, const char *what, Err *err)
{
    return err_set(err, STATUS_MEMORY, "out of memory: no room for %zu %s of %zu bytes each", count,
                   what, size);
}

/* Advice only: random access to large arrays is a tenth faster when the tables that map them are
 * short. */
static void advise(void *memory, size_t bytes)
{
    uintptr_t from = ((uintptr_t)memory + HUGE_PAGE - 1) & ~((uintptr_t)HUGE_PAGE - 1);
    uintptr_t to = ((uintptr_t)memory + bytes) & ~((uintptr_t)HUGE_PAGE - 1);
    madvise((char *)memory + (from - (uintptr_t)memory), to - from, MADV_HUGEPAGE);
}

Status mem_calloc(void *out, size_t count, size_t size, const char *what, Err *err)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        return out_of_memory(count, size, what, err);
    if (count * size >= LARGE)
        advise(memory, count * size);
    memcpy(out, &memory, sizeof memory);
    return STATUS_OK;
}

Status mem_reserve(void *items, size_t *capacity, size_t needed, size_t size, const char *what,
                   Err *err)
{
    if (needed <= *capacity)
        return STATUS_OK;
    size_t wanted = *capacity < 8 ? 8 : *capacity;
    while (wanted < needed && wanted <= SIZE_MAX / 2)
        wanted *= 2;
    if (wanted < needed || wanted > SIZE_MAX / size)
        return out_of_memory(needed, size, what, err);
    void *memory;
    memcpy(&memory, items, sizeof memory);
    memory = realloc(memory, wanted * size);
    if (!memory)
        return out_of_memory(wanted, size, what, err);
    memcpy(items, &memory, sizeof memory);
    *capacity = wanted;
    return STATUS_OK;
}

Status mem_strdup(char **out, const char *text, Err *err)
{
    size_t size = strlen(text) + 1;
    TRY(mem_calloc(out, size, 1, "bytes of text", err));
    memcpy(*out, text, size);
    return STATUS_OK;
}
