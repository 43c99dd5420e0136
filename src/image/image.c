/* Checks the sizes of images, and allocates, compares and releases images.
 *
 * An image larger than the machine's memory is refused before it is allocated. Otherwise Linux
 * would grant the memory and kill the program when the memory is used. */
#include "image/image.h"

#include "image/formats.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

Status image_check_sides(const char *name, long long width, long long height, Err *err)
{
    if (width >= 1 && width <= IMAGE_MAX_SIDE && height >= 1 && height <= IMAGE_MAX_SIDE)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: is %lld x %lld pixels; each side must be 1 to %d", name,
                   width, height, IMAGE_MAX_SIDE);
}

Status image_check_stated_size(const ImageBytes *file, long long width, long long height,
                               size_t bytes, size_t maximum, Err *err)
{
    TRY(image_check_sides(file->name, width, height, err));
    if (bytes <= maximum)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: its header announces %lld x %lld pixels, more than its %zu bytes can hold",
                   file->name, width, height, file->size);
}

Status image_check_memory(int width, int height, size_t bytes, Err *err)
{
    double machine = mem_machine_bytes();
    if ((double)bytes > machine)
        return err_set(err, STATUS_MEMORY,
                       "out of memory: an image of %d x %d pixels needs %.1f GB, and this machine "
                       "has %.1f GB",
                       width, height, (double)bytes / 1e9, machine / 1e9);
    return STATUS_OK;
}

/* mem_calloc or mem_alloc. */
typedef Status Allocator(void *out, size_t count, size_t size, const char *what, Err *err);

/* Allocates width * height pixels of pixel_bytes each, with mem_calloc or mem_alloc. */
static Status allocate(Allocator *allocator, void *out, int width, int height, size_t pixel_bytes,
                       Err *err)
{
    TRY(image_check_sides("the image", width, height, err));
    size_t count = (size_t)width * (size_t)height;
    TRY(image_check_memory(width, height, count * pixel_bytes, err));
    return allocator(out, count, pixel_bytes, "image values", err);
}

static Status make_plane(Allocator *allocator, Plane *plane, int width, int height, int channels,
                         Err *err)
{
    assert(channels >= 1 && channels <= IMAGE_MAX_CHANNELS);
    float *values;
    TRY(allocate(allocator, &values, width, height, (size_t)channels * sizeof *values, err));
    *plane = (Plane){.width = width, .height = height, .channels = channels, .values = values};
    return STATUS_OK;
}

Status plane_init(Plane *plane, int width, int height, int channels, Err *err)
{
    return make_plane(mem_calloc, plane, width, height, channels, err);
}

Status plane_init_unset(Plane *plane, int width, int height, int channels, Err *err)
{
    return make_plane(mem_alloc, plane, width, height, channels, err);
}

Status picture_init(Picture *picture, int width, int height, int channels, int bits, Err *err)
{
    assert(channels >= 1 && channels <= 4);
    assert(bits == 8 || bits == 16);
    Picture made = {.width = width, .height = height, .channels = channels, .bits = bits};
    if (bits == 8)
        TRY(allocate(mem_calloc, &made.codes8, width, height,
                     (size_t)channels * sizeof *made.codes8, err));
    else
        TRY(allocate(mem_calloc, &made.codes16, width, height,
                     (size_t)channels * sizeof *made.codes16, err));
    *picture = made;
    return STATUS_OK;
}

const uint16_t *picture_row(const Picture *picture, int y, uint16_t *scratch)
{
    size_t n = picture_stride(picture), start = (size_t)y * n;
    if (picture->bits == 16)
        return picture->codes16 + start;
    for (size_t i = 0; i < n; i++)
        scratch[i] = picture->codes8[start + i];
    return scratch;
}

/* Compares n pixels from column x on. Both pictures have the same width, channels and bits. */
bool picture_rows_equal(const Picture *a, const Picture *b, int y, int x, int n)
{
    size_t start = (size_t)y * picture_stride(a) + (size_t)x * (size_t)a->channels;
    size_t count = (size_t)n * (size_t)a->channels;
    if (a->bits == 8)
        return memcmp(a->codes8 + start, b->codes8 + start, count) == 0;
    return memcmp(a->codes16 + start, b->codes16 + start, count * sizeof *a->codes16) == 0;
}

Status idplane_init(IdPlane *ids, int width, int height, Err *err)
{
    uint32_t *values;
    TRY(allocate(mem_calloc, &values, width, height, sizeof *values, err));
    *ids = (IdPlane){.width = width, .height = height, .ids = values};
    return STATUS_OK;
}

void plane_release(Plane *plane)
{
    free(plane->values);
    *plane = (Plane){0};
}

void picture_release(Picture *picture)
{
    free(picture->codes8);
    free(picture->codes16);
    *picture = (Picture){0};
}

void idplane_release(IdPlane *ids)
{
    free(ids->ids);
    *ids = (IdPlane){0};
}

void image_release(Image *image)
{
    picture_release(&image->picture);
    picture_release(&image->transparent);
    plane_release(&image->plane);
}

void frame_release(Frame *frame)
{
    plane_release(&frame->color);
    plane_release(&frame->alpha);
    picture_release(&frame->codes);
    plane_release(&frame->depth);
    plane_release(&frame->normal);
    idplane_release(&frame->id);
}
