/* Reads WebP with libwebp from a file in memory: a single 8-bit color picture, with or without
 * alpha. The compression VP8 is lossy; VP8L is lossless. */
#include "image/formats.h"

#include <string.h>
#include <webp/decode.h>

static bool webp_is(const ImageBytes *file)
{
    return file->size >= 12 && memcmp(file->bytes, "RIFF", 4) == 0 &&
           memcmp(file->bytes + 8, "WEBP", 4) == 0;
}

/* Returns the bytes of a chunk of the container [WebP Container Specification]; NULL if there is
 * none. */
static const uint8_t *find_chunk(const ImageBytes *file, const char *name, size_t *size)
{
    for (size_t at = 12; at + 8 <= file->size; at += 8 + *size + *size % 2) {
        const uint8_t *head = file->bytes + at;
        *size = head[4] | (size_t)head[5] << 8 | (size_t)head[6] << 16 | (size_t)head[7] << 24;
        if (*size > file->size - at - 8)
            return NULL;
        if (memcmp(head, name, 4) == 0)
            return head + 8;
    }
    return NULL;
}

static Status check_features(const ImageBytes *file, const WebPBitstreamFeatures *features,
                             Err *err)
{
    /* A blank picture takes a few bytes at any size. Each file may therefore hold BLANK bytes, 4096
     * x 4096 pixels, and RATIO more bytes per byte of the file. Larger values let a tiny file make
     * the program allocate more; smaller values refuse more blank pictures. */
    enum { RATIO = 10000, BLANK = 64 << 20 };
    size_t size, pixels = (size_t)features->width * (size_t)features->height;
    const uint8_t *profile = find_chunk(file, "ICCP", &size);
    if (features->has_animation)
        return err_set(err, STATUS_INPUT, "%s: is an animation; it must be a single picture",
                       file->name);
    if (profile)
        TRY(image_check_profile(file->name, profile, size, err));
    return image_check_stated_size(file, features->width, features->height, 4 * pixels,
                                   file->size * RATIO + BLANK, err);
}

/* libwebp reports a failed allocation like a broken file, but errno is then ENOMEM. */
static Status decode(void *work, Err *err)
{
    ImageInput *input = work;
    const ImageBytes *file = &input->file;
    Picture *picture = &input->image.picture;
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(file->bytes, file->size, &features) != VP8_STATUS_OK)
        return guard_failure(err);
    TRY(check_features(file, &features, err));
    TRY(picture_init(picture, features.width, features.height, features.has_alpha ? 4 : 3, 8, err));
    const size_t stride = picture_stride(picture), bytes = stride * (size_t)picture->height;
    uint8_t *(*into)(const uint8_t *, size_t, uint8_t *, size_t, int) =
        features.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    input->image.lossy = features.format == 2 ? NULL : "WebP";
    return into(file->bytes, file->size, picture->codes8, bytes, (int)stride) ? STATUS_OK
                                                                              : guard_failure(err);
}

const ImageDecoder webp_decoder = {
    .format = "WebP", .state_size = sizeof(ImageInput), .is = webp_is, .decode = decode};
