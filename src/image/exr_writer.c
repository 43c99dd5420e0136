/* Writes OpenEXR with the C library OpenEXRCore: one flat image in scan lines, compressed with ZIP,
 * 16 rows per chunk. The chunk offset table is at the start of the file but is written last, so the
 * file must be seekable. */
#include "image/formats.h"
#include "image/png_fast.h"

#include <OpenEXR/openexr.h>
#include <errno.h>
#include <string.h>

typedef struct ExrWriter {
    ImageOutput output;
    exr_context_t context;
    exr_encode_pipeline_t encoder;
} ExrWriter;

static const ImageChannel of_colors[] = {{"R", false}, {"G", false}, {"B", false}};
static const ImageChannel of_grey[] = {{"Y", false}};

static const ImageChannel *channels_of(const ImageForm *form)
{
    return form->named ? form->named : form->channels == 3 ? of_colors : of_grey;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)message;
    if (code == EXR_ERR_OUT_OF_MEMORY)
        errno = ENOMEM;
    guard_note_message(exr_get_default_error_message(code));
}

static int64_t on_write(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    FILE *stream = user;
    if (ftello(stream) != (off_t)offset && fseeko(stream, (off_t)offset, SEEK_SET) != 0)
        return -1;
    return (int64_t)fwrite(bytes, 1, size, stream);
}

static bool add_channels(ExrWriter *self)
{
    const ImageForm *form = &self->output.form;
    const ImageChannel *channels = channels_of(form);
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int c = 0; c < form->channels && result == EXR_ERR_SUCCESS; c++) {
        bool half = form->packing.half && !channels[c].is_exact;
        result =
            exr_add_channel(self->context, 0, channels[c].name,
                            half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    return result == EXR_ERR_SUCCESS;
}

/* OpenEXR has standard names for the attributes that hold comments and software. */
static bool add_notes(ExrWriter *self, const ImageNotes *notes)
{
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int i = 0; notes && i < notes->count && result == EXR_ERR_SUCCESS; i++) {
        const ImageNote *note = &notes->notes[i];
        const char *name = strcmp(note->key, "Comment") == 0    ? "comments"
                           : strcmp(note->key, "Software") == 0 ? "software"
                                                                : note->key;
        result = exr_attr_set_string(self->context, 0, name, note->text);
    }
    if (notes && notes->dpi > 0 && result == EXR_ERR_SUCCESS)
        result = exr_attr_set_float(self->context, 0, "xDensity", (float)notes->dpi);
    return result == EXR_ERR_SUCCESS;
}

static bool write_header(ExrWriter *self)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    const ImageForm *form = &self->output.form;
    int part;
    int32_t chunk_rows;
    setup.error_handler_fn = on_error;
    setup.user_data = self->output.stream;
    setup.write_fn = on_write;
    if (exr_start_write(&self->context, "picture", EXR_WRITE_FILE_DIRECTLY, &setup) !=
            EXR_ERR_SUCCESS ||
        exr_add_part(self->context, "", EXR_STORAGE_SCANLINE, &part) != EXR_ERR_SUCCESS ||
        exr_initialize_required_attr_simple(self->context, 0, form->width, form->height,
                                            EXR_COMPRESSION_ZIP) != EXR_ERR_SUCCESS ||
        !add_channels(self) || !add_notes(self, form->notes) ||
        exr_write_header(self->context) != EXR_ERR_SUCCESS ||
        exr_get_scanlines_per_chunk(self->context, 0, &chunk_rows) != EXR_ERR_SUCCESS)
        return false;
    self->output.chunk_rows = chunk_rows;
    return true;
}

static Status begin(void *work, Err *err)
{
    ExrWriter *self = work;
    TRY(imageoutput_check_seekable(&self->output, err));
    errno = 0;
    return write_header(self) ? STATUS_OK : guard_failure(err);
}

/* Points the channels of the encoder at their values in the chunk. */
static void set_channel_pointers(ExrWriter *self)
{
    const ImageChannel *channels = channels_of(&self->output.form);
    const float *chunk = self->output.values;
    for (int e = 0; e < self->encoder.channel_count; e++) {
        exr_coding_channel_info_t *channel = &self->encoder.channels[e];
        size_t c = 0;
        while (strcmp(channels[c].name, channel->channel_name) != 0)
            c++;
        channel->encode_from_ptr = (const uint8_t *)(chunk + c);
        channel->user_pixel_stride = self->output.form.channels * (int32_t)sizeof(float);
        channel->user_line_stride = (int32_t)self->output.row_bytes;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
}

static bool encode_chunk(ExrWriter *self)
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t *encoder = &self->encoder;
    bool first = self->output.first == 0;
    if (exr_write_scanline_chunk_info(self->context, 0, self->output.first, &chunk) !=
            EXR_ERR_SUCCESS ||
        (first ? exr_encoding_initialize(self->context, 0, &chunk, encoder)
               : exr_encoding_update(self->context, 0, &chunk, encoder)) != EXR_ERR_SUCCESS)
        return false;
    set_channel_pointers(self);
    if (first && exr_encoding_choose_default_routines(self->context, 0, encoder) != EXR_ERR_SUCCESS)
        return false;
    return exr_encoding_run(self->context, 0, encoder) == EXR_ERR_SUCCESS;
}

static Status write_chunk(void *work, Err *err)
{
    return encode_chunk(work) ? STATUS_OK : guard_failure(err);
}

/* Writes the chunk offset table. */
static Status end(void *work, Err *err)
{
    ExrWriter *self = work;
    exr_encoding_destroy(self->context, &self->encoder);
    self->encoder = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
    return exr_finish(&self->context) == EXR_ERR_SUCCESS ? STATUS_OK : guard_failure(err);
}

static void release(void *work)
{
    ExrWriter *self = work;
    if (!self->context)
        return;
    exr_encoding_destroy(self->context, &self->encoder);
    exr_finish(&self->context);
}

const RowEncoder exr_encoder = {.format = "OpenEXR",
                                .state_size = sizeof(ExrWriter),
                                .begin = begin,
                                .rows = write_chunk,
                                .end = end,
                                .release = release,
                                .max_ratio = 2 * DEFLATE_MAX_RATIO, /* halves */
                                .traits = {.keeps_dpi = true, .floats = true}};
