/* A PNG file in base64 [RFC 4648], as the address of a picture that a page holds itself. */
#include "image/image.h"

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

Status picture_put_uri(const Picture *picture, Text *out, Err *err)
{
    Text png = TEXT_INIT;
    Status status = picture_to_png(picture, ENCODING_SRGB, NULL, &png, err);
    if (status == STATUS_OK) {
        text_puts(out, "data:image/png;base64,");
        base64(out, text_chars(&png), png.length);
    }
    text_release(&png);
    return status;
}
