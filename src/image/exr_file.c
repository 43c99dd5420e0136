/* OpenEXR through the C library OpenEXRCore: one flat image in scan lines, its channels R G B, X Y Z
 * or a single one, as 32-bit floats whatever they are in the file. Chunks are decoded one after the
 * other straight into the plane, from the file in memory. */
#include "image/formats.h"

#include <openexr.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHANNELS = 4 };

typedef struct Exr {
    ImageBytes file;
    exr_context_t context;
    exr_attr_box2i_t window;
    const char *names[MAX_CHANNELS]; /* of the channels of the plane, the last one perhaps "A" */
    int channels;                    /* alpha not counted */
    bool has_alpha;
    Plane plane;         /* owned; alpha included until it has been checked */
    char complaint[200]; /* the library's, "" when there is none */
} Exr;

bool exr_is(const ImageBytes *file)
{
    return file->size >= 4 && memcmp(file->bytes, "\x76\x2f\x31\x01", 4) == 0;
}

static Exr *self_of(exr_const_context_t context)
{
    void *self = NULL;
    return exr_get_user_data(context, &self) == EXR_ERR_SUCCESS ? self : NULL;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    Exr *self = self_of(context);
    if (!self || *self->complaint)
        return;
    /* It names the file first, which the sentence does already. */
    const char *text = strstr(message, "): ");
    snprintf(self->complaint, sizeof self->complaint, "%s", text ? text + 3 : message);
}

static int64_t on_size(exr_const_context_t context, void *user)
{
    (void)context;
    const Exr *self = user;
    return (int64_t)self->file.size;
}

/* As pread: at the end fewer bytes than asked for. */
static int64_t on_read(exr_const_context_t context, void *user, void *out, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    const Exr *self = user;
    uint64_t left = offset < self->file.size ? self->file.size - offset : 0;
    uint64_t count = size < left ? size : left;
    memcpy(out, self->file.bytes + (count ? offset : 0), count);
    return (int64_t)count;
}

static Status unsound(Exr *self, Err *err)
{
    image_plain_text(self->complaint);
    return err_set(err, STATUS_INPUT, "%s: is not a sound OpenEXR file: %s", self->file.name,
                   *self->complaint ? self->complaint : "its header and its data do not agree");
}

static bool has_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; i++)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return true;
    return false;
}

/* Which channels make the plane. */
static Status choose_channels(Exr *self, Err *err)
{
    static const char *const triples[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
    const exr_attr_chlist_t *list;
    if (exr_get_channels(self->context, 0, &list) != EXR_ERR_SUCCESS)
        return unsound(self, err);
    self->has_alpha = has_channel(list, "A");
    int others = list->num_channels - self->has_alpha;
    for (int t = 0; t < 2 && self->channels == 0; t++)
        if (others == 3 && has_channel(list, triples[t][0]) && has_channel(list, triples[t][1]) &&
            has_channel(list, triples[t][2])) {
            memcpy(self->names, triples[t], sizeof triples[t]);
            self->channels = 3;
        }
    for (int i = 0; i < list->num_channels && others == 1; i++)
        if (strcmp(list->entries[i].name.str, "A") != 0) {
            self->names[0] = list->entries[i].name.str;
            self->channels = 1;
        }
    if (self->channels == 0)
        return err_set(err, STATUS_INPUT,
                       "%s: has %d channels; only R G B, X Y Z or a single one, with an opaque A "
                       "or without, can be read",
                       self->file.name, list->num_channels);
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return err_set(err, STATUS_INPUT, "%s: has subsampled channels, which cannot be read",
                           self->file.name);
    if (self->has_alpha)
        self->names[self->channels] = "A";
    return STATUS_OK;
}

static Status open_file(Exr *self, Err *err)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = self;
    setup.read_fn = on_read;
    setup.size_fn = on_size;
    exr_storage_t storage;
    int parts;
    if (exr_start_read(&self->context, self->file.name, &setup) != EXR_ERR_SUCCESS ||
        exr_get_count(self->context, &parts) != EXR_ERR_SUCCESS ||
        exr_get_storage(self->context, 0, &storage) != EXR_ERR_SUCCESS ||
        exr_get_data_window(self->context, 0, &self->window) != EXR_ERR_SUCCESS)
        return unsound(self, err);
    if (parts != 1 || storage != EXR_STORAGE_SCANLINE)
        return err_set(err, STATUS_INPUT,
                       "%s: has tiles, several parts or deep pixels; only one flat image in scan "
                       "lines can be read",
                       self->file.name);
    return STATUS_OK;
}

/* Points the decoder's channels at row `y` of the plane, counted from 0. */
static void aim(Exr *self, exr_decode_pipeline_t *decoder, int y)
{
    size_t samples = (size_t)self->plane.channels;
    size_t row = (size_t)self->plane.width * samples;
    for (int c = 0; c < decoder->channel_count; c++) {
        exr_coding_channel_info_t *channel = &decoder->channels[c];
        channel->decode_to_ptr = NULL;
        for (size_t i = 0; i < samples; i++) {
            if (strcmp(channel->channel_name, self->names[i]) != 0)
                continue;
            channel->decode_to_ptr = (uint8_t *)(self->plane.values + (size_t)y * row + i);
            channel->user_pixel_stride = (int32_t)(samples * sizeof(float));
            channel->user_line_stride = (int32_t)(row * sizeof(float));
            channel->user_bytes_per_element = sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
        }
    }
}

static bool decode_chunks(Exr *self)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t lines;
    bool sound = exr_get_scanlines_per_chunk(self->context, 0, &lines) == EXR_ERR_SUCCESS;
    for (int y = 0; y < self->plane.height && sound; y += lines) {
        exr_chunk_info_t chunk;
        sound = exr_read_scanline_chunk_info(self->context, 0, self->window.min.y + y, &chunk) ==
                EXR_ERR_SUCCESS;
        if (sound)
            sound = (y == 0 ? exr_decoding_initialize(self->context, 0, &chunk, &decoder)
                            : exr_decoding_update(self->context, 0, &chunk, &decoder)) ==
                    EXR_ERR_SUCCESS;
        if (!sound)
            break;
        aim(self, &decoder, y);
        sound = (y > 0 || exr_decoding_choose_default_routines(self->context, 0, &decoder) ==
                              EXR_ERR_SUCCESS) &&
                exr_decoding_run(self->context, 0, &decoder) == EXR_ERR_SUCCESS;
    }
    exr_decoding_destroy(self->context, &decoder);
    return sound;
}

static Status decode(Exr *self, Err *err)
{
    TRY(open_file(self, err));
    TRY(choose_channels(self, err));
    long long width = (long long)self->window.max.x - self->window.min.x + 1;
    long long height = (long long)self->window.max.y - self->window.min.y + 1;
    TRY(image_check_sides(self->file.name, width, height, err));
    TRY(plane_init(&self->plane, (int)width, (int)height, self->channels + self->has_alpha, err));
    if (!decode_chunks(self))
        return unsound(self, err);
    return self->has_alpha ? plane_drop_alpha(&self->plane, self->file.name, err) : STATUS_OK;
}

Status exr_decode(const ImageBytes *file, Plane *plane, Err *err)
{
    Exr self = {.file = *file};
    Status status = decode(&self, err);
    exr_finish(&self.context);
    if (status == STATUS_OK)
        *plane = self.plane;
    else
        plane_release(&self.plane);
    return status;
}
