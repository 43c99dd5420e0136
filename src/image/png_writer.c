/* PNG through libpng, except the pixels, which png_fast.c compresses. */
#include "image/png_fast.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

typedef struct PngWriter {
    ImageOutput output;
    png_structp png;
    png_infop info;
    PngDeflater *deflater; /* owned */
    png_text *chunks;      /* owned */
} PngWriter;

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

static bool is_ascii(const char *text)
{
    while (*text && (unsigned char)*text < 0x80)
        text++;
    return !*text;
}

/* A tEXt chunk is Latin-1. Text that is not ASCII goes into an iTXt chunk, which is UTF-8. */
static void set_provenance(PngWriter *self, const ImageNotes *notes)
{
    for (int i = 0; i < notes->count; i++) {
        const ImageNote *note = &notes->notes[i];
        /* libpng copies both; its struct merely lacks the const. */
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
        set_provenance(self, form->notes);
    png_write_info(self->png, self->info);
}

/* Vessels on a plain ground repeat whole stretches of bytes, which filters hide. Without a filter
 * most files are smaller, by up to a quarter, and are written in half the time. Differences are
 * shorter only in pictures so large that shades hardly change from row to row. */
enum { FILTERED_HEIGHT = 6000 };

static Status begin(void *work, Err *err)
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

/* A PngTakeBytes. libpng writes the chunk and its checksum. */
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

static Status end(void *work, Err *err)
{
    (void)err;
    PngWriter *self = work;
    png_write_chunk(self->png, (png_const_bytep) "IEND", NULL, 0);
    return STATUS_OK;
}

static void release(void *work)
{
    PngWriter *self = work;
    png_destroy_write_struct(&self->png, &self->info);
    free(self->chunks);
    pngdeflater_free(self->deflater);
}

const RowEncoder png_encoder = {.format = "PNG",
                                .state_size = sizeof(PngWriter),
                                .begin = begin,
                                .rows = write_rows,
                                .end = end,
                                .release = release,
                                .folds = DEFLATE_MAX_RATIO,
                                .keeps_dpi = true,
                                .keeps_alpha = true};
