/* Handles the alpha channel of decoded images, for all formats. Decoders leave alpha as the last
 * channel. The colors of a Picture are not multiplied by alpha, as in PNG. The colors of a Plane
 * are multiplied by alpha, as in OpenEXR. Compositing is done in linear light, because only linear
 * values add as light does. */
#include "image/formats.h"

static int channels_of(const Image *image)
{
    return image->plane.values ? image->plane.channels : image->picture.channels;
}

static size_t pixels_of(const Image *image)
{
    return image->plane.values ? (size_t)image->plane.width * (size_t)image->plane.height
                               : (size_t)image->picture.width * (size_t)image->picture.height;
}

static bool has_alpha(const Image *image)
{
    int channels = channels_of(image);
    return channels == 2 || channels == 4;
}

/* Returns the alpha of a pixel, from 0 to 1. */
static float alpha_at(const Image *image, size_t pixel)
{
    size_t at = (pixel + 1) * (size_t)channels_of(image) - 1;
    if (image->plane.values)
        return image->plane.values[at];
    return (float)picture_code(&image->picture, at) / (image->picture.bits == 8 ? 255 : 65535);
}

/* Returns the number of opaque pixels before the first one that is not. */
static size_t count_opaque(const Image *image)
{
    size_t n = pixels_of(image), samples = (size_t)channels_of(image), i = 0;
    const Picture *picture = &image->picture;
    const uint16_t opaque = picture->bits == 8 ? 255 : 65535;
    if (image->plane.values)
        while (i < n && image->plane.values[(i + 1) * samples - 1] == 1)
            i++;
    else
        while (i < n && picture_code(picture, (i + 1) * samples - 1) == opaque)
            i++;
    return i;
}

static void drop_alpha(Image *image)
{
    Picture *picture = &image->picture;
    size_t n = pixels_of(image), samples = (size_t)channels_of(image), kept = samples - 1;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < kept; c++)
            if (image->plane.values)
                image->plane.values[i * kept + c] = image->plane.values[i * samples + c];
            else
                picture_set(picture, i * kept + c, picture_code(picture, i * samples + c));
    *(image->plane.values ? &image->plane.channels : &picture->channels) = (int)kept;
}

/* Replaces the colors by a mask [ALPHA_IS_MASK], and removes alpha. */
static void make_mask(Image *image)
{
    Picture *picture = &image->picture;
    size_t samples = (size_t)picture->channels;
    for (size_t i = 0; i < pixels_of(image); i++)
        for (size_t c = 0, code = alpha_at(image, i) < 0.5f ? 0 : 255; c + 1 < samples; c++)
            picture_set(picture, i * samples + c, (uint16_t)code);
    drop_alpha(image);
}

/* Converts a picture from 2 channels (grey, alpha) to 4 channels (red, green, blue, alpha). */
static Status widen_grey(Picture *picture, Err *err)
{
    Picture wide;
    TRY(picture_init(&wide, picture->width, picture->height, 4, picture->bits, err));
    wide.gamma = picture->gamma;
    size_t n = picture_stride(&wide) * (size_t)wide.height;
    for (size_t i = 0; i < n; i++)
        picture_set(&wide, i, picture_code(picture, i / 4 * 2 + (i % 4 == 3)));
    picture_release(picture);
    *picture = wide;
    return STATUS_OK;
}

static Status refuse(const Image *image, size_t pixel, const char *name, Err *err)
{
    size_t width = (size_t)(image->plane.values ? image->plane.width : image->picture.width);
    return err_set(err, STATUS_INPUT,
                   "%s: is transparent at column %zu, row %zu; the picture must be opaque", name,
                   pixel % width, pixel / width);
}

Status image_apply_alpha(Image *image, ImageAlpha alpha, const char *name, Err *err)
{
    if (!has_alpha(image))
        return STATUS_OK;
    size_t opaque = count_opaque(image);
    if (opaque == pixels_of(image))
        drop_alpha(image);
    else if (alpha == ALPHA_IS_MASK && image->picture.width > 0)
        make_mask(image);
    else if (alpha != ALPHA_KEPT)
        return refuse(image, opaque, name, err);
    else if (channels_of(image) == 2 && image->picture.width > 0)
        return widen_grey(&image->picture, err);
    return STATUS_OK;
}

/* ---- backgrounds ----------------------------------------------------------------------------- */

/* Puts the plane before a background of one color: color + (1 - alpha) * background. */
static Status composite_plane(const Plane *plane, const float background[3], Plane *composited,
                              Err *err)
{
    const size_t samples = (size_t)plane->channels;
    TRY(plane_init(composited, plane->width, plane->height, 3, err));
    for (size_t i = 0; i < (size_t)plane->width * (size_t)plane->height; i++) {
        const float *pixel = plane->values + i * samples;
        for (size_t c = 0; c < 3; c++)
            composited->values[3 * i + c] =
                pixel[samples == 2 ? 0 : c] + (1 - pixel[samples - 1]) * background[c];
    }
    return STATUS_OK;
}

/* Decodes a picture of 4 channels to linear colors and multiplies the colors by alpha. */
static Status multiply(const Image *image, Plane *plane, Err *err)
{
    TRY(plane_from_picture(plane, &image->picture, err));
    for (size_t i = 0; i < pixels_of(image); i++) {
        float alpha = alpha_at(image, i);
        for (size_t c = 0; c < 3; c++)
            plane->values[4 * i + c] *= alpha;
        plane->values[4 * i + 3] = alpha;
    }
    return STATUS_OK;
}

static Status composite_picture(Image *image, const float background[3], Err *err)
{
    Plane plane, composited = {0};
    Picture made = {0};
    Encoding encoding = image->picture.gamma == 1 ? ENCODING_LINEAR : ENCODING_SRGB;
    TRY(multiply(image, &plane, err));
    Status status = composite_plane(&plane, background, &composited, err);
    plane_release(&plane);
    if (status == STATUS_OK)
        status = picture_from_plane(&made, &composited, encoding, image->picture.bits, err);
    plane_release(&composited);
    TRY(status);
    image->transparent = image->picture;
    image->picture = made;
    return STATUS_OK;
}

Status image_composite(Image *image, const float background[3], Err *err)
{
    Plane composited;
    if (!has_alpha(image))
        return STATUS_OK;
    if (!image->plane.values)
        return composite_picture(image, background, err);
    TRY(composite_plane(&image->plane, background, &composited, err));
    plane_release(&image->plane);
    image->plane = composited;
    return STATUS_OK;
}
