/* Reads and writes PNG with libpng. Whole files of the common form are decoded by png_fast.c
 * instead. png_fast.c also compresses the pixels of files that are written. */
#include "image/png_fast.h"

#include <errno.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

static void on_error(png_structp png, png_const_charp message)
{
    (void)png;
    guard_leave(message);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* ---- reading -------------------------------------------------------------------------------- */

typedef struct PngReader {
    ImageInput input;
    png_structp png;
    png_infop info;
    bool has_pixels; /* all pixels have been read */
    ImageNotes notes;
    ImageNote *note; /* owned; its texts are libpng's */
} PngReader;

static bool png_is(const ImageBytes *file)
{
    return file->size >= 8 && png_sig_cmp(file->bytes, 0, 8) == 0;
}

static void read_bytes(png_structp png, png_bytep out, size_t size)
{
    const PngReader *self = png_get_io_ptr(png);
    if (fread(out, 1, size, self->input.stream) != size)
        png_error(png, self->has_pixels ? "it ends before its IEND chunk; its pixels are whole"
                                        : "the file ends too early");
}

static void open_png(PngReader *self)
{
    self->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    self->info = self->png ? png_create_info_struct(self->png) : NULL;
    if (!self->info)
        guard_leave_without_memory();
    png_set_read_fn(self->png, self, read_bytes);
    png_set_user_limits(self->png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
}

static void read_rows(const PngReader *self, void *values, size_t samples, int bits, int n)
{
    uint8_t *codes8 = values;
    uint16_t *codes16 = values;
    for (size_t y = 0; y < (size_t)n; y++)
        png_read_row(self->png,
                     bits == 8 ? codes8 + y * samples : (uint8_t *)(codes16 + y * samples), NULL);
}

static void release_reader(void *work)
{
    PngReader *self = work;
    png_destroy_read_struct(&self->png, &self->info, NULL);
    free(self->note);
}

/* ---- reading: whole files -------------------------------------------------------------------- */

/* Returns the data of a chunk that libpng does not interpret, if it has this size; else NULL. */
static const uint8_t *find_unknown(PngReader *self, const char *type, size_t size)
{
    png_unknown_chunkp chunks;
    int n = png_get_unknown_chunks(self->png, self->info, &chunks);
    for (int i = 0; i < n; i++)
        if (memcmp(chunks[i].name, type, 4) == 0 && chunks[i].size == size)
            return chunks[i].data;
    return NULL;
}

static Status check_single(PngReader *self, Err *err)
{
    const uint8_t *animation = find_unknown(self, "acTL", 8);
    png_uint_32 frames = animation ? png_get_uint_32(animation) : 1;
    if (frames > 1)
        return err_set(err, STATUS_INPUT,
                       "%s: is an animation of %u pictures; it must be a single picture",
                       self->input.file.name, (unsigned)frames);
    return STATUS_OK;
}

static bool has_srgb_primaries(PngReader *self)
{
    double white[2], xy[8];
    png_get_cHRM(self->png, self->info, &white[0], &white[1], &xy[0], &xy[1], &xy[2], &xy[3],
                 &xy[4], &xy[5]);
    memcpy(xy + 6, white, sizeof white);
    return image_is_srgb(xy);
}

/* Checks the color space and sets *gamma, 0 for sRGB. The chunks are read in the order of their
 * precedence [PNG 3, section 13.13]. libpng turns a profile that it knows into an sRGB chunk.
 *
 * `srgb` is the content of a cICP chunk for sRGB: primaries of Rec. 709, transfer function of sRGB,
 * RGB, full range. A gAMA chunk holds the gamma of the file times 100,000. Values within 50 of
 * srgb_gamma, 1 / 2.2, count as sRGB: programs round 1 / 2.2 to two to five digits. */
static Status read_colors(PngReader *self, double *gamma, Err *err)
{
    static const uint8_t srgb[4] = {1, 13, 0, 1};
    static const png_fixed_point srgb_gamma = 45455;
    png_structp png = self->png;
    png_infop info = self->info;
    const char *file = self->input.file.name;
    const uint8_t *code_points = find_unknown(self, "cICP", 4);
    if (code_points)
        return memcmp(code_points, srgb, 4) == 0 ? STATUS_OK
                                                 : image_fail_not_srgb(file, "cICP chunk", err);
    if (png_get_valid(png, info, PNG_INFO_sRGB))
        return STATUS_OK;
    png_charp name;
    png_bytep profile;
    png_uint_32 size;
    int method;
    if (png_get_iCCP(png, info, &name, &method, &profile, &size))
        return image_check_profile(file, profile, size, err);
    if (png_get_valid(png, info, PNG_INFO_cHRM) && !has_srgb_primaries(self))
        return image_fail_not_srgb(file, "cHRM chunk", err);
    png_fixed_point fixed;
    if (png_get_gAMA_fixed(png, info, &fixed) && abs(fixed - srgb_gamma) > 50)
        *gamma = fixed / 1e5;
    return STATUS_OK;
}

static Status decode_with_libpng(PngReader *self, Err *err)
{
    static const png_byte kept[] = "acTL\0cICP"; /* types of chunks for find_unknown */
    Picture *picture = &self->input.image.picture;
    double gamma = 0;
    open_png(self);
    png_structp png = self->png;
    png_infop info = self->info;
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, kept, 2);
    png_read_info(png, info);
    TRY(check_single(self, err));
    TRY(read_colors(self, &gamma, err));
    int width = (int)png_get_image_width(png, info), height = (int)png_get_image_height(png, info);
    TRY(image_check_stated_size(&self->input.file, width, height,
                                png_get_rowbytes(png, info) * (size_t)height,
                                self->input.file.size * DEFLATE_MAX_RATIO, err));
    png_set_expand(png);
    int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    TRY(picture_init(picture, width, height, png_get_channels(png, info),
                     png_get_bit_depth(png, info), err));
    picture->gamma = gamma;
    for (int pass = 0; pass < passes; pass++)
        read_rows(self, picture_codes(picture), picture_stride(picture), picture->bits, height);
    if (picture->bits == 16)
        png_swap_codes(picture->codes16, picture_stride(picture) * (size_t)height);
    self->has_pixels = true;
    png_read_end(png, NULL);
    return STATUS_OK;
}

static Status decode(void *work, Err *err)
{
    PngReader *self = work;
    if (png_decode_plain(&self->input.file, &self->input.image.picture))
        return STATUS_OK;
    errno = 0;
    return decode_with_libpng(self, err);
}

/* ---- reading: rows --------------------------------------------------------------------------- */

/* Reads the texts and the resolution of the file. */
static Status take_notes(PngReader *self, Err *err)
{
    png_textp text = NULL;
    int n = png_get_text(self->png, self->info, &text, NULL);
    TRY(mem_calloc(&self->note, (size_t)n, sizeof *self->note, "PNG texts", err));
    for (int i = 0; i < n; i++)
        self->note[i] = (ImageNote){text[i].key, text[i].text};
    png_uint_32 per_metre = png_get_pixels_per_meter(self->png, self->info);
    self->notes = (ImageNotes){self->note, n, per_metre * MM_PER_INCH / 1000};
    return STATUS_OK;
}

/* Reads the header of a file that is read row by row. Refuses files whose rows need a conversion.
 * libpng checks that the sides in the header are positive. */
static Status begin_reading(void *work, Err *err)
{
    PngReader *self = work;
    open_png(self);
    png_structp png = self->png;
    png_infop info = self->info;
    png_read_info(png, info);
    int type = png_get_color_type(png, info), bits = png_get_bit_depth(png, info);
    bool plain = (type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_RGB ||
                  type == PNG_COLOR_TYPE_RGB_ALPHA) &&
                 bits >= 8 && png_get_interlace_type(png, info) == PNG_INTERLACE_NONE;
    double gamma = 0;
    bool linear = png_get_gAMA(png, info, &gamma) && gamma == 1;
    if (!plain || png_get_valid(png, info, PNG_INFO_tRNS))
        return image_fail_no_rows(self->input.file.name, err);
    TRY(take_notes(self, err));
    self->input.form = (ImageForm){.width = (int)png_get_image_width(png, info),
                                   .height = (int)png_get_image_height(png, info),
                                   .channels = png_get_channels(png, info),
                                   .bits = bits,
                                   .encoding = linear ? ENCODING_LINEAR : ENCODING_SRGB,
                                   .notes = &self->notes};
    return STATUS_OK;
}

static Status rows(void *work, Err *err)
{
    (void)err;
    PngReader *self = work;
    const ImageInput *input = &self->input;
    size_t samples = (size_t)input->form.width * (size_t)input->form.channels;
    read_rows(self, input->rows, samples, input->form.bits, input->n_rows);
    if (input->form.bits == 16)
        png_swap_codes(input->rows, samples * (size_t)input->n_rows);
    return STATUS_OK;
}

static Status end_reading(void *work, Err *err)
{
    (void)err;
    PngReader *self = work;
    self->has_pixels = true;
    png_read_end(self->png, NULL);
    return STATUS_OK;
}

/* ---- reading: facts -------------------------------------------------------------------------- */

/* Maximum size of a chunk that libpng decompresses: 64 MiB, more than any color profile has. It
 * bounds the memory that a file can claim. */
enum { MAX_CHUNK_BYTES = 1 << 26 };

static Status get_facts(void *work, Err *err)
{
    (void)err;
    PngReader *self = work;
    ImageFacts *facts = &self->input.facts;
    png_charp name;
    png_bytep profile;
    png_uint_32 size;
    int method;
    open_png(self);
    png_structp png = self->png;
    png_infop info = self->info;
    png_set_chunk_malloc_max(png, MAX_CHUNK_BYTES);
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
    return STATUS_OK;
}

const ImageDecoder png_decoder = {.format = "PNG",
                                  .state_size = sizeof(PngReader),
                                  .is = png_is,
                                  .decode = decode,
                                  .get_facts = get_facts,
                                  .begin = begin_reading,
                                  .rows = rows,
                                  .end = end_reading,
                                  .release = release_reader};

/* ---- writing --------------------------------------------------------------------------------- */

typedef struct PngWriter {
    ImageOutput output;
    png_structp png;
    png_infop info;
    PngDeflater *deflater; /* owned */
    png_text *chunks;      /* owned */
} PngWriter;

static bool is_ascii(const char *text)
{
    while (*text && (unsigned char)*text < 0x80)
        text++;
    return !*text;
}

/* Stores the notes and the resolution. A tEXt chunk is Latin-1. Text that is not ASCII goes into an
 * iTXt chunk, which is UTF-8. */
static void set_notes(PngWriter *self, const ImageNotes *notes)
{
    for (int i = 0; i < notes->count; i++) {
        const ImageNote *note = &notes->notes[i];
        /* libpng copies both strings; the members of its struct just lack the const. */
        png_text *chunk = &self->chunks[i];
        memcpy(&chunk->key, &note->key, sizeof chunk->key);
        memcpy(&chunk->text, &note->text, sizeof chunk->text);
        chunk->compression =
            is_ascii(note->text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    }
    png_set_text(self->png, self->info, self->chunks, notes->count);
    if (notes->dpi > 0) {
        png_uint_32 per_metre = (png_uint_32)(notes->dpi * 1000 / MM_PER_INCH + 0.5);
        png_set_pHYs(self->png, self->info, per_metre, per_metre, PNG_RESOLUTION_METER);
    }
}

static int color_type(int channels)
{
    return channels == 1   ? PNG_COLOR_TYPE_GRAY
           : channels == 3 ? PNG_COLOR_TYPE_RGB
                           : PNG_COLOR_TYPE_RGB_ALPHA;
}

static void write_header(PngWriter *self)
{
    const ImageForm *form = &self->output.form;
    png_init_io(self->png, self->output.stream);
    png_set_user_limits(self->png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
    png_set_IHDR(self->png, self->info, (png_uint_32)form->width, (png_uint_32)form->height,
                 form->bits, color_type(form->channels), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (form->encoding == ENCODING_SRGB)
        png_set_sRGB(self->png, self->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else
        png_set_gAMA(self->png, self->info, 1.0);
    if (form->notes)
        set_notes(self, form->notes);
    png_write_info(self->png, self->info);
}

/* Minimum height, in pixels, of pictures that are written with the filter Up. Pictures of vessels
 * on a plain background repeat long sequences of bytes, which a filter would break up. Without a
 * filter most files are up to a quarter smaller and are written in half the time. The filter helps
 * only in pictures so large that neighbouring rows hardly differ. */
enum { FILTERED_HEIGHT = 6000 };

static Status begin_writing(void *work, Err *err)
{
    PngWriter *self = work;
    const ImageForm *form = &self->output.form;
    TRY(pngdeflater_open(&self->deflater, form, form->height >= FILTERED_HEIGHT, err));
    self->output.chunk_rows = pngdeflater_rows_at_once(self->deflater);
    TRY(mem_calloc(&self->chunks, form->notes ? (size_t)form->notes->count : 0,
                   sizeof *self->chunks, "PNG texts", err));
    self->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    self->info = self->png ? png_create_info_struct(self->png) : NULL;
    if (!self->info)
        guard_leave_without_memory();
    write_header(self);
    return STATUS_OK;
}

/* A PngTakeBytes: writes the bytes as an IDAT chunk. libpng adds the checksum. */
static void write_bytes(void *self, const uint8_t *bytes, size_t n)
{
    png_write_chunk(((PngWriter *)self)->png, (png_const_bytep) "IDAT", bytes, n);
}

static Status write_rows(void *work, Err *err)
{
    (void)err;
    PngWriter *self = work;
    ImageOutput *output = &self->output;
    if (output->form.bits == 16)
        png_swap_codes((uint16_t *)(void *)output->chunk,
                       (size_t)output->n * output->row_bytes / 2);
    pngdeflater_rows(self->deflater, output->chunk, output->n, write_bytes, self);
    return STATUS_OK;
}

static Status end_writing(void *work, Err *err)
{
    (void)err;
    PngWriter *self = work;
    png_write_chunk(self->png, (png_const_bytep) "IEND", NULL, 0);
    return STATUS_OK;
}

static void release_writer(void *work)
{
    PngWriter *self = work;
    png_destroy_write_struct(&self->png, &self->info);
    free(self->chunks);
    pngdeflater_free(self->deflater);
}

const RowEncoder png_encoder = {.format = "PNG",
                                .state_size = sizeof(PngWriter),
                                .begin = begin_writing,
                                .rows = write_rows,
                                .end = end_writing,
                                .release = release_writer,
                                .max_ratio = DEFLATE_MAX_RATIO,
                                .traits = {.keeps_dpi = true, .keeps_alpha = true}};
