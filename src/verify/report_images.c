/* Pictures as parts of a page: PNG files in base64 (RFC 4648), and thumbnails, each of whose pixels
 * is the mean of a square of the picture's, so that thin vessels stay visible. */
#include "verify/report.h"

enum { THUMBNAIL_WIDTH = 96 };

static void base64(Text *out, const char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (i + k < size ? (uint8_t)bytes[i + k] : 0u);
        char four[4];
        for (int k = 0; k < 4; k++)
            four[k] = i + (size_t)k <= size ? digits[bits >> (18 - 6 * k) & 63] : '=';
        text_append(out, four, 4);
    }
}

Status report_picture(Text *part, const Picture *picture, Err *err)
{
    Text png = TEXT_INIT;
    Status status = picture_to_png(picture, ENCODING_SRGB, NULL, &png, err);
    if (status == STATUS_OK) {
        text_puts(part, "data:image/png;base64,");
        base64(part, text_chars(&png), png.length);
    }
    text_release(&png);
    return status;
}

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
