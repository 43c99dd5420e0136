/* Makes thumbnails. Each pixel is the mean of a square of pixels of the picture, so that thin
 * vessels stay visible. */
#include "compare/report/page.h"

enum { THUMBNAIL_WIDTH = 96 }; /* maximum width in pixels; it fits into a row of the page's table */

typedef struct Thumbnail {
    const Picture *from;
    Picture *to;
    int factor;
} Thumbnail;

/* Each code of a row is the mean of a square of codes. */
static void fill_row(size_t y, int worker, void *context)
{
    (void)worker;
    const Thumbnail *self = context;
    const Picture *from = self->from;
    const size_t channels = (size_t)from->channels, factor = (size_t)self->factor;
    const size_t top = y * factor, height = (size_t)from->height;
    const size_t bottom = top + factor < height ? top + factor : height;
    for (size_t i = 0; i < picture_stride(self->to); i++) {
        size_t first = i / channels * factor * channels + i % channels, sum = 0;
        for (size_t v = top; v < bottom; v++)
            for (size_t u = 0; u < factor; u++)
                sum += picture_code(from, v * picture_stride(from) + first + u * channels);
        size_t count = (bottom - top) * factor, mean = (sum + count / 2) / count;
        picture_set(self->to, y * picture_stride(self->to) + i,
                    (uint16_t)(from->bits == 8 ? mean : mean / 257));
    }
}

Status report_thumbnail(Picture *out, const Picture *picture, Err *err)
{
    int factor = (picture->width + THUMBNAIL_WIDTH - 1) / THUMBNAIL_WIDTH;
    int width = picture->width / factor, height = picture->height / factor;
    TRY(picture_init(out, width, height ? height : 1, picture->channels, 8, err));
    Thumbnail thumbnail = {picture, out, factor};
    threads_for((size_t)out->height, 0, fill_row, &thumbnail);
    return STATUS_OK;
}
