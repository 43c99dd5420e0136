/* Memory and growable arrays whose failure is a Status, never an abort. */
#ifndef CORCAST_BASE_MEMORY_H
#define CORCAST_BASE_MEMORY_H

#include "base/status.h"
#include <stdarg.h>
#include <stddef.h>

/* Allocates `count` zeroed items of `size` bytes into *out (owned; free with free()). A count of
 * zero gives a pointer that may be freed. Fails with STATUS_MEMORY, `what` naming the thing. */
MUST_CHECK Status mem_calloc(void *out, size_t count, size_t size, const char *what, Err *err);

/* As mem_calloc, of items that hold anything: for large arrays of which nothing is read that was
 * not written before. Memory that served before is not cleared, and of fresh memory only what is
 * used is ever touched. */
MUST_CHECK Status mem_alloc(void *out, size_t count, size_t size, const char *what, Err *err);

/* The bytes of memory that the machine has; infinity when it does not say. */
double mem_of_machine(void);
/* STATUS_MEMORY, saying that `name` needs them, when the machine has fewer bytes. Linux grants more
 * memory than there is, and would end the program in the middle of a run. */
MUST_CHECK Status mem_check(double bytes, const char *name, Err *err);

/* As mem_reserve, of an array that has not room enough. */
MUST_CHECK Status mem_grow(void *items, size_t *capacity, size_t needed, size_t size,
                           const char *what, Err *err);

/* Makes room for at least `needed` items of `size` bytes in the array *items, whose capacity is
 * *capacity items; doubles, so that appending is O(1) amortised. `items` is a pointer to the
 * array's pointer. Unchanged on failure. */
MUST_CHECK static inline Status mem_reserve(void *items, size_t *capacity, size_t needed,
                                            size_t size, const char *what, Err *err)
{
    return needed <= *capacity ? STATUS_OK : mem_grow(items, capacity, needed, size, what, err);
}

/* Hands memory that has been freed back to the system, which the C library keeps else where small
 * blocks lie about it. Milliseconds. */
void mem_trim(void);

/* From now on the C library keeps all memory that is freed, large blocks too: what is asked for
 * anew picture by picture is not handed back in between, to be cleared page by page. */
void mem_keep(void);

/* STATUS_MEMORY with the sentence "out of memory: no room `purpose` `subject`", as in "to read", a
 * file. For what a library allocates: one that fails without telling why leaves ENOMEM in errno
 * where that was it. */
MUST_CHECK Status mem_out_of(const char *purpose, const char *subject, Err *err);

/* A copy of `text` in *out (owned). */
MUST_CHECK Status mem_strdup(char **out, const char *text, Err *err);

/* What vprintf would print, in *out (owned); `subject` is what it is for, as "a file's name". */
MUST_CHECK Status mem_vprintf(char **out, const char *subject, Err *err, const char *format,
                              va_list values) PRINTF_LIKE(4, 0);

#endif
