/* JPEG through libjpeg, from the file in memory: grey or colours of 8 bits, decoded by the integer
 * transform, chroma interpolated: what every viewer shows. A picture that Exif says is turned is
 * refused, since programs disagree about whether to turn it.
 *
 * libjpeg reports an error by a function that must not return: it jumps to where decode_guarded
 * calls the one that does the work. */
#include "image/formats.h"

#include <errno.h>
#include <jpeglib.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    ImageBytes file;
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    jmp_buf way_out;
    char complaint[JMSG_LENGTH_MAX];
    bool damaged;    /* libjpeg warned, and made something up */
    JOCTET *profile; /* owned */
    Picture picture; /* owned */
} Reader;

static bool jpeg_is(const ImageBytes *file)
{
    return file->size >= 3 && memcmp(file->bytes, "\xff\xd8\xff", 3) == 0;
}

static void on_error(j_common_ptr jpeg)
{
    Reader *self = jpeg->client_data;
    jpeg->err->format_message(jpeg, self->complaint);
    longjmp(self->way_out, 1);
}

/* A warning is that data are missing or broken. */
static void on_message(j_common_ptr jpeg, int level)
{
    Reader *self = jpeg->client_data;
    if (level >= 0 || self->damaged)
        return;
    self->damaged = true;
    jpeg->err->format_message(jpeg, self->complaint);
}

static Status unsound(Reader *self, Err *err)
{
    if (errno == ENOMEM)
        return mem_out_of("to read", self->file.name, err);
    image_plain_text(self->complaint);
    return err_set(err, STATUS_INPUT, "%s: is not a sound JPEG file: %s", self->file.name,
                   self->complaint);
}

/* ---- Exif ------------------------------------------------------------------------------------ */

static unsigned number_at(const uint8_t *at, int n, bool little)
{
    unsigned value = 0;
    for (int i = 0; i < n; i++)
        value = value << 8 | at[little ? n - 1 - i : i];
    return value;
}

/* The Orientation in the first directory of Exif's TIFF [CIPA DC-008]; 1, upright, when there is
 * none. */
static unsigned orientation_of(const jpeg_saved_marker_ptr marker)
{
    enum { NAME = 6, ENTRY = 12, TAG = 0x0112 };
    if (marker->data_length < NAME + 8 || memcmp(marker->data, "Exif\0\0", NAME) != 0)
        return 1;
    const uint8_t *tiff = marker->data + NAME;
    size_t size = marker->data_length - NAME;
    bool little = tiff[0] == 'I';
    size_t at = number_at(tiff + 4, 4, little);
    if (at + 2 > size)
        return 1;
    unsigned n = number_at(tiff + at, 2, little);
    for (at += 2; n > 0 && at + ENTRY <= size; n--, at += ENTRY)
        if (number_at(tiff + at, 2, little) == TAG)
            return number_at(tiff + at + 8, 2, little);
    return 1;
}

/* ---- picture --------------------------------------------------------------------------------- */

static Status check_header(Reader *self, Err *err)
{
    struct jpeg_decompress_struct *jpeg = &self->jpeg;
    unsigned size;
    const char *name = self->file.name;
    for (jpeg_saved_marker_ptr marker = jpeg->marker_list; marker; marker = marker->next)
        if (marker->marker == JPEG_APP0 + 1 && orientation_of(marker) != 1)
            return err_set(err, STATUS_INPUT,
                           "%s: is turned by its Exif orientation, %u; only upright ones can be "
                           "read",
                           name, orientation_of(marker));
    bool grey = jpeg->jpeg_color_space == JCS_GRAYSCALE;
    bool inks = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    if (!grey && jpeg->jpeg_color_space != JCS_YCbCr && jpeg->jpeg_color_space != JCS_RGB)
        return err_set(err, STATUS_INPUT, "%s: has %s; only grey and RGB can be read", name,
                       inks ? "the colours of inks (CMYK)" : "colours of an unknown kind");
    if (jpeg_read_icc_profile(jpeg, &self->profile, &size))
        TRY(image_check_profile(name, self->profile, size, err));
    jpeg->out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    TRY(image_check_sides(name, jpeg->image_width, jpeg->image_height, err));
    size_t pixels = (size_t)jpeg->image_width * jpeg->image_height;
    enum {
        RATIO = 4000
    }; /* a block of 64 pixels takes two bits or more, but in runs of blank ones */
    TRY(image_check_claim(&self->file, jpeg->image_width, jpeg->image_height, 3 * pixels,
                          self->file.size * RATIO, err));
    return picture_init(&self->picture, (int)jpeg->image_width, (int)jpeg->image_height,
                        grey ? 1 : 3, 8, err);
}

/* The work between setjmp and the end: may not return when libjpeg finds an error. */
static Status decode(Reader *self, Err *err)
{
    jpeg_create_decompress(&self->jpeg);
    jpeg_save_markers(&self->jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(&self->jpeg, JPEG_APP0 + 2, 0xffff);
    jpeg_mem_src(&self->jpeg, self->file.bytes, self->file.size);
    jpeg_read_header(&self->jpeg, TRUE);
    TRY(check_header(self, err));
    jpeg_start_decompress(&self->jpeg);
    while (self->jpeg.output_scanline < self->jpeg.output_height) {
        JSAMPROW row =
            self->picture.codes8 + self->jpeg.output_scanline * picture_stride(&self->picture);
        jpeg_read_scanlines(&self->jpeg, &row, 1);
    }
    jpeg_finish_decompress(&self->jpeg);
    return self->damaged ? unsound(self, err) : STATUS_OK;
}

static Status decode_guarded(Reader *self, Err *err)
{
    errno = 0;
    if (setjmp(self->way_out))
        return unsound(self, err);
    return decode(self, err);
}

static Status jpeg_decode(const ImageBytes *file, Image *image, Err *err)
{
    Reader *self;
    TRY(mem_calloc(&self, 1, sizeof *self, "readers", err));
    self->file = *file;
    self->jpeg.err = jpeg_std_error(&self->errors);
    self->jpeg.client_data = self;
    self->errors.error_exit = on_error;
    self->errors.emit_message = on_message;
    Status status = decode_guarded(self, err);
    jpeg_destroy_decompress(&self->jpeg);
    if (status == STATUS_OK) {
        image->picture = self->picture;
        image->lossy = "JPEG";
    } else {
        picture_release(&self->picture);
    }
    free(self->profile);
    free(self);
    return status;
}

const ImageDecoder jpeg_decoder = {.is = jpeg_is, .decode = jpeg_decode};
