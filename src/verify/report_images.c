/* Thumbnails, each of whose pixels is the mean of a square of the picture's, so that thin vessels
 * stay visible. */
#include "verify/report.h"

enum { THUMBNAIL_WIDTH = 96 };

/* A picture of at most THUMBNAIL_WIDTH pixels across, each the mean of a box. */
Status report_thumbnail(Picture *out, const Picture *picture, Err *err)
{
    int factor = (picture->width + THUMBNAIL_WIDTH - 1) / THUMBNAIL_WIDTH;
    int width = picture->width / factor, height = picture->height / factor;
    height = height ? height : 1;
    size_t channels = (size_t)picture->channels;
    TRY(picture_init(out, width, height, picture->channels, 8, err));
    for (int y = 0; y < height; y++)
        for (size_t i = 0; i < (size_t)width * channels; i++) {
            size_t x = i / channels * (size_t)factor, sum = 0, count = 0;
            for (int v = y * factor; v < (y + 1) * factor && v < picture->height; v++)
                for (size_t u = x; u < x + (size_t)factor; u++, count++)
                    sum += picture_code(picture, (size_t)v * picture_stride(picture) +
                                                     u * channels + i % channels);
            size_t mean = (sum + count / 2) / count;
            picture_set(out, (size_t)y * picture_stride(out) + i,
                        (uint16_t)(picture->bits == 8 ? mean : mean / 257));
        }
    return STATUS_OK;
}
