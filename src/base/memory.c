/* Allocates memory, and words the error if there is none.
 *
 * Small memory is zeroed, so that a struct can be released whether it was filled or not. For large
 * arrays, calloc gets zeroed pages from the system at no cost, if the memory has not been used
 * before. Arrays double when they grow. */
#include "base/memory.h"

#include "base/number.h"
#include "base/system.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Status out_of_memory(size_t count, size_t size, const char *what, Err *err)
{
    return err_set(err, STATUS_MEMORY, "out of memory: no room for %zu %s of %zu bytes each", count,
                   what, size);
}

/* Asks for huge pages of 2 MB for a large block. Large blocks are touched all over soon, so huge
 * pages save most of the page faults. */
static void prefer_huge_pages(void *memory, size_t size)
{
    const size_t huge = (size_t)1 << 21;
    if (size >= huge)
        system_prefer_huge_pages(memory, size);
}

double mem_machine_bytes(void)
{
    double bytes = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    return bytes > 0 ? bytes : (double)INFINITY;
}

Status mem_check(double bytes, const char *name, Err *err)
{
    char needs[BYTES_TEXT_SIZE], has[BYTES_TEXT_SIZE];
    double machine = mem_machine_bytes();
    if (bytes <= machine)
        return STATUS_OK;
    return err_set(err, STATUS_MEMORY, "%s: out of memory: needs %s, and this machine has %s", name,
                   bytes_text(bytes, needs), bytes_text(machine, has));
}

/* Stores the result of calloc or malloc in the pointer that `out` points to, or sets the error. */
static Status hand_out(void *memory, void *out, size_t count, size_t size, const char *what,
                       Err *err)
{
    if (!memory)
        return out_of_memory(count, size, what, err);
    prefer_huge_pages(memory, count * size);
    memcpy(out, &memory, sizeof memory);
    return STATUS_OK;
}

Status mem_calloc(void *out, size_t count, size_t size, const char *what, Err *err)
{
    return hand_out(calloc(count ? count : 1, size), out, count, size, what, err);
}

Status mem_alloc(void *out, size_t count, size_t size, const char *what, Err *err)
{
    void *memory = count > SIZE_MAX / size ? NULL : malloc(count ? count * size : 1);
    return hand_out(memory, out, count, size, what, err);
}

Status mem_grow(void *items, size_t *capacity, size_t needed, size_t size, const char *what,
                Err *err)
{
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

Status mem_out_of(const char *purpose, const char *subject, Err *err)
{
    return err_set(err, STATUS_MEMORY, "out of memory: no room %s %s", purpose, subject);
}

Status mem_strdup(char **out, const char *text, Err *err)
{
    size_t size = strlen(text) + 1;
    TRY(mem_calloc(out, size, 1, "bytes of text", err));
    memcpy(*out, text, size);
    return STATUS_OK;
}

Status mem_vprintf(char **out, const char *subject, Err *err, const char *format, va_list values)
{
    char *text = NULL;
    if (vasprintf(&text, format, values) < 0)
        return mem_out_of("for", subject, err);
    *out = text;
    return STATUS_OK;
}

Status mem_printf(char **out, Err *err, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    Status status = mem_vprintf(out, "a text", err, format, values);
    va_end(values);
    return status;
}
