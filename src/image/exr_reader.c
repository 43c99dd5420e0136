/* Reads OpenEXR with the C library OpenEXRCore: one flat image in scan lines or tiles.
 *
 * The channels that are read are R G B, whether or not there are other channels; else X Y Z if
 * there are no other channels; else the only channel. All are converted to 32-bit floats. A
 * requested layer is the part with its name, or the channels whose names begin with the layer's
 * name and a dot. Chunks are decoded one by one from memory into a plane of the size of the data
 * window. The image is the content of the display window. */
#include "image/formats.h"

#define IMATH_HALF_NO_LOOKUP_TABLE /* the table is in a separate library */
#include <Imath/half.h>
#include <OpenEXR/openexr.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHANNELS = 4 }; /* three colors and alpha */

typedef struct ExrReader {
    ImageInput input;
    exr_context_t context;
    int part;
    const char *prefix; /* prefix of the channels' names: "", or the name of the layer */
    bool is_tiled;
    exr_attr_box2i_t window, display; /* data window; display window */
    const char *names[MAX_CHANNELS];  /* of the plane's channels; alpha is the last */
    int channels;                     /* number of channels without alpha */
    bool has_alpha, is_colored;       /* there is an A channel; the other channels are R G B */
    Plane plane;                      /* owned; of the data window; alpha last */
    exr_result_t (*decompress)(
        exr_decode_pipeline_t *decoder); /* the routine that the library chose */
    int x, y; /* column and row in the plane at which the chunk that is being decoded begins */
} ExrReader;

static bool exr_is(const ImageBytes *file)
{
    return file->size >= 4 && memcmp(file->bytes, "\x76\x2f\x31\x01", 4) == 0;
}

/* The library's message begins with the file's name. The part up to the name is skipped, because
 * our error message states the name, too. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    const char *text = strstr(message, "): ");
    guard_note_message(text ? text + 3 : message);
}

static int64_t on_size(exr_const_context_t context, void *user)
{
    (void)context;
    const ExrReader *self = user;
    return (int64_t)self->input.file.size;
}

/* Reads like pread: fewer bytes than requested at the end. */
static int64_t on_read(exr_const_context_t context, void *user, void *out, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    const ExrReader *self = user;
    uint64_t left = offset < self->input.file.size ? self->input.file.size - offset : 0;
    uint64_t count = size < left ? size : left;
    memcpy(out, self->input.file.bytes + (count ? offset : 0), count);
    return (int64_t)count;
}

/* Returns the name of a channel after the prefix and a dot; NULL if the channel is not in that
 * layer. */
static const char *name_in_layer(const char *channel, const char *prefix)
{
    size_t length = strlen(prefix);
    if (length == 0)
        return channel;
    bool within = strncmp(channel, prefix, length) == 0 && channel[length] == '.';
    return within && !strchr(channel + length + 1, '.') ? channel + length + 1 : NULL;
}

/* Returns the full name of a channel of the layer; NULL if there is none. */
static const char *find_channel(const exr_attr_chlist_t *list, const char *prefix, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *channel = list->entries[i].name.str, *own = name_in_layer(channel, prefix);
        if (own && strcmp(own, name) == 0)
            return channel;
    }
    return NULL;
}

/* Returns the number of channels of the layer, without alpha. Sets *last to the name of the last
 * such channel. */
static int count_channels(const exr_attr_chlist_t *list, const char *prefix, const char **last)
{
    int n = 0;
    for (int i = 0; i < list->num_channels; i++) {
        const char *own = name_in_layer(list->entries[i].name.str, prefix);
        if (!own || strcmp(own, "A") == 0)
            continue;
        *last = list->entries[i].name.str;
        n++;
    }
    return n;
}

/* Sets the error that none of the accepted sets of channels is in the file. The message names the
 * first SHOWN channels, truncated to the size of `names`, so that it stays readable. */
static Status no_channels(const ExrReader *self, const exr_attr_chlist_t *list, Err *err)
{
    enum { SHOWN = 8 };
    char names[200] = "";
    for (int i = 0; i < list->num_channels && i < SHOWN; i++) {
        size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", i ? ", " : "",
                 list->entries[i].name.str);
    }
    image_plain_text(names);
    return err_set(
        err, STATUS_INPUT,
        "%s: has the channels %s%s; they must be R G B, X Y Z or a single one, with or without A%s",
        self->input.file.name, names, list->num_channels > SHOWN ? ", ..." : "",
        strchr(names, '.') ? ", or those of one layer" : "");
}

/* Chooses the channels of the plane: R G B; else X Y Z if the layer has only these; else the only
 * channel. Adds A if the layer has it. */
static Status choose_channels(ExrReader *self, Err *err)
{
    static const char *const triples[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
    const exr_attr_chlist_t *list;
    const char *alpha, *last = NULL;
    if (exr_get_channels(self->context, self->part, &list) != EXR_ERR_SUCCESS)
        return guard_failure(err);
    alpha = find_channel(list, self->prefix, "A");
    self->has_alpha = alpha != NULL;
    int others = count_channels(list, self->prefix, &last);
    for (int t = 0; t < 2 && self->channels == 0; t++) {
        int found = 0;
        for (int c = 0; c < 3 && (t == 0 || others == 3); c++)
            found += (self->names[c] = find_channel(list, self->prefix, triples[t][c])) != NULL;
        self->channels = found == 3 ? 3 : 0;
        self->is_colored = self->channels == 3 && t == 0;
    }
    if (self->channels == 0 && others == 1) {
        self->names[0] = last;
        self->channels = 1;
    }
    if (self->channels == 0)
        return no_channels(self, list, err);
    for (int i = 0; i < list->num_channels; i++)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return err_set(err, STATUS_INPUT, "%s: has subsampled channels, which cannot be read",
                           self->input.file.name);
    if (self->has_alpha)
        self->names[self->channels] = alpha;
    return STATUS_OK;
}

/* Checks that R G B have the primaries of sRGB. A file without chromaticities has the primaries of
 * Rec. 709, which are those of sRGB. */
static Status check_colors(ExrReader *self, Err *err)
{
    exr_attr_chromaticities_t given;
    float values[8];
    double xy[8];
    if (!self->is_colored)
        return STATUS_OK;
    exr_result_t found =
        exr_attr_get_chromaticities(self->context, self->part, "chromaticities", &given);
    guard_clear_message(); /* a missing attribute is no error */
    if (found != EXR_ERR_SUCCESS)
        return STATUS_OK;
    memcpy(values, &given, sizeof values);
    for (int i = 0; i < 8; i++)
        xy[i] = (double)values[i];
    return image_is_srgb(xy) ? STATUS_OK
                             : image_fail_not_srgb(self->input.file.name, "chromaticities", err);
}

static const char *part_name(const ExrReader *self, int part)
{
    const char *name = NULL;
    bool named = exr_get_name(self->context, part, &name) == EXR_ERR_SUCCESS;
    return named && name ? name : "";
}

/* Returns true if the part has channels of the layer. */
static bool has_layer(const ExrReader *self, int part, const char *layer)
{
    const exr_attr_chlist_t *list;
    const char *last;
    return exr_get_channels(self->context, part, &list) == EXR_ERR_SUCCESS &&
           count_channels(list, layer, &last) > 0;
}

/* Sets the error that the requested layer does not exist, or that no layer was requested of a file
 * with several parts. */
static Status no_layer(const ExrReader *self, int parts, Err *err)
{
    Text names = TEXT_INIT;
    for (int i = 0; i < parts; i++)
        text_printf(&names, "%s'%s'", i ? ", " : "", part_name(self, i));
    const char *layer = self->input.file.layer;
    Status status = text_check(&names, err);
    if (status == STATUS_OK)
        status =
            !layer || parts > 1
                ? err_set(err, STATUS_INPUT, "%s: has %d parts, %s; %s%s%s", self->input.file.name,
                          parts, text_chars(&names),
                          layer ? "none has the name or the layer '" : "select one by its name",
                          layer ? layer : "", layer ? "'" : "")
                : err_set(err, STATUS_INPUT, "%s: has no layer '%s'", self->input.file.name, layer);
    text_release(&names);
    return status;
}

/* Chooses the part that has the name of the layer; else the first part that has channels of the
 * layer. In a part that has the layer's name, the channels may have that name as a prefix or no
 * prefix. */
static Status choose_part(ExrReader *self, int parts, Err *err)
{
    const char *layer = self->input.file.layer;
    self->prefix = "";
    if (!layer)
        return parts == 1 ? STATUS_OK : no_layer(self, parts, err);
    for (int pass = 0; pass < 2; pass++)
        for (self->part = 0; self->part < parts; self->part++) {
            bool inside = has_layer(self, self->part, layer);
            if (pass == 0 ? strcmp(part_name(self, self->part), layer) != 0 : !inside)
                continue;
            self->prefix = inside ? layer : "";
            guard_clear_message(); /* a part without a name is no error */
            return STATUS_OK;
        }
    return no_layer(self, parts, err);
}

static Status open_file(ExrReader *self, Err *err)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = self;
    setup.read_fn = on_read;
    setup.size_fn = on_size;
    exr_storage_t storage;
    exr_compression_t compression;
    int parts;
    if (exr_start_read(&self->context, self->input.file.name, &setup) != EXR_ERR_SUCCESS ||
        exr_get_count(self->context, &parts) != EXR_ERR_SUCCESS)
        return guard_failure(err);
    TRY(choose_part(self, parts, err));
    if (exr_get_storage(self->context, self->part, &storage) != EXR_ERR_SUCCESS ||
        exr_get_compression(self->context, self->part, &compression) != EXR_ERR_SUCCESS ||
        exr_get_data_window(self->context, self->part, &self->window) != EXR_ERR_SUCCESS ||
        exr_get_display_window(self->context, self->part, &self->display) != EXR_ERR_SUCCESS)
        return guard_failure(err);
    self->is_tiled = storage == EXR_STORAGE_TILED;
    if (storage != EXR_STORAGE_SCANLINE && !self->is_tiled)
        return err_set(err, STATUS_INPUT, "%s: has deep pixels; only flat images can be read",
                       self->input.file.name);
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB)
        return err_set(err, STATUS_INPUT,
                       "%s: is compressed by DWAA or DWAB, which the library OpenEXRCore cannot "
                       "read; any other compression can be read",
                       self->input.file.name);
    return STATUS_OK;
}

/* Converts a little-endian number of the file to a float. Integers above 2^24 are rounded. */
static float number_at(const uint8_t *at, int type)
{
    uint32_t bits;
    float value;
    if (type == EXR_PIXEL_HALF)
        return imath_half_to_float((imath_half_bits_t)(at[0] | at[1] << 8));
    bits = at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    memcpy(&value, &bits, sizeof value);
    return type == EXR_PIXEL_UINT ? (float)bits : value;
}

/* Returns the index in the plane of a channel of the file; -1 if the plane does not have it. */
static int plane_channel(const ExrReader *self, const exr_coding_channel_info_t *channel)
{
    for (int i = 0; i < self->plane.channels; i++)
        if (strcmp(channel->channel_name, self->names[i]) == 0)
            return i;
    return -1;
}

/* Copies a decompressed chunk into the plane. Each row of a chunk stores one channel after another,
 * in the order of their names. The routine of OpenEXRCore 3.1.5 is not used, because it confuses
 * the channels of half RGBA. */
static exr_result_t unpack(exr_decode_pipeline_t *decoder)
{
    ExrReader *self = decoder->decoding_user_data;
    const uint8_t *at = decoder->unpacked_buffer;
    const size_t samples = (size_t)self->plane.channels;
    for (int y = 0; y < decoder->chunk.height; y++)
        for (int c = 0; c < decoder->channel_count; c++) {
            const exr_coding_channel_info_t *channel = &decoder->channels[c];
            const int in_plane = plane_channel(self, channel);
            if ((decoder->chunk.start_y + y) % channel->y_samples != 0)
                continue;
            for (int x = 0; in_plane >= 0 && x < channel->width; x++) {
                size_t pixel =
                    (size_t)(self->y + y) * (size_t)self->plane.width + (size_t)(self->x + x);
                self->plane.values[pixel * samples + (size_t)in_plane] = number_at(
                    at + (size_t)x * (size_t)channel->bytes_per_element, channel->data_type);
            }
            at += (size_t)channel->width * (size_t)channel->bytes_per_element;
        }
    return EXR_ERR_SUCCESS;
}

/* Finds the size of a full chunk: a tile, or a block of scan lines. */
static bool measure_chunks(ExrReader *self, uint32_t *width, uint32_t *height)
{
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    int32_t lines;
    if (self->is_tiled)
        return exr_get_tile_descriptor(self->context, self->part, width, height, &levels,
                                       &rounding) == EXR_ERR_SUCCESS &&
               *width > 0 && *height > 0;
    if (exr_get_scanlines_per_chunk(self->context, self->part, &lines) != EXR_ERR_SUCCESS ||
        lines < 1)
        return false;
    *width = (uint32_t)self->plane.width;
    *height = (uint32_t)lines;
    return true;
}

static bool find_chunk(ExrReader *self, int column, int row, int y, exr_chunk_info_t *chunk)
{
    return (self->is_tiled
                ? exr_read_tile_chunk_info(self->context, self->part, column, row, 0, 0, chunk)
                : exr_read_scanline_chunk_info(self->context, self->part, self->window.min.y + y,
                                               chunk)) == EXR_ERR_SUCCESS;
}

static bool decode_chunk(ExrReader *self, exr_decode_pipeline_t *decoder,
                         const exr_chunk_info_t *chunk, int x, int y)
{
    bool first = x == 0 && y == 0;
    exr_result_t result = first ? exr_decoding_initialize(self->context, self->part, chunk, decoder)
                                : exr_decoding_update(self->context, self->part, chunk, decoder);
    if (result == EXR_ERR_SUCCESS && first) {
        result = exr_decoding_choose_default_routines(self->context, self->part, decoder);
        self->decompress = decoder->decompress_fn;
    }
    /* A chunk that compression does not shorten is stored uncompressed. OpenEXRCore 3.1.5 detects
     * this except for B44 and B44A, for which it decodes wrong numbers. */
    decoder->decompress_fn = chunk->packed_size < chunk->unpacked_size ? self->decompress : NULL;
    decoder->unpack_and_convert_fn = unpack;
    decoder->decoding_user_data = self;
    self->x = x;
    self->y = y;
    return result == EXR_ERR_SUCCESS &&
           exr_decoding_run(self->context, self->part, decoder) == EXR_ERR_SUCCESS;
}

static bool decode_chunks(ExrReader *self)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    uint32_t width = 0, height = 0;
    bool sound = measure_chunks(self, &width, &height);
    int row = 0;
    for (int64_t y = 0; sound && y < self->plane.height; y += height, row++) {
        int column = 0;
        for (int64_t x = 0; sound && x < self->plane.width; x += width, column++) {
            exr_chunk_info_t chunk;
            sound = find_chunk(self, column, row, (int)y, &chunk) &&
                    decode_chunk(self, &decoder, &chunk, (int)x, (int)y);
        }
    }
    exr_decoding_destroy(self->context, &decoder);
    return sound;
}

static long long width_of(const exr_attr_box2i_t *window)
{
    return (long long)window->max.x - window->min.x + 1;
}

static long long height_of(const exr_attr_box2i_t *window)
{
    return (long long)window->max.y - window->min.y + 1;
}

/* Returns an upper bound on the number of bytes of 32-bit floats that a file of this size can hold.
 * ZIP and ZIPS compress a blank picture by a factor of 1032, PXR24 by 1376, PIZ by 410, RLE by 64
 * and B44A by 11. Half floats double in size when they are converted. RATIO is more than three
 * times the resulting maximum, 2752. */
static size_t max_bytes(const ExrReader *self)
{
    enum { RATIO = 10000 };
    return self->input.file.size * RATIO;
}

/* Allocates a plane of the size of a window. Errors: STATUS_INPUT if it has more than `most`
 * bytes. */
static Status make_plane(const ExrReader *self, Plane *plane, const exr_attr_box2i_t *window,
                         size_t most, Err *err)
{
    long long width = width_of(window), height = height_of(window);
    int channels = self->channels + self->has_alpha;
    size_t bytes = (size_t)width * (size_t)height * (size_t)channels * sizeof *plane->values;
    TRY(image_check_stated_size(&self->input.file, width, height, bytes, most, err));
    return plane_init(plane, (int)width, (int)height, channels, err);
}

/* Copies the part of the plane that is in the display window to *shown. Pixels of the display
 * window outside the data window remain 0. A small file may therefore state a large display window,
 * so the limit on its size is raised by BLANK bytes, the size of 8192 x 8192 pixels of 4 channels.
 */
static Status copy_display_window(const ExrReader *self, Plane *shown, Err *err)
{
    enum { BLANK = 1 << 30 };
    const exr_attr_box2i_t *data = &self->window, *display = &self->display;
    const size_t channels = (size_t)self->plane.channels;
    TRY(make_plane(self, shown, display, max_bytes(self) + BLANK, err));
    long long left = data->min.x > display->min.x ? data->min.x : display->min.x;
    long long right = data->max.x < display->max.x ? data->max.x : display->max.x;
    for (long long y = display->min.y; y <= display->max.y && left <= right; y++) {
        if (y < data->min.y || y > data->max.y)
            continue;
        size_t from = (size_t)((y - data->min.y) * self->plane.width + left - data->min.x);
        size_t to = (size_t)((y - display->min.y) * shown->width + left - display->min.x);
        memcpy(shown->values + to * channels, self->plane.values + from * channels,
               (size_t)(right - left + 1) * channels * sizeof *shown->values);
    }
    return STATUS_OK;
}

static Status decode(void *work, Err *err)
{
    ExrReader *self = work;
    Plane *shown = &self->input.image.plane;
    TRY(open_file(self, err));
    TRY(choose_channels(self, err));
    TRY(check_colors(self, err));
    TRY(make_plane(self, &self->plane, &self->window, max_bytes(self), err));
    if (!decode_chunks(self))
        return guard_failure(err);
    if (memcmp(&self->window, &self->display, sizeof self->window) != 0)
        return copy_display_window(self, shown, err);
    *shown = self->plane;
    self->plane = (Plane){0};
    return STATUS_OK;
}

static void release(void *work)
{
    ExrReader *self = work;
    exr_finish(&self->context);
    plane_release(&self->plane);
}

const ImageDecoder exr_decoder = {.format = "OpenEXR",
                                  .state_size = sizeof(ExrReader),
                                  .is = exr_is,
                                  .decode = decode,
                                  .release = release,
                                  .has_layers = true};

/* ---- attributes ------------------------------------------------------------------------------ */

/* Drops OpenEXR's messages: a file that is no OpenEXR file is an answer here, and no error. */
static void on_silent_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

bool image_exr_text(const char *path, const char *name, char *text, size_t size)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    const char *value;
    int32_t length;
    setup.error_handler_fn = on_silent_error;
    if (exr_start_read(&context, path, &setup) != EXR_ERR_SUCCESS)
        return false;
    const bool found = exr_attr_get_string(context, 0, name, &length, &value) == EXR_ERR_SUCCESS &&
                       (size_t)length < size;
    if (found) {
        memcpy(text, value, (size_t)length);
        text[length] = '\0';
    }
    exr_finish(&context);
    return found;
}
