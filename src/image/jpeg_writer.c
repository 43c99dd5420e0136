/* JPEG through libjpeg, row by row: baseline, the colours of neighbouring pixels not shared
 * (4:4:4), since red vessels on white would bleed. The integer transform gives the same bytes on
 * every machine. JFIF has no CMYK; its header is written all the same, as it holds the resolution,
 * and inks are stored inverted after an Adobe marker, as every reader expects.
 *
 * libjpeg reports an error by a function that must not return: it jumps to where a function of this
 * file calls the one that does the work. */
#include "image/formats.h"

#include <errno.h>
#include <jpeglib.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_QUALITY = 95 };

typedef struct Writer {
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    jmp_buf way_out;
    char complaint[JMSG_LENGTH_MAX];
    bool created, inverted;
    uint8_t *row;         /* owned; inverted */
    ImageProfile profile; /* owned */
    char *description;    /* owned */
    ImageForm form;       /* its packing and notes are for `begin` */
    FILE *stream;
} Writer;

static void on_error(j_common_ptr jpeg)
{
    Writer *self = jpeg->client_data;
    jpeg->err->format_message(jpeg, self->complaint);
    image_plain_text(self->complaint);
    longjmp(self->way_out, 1);
}

static void on_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

static Status failed(const Writer *self, Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("for the JPEG", "that is written", err);
    return err_set(err, STATUS_IO, "writing the JPEG failed: %s",
                   ferror(self->stream) ? strerror(errno) : self->complaint);
}

static void set_colors(Writer *self)
{
    static const J_COLOR_SPACE spaces[] = {[1] = JCS_GRAYSCALE, [3] = JCS_RGB, [4] = JCS_CMYK};
    const int quality = self->form.packing.quality;
    self->jpeg.image_width = (JDIMENSION)self->form.width;
    self->jpeg.image_height = (JDIMENSION)self->form.height;
    self->jpeg.input_components = self->form.channels;
    self->jpeg.in_color_space = spaces[self->form.channels];
    jpeg_set_defaults(&self->jpeg);
    jpeg_set_quality(&self->jpeg, quality ? quality : DEFAULT_QUALITY, TRUE);
    self->jpeg.dct_method = JDCT_ISLOW;
    for (int c = 0; c < self->jpeg.num_components; c++)
        self->jpeg.comp_info[c].h_samp_factor = self->jpeg.comp_info[c].v_samp_factor = 1;
}

static void put_comment(Writer *self, const char *text)
{
    enum { MOST = 65533 };
    if (text && *text)
        jpeg_write_marker(&self->jpeg, JPEG_COM, (const JOCTET *)text,
                          (unsigned)strnlen(text, MOST));
}

/* The work between setjmp and the end: may not return when libjpeg finds an error. */
static void write_header(Writer *self)
{
    const ImageNotes *notes = self->form.notes;
    jpeg_create_compress(&self->jpeg);
    self->created = true;
    jpeg_stdio_dest(&self->jpeg, self->stream);
    set_colors(self);
    self->jpeg.write_JFIF_header = TRUE;
    if (notes && notes->dpi > 0) {
        self->jpeg.density_unit = 1; /* dots an inch */
        self->jpeg.X_density = self->jpeg.Y_density =
            (UINT16)(notes->dpi < UINT16_MAX ? notes->dpi + 0.5 : UINT16_MAX);
    }
    jpeg_start_compress(&self->jpeg, TRUE);
    put_comment(self, self->description);
    put_comment(self, image_note(notes, "Software"));
    if (self->profile.size > 0)
        jpeg_write_icc_profile(&self->jpeg, self->profile.bytes, (unsigned)self->profile.size);
}

static Status begin_guarded(Writer *self, Err *err)
{
    errno = 0;
    if (setjmp(self->way_out))
        return failed(self, err);
    write_header(self);
    return STATUS_OK;
}

static Status begin(FILE *stream, const ImageForm *form, void **self, Err *err)
{
    Writer *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *self = writer;
    writer->stream = stream;
    writer->form = *form;
    writer->inverted = form->channels == 4;
    if (form->bits != 8)
        return err_set(err, STATUS_USAGE, "a JPEG has `bits` 8, not %d", form->bits);
    if (form->width > JPEG_MAX_DIMENSION || form->height > JPEG_MAX_DIMENSION)
        return err_set(err, STATUS_USAGE, "a JPEG has at most %ld x %ld pixels, not %d x %d",
                       JPEG_MAX_DIMENSION, JPEG_MAX_DIMENSION, form->width, form->height);
    TRY(image_profile(form, &writer->profile, err));
    TRY(image_description(form->notes, &writer->description, err));
    if (writer->inverted)
        TRY(mem_calloc(&writer->row, (size_t)form->width, 4, "bytes of a row", err));
    writer->jpeg.err = jpeg_std_error(&writer->errors);
    writer->jpeg.client_data = writer;
    writer->errors.error_exit = on_error;
    writer->errors.output_message = on_message;
    return begin_guarded(writer, err);
}

static void put_rows(Writer *self, const uint8_t *codes, int n)
{
    size_t samples = (size_t)self->form.width * (size_t)self->form.channels;
    for (int y = 0; y < n; y++, codes += samples) {
        /* It is only read, whatever libjpeg's declaration says. */
        JSAMPROW row = self->inverted ? self->row : (void *)(uintptr_t)codes;
        for (size_t i = 0; self->inverted && i < samples; i++)
            row[i] = (uint8_t)(255 - codes[i]);
        jpeg_write_scanlines(&self->jpeg, &row, 1);
    }
}

static Status write_rows(void *self, const void *values, int first, int n, Err *err)
{
    (void)first;
    Writer *writer = self;
    errno = 0;
    if (setjmp(writer->way_out))
        return failed(writer, err);
    put_rows(writer, values, n);
    return STATUS_OK;
}

static Status end(void *self, Err *err)
{
    Writer *writer = self;
    errno = 0;
    if (setjmp(writer->way_out))
        return failed(writer, err);
    jpeg_finish_compress(&writer->jpeg);
    return STATUS_OK;
}

static void release_writer(void *self)
{
    Writer *writer = self;
    if (!writer)
        return;
    if (writer->created)
        jpeg_destroy_compress(&writer->jpeg);
    free(writer->description);
    free(writer->profile.bytes);
    free(writer->row);
    free(writer);
}

const RowEncoder jpeg_encoder = {.begin = begin,
                                 .rows = write_rows,
                                 .end = end,
                                 .release = release_writer,
                                 .keeps_dpi = true,
                                 .keeps_inks = true};
