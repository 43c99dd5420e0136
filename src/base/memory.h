/* Allocation of memory and of growable arrays. A failed allocation is a Status; it never ends the
 * program. base/array.h wraps growable arrays in a struct. */
#ifndef CORCAST_BASE_MEMORY_H
#define CORCAST_BASE_MEMORY_H

#include "base/status.h"
#include <stdarg.h>
#include <stddef.h>

/* Allocates an array of `count` zeroed items of `size` bytes. `out` is the address of the pointer
 * that receives the array; release the array with free(). A count of 0 gives a pointer that free()
 * accepts. `what` names the array in the error sentence: "radii". Errors: STATUS_MEMORY. */
MUST_CHECK Status mem_calloc(void *out, size_t count, size_t size, const char *what, Err *err);

/* Allocates as mem_calloc does, but leaves the items uninitialized. For large arrays: the function
 * spends no time on clearing, and the system provides only the pages that are used. */
MUST_CHECK Status mem_alloc(void *out, size_t count, size_t size, const char *what, Err *err);

/* Returns the size of the machine's memory in bytes; infinity if the size is unknown. */
double mem_machine_bytes(void);
/* Checks that the machine has at least `bytes` of memory. `name` names the work in the error
 * sentence. Errors: STATUS_MEMORY. Without this check, Linux would grant more memory than the
 * machine has, and later end the program in the middle of its work. */
MUST_CHECK Status mem_check(double bytes, const char *name, Err *err);

/* Enlarges an array whose capacity is below `needed`; called by mem_reserve. */
MUST_CHECK Status mem_grow(void *items, size_t *capacity, size_t needed, size_t size,
                           const char *what, Err *err);

/* Ensures that a growable array has the capacity for `needed` items of `size` bytes.
 *
 * items    the address of the array's pointer, which may move.
 * capacity the capacity in items. It at least doubles when it grows, so that appending costs O(1)
 *          amortized.
 * Errors   STATUS_MEMORY; the array and *capacity are then unchanged. */
MUST_CHECK static inline Status mem_reserve(void *items, size_t *capacity, size_t needed,
                                            size_t size, const char *what, Err *err)
{
    return needed <= *capacity ? STATUS_OK : mem_grow(items, capacity, needed, size, what, err);
}

/* Returns STATUS_MEMORY, and sets the sentence "out of memory: no room PURPOSE SUBJECT". Used as
 * mem_out_of("to read", "t.png", err) for failed allocations inside a library. If a library does
 * not report why it failed, call this only if errno is ENOMEM. */
MUST_CHECK Status mem_out_of(const char *purpose, const char *subject, Err *err);

/* Copies `text` to *out, which the caller frees with free(). Errors: STATUS_MEMORY. */
MUST_CHECK Status mem_strdup(char **out, const char *text, Err *err);

/* Sets *out to a formatted text of any length, which the caller frees with free(). Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status mem_printf(char **out, Err *err, const char *format, ...) PRINTF_LIKE(3, 4);
/* Does the same as mem_printf, with a va_list. `subject` names the text in the error sentence: "a
 * file's name". Errors: STATUS_MEMORY. */
MUST_CHECK Status mem_vprintf(char **out, const char *subject, Err *err, const char *format,
                              va_list values) PRINTF_LIKE(4, 0);

#endif
