/* PNG row by row through libpng, from a stream. setjmp stands in functions that only call the one
 * that does the work, as in png_file.c. */
#include "image/png_complaint.h"

#include <errno.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

typedef struct Rows {
    const char *name; /* borrowed */
    FILE *stream;     /* borrowed */
    png_structp png;
    png_infop info;
    ImageForm form;
    ImageNotes notes;
    ImageNote *note; /* owned; texts are libpng's */
    PngComplaint complaint;
} Rows;

static bool png_rows_is(const ImageBytes *file)
{
    return file->size >= 8 && png_sig_cmp(file->bytes, 0, 8) == 0;
}

static Status unsound(const Rows *self, Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", self->name, err);
    return err_set(err, STATUS_INPUT, "%s: is not a sound PNG file: %s", self->name,
                   self->complaint.text);
}

static Status take_notes(Rows *self, Err *err)
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

/* libpng refuses a header whose sides are not positive. */
static Status read_header(Rows *self, Err *err)
{
    png_structp png = self->png;
    png_infop info = self->info;
    png_init_io(png, self->stream);
    png_set_user_limits(png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
    png_read_info(png, info);
    int type = png_get_color_type(png, info), bits = png_get_bit_depth(png, info);
    bool plain = (type == PNG_COLOR_TYPE_GRAY || type == PNG_COLOR_TYPE_RGB ||
                  type == PNG_COLOR_TYPE_RGB_ALPHA) &&
                 bits >= 8 && png_get_interlace_type(png, info) == PNG_INTERLACE_NONE;
    double gamma = 0;
    bool linear = png_get_gAMA(png, info, &gamma) && gamma == 1;
    if (!plain || png_get_valid(png, info, PNG_INFO_tRNS))
        return image_no_rows(self->name, err);
    TRY(take_notes(self, err));
    self->form = (ImageForm){.width = (int)png_get_image_width(png, info),
                             .height = (int)png_get_image_height(png, info),
                             .channels = png_get_channels(png, info),
                             .bits = bits,
                             .encoding = linear ? ENCODING_LINEAR : ENCODING_SRGB,
                             .notes = &self->notes};
    return STATUS_OK;
}

static Status begin_guarded(Rows *self, Err *err)
{
    if (setjmp(png_jmpbuf(self->png)))
        return unsound(self, err);
    TRY(read_header(self, err));
    /* libpng goes on without a chunk that it had no room for. */
    return errno == ENOMEM ? mem_out_of("to read", self->name, err) : STATUS_OK;
}

static Status begin(FILE *stream, const char *name, ImageForm *form, void **self, Err *err)
{
    Rows *rows;
    TRY(mem_calloc(&rows, 1, sizeof *rows, "readers", err));
    *self = rows;
    rows->name = name;
    rows->stream = stream;
    errno = 0;
    rows->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &rows->complaint, png_on_error,
                                       png_on_warning);
    rows->info = rows->png ? png_create_info_struct(rows->png) : NULL;
    if (!rows->info)
        return mem_out_of("to read", name, err);
    TRY(begin_guarded(rows, err));
    *form = rows->form;
    return STATUS_OK;
}

/* 16-bit codes come with the high byte first; each is put together where it stands. */
static void put_together(uint16_t *codes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint8_t bytes[2];
        memcpy(bytes, &codes[i], sizeof bytes);
        codes[i] = (uint16_t)(bytes[0] << 8 | bytes[1]);
    }
}

static void read_rows(const Rows *self, void *values, int n)
{
    size_t samples = (size_t)self->form.width * (size_t)self->form.channels;
    uint8_t *codes8 = values;
    uint16_t *codes16 = values;
    for (size_t y = 0; y < (size_t)n; y++) {
        if (self->form.bits == 8) {
            png_read_row(self->png, codes8 + y * samples, NULL);
            continue;
        }
        png_read_row(self->png, (png_bytep)(codes16 + y * samples), NULL);
        put_together(codes16 + y * samples, samples);
    }
}

static Status rows(void *self, void *values, int n, Err *err)
{
    const Rows *reader = self;
    errno = 0;
    if (setjmp(png_jmpbuf(reader->png)))
        return unsound(reader, err);
    read_rows(reader, values, n);
    return STATUS_OK;
}

static Status end(void *self, Err *err)
{
    const Rows *reader = self;
    errno = 0;
    if (setjmp(png_jmpbuf(reader->png)))
        return feof(reader->stream) ? png_without_end(reader->name, err) : unsound(reader, err);
    png_read_end(reader->png, NULL);
    return STATUS_OK;
}

static void release(void *self)
{
    Rows *reader = self;
    if (!reader)
        return;
    png_destroy_read_struct(&reader->png, &reader->info, NULL);
    free(reader->note);
    free(reader);
}

const RowDecoder png_rows_decoder = {png_rows_is, begin, rows, end, release};
