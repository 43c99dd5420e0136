/* Reads whole image files of any supported format. The format is recognised by the first bytes of
 * the file, not by its name. The whole file is read before it is decoded. Decoders then know the
 * size of the file and can seek in it, even if it came from standard input. */
#include "image/formats.h"

#include <stdlib.h>
#include <string.h>

static const ImageDecoder *const decoders[] = {&png_decoder, &pnm_decoder,  &pfm_decoder,
                                               &exr_decoder, &tiff_decoder, &jpeg_decoder,
                                               &webp_decoder};

const ImageDecoder *imagedecoder_of(const ImageBytes *file)
{
    for (size_t i = 0; i < sizeof decoders / sizeof *decoders; i++)
        if (decoders[i]->is(file))
            return decoders[i];
    return NULL;
}

static bool is_known(const char *start, size_t count)
{
    const ImageBytes file = {.bytes = (const uint8_t *)start, .size = count};
    return imagedecoder_of(&file) != NULL;
}

static const char *name_of(const char *path)
{
    return strcmp(path, "-") ? path : "standard input";
}

Status imageinput_open(const ImageDecoder *decoder, const ImageBytes *file, FILE *stream,
                       ImageInput **out, Err *err)
{
    ImageInput *input;
    TRY(mem_calloc(&input, 1, decoder->state_size, "readers", err));
    input->guard.format = decoder->format;
    input->guard.name = file->name;
    input->decoder = decoder;
    input->file = *file;
    /* fmemopen takes a pointer to non-const bytes, but in mode "rb" it only reads them. */
    input->stream = stream ? stream : fmemopen((void *)(uintptr_t)file->bytes, file->size, "rb");
    if (input->stream) {
        *out = input;
        return STATUS_OK;
    }
    free(input);
    return mem_out_of("to read", file->name, err);
}

void imageinput_close(ImageInput *input)
{
    if (!input)
        return;
    if (input->decoder->release)
        input->decoder->release(input);
    if (input->file.bytes)
        fclose(input->stream);
    image_release(&input->image);
    free(input);
}

/* Decodes a file in memory. file->layer may be NULL. */
static Status decode(const ImageBytes *file, ImageAlpha alpha, Image *image, Err *err)
{
    const ImageDecoder *decoder = imagedecoder_of(file);
    if (file->layer && !decoder->has_layers)
        return err_set(err, STATUS_INPUT, "%s: has no layer '%s': only OpenEXR files have layers",
                       file->name, file->layer);
    ImageInput *input = NULL;
    Status status;
    TRY_GOTO(imageinput_open(decoder, file, NULL, &input, err));
    TRY_GOTO(guard_run(&input->guard, decoder->decode, input, err));
    TRY_GOTO(image_apply_alpha(&input->image, alpha, file->name, err));
    *image = input->image;
    input->image = (Image){0};
done:
    if (status == STATUS_MEMORY)
        err_prefix(err, "%s: ", file->name);
    imageinput_close(input);
    return status;
}

Status image_read(Image *image, const char *path, ImageAlpha alpha, const char *layer, Err *err)
{
    static const FileForm form = {
        .name = "a PBM, PGM, PPM, PAM, PFM, PNG, TIFF, OpenEXR, JPEG or WebP file",
        .most_bytes = 16e9,
        .begins = is_known};
    char *bytes;
    size_t size;
    TRY(file_read(path, &form, &bytes, &size, err));
    const ImageBytes file = {name_of(path), (const uint8_t *)bytes, size, layer};
    Status status = decode(&file, alpha, image, err);
    free(bytes);
    return status;
}

Status picture_read(Picture *picture, const char *path, ImageAlpha alpha, Err *err)
{
    Image image;
    TRY(image_read(&image, path, alpha, NULL, err));
    if (image.plane.values) {
        image_release(&image);
        return err_set(err, STATUS_INPUT,
                       "%s: holds floats; a picture of 8 or 16 bits is needed here", name_of(path));
    }
    *picture = image.picture;
    return STATUS_OK;
}

Status image_decode(Image *image, const char *name, const void *bytes, size_t size,
                    ImageAlpha alpha, Err *err)
{
    const ImageBytes file = {name, bytes, size, NULL};
    if (!is_known(bytes, size))
        return err_set(err, STATUS_INPUT, "%s: is not an image of a known format", name);
    return decode(&file, alpha, image, err);
}

Status plane_read(Plane *plane, const char *path, ImageAlpha alpha, Err *err)
{
    Image image;
    TRY(image_read(&image, path, alpha, NULL, err));
    if (!image.plane.values) {
        image_release(&image);
        return err_set(
            err, STATUS_INPUT,
            "%s: holds integers; a picture of floats (PFM, OpenEXR or TIFF) is needed here",
            name_of(path));
    }
    *plane = image.plane;
    return STATUS_OK;
}
