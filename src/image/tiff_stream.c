/* Connects libtiff to a stream or to a file in memory, and replaces its allocation functions.
 *
 * libtiff 4.5 does not check all its allocations. Reading a small file takes 57 allocations; if one
 * of 3 of them fails, libtiff dereferences NULL. Writing a small file takes 44 allocations, 4 of
 * them unchecked. libtiff allocates with its functions _TIFFmalloc, _TIFFcalloc and _TIFFrealloc,
 * which the dynamic linker resolves. The functions of these names here therefore replace libtiff's.
 * A failed allocation does not return to libtiff but leaves the guard. If a libtiff was linked so
 * that it always calls its own functions, these functions are unused.
 *
 * The program exports these functions. The libraries do not, because they would replace libtiff's
 * functions for the whole process that loads them. */
#include "image/tiff_stream.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/types.h>
#include <tiffio.h>

/* Visible to libtiff. Everything else is compiled with hidden visibility. */
#define REPLACES_LIBTIFF __attribute__((visibility("default")))

/* Returns memory, or leaves the guarded call if there is none. */
static void *memory_or_leave(void *memory)
{
    if (!memory)
        guard_leave_without_memory();
    return memory;
}

REPLACES_LIBTIFF void *_TIFFmalloc(tmsize_t size)
{
    return size > 0 ? memory_or_leave(malloc((size_t)size)) : NULL;
}

REPLACES_LIBTIFF void *_TIFFcalloc(tmsize_t count, tmsize_t size)
{
    return count > 0 && size > 0 ? memory_or_leave(calloc((size_t)count, (size_t)size)) : NULL;
}

REPLACES_LIBTIFF void *_TIFFrealloc(void *memory, tmsize_t size)
{
    void *moved = realloc(memory, (size_t)size);
    return size > 0 ? memory_or_leave(moved) : moved;
}

/* ---- callbacks ------------------------------------------------------------------------------- */

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

/* Maps the file for libtiff if it is in memory. libtiff then uses the stream for little more than
 * the header. */
static int on_map(thandle_t user, void **bytes, toff_t *size)
{
    const TiffStream *tiff = user;
    /* libtiff takes a pointer to non-const bytes, but only reads them. */
    *bytes = (void *)(uintptr_t)tiff->bytes;
    *size = tiff->size;
    return tiff->bytes != NULL;
}

/* Does nothing: the bytes of a file in memory stay there. */
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
    (void)user;
    (void)module;
    char text[GUARD_TEXT];
    vsnprintf(text, sizeof text, format, values);
    guard_note_message(text);
    return 1;
}

static int on_warning(TIFF *handle, void *user, const char *module, const char *format,
                      va_list values) PRINTF_LIKE(4, 0);
static int on_warning(TIFF *handle, void *user, const char *module, const char *format,
                      va_list values)
{
    (void)handle;
    (void)user;
    (void)module;
    (void)format;
    (void)values;
    return 1;
}

bool tiff_open(TiffStream *tiff, const char *name, const char *mode)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options)
        return false;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_complaint, NULL);
    TIFFOpenOptionsSetWarningHandlerExtR(options, *mode == 'w' ? on_complaint : on_warning, NULL);
    tiff->handle = TIFFClientOpenExt(name, mode, tiff, on_read, on_write, on_seek, on_close,
                                     on_size, on_map, on_unmap, options);
    TIFFOpenOptionsFree(options);
    return tiff->handle;
}
