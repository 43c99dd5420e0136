/* A PNG file in base64 [RFC 4648], as the address of a picture that a page holds itself. */
#include "image/image.h"

Status picture_put_uri(const Picture *picture, Text *out, Err *err)
{
    Text png = TEXT_INIT;
    Status status = picture_to_png(picture, ENCODING_SRGB, NULL, &png, err);
    if (status == STATUS_OK) {
        text_puts(out, "data:image/png;base64,");
        text_base64(out, text_chars(&png), png.length);
    }
    text_release(&png);
    return status;
}
