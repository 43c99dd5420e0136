/* What PNG, TIFF and JPEG files say of themselves, asked of the libraries that read them; no pixel
 * is. The libraries' ways of failing are those that png_file.c, tiff_stream.c and jpeg_writer.c
 * tell of. */
#include "image/tiff_stream.h"

#include <errno.h>
#include <jpeglib.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

static Status unsound(const ImageBytes *file, const char *what, const char *complaint, Err *err)
{
    return errno == ENOMEM ? mem_out_of("to read", file->name, err)
                           : err_set(err, STATUS_INPUT, "%s: is not a sound %s file: %s",
                                     file->name, what, complaint);
}

/* ---- PNG ------------------------------------------------------------------------------------- */

typedef struct Png {
    ImageBytes file;
    size_t at;
    png_structp png;
    png_infop info;
    char complaint[200];
} Png;

static void on_png_error(png_structp png, png_const_charp message)
{
    Png *self = png_get_error_ptr(png);
    snprintf(self->complaint, sizeof self->complaint, "%s", message);
    image_plain_text(self->complaint);
    longjmp(png_jmpbuf(png), 1);
}

static void on_png_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void read_bytes(png_structp png, png_bytep out, size_t size)
{
    Png *self = png_get_io_ptr(png);
    if (size > self->file.size - self->at)
        png_error(png, "the file ends too early");
    memcpy(out, self->file.bytes + self->at, size);
    self->at += size;
}

enum { MOST_OF_A_CHUNK = 1 << 26 }; /* bytes; a profile's */

static void take_png(Png *self, ImageFacts *facts)
{
    png_structp png = self->png;
    png_infop info = self->info;
    png_charp name;
    png_bytep profile;
    png_uint_32 size;
    int method;
    png_set_read_fn(png, self, read_bytes);
    png_set_chunk_malloc_max(png, MOST_OF_A_CHUNK);
    png_set_user_limits(png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
    png_read_info(png, info);
    int type = png_get_color_type(png, info);
    *facts = (ImageFacts){.format = "png",
                          .compression = "deflate",
                          .width = (int)png_get_image_width(png, info),
                          .height = (int)png_get_image_height(png, info),
                          .bits = png_get_bit_depth(png, info),
                          .pages = 1,
                          .colors = type & PNG_COLOR_MASK_COLOR ? "rgb" : "grey"};
    facts->has_alpha = (type & PNG_COLOR_MASK_ALPHA) || png_get_valid(png, info, PNG_INFO_tRNS);
    facts->dpi = png_get_pixels_per_meter(png, info) * MM_PER_INCH / 1000;
    if (png_get_valid(png, info, PNG_INFO_sRGB))
        snprintf(facts->profile, sizeof facts->profile, "sRGB");
    else if (png_get_iCCP(png, info, &name, &method, &profile, &size))
        image_profile_name(profile, size, facts->profile);
}

static Status png_guarded(Png *self, ImageFacts *facts, Err *err)
{
    if (setjmp(png_jmpbuf(self->png)))
        return unsound(&self->file, "PNG", self->complaint, err);
    take_png(self, facts);
    return STATUS_OK;
}

static Status png_facts(const ImageBytes *file, ImageFacts *facts, Err *err)
{
    Png self = {.file = *file};
    errno = 0;
    self.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &self, on_png_error, on_png_warning);
    self.info = self.png ? png_create_info_struct(self.png) : NULL;
    Status status =
        self.info ? png_guarded(&self, facts, err) : mem_out_of("to read", file->name, err);
    png_destroy_read_struct(&self.png, &self.info, NULL);
    return status;
}

/* ---- TIFF ------------------------------------------------------------------------------------ */

typedef struct TiffFacts {
    TiffStream tiff;
    const ImageBytes *file;
    ImageFacts facts;
} TiffFacts;

static const char *tiff_compression(uint16_t compression)
{
    return compression == COMPRESSION_NONE  ? "none"
           : compression == COMPRESSION_LZW ? "lzw"
           : compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE
               ? "deflate"
           : compression == COMPRESSION_JPEG     ? "jpeg"
           : compression == COMPRESSION_PACKBITS ? "packbits"
                                                 : "another";
}

static const char *tiff_colors(uint16_t photometric)
{
    return photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_PALETTE ? "rgb"
           : photometric == PHOTOMETRIC_SEPARATED                               ? "cmyk"
           : photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE
               ? "grey"
               : "another";
}

static double tiff_dpi(TIFF *handle)
{
    float resolution = 0;
    uint16_t unit;
    TIFFGetFieldDefaulted(handle, TIFFTAG_RESOLUTIONUNIT, &unit);
    if (!TIFFGetField(handle, TIFFTAG_XRESOLUTION, &resolution) || unit == RESUNIT_NONE)
        return 0;
    return (double)resolution * (unit == RESUNIT_CENTIMETER ? MM_PER_INCH / 10 : 1);
}

static Status take_tiff(void *work, Err *err)
{
    TiffFacts *self = work;
    if (!tiff_open(&self->tiff, self->file->name, "r")) {
        image_plain_text(self->tiff.complaint);
        return unsound(self->file, "TIFF", self->tiff.complaint, err);
    }
    TIFF *handle = self->tiff.handle;
    uint32_t width = 0, height = 0, size;
    uint16_t bits, compression, photometric = PHOTOMETRIC_YCBCR, extra, *kinds;
    const void *profile;
    TIFFGetField(handle, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(handle, TIFFTAG_IMAGELENGTH, &height);
    TIFFGetField(handle, TIFFTAG_PHOTOMETRIC, &photometric);
    TIFFGetFieldDefaulted(handle, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(handle, TIFFTAG_COMPRESSION, &compression);
    TIFFGetFieldDefaulted(handle, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
    self->facts = (ImageFacts){.format = "tif",
                               .compression = tiff_compression(compression),
                               .width = (int)width,
                               .height = (int)height,
                               .bits = bits,
                               .dpi = tiff_dpi(handle),
                               .has_alpha = extra > 0,
                               .colors = tiff_colors(photometric)};
    if (TIFFGetField(handle, TIFFTAG_ICCPROFILE, &size, &profile))
        image_profile_name(profile, size, self->facts.profile);
    self->facts.pages = TIFFNumberOfDirectories(handle);
    return STATUS_OK;
}

static Status tiff_facts(const ImageBytes *file, ImageFacts *facts, Err *err)
{
    TiffFacts self = {.file = file};
    Status status = tiff_guard_bytes(take_tiff, &self, &self.tiff, file, err);
    if (status == STATUS_OK)
        *facts = self.facts;
    return status;
}

/* ---- JPEG ------------------------------------------------------------------------------------ */

typedef struct Jpeg {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    jmp_buf way_out;
    char complaint[JMSG_LENGTH_MAX];
    JOCTET *profile; /* owned */
} Jpeg;

static void on_jpeg_error(j_common_ptr jpeg)
{
    Jpeg *self = jpeg->client_data;
    jpeg->err->format_message(jpeg, self->complaint);
    image_plain_text(self->complaint);
    longjmp(self->way_out, 1);
}

static void on_jpeg_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

static void take_jpeg(Jpeg *self, const ImageBytes *file, ImageFacts *facts)
{
    struct jpeg_decompress_struct *jpeg = &self->jpeg;
    unsigned size;
    jpeg_create_decompress(jpeg);
    jpeg_mem_src(jpeg, file->bytes, file->size);
    jpeg_save_markers(jpeg, JPEG_APP0 + 2, 0xffff);
    jpeg_read_header(jpeg, TRUE);
    double per_unit[] = {0, 1, MM_PER_INCH / 10};
    *facts = (ImageFacts){.format = "jpg",
                          .compression = "jpeg",
                          .width = (int)jpeg->image_width,
                          .height = (int)jpeg->image_height,
                          .bits = jpeg->data_precision,
                          .pages = 1,
                          .colors = jpeg->num_components == 1   ? "grey"
                                    : jpeg->num_components == 3 ? "rgb"
                                                                : "cmyk"};
    if (jpeg->saw_JFIF_marker && jpeg->density_unit <= 2)
        facts->dpi = jpeg->X_density * per_unit[jpeg->density_unit];
    if (jpeg_read_icc_profile(jpeg, &self->profile, &size))
        image_profile_name(self->profile, size, facts->profile);
}

static Status jpeg_guarded(Jpeg *self, const ImageBytes *file, ImageFacts *facts, Err *err)
{
    errno = 0;
    if (setjmp(self->way_out))
        return unsound(file, "JPEG", self->complaint, err);
    take_jpeg(self, file, facts);
    return STATUS_OK;
}

static Status jpeg_facts(const ImageBytes *file, ImageFacts *facts, Err *err)
{
    Jpeg *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "readers", err));
    self->jpeg.err = jpeg_std_error(&self->errors);
    self->jpeg.client_data = self;
    self->errors.error_exit = on_jpeg_error;
    self->errors.output_message = on_jpeg_message;
    Status status = jpeg_guarded(self, file, facts, err);
    jpeg_destroy_decompress(&self->jpeg);
    free(self->profile);
    free(self);
    return status;
}

/* ---- all ------------------------------------------------------------------------------------- */

static const struct {
    const char *begins;
    size_t length;
    const char *format; /* of files that only their names identify */
    Status (*facts)(const ImageBytes *file, ImageFacts *facts, Err *err);
} kinds[] = {{"\x89PNG", 4, NULL, png_facts},
             {"\xff\xd8\xff", 3, NULL, jpeg_facts},
             {"II*\0", 4, NULL, tiff_facts},
             {"MM\0*", 4, NULL, tiff_facts},
             {"II+\0", 4, NULL, tiff_facts},
             {"MM\0+", 4, NULL, tiff_facts},
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

Status image_facts(const char *path, ImageFacts *out, Err *err)
{
    static const FileForm form = {
        .name = "a picture or a page", .most_bytes = 16e9, .begins = is_known};
    char *bytes;
    size_t size;
    ImageFacts facts = {0};
    TRY(file_read(path, &form, &bytes, &size, err));
    const ImageBytes file = {.name = path, .bytes = (const uint8_t *)bytes, .size = size};
    size_t kind = kind_of(bytes, size);
    Status status = STATUS_OK;
    if (kinds[kind].facts)
        status = kinds[kind].facts(&file, &facts, err);
    else
        facts.format = kinds[kind].format;
    facts.bytes = size;
    free(bytes);
    if (status == STATUS_OK)
        *out = facts;
    return status;
}
