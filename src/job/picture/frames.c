/* One writer a file. The planes take their final names first and the picture last, so that a
 * picture never stands beside planes of another. OpenEXR holds planes itself: they become channels
 * of the picture, floats throughout, as few programs take whole numbers: ids, up to IMAGE_MAX_ID,
 * are exact in 32 bits. */
#include "job/picture/frames.h"

#include "options/output.h"
#include <stdlib.h>
#include <string.h>

bool frames_is_page(const char *path)
{
    static const char *const known[] = {"pdf", "svg", NULL};
    return is_one_of(file_extension(path), known);
}

Status frames_check_output(const char *path, bool planes, Err *err)
{
    if (strcmp(path, "-") == 0) {
        if (planes)
            return err_set(err, STATUS_USAGE, "--planes needs -o FILE, to name the planes after");
        return STATUS_OK;
    }
    static const char *const known[] = {"png", "ppm", "pfm", "tif", "tiff", "jpg", "jpeg", "exr"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(file_extension(path), known[i]) == 0)
            return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "-o: '%s' does not end in .png, .ppm, .tif, .jpg, .exr or .pfm", path);
}

const Range bits_range = {8, 16};

Status bits_check(int bits, Err *err)
{
    if (bits == 8 || bits == 16)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--bits: '%d' is not 8 or 16", bits);
}

typedef enum FrameFile { FILE_COLOR, FILE_DEPTH, FILE_NORMAL, FILE_ID, FILE_PICTURE } FrameFile;
enum { FRAME_FILES = FILE_PICTURE + 1, LAYER_ALPHA = FRAME_FILES };

/* The channels of an OpenEXR file, in their order in memory. */
static const struct {
    int of; /* a FrameFile, or LAYER_ALPHA */
    ImageChannel channel;
} layers[] = {
    {FILE_PICTURE, {"R", false}},  {FILE_PICTURE, {"G", false}},  {FILE_PICTURE, {"B", false}},
    {LAYER_ALPHA, {"A", false}},   {FILE_DEPTH, {"Z", true}},     {FILE_NORMAL, {"N.X", false}},
    {FILE_NORMAL, {"N.Y", false}}, {FILE_NORMAL, {"N.Z", false}}, {FILE_ID, {"id", true}}};
enum { LAYERS = sizeof layers / sizeof *layers };
_Static_assert(sizeof layers / sizeof *layers <= IMAGE_MAX_CHANNELS, "a plane holds all layers");

struct FramesWriter {
    const FramesForm *form;
    ImageChannel channels[LAYERS]; /* of an OpenEXR file */
    int n_channels;
    ImageWriter *files[FRAME_FILES]; /* NULL: not wanted */
    Picture whole;                   /* of a page, or to be kept */
    int next;                        /* row */
};

static bool is_asked_for(const FramesForm *form, int file)
{
    const bool asked_for[] = {form->color, form->depth,   form->normal,
                              form->id,    form->picture, form->alpha};
    return asked_for[file];
}

static bool is_layered(const FramesForm *form)
{
    return form->picture && strcmp(file_extension(form->path), "exr") == 0;
}

/* Whether there is such a file. */
static bool is_wanted(const FramesForm *form, int file)
{
    return is_asked_for(form, file) && (file == FILE_PICTURE || !is_layered(form));
}

static void choose_channels(FramesWriter *writer)
{
    for (int i = 0; i < LAYERS; i++)
        if (is_asked_for(writer->form, layers[i].of))
            writer->channels[writer->n_channels++] = layers[i].channel;
}

/* Whether the picture is held in memory until the end. */
static bool is_held(const FramesForm *form)
{
    return form->kept || frames_is_page(form->path);
}

static Status open_picture(FramesWriter *writer, Err *err)
{
    const FramesForm *form = writer->form;
    if (is_held(form))
        return picture_init(&writer->whole, form->width, form->height, 3, 8, err);
    ImageNote notes[4] = {{"Software", GENERATOR}, {"Comment", form->provenance}};
    ImageNotes all = {.notes = notes, .count = 2, .dpi = form->dpi};
    if (form->colors)
        notes[all.count++] = (ImageNote){"Colors", form->colors};
    if (form->shard)
        notes[all.count++] = (ImageNote){"Shard", form->shard};
    ImageForm image = {.width = form->width,
                       .height = form->height,
                       .channels = form->alpha ? 4 : 3,
                       .bits = image_traits(form->path).floats ? 32 : form->bits,
                       .encoding = form->encoding,
                       .notes = &all,
                       .packing = form->packing};
    if (is_layered(form)) {
        choose_channels(writer);
        image.channels = writer->n_channels;
        image.named = writer->channels;
    }
    return imagewriter_open(&writer->files[FILE_PICTURE], form->path, &image, err);
}

static const struct {
    const char *suffix;
    int channels, bits;
} planes[] = {[FILE_COLOR] = {".color.pfm", 3, 32},
              [FILE_DEPTH] = {".depth.pfm", 1, 32},
              [FILE_NORMAL] = {".normal.pfm", 3, 32},
              [FILE_ID] = {".id.ppm", 3, 8}};

Status frames_note_planes(const FramesForm *form, Files *files, Err *err)
{
    for (int file = 0; file < FILE_PICTURE; file++) {
        char *name = NULL;
        if (!is_wanted(form, file))
            continue;
        TRY(file_with_suffix(form->path, planes[file].suffix, &name, err));
        Status status = files_write(files, "--planes", name, err);
        free(name);
        TRY(status);
    }
    return STATUS_OK;
}

static Status open_plane(FramesWriter *writer, int file, Err *err)
{
    const ImageForm image = {.width = writer->form->width,
                             .height = writer->form->height,
                             .channels = planes[file].channels,
                             .bits = planes[file].bits,
                             .encoding = ENCODING_LINEAR};
    char *name = NULL;
    TRY(file_with_suffix(writer->form->path, planes[file].suffix, &name, err));
    Status status = imagewriter_open(&writer->files[file], name, &image, err);
    free(name);
    return status;
}

Status frames_open(FramesWriter **out, const FramesForm *form, Err *err)
{
    FramesWriter *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    writer->form = form;
    Status status = STATUS_OK;
    for (int file = 0; file < FRAME_FILES && status == STATUS_OK; file++)
        if (is_wanted(form, file))
            status =
                file == FILE_PICTURE ? open_picture(writer, err) : open_plane(writer, file, err);
    if (status != STATUS_OK) {
        frames_discard(writer);
        return status;
    }
    *out = writer;
    return STATUS_OK;
}

static Status write_codes(ImageWriter *file, Picture *codes, Err *err)
{
    Status status = imagewriter_codes(file, codes, err);
    picture_release(codes);
    return status;
}

/* Rows of the picture with what is drawn over them. */
static Status annotate(FramesWriter *writer, Picture *codes, Err *err)
{
    const FramesForm *form = writer->form;
    if (is_held(form))
        memcpy(writer->whole.codes8 + (size_t)writer->next * picture_stride(codes), codes->codes8,
               (size_t)codes->height * picture_stride(codes));
    else if (form->page)
        TRY(figure_draw(form->page, form->first + writer->next, codes, err));
    writer->next += codes->height;
    return STATUS_OK;
}

/* Puts all that is asked for into one plane. */
static void merge(const FramesForm *form, const Frame *rows, Plane *merged)
{
    const Plane *const values[] = {[FILE_DEPTH] = &rows->depth,
                                   [FILE_NORMAL] = &rows->normal,
                                   [FILE_PICTURE] = &rows->color,
                                   [LAYER_ALPHA] = &rows->alpha};
    size_t n = (size_t)merged->width * (size_t)merged->height;
    size_t stride = (size_t)merged->channels, at = 0;
    for (size_t i = 0, c = 0; i < LAYERS; i++) {
        int of = layers[i].of;
        c = i > 0 && of == layers[i - 1].of ? c + 1 : 0;
        if (!is_asked_for(form, of))
            continue;
        for (size_t p = 0; p < n; p++)
            merged->values[p * stride + at] =
                of == FILE_ID ? (float)rows->id.ids[p]
                              : values[of]->values[p * (size_t)values[of]->channels + c];
        at++;
    }
}

static Status write_layers(FramesWriter *writer, const Frame *rows, Err *err)
{
    Plane merged;
    TRY(plane_init(&merged, rows->color.width, rows->color.height, writer->n_channels, err));
    merge(writer->form, rows, &merged);
    Status status = imagewriter_floats(writer->files[FILE_PICTURE], &merged, err);
    plane_release(&merged);
    return status;
}

static Status write_picture(FramesWriter *writer, const Frame *rows, Err *err)
{
    ImageWriter *file = writer->files[FILE_PICTURE];
    if (is_layered(writer->form))
        return write_layers(writer, rows, err);
    if (image_traits(writer->form->path).floats)
        return imagewriter_floats(file, &rows->color, err);
    if (rows->codes.codes8)
        return imagewriter_codes(file, &rows->codes, err);
    const FramesForm *form = writer->form;
    Picture codes;
    TRY(form->alpha ? picture_from_transparent(&codes, &rows->color, &rows->alpha, form->encoding,
                                               form->bits, err)
                    : picture_from_plane(&codes, &rows->color, form->encoding, form->bits, err));
    Status status = annotate(writer, &codes, err);
    if (status == STATUS_OK && file)
        return write_codes(file, &codes, err);
    picture_release(&codes);
    return status;
}

Status frames_write_page(const FigurePage *page, const FigureNotes *notes, const char *path,
                         Err *err)
{
    if (strcmp(file_extension(path), "pdf") == 0)
        return figure_write_pdf(page, notes, path, err);
    OutFile file;
    TRY(outfile_open(&file, path, err));
    Text svg = TEXT_TO(file.stream);
    Status status = figure_put_svg(page, notes, &svg, err);
    if (status == STATUS_OK)
        status = text_flush(&svg, err);
    text_release(&svg);
    if (status == STATUS_OK)
        return outfile_commit(&file, err);
    if (status == STATUS_IO)
        err_prefix(err, "%s: ", path);
    outfile_discard(&file);
    return status;
}

/* The picture in its page, which is written, or handed over. */
static Status finish_held(FramesWriter *writer, Err *err)
{
    const FramesForm *form = writer->form;
    if (form->kept) {
        *form->kept = writer->whole;
        writer->whole = (Picture){0};
        return STATUS_OK;
    }
    figure_add_picture(form->page, &writer->whole, 0, 0);
    TRY(figure_check(form->page, err));
    Status status = frames_write_page(form->page, form->notes, form->path, err);
    form->page->n--; /* the next picture takes its place */
    return status;
}

Status frames_rows(FramesWriter *writer, const Frame *rows, Err *err)
{
    const Plane *const values[] = {
        [FILE_COLOR] = &rows->color, [FILE_DEPTH] = &rows->depth, [FILE_NORMAL] = &rows->normal};
    for (int file = FILE_COLOR; file <= FILE_NORMAL; file++)
        if (writer->files[file])
            TRY(imagewriter_floats(writer->files[file], values[file], err));
    if (writer->files[FILE_ID]) {
        Picture codes;
        TRY(picture_from_ids(&codes, &rows->id, err));
        TRY(write_codes(writer->files[FILE_ID], &codes, err));
    }
    return writer->form->picture ? write_picture(writer, rows, err) : STATUS_OK;
}

Status frames_commit(FramesWriter *writer, Err *err)
{
    Status status = STATUS_OK;
    for (int file = 0; file < FRAME_FILES && status == STATUS_OK; file++) {
        if (!writer->files[file])
            continue;
        status = imagewriter_commit(writer->files[file], err);
        writer->files[file] = NULL;
    }
    if (status == STATUS_OK && writer->whole.codes8)
        status = finish_held(writer, err);
    frames_discard(writer);
    return status;
}

void frames_discard(FramesWriter *writer)
{
    for (int file = 0; writer && file < FRAME_FILES; file++)
        imagewriter_discard(writer->files[file]);
    if (writer)
        picture_release(&writer->whole);
    free(writer);
}

Status frames_write(const Frame *frame, const FramesForm *form, Err *err)
{
    FramesForm whole = *form;
    whole.width = form->picture ? frame->color.width : frame->id.width;
    whole.height = form->picture ? frame->color.height : frame->id.height;
    whole.depth = frame->depth.values != NULL;
    whole.normal = frame->normal.values != NULL;
    whole.id = frame->id.ids != NULL;
    FramesWriter *writer;
    TRY(frames_open(&writer, &whole, err));
    Status status = frames_rows(writer, frame, err);
    if (status == STATUS_OK)
        return frames_commit(writer, err);
    frames_discard(writer);
    return status;
}
