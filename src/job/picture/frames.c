/* Writes pictures and their planes (color, depth, normal, id) to files, row by row, or keeps them
 * in memory. Each file has its own writer. The planes get their final names first and the picture
 * last, so that a picture is never beside the planes of another picture. OpenEXR contains the
 * planes as channels of the picture. All channels are floats, because few programs read integer
 * channels. Ids up to IMAGE_MAX_ID are exact in a float of 32 bits. */
#include "job/picture/frames.h"

#include "options/output.h"
#include <stdlib.h>
#include <string.h>

bool frames_is_page(const char *path)
{
    static const char *const known[] = {"pdf", "eps", "svg", NULL};
    return is_one_of(file_extension(path), known);
}

Status frames_check_output(const char *path, bool planes, Err *err)
{
    static const char *const known[] = {"png", "ppm",  "pfm", "tif", "tiff",
                                        "jpg", "jpeg", "exr", NULL};
    const bool is_stream = strcmp(path, "-") == 0;
    if (is_stream && planes)
        return err_set(err, STATUS_USAGE,
                       "--planes needs -o FILE, from which the names of the planes are formed");
    if (is_stream || is_one_of(file_extension(path), known))
        return STATUS_OK;
    (void)err_set(err, STATUS_USAGE,
                  "-o: '%s' does not end in .png, .ppm, .tif, .jpg, .exr or .pfm%s", path,
                  frames_is_page(path) ? "" : ", or for a page in .svg, .pdf or .eps");
    suggestion_append_extension(file_extension(path), err);
    return STATUS_USAGE;
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
    Picture whole;                   /* the picture of a page; owned */
    int next;                        /* row that comes next */
};

static bool is_asked_for(const FramesForm *form, int file)
{
    const bool asked_for[] = {form->color, form->depth,   form->normal,
                              form->id,    form->picture, form->alpha};
    return asked_for[file];
}

/* Returns true if the planes are layers of one file. */
static bool is_layered(const FramesForm *form)
{
    return form->picture && strcmp(file_extension(form->path), "exr") == 0;
}

/* Returns true if the file is written. */
static bool is_wanted(const FramesForm *form, int file)
{
    return is_asked_for(form, file) && (file == FILE_PICTURE || !is_layered(form));
}

/* Returns true if the fourth channel of the picture is the black ink of what is drawn over it. */
static bool has_black(const FramesForm *form)
{
    return form->page && form->packing.inks && !frames_is_page(form->path);
}

static Status open_picture(FramesWriter *writer, Err *err)
{
    const FramesForm *form = writer->form;
    if (frames_is_page(form->path))
        return picture_init(&writer->whole, form->width, form->height, 3, 8, err);
    ImageNote notes[4] = {{"Software", GENERATOR}, {"Comment", form->provenance}};
    ImageNotes all = {.notes = notes, .count = 2, .dpi = form->dpi};
    if (form->colors)
        notes[all.count++] = (ImageNote){"Colors", form->colors};
    if (form->shard)
        notes[all.count++] = (ImageNote){"Shard", form->shard};
    ImageForm image = {.width = form->width,
                       .height = form->height,
                       .channels = form->alpha || has_black(form) ? 4 : 3,
                       .bits = image_traits(form->path).floats ? 32 : form->bits,
                       .encoding = form->encoding,
                       .notes = &all,
                       .packing = form->packing};
    if (is_layered(form)) {
        for (int i = 0; i < LAYERS; i++)
            if (is_asked_for(form, layers[i].of))
                writer->channels[writer->n_channels++] = layers[i].channel;
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
        Status status = files_add_output(files, "--planes", name, err);
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

static Status open_files(FramesWriter *writer, Err *err)
{
    for (int file = 0; file < FRAME_FILES; file++)
        if (is_wanted(writer->form, file))
            TRY(file == FILE_PICTURE ? open_picture(writer, err) : open_plane(writer, file, err));
    return STATUS_OK;
}

/* Makes the frame that receives everything in memory. A picture of floats is its color plane. */
static Status open_memory(const FramesForm *form, Err *err)
{
    const int width = form->width, height = form->height;
    const bool floats = form->picture && image_traits(form->path).floats;
    Frame *kept = form->kept;
    if (form->picture && !floats)
        TRY(picture_init(&kept->codes, width, height, form->alpha ? 4 : 3, form->bits, err));
    if (form->color || floats)
        TRY(plane_init_unset(&kept->color, width, height, 3, err));
    if (form->alpha && floats)
        TRY(plane_init_unset(&kept->alpha, width, height, 1, err));
    if (form->depth)
        TRY(plane_init_unset(&kept->depth, width, height, 1, err));
    if (form->normal)
        TRY(plane_init_unset(&kept->normal, width, height, 3, err));
    return form->id ? idplane_init(&kept->id, width, height, err) : STATUS_OK;
}

Status frames_open(FramesWriter **out, const FramesForm *form, Err *err)
{
    FramesWriter *writer;
    TRY(mem_calloc(&writer, 1, sizeof *writer, "writers", err));
    writer->form = form;
    Status status = form->kept ? open_memory(form, err) : open_files(writer, err);
    if (status != STATUS_OK) {
        frames_discard(writer);
        return status;
    }
    *out = writer;
    return STATUS_OK;
}

/* Copies rows into a whole picture, from the row `at` on. Without codes there is nothing to copy,
 * as for values below. */
static void keep_codes(Picture *whole, const Picture *rows, int at)
{
    const size_t stride = picture_stride(rows), n = (size_t)rows->height * stride;
    if (whole->codes8)
        memcpy(whole->codes8 + (size_t)at * stride, rows->codes8, n);
    if (whole->codes16)
        memcpy(whole->codes16 + (size_t)at * stride, rows->codes16, n * sizeof *rows->codes16);
}

/* Copies rows into a plane in memory, which may be absent. */
static void keep_values(Plane *whole, const Plane *rows, int at)
{
    const size_t stride = (size_t)whole->width * (size_t)whole->channels;
    if (whole->values)
        memcpy(whole->values + (size_t)at * stride, rows->values,
               (size_t)rows->height * stride * sizeof *rows->values);
}

/* Draws what lies over the picture, with black ink in a channel of its own. */
static Status write_with_black(const FramesWriter *writer, const Picture *codes, Err *err)
{
    const FramesForm *form = writer->form;
    Picture rows;
    TRY(picture_init(&rows, codes->width, codes->height, 4, codes->bits, err));
    for (size_t i = 0; i < picture_stride(codes) * (size_t)codes->height; i++)
        picture_set(&rows, i / 3 * 4 + i % 3, picture_code(codes, i));
    Status status = figure_draw(form->page, form->first + writer->next, &rows, err);
    if (status == STATUS_OK)
        status = imagewriter_codes(writer->files[FILE_PICTURE], &rows, err);
    picture_release(&rows);
    return status;
}

/* Draws what lies over the picture, and hands the rows over: to a page or memory, or to the file.
 */
static Status take_codes(FramesWriter *writer, Picture *codes, Err *err)
{
    const FramesForm *form = writer->form;
    ImageWriter *file = writer->files[FILE_PICTURE];
    if (file && has_black(form))
        return write_with_black(writer, codes, err);
    if (form->page && !writer->whole.codes8)
        TRY(figure_draw(form->page, form->first + writer->next, codes, err));
    if (file)
        return imagewriter_codes(file, codes, err);
    keep_codes(form->kept ? &form->kept->codes : &writer->whole, codes, writer->next);
    return STATUS_OK;
}

/* Merges all specified planes into one. */
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
        for (size_t pixel = 0; pixel < n; pixel++)
            merged->values[pixel * stride + at] =
                of == FILE_ID ? (float)rows->id.ids[pixel]
                              : values[of]->values[pixel * (size_t)values[of]->channels + c];
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
    const FramesForm *form = writer->form;
    if (image_traits(form->path).floats && form->kept)
        return STATUS_OK;
    if (is_layered(form))
        return write_layers(writer, rows, err);
    if (image_traits(form->path).floats)
        return imagewriter_floats(writer->files[FILE_PICTURE], &rows->color, err);
    Picture codes = rows->codes;
    if (codes.width > 0)
        return take_codes(writer, &codes, err);
    TRY(form->alpha ? picture_from_transparent(&codes, &rows->color, &rows->alpha, form->encoding,
                                               form->bits, err)
                    : picture_from_plane(&codes, &rows->color, form->encoding, form->bits, err));
    Status status = take_codes(writer, &codes, err);
    picture_release(&codes);
    return status;
}

/* A page and its notes. Borrowed. */
typedef struct NotedPage {
    const FigurePage *page;
    const FigureNotes *notes;
} NotedPage;

static Status put_svg(const void *context, Text *text, Err *err)
{
    const NotedPage *noted = context;
    return figure_put_svg(noted->page, noted->notes, text, err);
}

Status frames_write_page(const FigurePage *page, const FigureNotes *notes, const char *path,
                         Err *err)
{
    const bool eps = strcmp(file_extension(path), "eps") == 0;
    if (eps || strcmp(file_extension(path), "pdf") == 0)
        return figure_write_pdf(page, notes, eps, path, err);
    return file_write_parts(path, put_svg, &(NotedPage){page, notes}, err);
}

/* Writes the page with its picture in it. */
static Status finish_page(FramesWriter *writer, Err *err)
{
    const FramesForm *form = writer->form;
    figure_add_picture(form->page, &writer->whole, 0, 0);
    TRY(figure_check(form->page, err));
    Status status = frames_write_page(form->page, form->notes, form->path, err);
    form->page->n--; /* the next picture takes its place */
    return status;
}

static Status write_ids(ImageWriter *file, const IdPlane *ids, Err *err)
{
    Picture codes;
    TRY(picture_from_ids(&codes, ids, err));
    Status status = imagewriter_codes(file, &codes, err);
    picture_release(&codes);
    return status;
}

static Status write_planes(FramesWriter *writer, const Frame *rows, Err *err)
{
    const Plane *const values[] = {
        [FILE_COLOR] = &rows->color, [FILE_DEPTH] = &rows->depth, [FILE_NORMAL] = &rows->normal};
    for (int file = FILE_COLOR; file <= FILE_NORMAL; file++)
        if (writer->files[file])
            TRY(imagewriter_floats(writer->files[file], values[file], err));
    return writer->files[FILE_ID] ? write_ids(writer->files[FILE_ID], &rows->id, err) : STATUS_OK;
}

static void keep_planes(Frame *kept, const Frame *rows, int at)
{
    const size_t stride = (size_t)kept->id.width;
    keep_values(&kept->color, &rows->color, at);
    keep_values(&kept->alpha, &rows->alpha, at);
    keep_values(&kept->depth, &rows->depth, at);
    keep_values(&kept->normal, &rows->normal, at);
    if (kept->id.ids)
        memcpy(kept->id.ids + (size_t)at * stride, rows->id.ids,
               (size_t)rows->id.height * stride * sizeof *rows->id.ids);
}

Status frames_rows(FramesWriter *writer, const Frame *rows, Err *err)
{
    const FramesForm *form = writer->form;
    if (form->kept)
        keep_planes(form->kept, rows, writer->next);
    else
        TRY(write_planes(writer, rows, err));
    if (form->picture)
        TRY(write_picture(writer, rows, err));
    writer->next += rows->codes.width > 0 ? rows->codes.height : rows->color.height;
    return STATUS_OK;
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
        status = finish_page(writer, err);
    frames_discard(writer);
    return status;
}

void frames_discard(FramesWriter *writer)
{
    if (!writer)
        return;
    for (int file = 0; file < FRAME_FILES; file++)
        imagewriter_discard(writer->files[file]);
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
