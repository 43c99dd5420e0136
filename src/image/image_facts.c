/* Finds the properties of a picture file, such as its sides, bits and resolution. The decoders of
 * PNG, TIFF and JPEG find them, and decode pixels only to find the maximum total ink of a CMYK
 * file. For files of other formats only the format and the size in bytes are found. */
#include "image/formats.h"

#include <stdlib.h>
#include <string.h>

static const struct {
    const char *begins;
    size_t length;
    const char *format;          /* format of files without a decoder here */
    const ImageDecoder *decoder; /* finds the properties; NULL: only the format is found */
} kinds[] = {{"\x89PNG", 4, NULL, &png_decoder},
             {"\xff\xd8\xff", 3, NULL, &jpeg_decoder},
             {"II*\0", 4, NULL, &tiff_decoder},
             {"MM\0*", 4, NULL, &tiff_decoder},
             {"II+\0", 4, NULL, &tiff_decoder},
             {"MM\0+", 4, NULL, &tiff_decoder},
             {"%PDF-", 5, "pdf", NULL},
             {"%!PS", 4, "eps", NULL},
             {"\xc5\xd0\xd3\xc6", 4, "eps", NULL},
             {"<?xml", 5, "svg", NULL},
             {"<svg", 4, "svg", NULL},
             {"\x76\x2f\x31\x01", 4, "exr", NULL},
             {"P6", 2, "ppm", NULL},
             {"P5", 2, "pgm", NULL},
             {"PF", 2, "pfm", NULL},
             {"8BPS", 4, "psd", NULL}};

/* Returns the index of the kind whose signature begins the file; the number of kinds if there is
 * none. */
static size_t kind_of(const char *start, size_t count)
{
    size_t i = 0;
    while (i < sizeof kinds / sizeof *kinds &&
           (count < kinds[i].length || memcmp(start, kinds[i].begins, kinds[i].length) != 0))
        i++;
    return i;
}

static bool is_known(const char *start, size_t count)
{
    return kind_of(start, count) < sizeof kinds / sizeof *kinds;
}

static Status read_facts(const ImageDecoder *decoder, const ImageBytes *file, ImageFacts *facts,
                         Err *err)
{
    ImageInput *input;
    TRY(imageinput_open(decoder, file, NULL, &input, err));
    Status status = guard_run(&input->guard, decoder->get_facts, input, err);
    *facts = input->facts;
    imageinput_close(input);
    return status;
}

Status image_facts(const char *path, ImageFacts *out, Err *err)
{
    static const FileForm form = {
        .name = "a picture or a page", .most_bytes = 16e9, .begins = is_known};
    char *bytes;
    size_t size;
    ImageFacts facts = {0};
    TRY(file_read(path, &form, &bytes, &size, err));
    const ImageBytes file = {.name = path, .bytes = (const uint8_t *)bytes, .size = size};
    const size_t kind = kind_of(bytes, size);
    Status status = STATUS_OK;
    if (kinds[kind].decoder)
        status = read_facts(kinds[kind].decoder, &file, &facts, err);
    else
        facts.format = kinds[kind].format;
    facts.bytes = size;
    free(bytes);
    if (status == STATUS_OK)
        *out = facts;
    return status;
}
