/* libtiff 4.5 does not look at all that it is given: of 57 allocations of reading a small file it
 * reads through NULL after 3 that fail, and of 44 of writing one after 4. It takes its memory by
 * its own _TIFFmalloc, _TIFFcalloc and _TIFFrealloc, and calls these as any program may: so those
 * here come first, and a failed one does not return to libtiff but jumps out of it. Where a libtiff
 * is linked so that it calls its own, these are never called, and all is as libtiff has it. */
#include "image/tiff_memory.h"

#include <setjmp.h>
#include <stdlib.h>
#include <tiffio.h>

static _Thread_local jmp_buf *way_out; /* NULL outside of tiff_guard */

static void *memory_or_leave(void *memory)
{
    if (!memory && way_out)
        longjmp(*way_out, 1);
    return memory;
}

void *_TIFFmalloc(tmsize_t size)
{
    return size > 0 ? memory_or_leave(malloc((size_t)size)) : NULL;
}

void *_TIFFcalloc(tmsize_t count, tmsize_t size)
{
    return count > 0 && size > 0 ? memory_or_leave(calloc((size_t)count, (size_t)size)) : NULL;
}

void *_TIFFrealloc(void *memory, tmsize_t size)
{
    void *moved = realloc(memory, (size_t)size);
    return size > 0 ? memory_or_leave(moved) : moved;
}

Status tiff_guard(TiffWork *work, void *self, void **handle, const char *name, Err *err)
{
    jmp_buf here;
    if (setjmp(here)) {
        way_out = NULL;
        *handle = NULL;
        return mem_out_of("for the TIFF", name, err);
    }
    way_out = &here;
    Status status = work(self, err);
    way_out = NULL;
    return status;
}
