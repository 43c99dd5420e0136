/* OpenEXR through the C library OpenEXRCore: one flat image in scan lines, compressed by ZIP, 16
 * rows at a time, each as soon as it is full. Where the chunks are stands at the front and is
 * written last, so the file must be one with places. */
#include "image/formats.h"

#include <errno.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

typedef struct Writer {
    FILE *stream;
    exr_context_t context;
    exr_encode_pipeline_t encoder;
    ImageForm form;       /* its notes are for `begin` */
    float *chunk;         /* owned */
    int32_t chunk_rows;   /* of a full one */
    int filled, next;     /* rows in the chunk, and above it */
    exr_result_t failure; /* the first; EXR_ERR_SUCCESS: none */
} Writer;

static const ImageChannel of_colors[] = {{"R", false}, {"G", false}, {"B", false}};
static const ImageChannel of_grey[] = {{"Y", false}};

static const ImageChannel *channels_of(const ImageForm *form)
{
    return form->named ? form->named : form->channels == 3 ? of_colors : of_grey;
}

/* The context cannot be asked whose it is: it holds its lock when it calls. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

/* Keeps what failed first. */
static bool went(Writer *self, exr_result_t result)
{
    if (self->failure == EXR_ERR_SUCCESS)
        self->failure = result;
    return result == EXR_ERR_SUCCESS;
}

static int64_t on_write(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    Writer *self = user;
    if (ftello(self->stream) != (off_t)offset && fseeko(self->stream, (off_t)offset, SEEK_SET) != 0)
        return -1;
    return (int64_t)fwrite(bytes, 1, size, self->stream);
}

static Status failed(Writer *self, Err *err)
{
    if (errno == ENOMEM || self->failure == EXR_ERR_OUT_OF_MEMORY)
        return mem_out_of("for the OpenEXR file", "that is written", err);
    return err_set(err, STATUS_IO, "writing the OpenEXR file failed: %s",
                   ferror(self->stream) ? strerror(errno)
                                        : exr_get_default_error_message(self->failure));
}

static bool add_channels(Writer *self)
{
    const ImageChannel *channels = channels_of(&self->form);
    bool half = self->form.packing.half, added = true;
    for (int c = 0; c < self->form.channels && added; c++)
        added = went(
            self, exr_add_channel(self->context, 0, channels[c].name,
                                  half && !channels[c].is_exact ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                  EXR_PERCEPTUALLY_LINEAR, 1, 1));
    return added;
}

/* "Comment" is what OpenEXR calls comments, "Software" software. */
static bool add_notes(Writer *self, const ImageNotes *notes)
{
    bool added = true;
    for (int i = 0; notes && i < notes->count && added; i++) {
        const ImageNote *note = &notes->notes[i];
        const char *name = strcmp(note->key, "Comment") == 0    ? "comments"
                           : strcmp(note->key, "Software") == 0 ? "software"
                                                                : note->key;
        added = went(self, exr_attr_set_string(self->context, 0, name, note->text));
    }
    if (notes && notes->dpi > 0 && added)
        added = went(self, exr_attr_set_float(self->context, 0, "xDensity", (float)notes->dpi));
    return added;
}

static bool write_header(Writer *self)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    const ImageForm *form = &self->form;
    int part;
    setup.error_handler_fn = on_error;
    setup.user_data = self;
    setup.write_fn = on_write;
    return went(self,
                exr_start_write(&self->context, "picture", EXR_WRITE_FILE_DIRECTLY, &setup)) &&
           went(self, exr_add_part(self->context, "", EXR_STORAGE_SCANLINE, &part)) &&
           went(self, exr_initialize_required_attr_simple(self->context, 0, form->width,
                                                          form->height, EXR_COMPRESSION_ZIP)) &&
           add_channels(self) && add_notes(self, form->notes) &&
           went(self, exr_write_header(self->context)) &&
           went(self, exr_get_scanlines_per_chunk(self->context, 0, &self->chunk_rows)) &&
           errno != ENOMEM; /* it goes on without an attribute that it had no room for */
}

static Status begin(FILE *stream, const ImageForm *form, void **self, Err *err)
{
    Writer *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    *self = writer;
    writer->stream = stream;
    writer->form = *form;
    if (fseeko(stream, 0, SEEK_CUR) != 0)
        return err_set(err, STATUS_IO, "an OpenEXR file needs a file, not a pipe");
    errno = 0;
    if (!write_header(writer))
        return failed(writer, err);
    return mem_calloc(&writer->chunk, (size_t)writer->chunk_rows * (size_t)form->width,
                      (size_t)form->channels * sizeof *writer->chunk, "rows of a chunk", err);
}

/* Points the encoder's channels at their numbers in the chunk. */
static void aim(Writer *self)
{
    const ImageChannel *channels = channels_of(&self->form);
    size_t samples = (size_t)self->form.channels;
    for (int e = 0; e < self->encoder.channel_count; e++) {
        exr_coding_channel_info_t *channel = &self->encoder.channels[e];
        size_t c = 0;
        while (strcmp(channels[c].name, channel->channel_name) != 0)
            c++;
        channel->encode_from_ptr = (const uint8_t *)(self->chunk + c);
        channel->user_pixel_stride = (int32_t)(samples * sizeof(float));
        channel->user_line_stride = (int32_t)(samples * sizeof(float) * (size_t)self->form.width);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
}

static bool encode_chunk(Writer *self)
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t *encoder = &self->encoder;
    bool first = self->next == 0;
    if (!went(self, exr_write_scanline_chunk_info(self->context, 0, self->next, &chunk)) ||
        !went(self, first ? exr_encoding_initialize(self->context, 0, &chunk, encoder)
                          : exr_encoding_update(self->context, 0, &chunk, encoder)))
        return false;
    aim(self);
    if (first && !went(self, exr_encoding_choose_default_routines(self->context, 0, encoder)))
        return false;
    self->next += self->filled;
    self->filled = 0;
    return went(self, exr_encoding_run(self->context, 0, encoder));
}

static Status write_rows(void *self, const void *values, int first, int n, Err *err)
{
    Writer *writer = self;
    size_t row = (size_t)writer->form.width * (size_t)writer->form.channels;
    const float *floats = values;
    errno = 0;
    for (int y = 0; y < n; y++) {
        memcpy(writer->chunk + (size_t)writer->filled++ * row, floats + (size_t)y * row,
               row * sizeof *floats);
        bool full = writer->filled == writer->chunk_rows || first + y + 1 == writer->form.height;
        if (full && !encode_chunk(writer))
            return failed(writer, err);
    }
    return STATUS_OK;
}

/* Writes where the chunks are. */
static Status end(void *self, Err *err)
{
    Writer *writer = self;
    errno = 0;
    exr_encoding_destroy(writer->context, &writer->encoder);
    writer->encoder = (exr_encode_pipeline_t)EXR_ENCODE_PIPELINE_INITIALIZER;
    return went(writer, exr_finish(&writer->context)) ? STATUS_OK : failed(writer, err);
}

static void release_writer(void *self)
{
    Writer *writer = self;
    if (!writer)
        return;
    if (writer->context) {
        exr_encoding_destroy(writer->context, &writer->encoder);
        exr_finish(&writer->context);
    }
    free(writer->chunk);
    free(writer);
}

const RowEncoder exr_encoder = {.begin = begin,
                                .rows = write_rows,
                                .end = end,
                                .release = release_writer,
                                .folds = 2 * DEFLATE_MAX_RATIO, /* halves */
                                .keeps_dpi = true,
                                .floats = true};
