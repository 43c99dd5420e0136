/* Which format a file has: told by its extension when writing, by its first bytes when reading. */
#include "image/formats.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum PictureFormat { FORMAT_PPM, FORMAT_PGM, FORMAT_PNG } PictureFormat;

static Status choose_format(const Picture *picture, const char *path, PictureFormat *format,
                            Err *err)
{
    const char *extension = file_extension(path);
    if (strcmp(path, "-") == 0 || strcasecmp(extension, "ppm") == 0)
        *format = FORMAT_PPM;
    else if (strcasecmp(extension, "pgm") == 0)
        *format = FORMAT_PGM;
    else if (strcasecmp(extension, "png") == 0)
        *format = FORMAT_PNG;
    else
        return err_set(err, STATUS_USAGE,
                       "%s: the extension of a picture must be .ppm, .pgm or .png", path);
    if (*format == FORMAT_PGM && picture->channels != 1)
        return err_set(err, STATUS_USAGE, "%s: a colour picture cannot be a .pgm; use .ppm or .png",
                       path);
    return STATUS_OK;
}

Status picture_write(const Picture *picture, const char *path, Encoding encoding,
                     const ImageNotes *notes, Err *err)
{
    PictureFormat format;
    TRY(choose_format(picture, path, &format, err));
    OutFile file;
    TRY(outfile_open(&file, path, err));
    Status status = format == FORMAT_PNG
                        ? png_encode(file.stream, picture, encoding, notes, err)
                        : pnm_encode(file.stream, picture, format == FORMAT_PGM ? 1 : 3, err);
    if (status == STATUS_OK)
        return outfile_commit(&file, err);
    err_prefix(err, "%s: ", path);
    outfile_discard(&file);
    return status;
}

Status picture_to_png(const Picture *picture, Encoding encoding, const ImageNotes *notes, Text *out,
                      Err *err)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    if (!stream)
        return err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG: %s", strerror(errno));
    Status status = png_encode(stream, picture, encoding, notes, err);
    if (fclose(stream) != 0 && status == STATUS_OK)
        status = err_set(err, STATUS_MEMORY, "out of memory: no room for a PNG of %zu bytes", size);
    if (status == STATUS_OK) {
        text_append(out, bytes, size);
        status = text_check(out, err);
    }
    free(bytes);
    return status;
}

static Status decode(const ImageBytes *file, Image *image, Err *err)
{
    if (png_is(file))
        return png_decode(file, &image->picture, err);
    if (pnm_is(file))
        return pnm_decode(file, &image->picture, err);
    if (pfm_is(file))
        return pfm_decode(file, &image->plane, err);
    if (exr_is(file))
        return exr_decode(file, &image->plane, err);
    if (tiff_is(file))
        return tiff_decode(file, image, err);
    return err_set(err, STATUS_INPUT, "%s: is not a PPM, PGM, PFM, PNG, TIFF or OpenEXR file",
                   file->name);
}

void image_plain_text(char *text)
{
    for (; *text; text++)
        if (*text < ' ' || *text > '~')
            *text = ' ';
}

static const char *name_of(const char *path)
{
    return strcmp(path, "-") ? path : "standard input";
}

Status image_read(Image *image, const char *path, Err *err)
{
    char *bytes;
    size_t size;
    TRY(file_read(path, &bytes, &size, err));
    ImageBytes file = {name_of(path), (const uint8_t *)bytes, size};
    Image made = {0};
    Status status = decode(&file, &made, err);
    free(bytes);
    if (status == STATUS_OK)
        *image = made;
    return status;
}

Status picture_read(Picture *picture, const char *path, Err *err)
{
    Image image;
    TRY(image_read(&image, path, err));
    if (image.plane.values) {
        image_release(&image);
        return err_set(err, STATUS_INPUT,
                       "%s: holds floats; a picture of 8 or 16 bits is wanted here", name_of(path));
    }
    *picture = image.picture;
    return STATUS_OK;
}

Status plane_read(Plane *plane, const char *path, Err *err)
{
    Image image;
    TRY(image_read(&image, path, err));
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
