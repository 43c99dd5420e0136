/* Allocation is refused by arithmetic before it is tried: an image larger than the machine's memory
 * would otherwise be granted page by page and end the program in the middle of a run. */
#include "image/image.h"

#include "image/formats.h"
#include <assert.h>
#include <stdlib.h>
#include <unistd.h>

Status image_check_sides(const char *name, long long width, long long height, Err *err)
{
    if (width >= 1 && width <= IMAGE_MAX_SIDE && height >= 1 && height <= IMAGE_MAX_SIDE)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: is %lld x %lld pixels; each side must be 1 to %d", name,
                   width, height, IMAGE_MAX_SIDE);
}

/* width * height * channels zeroed items in *out. */
static Status allocate(void *out, int width, int height, int channels, size_t item, Err *err)
{
    TRY(image_check_sides("the image", width, height, err));
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    double needed = (double)count * (double)item;
    double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (machine > 0 && needed > machine)
        return err_set(err, STATUS_MEMORY,
                       "out of memory: an image of %d x %d pixels needs %.1f GB, and this machine "
                       "has %.1f GB",
                       width, height, needed / 1e9, machine / 1e9);
    return mem_calloc(out, count, item, "image values", err);
}

Status plane_init(Plane *plane, int width, int height, int channels, Err *err)
{
    assert(channels >= 1 && channels <= 4);
    float *values;
    TRY(allocate(&values, width, height, channels, sizeof *values, err));
    *plane = (Plane){.width = width, .height = height, .channels = channels, .values = values};
    return STATUS_OK;
}

Status picture_init(Picture *picture, int width, int height, int channels, int bits, Err *err)
{
    assert(channels == 1 || channels == 3);
    assert(bits == 8 || bits == 16);
    uint16_t *codes;
    TRY(allocate(&codes, width, height, channels, sizeof *codes, err));
    *picture = (Picture){
        .width = width, .height = height, .channels = channels, .bits = bits, .codes = codes};
    return STATUS_OK;
}

Status idplane_init(IdPlane *ids, int width, int height, Err *err)
{
    uint32_t *values;
    TRY(allocate(&values, width, height, 1, sizeof *values, err));
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
    free(picture->codes);
    *picture = (Picture){0};
}

void idplane_release(IdPlane *ids)
{
    free(ids->ids);
    *ids = (IdPlane){0};
}

void frame_release(Frame *frame)
{
    plane_release(&frame->color);
    plane_release(&frame->depth);
    plane_release(&frame->normal);
    idplane_release(&frame->id);
}
