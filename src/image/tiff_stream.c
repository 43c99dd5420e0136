/* libtiff 4.5 does not look at all that it is given: of 57 allocations of reading a small file it
 * reads through NULL after 3 that fail, and of 44 of writing one after 4. It takes its memory by
 * its own _TIFFmalloc, _TIFFcalloc and _TIFFrealloc, and calls these as any program may: so those
 * here come first, and a failed one does not return to libtiff but jumps out of it. Where a libtiff
 * is linked so that it calls its own, these are never called, and all is as libtiff has it. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
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

Status tiff_guard(TiffWork *work, void *self, TiffStream *tiff, const char *name, Err *err)
{
    jmp_buf here;
    if (setjmp(here)) {
        way_out = NULL;
        tiff->handle = NULL;
        return mem_out_of("for the TIFF", name, err);
    }
    way_out = &here;
    Status status = work(self, err);
    way_out = NULL;
    return status;
}

/* ---- what libtiff calls ---------------------------------------------------------------------- */

Status tiff_guard_bytes(TiffWork *work, void *self, TiffStream *tiff, const ImageBytes *file,
                        Err *err)
{
    errno = 0;
    /* It is only read, whatever fmemopen's declaration says. */
    tiff->bytes = (void *)(uintptr_t)file->bytes;
    tiff->size = file->size;
    tiff->stream = fmemopen(tiff->bytes, file->size, "rb");
    if (!tiff->stream)
        return mem_out_of("to read", file->name, err);
    Status status = tiff_guard(work, self, tiff, file->name, err);
    if (tiff->handle)
        TIFFClose(tiff->handle);
    fclose(tiff->stream);
    return status;
}

static tmsize_t on_read(thandle_t user, void *out, tmsize_t size)
{
    return (tmsize_t)fread(out, 1, (size_t)size, ((TiffStream *)user)->stream);
}

static tmsize_t on_write(thandle_t user, void *bytes, tmsize_t size)
{
    return (tmsize_t)fwrite(bytes, 1, (size_t)size, ((TiffStream *)user)->stream);
}

static toff_t on_seek(thandle_t user, toff_t offset, int whence)
{
    FILE *stream = ((TiffStream *)user)->stream;
    return fseeko(stream, (off_t)offset, whence) == 0 ? (toff_t)ftello(stream) : (toff_t)-1;
}

static int on_close(thandle_t user)
{
    (void)user;
    return 0;
}

static toff_t on_size(thandle_t user)
{
    FILE *stream = ((TiffStream *)user)->stream;
    off_t here = ftello(stream);
    fseeko(stream, 0, SEEK_END);
    off_t size = ftello(stream);
    fseeko(stream, here, SEEK_SET);
    return (toff_t)size;
}

/* libtiff then reads where the bytes are, and goes to the stream for little but the header. */
static int on_map(thandle_t user, void **bytes, toff_t *size)
{
    const TiffStream *tiff = user;
    *bytes = tiff->bytes;
    *size = tiff->size;
    return tiff->bytes != NULL;
}

static void on_unmap(thandle_t user, void *bytes, toff_t size)
{
    (void)user;
    (void)bytes;
    (void)size;
}

static int on_complaint(TIFF *handle, void *user, const char *module, const char *format,
                        va_list values) PRINTF_LIKE(4, 0);
static int on_complaint(TIFF *handle, void *user, const char *module, const char *format,
                        va_list values)
{
    (void)handle;
    (void)module;
    TiffStream *tiff = user;
    if (tiff && !*tiff->complaint)
        vsnprintf(tiff->complaint, sizeof tiff->complaint, format, values);
    return 1;
}

bool tiff_open(TiffStream *tiff, const char *name, const char *mode)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options)
        return false;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_complaint, tiff);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_complaint, *mode == 'w' ? tiff : NULL);
    tiff->handle = TIFFClientOpenExt(name, mode, tiff, on_read, on_write, on_seek, on_close,
                                     on_size, on_map, on_unmap, options);
    TIFFOpenOptionsFree(options);
    return tiff->handle;
}
