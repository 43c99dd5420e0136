/* Reads and writes JPEG with libjpeg.
 *
 * Reading: the file is in memory, with 8-bit grey or color. It is decoded with the accurate integer
 * DCT and interpolated chroma, as common viewers do. A picture whose Exif orientation is not
 * upright is refused, because programs disagree about whether to rotate it.
 *
 * Writing: baseline JPEG, row by row. Chroma is not subsampled (4:4:4), because red vessels on
 * white would bleed. The integer DCT gives the same bytes on every machine. JFIF does not define
 * CMYK. The JFIF header is written nevertheless, because it holds the resolution. Inks are stored
 * inverted after an Adobe marker, as readers expect. */
#include "image/formats.h"

#include <jpeglib.h>
#include <stdlib.h>
#include <string.h>

/* ---- errors ---------------------------------------------------------------------------------- */

static void on_error(j_common_ptr jpeg)
{
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    guard_leave(text);
}

/* A warning (level -1) means that data are missing or corrupt, so it is treated as an error. */
static void on_message(j_common_ptr jpeg, int level)
{
    char text[JMSG_LENGTH_MAX];
    if (level >= 0)
        return;
    jpeg->err->num_warnings++;
    jpeg->err->format_message(jpeg, text);
    guard_note_message(text);
}

static struct jpeg_error_mgr *set_errors(struct jpeg_error_mgr *errors)
{
    jpeg_std_error(errors);
    errors->error_exit = on_error;
    errors->emit_message = on_message;
    return errors;
}

/* ---- reading --------------------------------------------------------------------------------- */

typedef struct JpegReader {
    ImageInput input;
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    JOCTET *profile; /* owned */
    uint8_t *row;    /* owned; of get_facts */
    uint32_t *sums;  /* owned; of get_facts: per block of a row of blocks, the sum of its codes */
} JpegReader;

static bool jpeg_is(const ImageBytes *file)
{
    return file->size >= 3 && memcmp(file->bytes, "\xff\xd8\xff", 3) == 0;
}

/* Reads the header, and stores the markers of Exif (APP1) and of color profiles (APP2). */
static void open_jpeg(JpegReader *self)
{
    self->jpeg.err = set_errors(&self->errors);
    jpeg_create_decompress(&self->jpeg);
    jpeg_save_markers(&self->jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(&self->jpeg, JPEG_APP0 + 2, 0xffff);
    jpeg_mem_src(&self->jpeg, self->input.file.bytes, self->input.file.size);
    jpeg_read_header(&self->jpeg, TRUE);
}

static void release_reader(void *work)
{
    JpegReader *self = work;
    jpeg_destroy_decompress(&self->jpeg);
    free(self->profile);
    free(self->row);
    free(self->sums);
}

/* Returns the number in `n` bytes, little-endian or big-endian. */
static unsigned number_at(const uint8_t *at, int n, bool little)
{
    unsigned value = 0;
    for (int i = 0; i < n; i++)
        value = value << 8 | at[little ? n - 1 - i : i];
    return value;
}

/* Returns the tag Orientation in the first directory of an Exif marker [CIPA DC-008]; 1 (upright)
 * if there is none. */
static unsigned orientation_of(const jpeg_saved_marker_ptr marker)
{
    enum { NAME = 6, ENTRY = 12, TAG = 0x0112 }; /* bytes; bytes; number of the tag */
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

static Status check_upright(const JpegReader *self, Err *err)
{
    for (jpeg_saved_marker_ptr marker = self->jpeg.marker_list; marker; marker = marker->next)
        if (marker->marker == JPEG_APP0 + 1 && orientation_of(marker) != 1)
            return err_set(err, STATUS_INPUT,
                           "%s: its Exif orientation is %u; it must be 1 (upright)",
                           self->input.file.name, orientation_of(marker));
    return STATUS_OK;
}

static Status check_colors(JpegReader *self, Err *err)
{
    const J_COLOR_SPACE space = self->jpeg.jpeg_color_space;
    const char *name = self->input.file.name;
    unsigned size;
    if (space != JCS_GRAYSCALE && space != JCS_YCbCr && space != JCS_RGB)
        return err_set(err, STATUS_INPUT, "%s: has %s; the colors must be gray or RGB", name,
                       space == JCS_CMYK || space == JCS_YCCK ? "CMYK colors"
                                                              : "colors of an unknown kind");
    if (jpeg_read_icc_profile(&self->jpeg, &self->profile, &size))
        return image_check_profile(name, self->profile, size, err);
    return STATUS_OK;
}

/* Checks the size of the picture and allocates it. */
static Status make_picture(JpegReader *self, Err *err)
{
    /* Maximum of bytes of RGB per byte of the file. With Huffman codes a blank block of 64 pixels
     * takes at least 2 bits, or 1 bit in a progressive file with runs of blank blocks: at most 8
     * blocks of 192 bytes per byte, 1536. MAX_RATIO is more than twice that. Blank pictures with
     * arithmetic coding can exceed it and are refused. */
    enum { MAX_RATIO = 4000 };
    const ImageBytes *file = &self->input.file;
    const struct jpeg_decompress_struct *jpeg = &self->jpeg;
    size_t pixels = (size_t)jpeg->image_width * jpeg->image_height;
    TRY(image_check_stated_size(file, jpeg->image_width, jpeg->image_height, 3 * pixels,
                                file->size * MAX_RATIO, err));
    return picture_init(&self->input.image.picture, (int)jpeg->image_width, (int)jpeg->image_height,
                        jpeg->out_color_space == JCS_RGB ? 3 : 1, 8, err);
}

static Status decode(void *work, Err *err)
{
    JpegReader *self = work;
    struct jpeg_decompress_struct *jpeg = &self->jpeg;
    Picture *picture = &self->input.image.picture;
    open_jpeg(self);
    TRY(check_upright(self, err));
    TRY(check_colors(self, err));
    jpeg->out_color_space = jpeg->jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    TRY(make_picture(self, err));
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = picture->codes8 + jpeg->output_scanline * picture_stride(picture);
        jpeg_read_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_decompress(jpeg);
    self->input.image.lossy = "JPEG";
    return self->errors.num_warnings > 0 ? guard_failure(err) : STATUS_OK;
}

/* Finds the maximum, over all complete blocks of 8 x 8 pixels, of a block's mean total ink. Codes
 * are inverted if the file has an Adobe marker. */
static Status measure_ink(JpegReader *self, Err *err)
{
    enum { INKS = 4, BLOCK = DCTSIZE, FULL = 255 * BLOCK * BLOCK };
    struct jpeg_decompress_struct *jpeg = &self->jpeg;
    const size_t blocks = jpeg->image_width / BLOCK;
    uint32_t max_sum = 0;
    TRY(mem_calloc(&self->row, (size_t)jpeg->image_width * INKS, 1, "a row of a JPEG", err));
    TRY(mem_calloc(&self->sums, blocks + 1, sizeof *self->sums, "a row of a JPEG", err));
    jpeg->out_color_space = JCS_CMYK;
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        jpeg_read_scanlines(jpeg, &self->row, 1);
        for (size_t i = 0; i < blocks * BLOCK * INKS; i++)
            self->sums[i / (BLOCK * INKS)] +=
                jpeg->saw_Adobe_marker ? 255u - self->row[i] : self->row[i];
        for (size_t k = 0; k < blocks && jpeg->output_scanline % BLOCK == 0; k++) {
            max_sum = self->sums[k] > max_sum ? self->sums[k] : max_sum;
            self->sums[k] = 0;
        }
    }
    jpeg_finish_decompress(jpeg);
    self->input.facts.ink_percent = 100.0 * max_sum / FULL;
    return self->errors.num_warnings > 0 ? guard_failure(err) : STATUS_OK;
}

static Status get_facts(void *work, Err *err)
{
    /* Dots per inch, per density of 1 in each unit: none, per inch, per centimetre. */
    static const double per_unit[] = {0, 1, MM_PER_INCH / 10};
    JpegReader *self = work;
    struct jpeg_decompress_struct *jpeg = &self->jpeg;
    ImageFacts *facts = &self->input.facts;
    unsigned size;
    open_jpeg(self);
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
    return jpeg->num_components == 4 ? measure_ink(self, err) : STATUS_OK;
}

const ImageDecoder jpeg_decoder = {.format = "JPEG",
                                   .state_size = sizeof(JpegReader),
                                   .is = jpeg_is,
                                   .decode = decode,
                                   .get_facts = get_facts,
                                   .release = release_reader};

/* ---- writing --------------------------------------------------------------------------------- */

/* The quality of libjpeg, 1 to 100, if the caller states none. At 95 the errors of a rendered
 * picture are hardly visible; higher values make files much larger. */
enum { DEFAULT_QUALITY = 95 };

typedef struct JpegWriter {
    ImageOutput output;
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
} JpegWriter;

static void set_colors(JpegWriter *self)
{
    static const J_COLOR_SPACE spaces[] = {[1] = JCS_GRAYSCALE, [3] = JCS_RGB, [4] = JCS_CMYK};
    const ImageForm *form = &self->output.form;
    struct jpeg_compress_struct *jpeg = &self->jpeg;
    jpeg->image_width = (JDIMENSION)form->width;
    jpeg->image_height = (JDIMENSION)form->height;
    jpeg->input_components = form->channels;
    jpeg->in_color_space = spaces[form->channels];
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, form->packing.quality ? form->packing.quality : DEFAULT_QUALITY, TRUE);
    jpeg->dct_method = JDCT_ISLOW;
    for (int c = 0; c < jpeg->num_components; c++)
        jpeg->comp_info[c].h_samp_factor = jpeg->comp_info[c].v_samp_factor = 1;
}

static void put_comment(JpegWriter *self, const char *text)
{
    enum { MAX_BYTES = 65533 }; /* a marker has a length of 16 bits, which counts itself */
    if (text && *text)
        jpeg_write_marker(&self->jpeg, JPEG_COM, (const JOCTET *)text,
                          (unsigned)strnlen(text, MAX_BYTES));
}

static void write_header(JpegWriter *self)
{
    const ImageOutput *output = &self->output;
    const ImageNotes *notes = output->form.notes;
    self->jpeg.err = set_errors(&self->errors);
    jpeg_create_compress(&self->jpeg);
    jpeg_stdio_dest(&self->jpeg, output->stream);
    set_colors(self);
    self->jpeg.write_JFIF_header = TRUE;
    if (notes && notes->dpi > 0) {
        self->jpeg.density_unit = 1; /* dots per inch */
        self->jpeg.X_density = self->jpeg.Y_density =
            (UINT16)(notes->dpi < UINT16_MAX ? notes->dpi + 0.5 : UINT16_MAX);
    }
    jpeg_start_compress(&self->jpeg, TRUE);
    put_comment(self, output->description);
    put_comment(self, image_note(notes, "Software"));
    if (output->profile.size > 0)
        jpeg_write_icc_profile(&self->jpeg, output->profile.bytes, (unsigned)output->profile.size);
}

static Status begin(void *work, Err *err)
{
    JpegWriter *self = work;
    const ImageForm *form = &self->output.form;
    if (form->bits != 8)
        return err_set(err, STATUS_USAGE, "a JPEG has `bits` 8, not %d", form->bits);
    if (form->width > JPEG_MAX_DIMENSION || form->height > JPEG_MAX_DIMENSION)
        return err_set(err, STATUS_USAGE, "a JPEG has at most %ld x %ld pixels, not %d x %d",
                       JPEG_MAX_DIMENSION, JPEG_MAX_DIMENSION, form->width, form->height);
    if (form->channels == 4)
        TRY(mem_calloc(&self->output.row, self->output.row_bytes, 1, "bytes of a row", err));
    write_header(self);
    return STATUS_OK;
}

/* Inks are inverted in the workspace output.row. */
static Status write_rows(void *work, Err *err)
{
    (void)err;
    JpegWriter *self = work;
    const size_t samples = self->output.row_bytes;
    const uint8_t *codes = self->output.values;
    for (int y = 0; y < self->output.n; y++, codes += samples) {
        /* libjpeg takes a pointer to a non-const row, but only reads the row. */
        JSAMPROW row = self->output.row ? self->output.row : (void *)(uintptr_t)codes;
        for (size_t i = 0; self->output.row && i < samples; i++)
            row[i] = (uint8_t)(255 - codes[i]);
        jpeg_write_scanlines(&self->jpeg, &row, 1);
    }
    return STATUS_OK;
}

static Status end(void *work, Err *err)
{
    (void)err;
    JpegWriter *self = work;
    jpeg_finish_compress(&self->jpeg);
    return STATUS_OK;
}

static void release_writer(void *work)
{
    JpegWriter *self = work;
    jpeg_destroy_compress(&self->jpeg);
}

const RowEncoder jpeg_encoder = {.format = "JPEG",
                                 .state_size = sizeof(JpegWriter),
                                 .begin = begin,
                                 .rows = write_rows,
                                 .end = end,
                                 .release = release_writer,
                                 .traits = {.keeps_dpi = true, .has_profile = true}};
