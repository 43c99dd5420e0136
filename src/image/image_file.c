/* The format of a file is recognised by its first bytes, whatever its name. The whole file is read
 * before it is decoded: readers then know how much there is, and need no file that can be wound
 * back, so that standard input will do. */
#include "image/formats.h"

#include <stdlib.h>
#include <string.h>

static const ImageDecoder *const decoders[] = {&png_decoder, &pnm_decoder,  &pfm_decoder,
                                               &exr_decoder, &tiff_decoder, &jpeg_decoder,
                                               &webp_decoder};

/* NULL when the file is of no known format. */
static const ImageDecoder *decoder_of(const ImageBytes *file)
{
    for (size_t i = 0; i < sizeof decoders / sizeof *decoders; i++)
        if (decoders[i]->is(file))
            return decoders[i];
    return NULL;
}

static bool is_known(const char *start, size_t count)
{
    const ImageBytes file = {.bytes = (const uint8_t *)start, .size = count};
    return decoder_of(&file) != NULL;
}

static const char *name_of(const char *path)
{
    return strcmp(path, "-") ? path : "standard input";
}

/* `layer` may be NULL. */
static Status read_image(Image *image, const char *path, const char *layer, ImageAlpha alpha,
                         Err *err)
{
    static const FileForm form = {
        .name = "a PBM, PGM, PPM, PAM, PFM, PNG, TIFF, OpenEXR, JPEG or WebP file",
        .most_bytes = 16e9,
        .begins = is_known};
    char *bytes;
    size_t size;
    TRY(file_read(path, &form, &bytes, &size, err));
    ImageBytes file = {name_of(path), (const uint8_t *)bytes, size, layer};
    Image made = {0};
    const ImageDecoder *decoder = decoder_of(&file);
    Status status =
        layer && !decoder->has_layers
            ? err_set(err, STATUS_INPUT, "%s: has no layer '%s': only OpenEXR files have layers",
                      file.name, layer)
            : decoder->decode(&file, &made, err);
    free(bytes);
    if (status == STATUS_OK)
        status = image_settle_alpha(&made, alpha, file.name, err);
    if (status == STATUS_MEMORY)
        err_prefix(err, "%s: ", file.name);
    if (status == STATUS_OK)
        *image = made;
    else
        image_release(&made);
    return status;
}

Status image_read(Image *image, const char *path, Err *err)
{
    return read_image(image, path, NULL, ALPHA_REFUSED, err);
}

Status image_read_transparent(Image *image, const char *path, Err *err)
{
    return read_image(image, path, NULL, ALPHA_KEPT, err);
}

Status image_read_layer(Image *image, const char *path, const char *layer, bool transparent,
                        Err *err)
{
    return read_image(image, path, layer, transparent ? ALPHA_KEPT : ALPHA_REFUSED, err);
}

static Status read_picture(Picture *picture, const char *path, ImageAlpha alpha, Err *err)
{
    Image image;
    TRY(read_image(&image, path, NULL, alpha, err));
    if (image.plane.values) {
        image_release(&image);
        return err_set(err, STATUS_INPUT,
                       "%s: holds floats; a picture of 8 or 16 bits is wanted here", name_of(path));
    }
    *picture = image.picture;
    return STATUS_OK;
}

Status picture_read(Picture *picture, const char *path, Err *err)
{
    return read_picture(picture, path, ALPHA_REFUSED, err);
}

Status picture_read_transparent(Picture *picture, const char *path, Err *err)
{
    return read_picture(picture, path, ALPHA_KEPT, err);
}

Status picture_read_mask(Picture *picture, const char *path, Err *err)
{
    return read_picture(picture, path, ALPHA_IS_MASK, err);
}

static Status read_plane(Plane *plane, const char *path, ImageAlpha alpha, Err *err)
{
    Image image;
    TRY(read_image(&image, path, NULL, alpha, err));
    if (!image.plane.values) {
        image_release(&image);
        return err_set(
            err, STATUS_INPUT,
            "%s: holds whole numbers; a plane of floats (PFM, OpenEXR or TIFF) is wanted "
            "here",
            name_of(path));
    }
    *plane = image.plane;
    return STATUS_OK;
}

Status plane_read(Plane *plane, const char *path, Err *err)
{
    return read_plane(plane, path, ALPHA_REFUSED, err);
}

Status plane_read_transparent(Plane *plane, const char *path, Err *err)
{
    return read_plane(plane, path, ALPHA_KEPT, err);
}
