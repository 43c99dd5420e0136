/* PNG through libpng: reading what png_plain.c leaves to it, and writing all but the pixels, which
 * png_stripes.c compresses. libpng reports an error
 * by longjmp; setjmp therefore stands in functions that only call the one that does the work, and
 * everything that work allocates hangs on a struct outside it, so that nothing leaks and no local
 * is clobbered.
 *
 * What a header claims is bounded before allocation. */
#include "image/png_complaint.h"
#include "image/png_stripes.h"

#include <errno.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

static bool png_is(const ImageBytes *file)
{
    return file->size >= 8 && png_sig_cmp(file->bytes, 0, 8) == 0;
}

void png_on_error(png_structp png, png_const_charp message)
{
    PngComplaint *complaint = png_get_error_ptr(png);
    snprintf(complaint->text, sizeof complaint->text, "%s", message);
    image_plain_text(complaint->text);
    longjmp(png_jmpbuf(png), 1);
}

void png_on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

Status png_without_end(const char *name, Err *err)
{
    return err_set(err, STATUS_INPUT,
                   "%s: ends before its IEND chunk; its pixels are whole, but the file was cut off",
                   name);
}

/* ------------------------------------------------------------------------------------ reading */

typedef struct Reader {
    ImageBytes file;
    size_t at;
    png_structp png;
    png_infop info;
    uint8_t *bytes;              /* owned; all rows */
    png_bytep *rows;             /* owned; into bytes */
    Picture picture;             /* owned */
    double gamma;                /* of the picture */
    bool ends_early, has_pixels; /* more bytes were wanted than there are; all pixels were read */
    PngComplaint complaint;
    Err *err;
} Reader;

static void read_bytes(png_structp png, png_bytep out, size_t size)
{
    Reader *self = png_get_io_ptr(png);
    self->ends_early = size > self->file.size - self->at;
    if (self->ends_early)
        png_error(png, "the file ends too early");
    memcpy(out, self->file.bytes + self->at, size);
    self->at += size;
}

static Status allocate_rows(Reader *self, int height, size_t row_size)
{
    TRY(mem_calloc(&self->bytes, (size_t)height, row_size, "bytes of a PNG row", self->err));
    TRY(mem_calloc(&self->rows, (size_t)height, sizeof *self->rows, "PNG rows", self->err));
    for (int y = 0; y < height; y++)
        self->rows[y] = self->bytes + (size_t)y * row_size;
    return STATUS_OK;
}

/* Takes the rows into the picture, alpha among its channels. */
static void take_rows(Reader *self)
{
    Picture *picture = &self->picture;
    size_t stride = picture_stride(picture);
    for (int y = 0; y < picture->height; y++) {
        const uint8_t *row = self->rows[y];
        for (size_t i = 0; i < stride; i++)
            picture_set(
                picture, (size_t)y * stride + i,
                (uint16_t)(picture->bits == 16 ? row[2 * i] << 8 | row[2 * i + 1] : row[i]));
    }
}

/* -- what the codes mean */

static const uint8_t *find_unknown(Reader *self, const char *type, size_t size)
{
    png_unknown_chunkp chunks;
    int n = png_get_unknown_chunks(self->png, self->info, &chunks);
    for (int i = 0; i < n; i++)
        if (memcmp(chunks[i].name, type, 4) == 0 && chunks[i].size == size)
            return chunks[i].data;
    return NULL;
}

static Status check_single(Reader *self)
{
    const uint8_t *animation = find_unknown(self, "acTL", 8);
    png_uint_32 frames = animation ? png_get_uint_32(animation) : 1;
    if (frames > 1)
        return err_set(self->err, STATUS_INPUT,
                       "%s: is an animation of %u pictures; only a single one can be read",
                       self->file.name, (unsigned)frames);
    return STATUS_OK;
}

static bool has_srgb_primaries(Reader *self)
{
    double white[2], xy[8];
    png_get_cHRM(self->png, self->info, &white[0], &white[1], &xy[0], &xy[1], &xy[2], &xy[3],
                 &xy[4], &xy[5]);
    memcpy(xy + 6, white, sizeof white);
    return image_is_srgb(xy);
}

/* The chunks in the order in which one outdoes the other [PNG 3, section 13.13]. libpng takes a
 * profile that it knows for an sRGB chunk. */
static Status read_meaning(Reader *self)
{
    static const uint8_t srgb[4] = {1, 13, 0, 1};
    static const png_fixed_point srgb_gamma = 45455;
    png_structp png = self->png;
    png_infop info = self->info;
    const uint8_t *code_points = find_unknown(self, "cICP", 4);
    if (code_points)
        return memcmp(code_points, srgb, 4) == 0
                   ? STATUS_OK
                   : image_other_colors(self->file.name, "cICP chunk", self->err);
    if (png_get_valid(png, info, PNG_INFO_sRGB))
        return STATUS_OK;
    png_charp name;
    png_bytep profile;
    png_uint_32 size;
    int method;
    if (png_get_iCCP(png, info, &name, &method, &profile, &size))
        return image_check_profile(self->file.name, profile, size, self->err);
    if (png_get_valid(png, info, PNG_INFO_cHRM) && !has_srgb_primaries(self))
        return image_other_colors(self->file.name, "cHRM chunk", self->err);
    png_fixed_point gamma;
    if (png_get_gAMA_fixed(png, info, &gamma) && abs(gamma - srgb_gamma) > 50)
        self->gamma = gamma / 1e5;
    return STATUS_OK;
}

/* The work between setjmp and the end: may not return when libpng finds an error. */
static Status read_picture(Reader *self)
{
    static const png_byte kept[] = "acTL\0cICP";
    png_structp png = self->png;
    png_infop info = self->info;
    png_set_read_fn(png, self, read_bytes);
    png_set_user_limits(png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, kept, 2);
    png_read_info(png, info);
    TRY(check_single(self));
    TRY(read_meaning(self));
    int width = (int)png_get_image_width(png, info);
    int height = (int)png_get_image_height(png, info);
    TRY(image_check_claim(&self->file, width, height, png_get_rowbytes(png, info) * (size_t)height,
                          self->file.size * DEFLATE_MAX_RATIO, self->err));
    png_set_expand(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    TRY(picture_init(&self->picture, width, height, png_get_channels(png, info),
                     png_get_bit_depth(png, info), self->err));
    self->picture.gamma = self->gamma;
    TRY(allocate_rows(self, height, png_get_rowbytes(png, info)));
    png_read_image(png, self->rows);
    self->has_pixels = true;
    png_read_end(png, NULL);
    take_rows(self);
    return STATUS_OK;
}

static Status unsound(Reader *self)
{
    if (self->has_pixels && self->ends_early)
        return png_without_end(self->file.name, self->err);
    return err_set(self->err, STATUS_INPUT, "%s: is not a sound PNG file: %s", self->file.name,
                   self->complaint.text);
}

static Status read_guarded(Reader *self)
{
    if (setjmp(png_jmpbuf(self->png)))
        return errno == ENOMEM ? mem_out_of("to read", self->file.name, self->err) : unsound(self);
    TRY(read_picture(self));
    /* libpng goes on without a chunk that it had no room for. */
    return errno == ENOMEM ? mem_out_of("to read", self->file.name, self->err) : STATUS_OK;
}

static Status png_decode(const ImageBytes *file, Image *image, Err *err)
{
    if (png_decode_plain(file, &image->picture))
        return STATUS_OK;
    Reader self = {.file = *file, .err = err};
    errno = 0;
    self.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &self.complaint, png_on_error,
                                      png_on_warning);
    self.info = self.png ? png_create_info_struct(self.png) : NULL;
    Status status = self.info ? read_guarded(&self)
                              : err_set(err, STATUS_MEMORY, "out of memory: no room to read a PNG");
    png_destroy_read_struct(&self.png, &self.info, NULL);
    free(self.rows);
    free(self.bytes);
    if (status == STATUS_OK)
        image->picture = self.picture;
    else
        picture_release(&self.picture);
    return status;
}

const ImageDecoder png_decoder = {.is = png_is, .decode = png_decode};

/* ------------------------------------------------------------------------------------ writing */

typedef struct Writer {
    FILE *stream;
    ImageForm form;
    png_structp png;
    png_infop info;
    PngStripes *stripes; /* owned */
    png_text *chunks;    /* owned */
    PngComplaint complaint;
} Writer;

static bool is_ascii(const char *text)
{
    while (*text && (unsigned char)*text < 0x80)
        text++;
    return !*text;
}

/* A tEXt chunk would be Latin-1: what is not ASCII goes into an iTXt chunk, which is UTF-8. */
static void set_provenance(Writer *self, const ImageNotes *notes)
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

/* Vessels on a plain ground repeat whole stretches of bytes, which filters hide: without, most
 * files are smaller, by up to a fourth, and written in half the time. Only where pixels are so many
 * that shades hardly change from row to row, differences are shorter. */
enum { MANY_ROWS = 6000 };

static int color_type(int channels)
{
    return channels == 1   ? PNG_COLOR_TYPE_GRAY
           : channels == 3 ? PNG_COLOR_TYPE_RGB
                           : PNG_COLOR_TYPE_RGB_ALPHA;
}

static void write_header(Writer *self)
{
    const ImageForm *form = &self->form;
    png_init_io(self->png, self->stream);
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

/* libpng writes the chunk and its checksum. */
static void write_bytes(void *self, const uint8_t *bytes, size_t n)
{
    png_write_chunk(((Writer *)self)->png, (png_const_bytep) "IDAT", bytes, n);
}

/* Of what the stream refuses, libpng says nothing more. */
static Status failed(const Writer *self, Err *err)
{
    return err_set(err, STATUS_IO, "writing the PNG failed: %s",
                   ferror(self->stream) ? strerror(errno) : self->complaint.text);
}

static Status begin_guarded(Writer *self, Err *err)
{
    if (setjmp(png_jmpbuf(self->png)))
        return failed(self, err);
    write_header(self);
    return STATUS_OK;
}

static Status write_rows(void *self, const void *values, int first, int n, Err *err)
{
    (void)first;
    Writer *writer = self;
    if (setjmp(png_jmpbuf(writer->png)))
        return failed(writer, err);
    pngstripes_rows(writer->stripes, values, n, write_bytes, writer);
    return STATUS_OK;
}

static Status end(void *self, Err *err)
{
    Writer *writer = self;
    if (setjmp(png_jmpbuf(writer->png)))
        return failed(writer, err);
    png_write_chunk(writer->png, (png_const_bytep) "IEND", NULL, 0);
    return STATUS_OK;
}

static Status begin(FILE *stream, const ImageForm *form, void **self, Err *err)
{
    Writer *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *self = writer;
    writer->stream = stream;
    writer->form = *form;
    TRY(pngstripes_open(&writer->stripes, form, form->height >= MANY_ROWS, err));
    TRY(mem_calloc(&writer->chunks, form->notes ? (size_t)form->notes->count : 0,
                   sizeof *writer->chunks, "PNG texts", err));
    writer->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer->complaint, png_on_error,
                                          png_on_warning);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    return writer->info ? begin_guarded(writer, err)
                        : err_set(err, STATUS_MEMORY, "out of memory: no room to write a PNG");
}

static void release_writer(void *self)
{
    Writer *writer = self;
    if (!writer)
        return;
    png_destroy_write_struct(&writer->png, &writer->info);
    free(writer->chunks);
    pngstripes_free(writer->stripes);
    free(writer);
}

const RowEncoder png_encoder = {.begin = begin,
                                .rows = write_rows,
                                .end = end,
                                .release = release_writer,
                                .folds = DEFLATE_MAX_RATIO,
                                .keeps_dpi = true,
                                .keeps_alpha = true};
