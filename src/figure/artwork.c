/* Reads and draws image files and vector files that other programs wrote, as panels of a figure.
 *
 * poppler-glib draws a page of a PDF, and librsvg draws an SVG. Both draw on a cairo context, so
 * that lines and text stay vectors. Both libraries depend on many other libraries, so they are
 * loaded only for a figure that has such a panel. They abort the process when memory runs out. All
 * drawing is therefore done in child processes. */
#include "figure/artwork.h"

#include <cairo-svg.h>
#include <dlfcn.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- cairo ----------------------------------------------------------------------------------- */

Status artwork_check_cairo(cairo_status_t failed, Err *err)
{
    if (failed == CAIRO_STATUS_SUCCESS)
        return STATUS_OK;
    if (failed == CAIRO_STATUS_NO_MEMORY || failed == CAIRO_STATUS_WRITE_ERROR)
        return mem_out_of("for", "the page", err);
    return err_set(err, STATUS_IO, "the page: %s", cairo_status_to_string(failed));
}

cairo_status_t artwork_write_to_text(void *bytes, const unsigned char *from, unsigned int n)
{
    text_append(bytes, (const char *)from, n);
    return text_chars(bytes) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* Copies a picture to a cairo surface, which the caller destroys. */
static Status make_surface(const Picture *picture, cairo_surface_t **out, Err *err)
{
    if (picture->width > FIGURE_PDF_SIDE || picture->height > FIGURE_PDF_SIDE)
        return err_set(err, STATUS_USAGE,
                       "a picture of %dx%d pixels is too large for a PDF (at most %d per side); "
                       "use .png or .tif",
                       picture->width, picture->height, FIGURE_PDF_SIDE);
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture->width, picture->height);
    TRY(artwork_check_cairo(cairo_surface_status(surface), err));
    unsigned char *bytes = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            const uint8_t *rgb =
                picture->codes8 + (size_t)y * picture_stride(picture) + 3 * (size_t)x;
            uint32_t pixel = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
            memcpy(bytes + (size_t)y * (size_t)stride + 4 * (size_t)x, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
    *out = surface;
    return STATUS_OK;
}

Status artwork_draw_picture(const Picture *picture, const FigureBox *box, cairo_filter_t filter,
                            cairo_t *cairo, Err *err)
{
    cairo_surface_t *surface = NULL;
    TRY(make_surface(picture, &surface, err));
    cairo_save(cairo);
    cairo_translate(cairo, box->left, box->top);
    cairo_scale(cairo, (box->right - box->left) / picture->width,
                (box->bottom - box->top) / picture->height);
    cairo_set_source_surface(cairo, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo), filter);
    cairo_paint(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(surface);
    return artwork_check_cairo(cairo_status(cairo), err);
}

/* ---- the libraries --------------------------------------------------------------------------- */

/* Copies of the declarations of GLib's error and of librsvg's rectangle and length. */
typedef struct GError {
    uint32_t domain;
    int code;
    char *message;
} GError;
typedef struct RsvgRectangle {
    double x, y, width, height;
} RsvgRectangle;
typedef struct RsvgLength {
    double length;
    int unit;
} RsvgLength;

/* The functions of the libraries, and their prototypes. */
typedef struct Poppler {
    void *(*document_new_from_data)(char *bytes, int size, const char *password, GError **error);
    int (*document_get_n_pages)(void *document);
    void *(*document_get_page)(void *document, int index);
    void (*page_get_size)(void *page, double *width, double *height);
    void (*page_render_for_printing)(void *page, cairo_t *cairo);
} Poppler;
typedef struct Rsvg {
    void *(*handle_new_from_data)(const uint8_t *bytes, size_t size, GError **error);
    int (*handle_get_intrinsic_size_in_pixels)(void *handle, double *width, double *height);
    void (*handle_get_intrinsic_dimensions)(void *handle, int *has_width, RsvgLength *width,
                                            int *has_height, RsvgLength *height, int *has_box,
                                            RsvgRectangle *box);
    int (*handle_render_document)(void *handle, cairo_t *cairo, const RsvgRectangle *where,
                                  GError **error);
} Rsvg;

typedef struct Symbol {
    const char *name;
    void *where; /* the address of a function pointer */
} Symbol;

/* Loads functions of a library. The library is never unloaded, because the child process ends soon.
 * `package` is the Debian package that an error names. */
static Status load(const char *library, const char *package, const Symbol *symbols, size_t n,
                   Err *err)
{
    void *loaded = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    for (size_t i = 0; i < n; i++) {
        void *found = loaded ? dlsym(loaded, symbols[i].name) : NULL;
        if (!found)
            return err_set(err, STATUS_TOOL, "this picture needs the library %s (Debian: %s): %s",
                           library, package, dlerror());
        memcpy(symbols[i].where, &found, sizeof found);
    }
    return STATUS_OK;
}

static Status load_poppler(Poppler *poppler, Err *err)
{
    const Symbol symbols[] = {
        {"poppler_document_new_from_data", &poppler->document_new_from_data},
        {"poppler_document_get_n_pages", &poppler->document_get_n_pages},
        {"poppler_document_get_page", &poppler->document_get_page},
        {"poppler_page_get_size", &poppler->page_get_size},
        {"poppler_page_render_for_printing", &poppler->page_render_for_printing}};
    return load("libpoppler-glib.so.8", "libpoppler-glib8", symbols,
                sizeof symbols / sizeof *symbols, err);
}

static Status load_rsvg(Rsvg *rsvg, Err *err)
{
    const Symbol symbols[] = {
        {"rsvg_handle_new_from_data", &rsvg->handle_new_from_data},
        {"rsvg_handle_get_intrinsic_size_in_pixels", &rsvg->handle_get_intrinsic_size_in_pixels},
        {"rsvg_handle_get_intrinsic_dimensions", &rsvg->handle_get_intrinsic_dimensions},
        {"rsvg_handle_render_document", &rsvg->handle_render_document}};
    return load("librsvg-2.so.2", "librsvg2-2", symbols, sizeof symbols / sizeof *symbols, err);
}

static Status refuse(const FigureArtwork *artwork, const char *kind, const GError *error, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s: is not %s that can be read: %.200s", artwork->path, kind,
                   error ? error->message : "no reason is stated");
}

/* Opens the page of a PDF that has exactly one page. */
static Status open_pdf(const FigureArtwork *artwork, Poppler *poppler, void **page, Err *err)
{
    GError *error = NULL;
    TRY(load_poppler(poppler, err));
    void *document =
        poppler->document_new_from_data(artwork->bytes, (int)artwork->size, NULL, &error);
    if (!document)
        return refuse(artwork, "a PDF", error, err);
    const int pages = poppler->document_get_n_pages(document);
    if (pages != 1)
        return err_set(err, STATUS_INPUT, "%s: has %d pages; a panel shows a PDF of one page",
                       artwork->path, pages);
    *page = poppler->document_get_page(document, 0);
    return *page ? STATUS_OK : refuse(artwork, "a PDF", NULL, err);
}

static Status open_svg(const FigureArtwork *artwork, Rsvg *rsvg, void **handle, Err *err)
{
    GError *error = NULL;
    TRY(load_rsvg(rsvg, err));
    *handle = rsvg->handle_new_from_data((const uint8_t *)artwork->bytes, artwork->size, &error);
    return *handle ? STATUS_OK : refuse(artwork, "an SVG", error, err);
}

/* Finds the size of an SVG. An SVG without a size has the size of its viewBox, and without a
 * viewBox 0 x 0. */
static void measure_svg(const Rsvg *rsvg, void *handle, double size[2])
{
    int has_width, has_height, has_box;
    RsvgLength width, height;
    RsvgRectangle box = {0};
    if (rsvg->handle_get_intrinsic_size_in_pixels(handle, &size[0], &size[1]))
        return;
    rsvg->handle_get_intrinsic_dimensions(handle, &has_width, &width, &has_height, &height,
                                          &has_box, &box);
    size[0] = has_box ? box.width : 0;
    size[1] = has_box ? box.height : 0;
}

/* Discards the warnings that the libraries write to standard error, where only corcast should
 * write. */
static void be_silent(void)
{
    if (!freopen("/dev/null", "w", stderr))
        fclose(stderr);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* An IsolatedWork: appends the width and the height of an artwork, two doubles. */
static Status put_size(const void *context, Text *bytes, Err *err)
{
    const FigureArtwork *artwork = context;
    double size[2] = {0};
    be_silent();
    if (artwork->pdf) {
        Poppler poppler;
        void *page;
        TRY(open_pdf(artwork, &poppler, &page, err));
        poppler.page_get_size(page, &size[0], &size[1]);
    } else {
        Rsvg rsvg;
        void *handle;
        TRY(open_svg(artwork, &rsvg, &handle, err));
        measure_svg(&rsvg, handle, size);
    }
    text_append(bytes, (const char *)size, sizeof size);
    return STATUS_OK;
}

/* Maximum number of bytes of a PDF or SVG. Viewers cannot open larger pages of vectors, so a larger
 * file is a mistake. */
enum { MAX_BYTES = 100000000 };

static Status read_vectors(FigureArtwork *artwork, Err *err)
{
    const FileForm form = {.name = "a page of vectors", .most_bytes = MAX_BYTES};
    Text bytes = TEXT_INIT;
    double size[2];
    Status status;
    TRY(file_read(artwork->path, &form, &artwork->bytes, &artwork->size, err));
    TRY_GOTO(isolated_run(put_size, artwork, "the picture", &bytes, err));
    memcpy(size, text_chars(&bytes), sizeof size);
    artwork->width = size[0];
    artwork->height = size[1];
    /* A page 10,000 times as long as wide has no sensible place in a panel. */
    if (!(size[0] > 0 && size[1] > 0 && size[0] / size[1] < 1e4 && size[1] / size[0] < 1e4))
        status = err_set(err, STATUS_INPUT, "%s: its size is %g x %g; it must be above 0 x 0",
                         artwork->path, size[0], size[1]);
done:
    text_release(&bytes);
    return status;
}

/* Composites a picture of 4 channels over a paper color. */
static void flatten(const Picture *from, FigureColor paper, Picture *to)
{
    const size_t n = (size_t)from->width * (size_t)from->height;
    const int all = from->bits == 8 ? 255 : 65535, channels = from->channels;
    for (size_t i = 0; i < n; i++) {
        const size_t at = i * (size_t)channels;
        const int alpha = channels == 4 ? picture_code(from, at + 3) : all;
        for (int c = 0; c < 3; c++) {
            const double code = picture_code(from, at + (size_t)(channels > 2 ? c : 0));
            const double mixed =
                (code * alpha / all * 255 + paper.rgb[c] * (double)(all - alpha)) / all;
            to->codes8[3 * i + (size_t)c] = (uint8_t)lround(mixed);
        }
    }
}

static Status read_pixels(FigureArtwork *artwork, FigureColor paper, Err *err)
{
    Picture read = {0}, srgb = {0};
    Status status = STATUS_OK;
    TRY_GOTO(picture_read(&read, artwork->path, ALPHA_KEPT, err));
    if (read.width > FIGURE_PDF_SIDE || read.height > FIGURE_PDF_SIDE)
        TRY_GOTO(err_set(err, STATUS_INPUT,
                         "%s: has %dx%d pixels; a panel shows at most %d pixels per side",
                         artwork->path, read.width, read.height, FIGURE_PDF_SIDE));
    TRY_GOTO(picture_to_srgb(&srgb, &read, read.bits, err));
    artwork->width = srgb.width;
    artwork->height = srgb.height;
    TRY_GOTO(picture_init(&artwork->picture, srgb.width, srgb.height, 3, 8, err));
    flatten(&srgb, paper, &artwork->picture);
done:
    picture_release(&read);
    picture_release(&srgb);
    return status;
}

Status figureartwork_read(const char *path, FigureColor paper, FigureArtwork *artwork, Err *err)
{
    ImageFacts facts;
    TRY(image_facts(path, &facts, err));
    if (facts.bytes > MAX_BYTES)
        return err_set(err, STATUS_INPUT, "%s: has %.0f MB; a panel shows files of at most %d MB",
                       path, (double)facts.bytes * 1e-6, MAX_BYTES / 1000000);
    *artwork = (FigureArtwork){.path = path, .pdf = strcmp(facts.format, "pdf") == 0};
    if (artwork->pdf || strcmp(facts.format, "svg") == 0)
        return read_vectors(artwork, err);
    if (facts.width > 0)
        return read_pixels(artwork, paper, err);
    return err_set(err, STATUS_INPUT,
                   "%s: is of the format %s; a panel shows a .pdf, .svg, .png, .tif or .jpg", path,
                   facts.format);
}

void figureartwork_release(FigureArtwork *artwork)
{
    free(artwork->bytes);
    picture_release(&artwork->picture);
    *artwork = (FigureArtwork){0};
}

/* ---- drawing --------------------------------------------------------------------------------- */

/* Draws the page into the box, and nothing of it outside. */
static Status draw_pdf(const FigureArtwork *artwork, const FigureBox *box, cairo_t *cairo, Err *err)
{
    Poppler poppler;
    void *page;
    TRY(open_pdf(artwork, &poppler, &page, err));
    cairo_translate(cairo, box->left, box->top);
    cairo_scale(cairo, (box->right - box->left) / artwork->width,
                (box->bottom - box->top) / artwork->height);
    cairo_rectangle(cairo, 0, 0, artwork->width, artwork->height);
    cairo_clip(cairo);
    poppler.page_render_for_printing(page, cairo);
    return STATUS_OK;
}

static Status draw_svg(const FigureArtwork *artwork, const FigureBox *box, cairo_t *cairo, Err *err)
{
    const RsvgRectangle where = {box->left, box->top, box->right - box->left,
                                 box->bottom - box->top};
    GError *error = NULL;
    Rsvg rsvg;
    void *handle;
    TRY(open_svg(artwork, &rsvg, &handle, err));
    if (!rsvg.handle_render_document(handle, cairo, &where, &error))
        return refuse(artwork, "an SVG", error, err);
    return STATUS_OK;
}

Status artwork_draw(const FigureArtwork *artwork, const FigureBox *box, cairo_t *cairo, Err *err)
{
    if (artwork->picture.width > 0)
        return artwork_draw_picture(&artwork->picture, box, CAIRO_FILTER_BEST, cairo, err);
    be_silent();
    cairo_save(cairo);
    TRY(artwork->pdf ? draw_pdf(artwork, box, cairo, err) : draw_svg(artwork, box, cairo, err));
    cairo_restore(cairo);
    return artwork_check_cairo(cairo_status(cairo), err);
}

/* The task of a child process. */
typedef struct ArtworkWork {
    const FigureArtwork *artwork;
    FigureBox box;
    FigureColor paper;
} ArtworkWork;

/* An IsolatedWork: appends the artwork as an SVG that cairo writes. */
static Status put_svg(const void *context, Text *bytes, Err *err)
{
    const ArtworkWork *work = context;
    const double points = 1 / MM_PER_POINT;
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(
        artwork_write_to_text, bytes, work->box.right * points, work->box.bottom * points);
    cairo_t *cairo = cairo_create(surface);
    cairo_scale(cairo, points, points);
    TRY(artwork_draw(work->artwork, &work->box, cairo, err));
    cairo_surface_finish(surface);
    return artwork_check_cairo(cairo_surface_status(surface), err);
}

Status artwork_put_svg(const FigureArtwork *artwork, double width_mm, double height_mm, Text *svg,
                       Err *err)
{
    const ArtworkWork work = {.artwork = artwork, .box = {0, 0, width_mm, height_mm}};
    return isolated_run(put_svg, &work, "the picture", svg, err);
}

/* An IsolatedWork: appends the pixels as 8-bit RGB. */
static Status put_pixels(const void *context, Text *bytes, Err *err)
{
    const ArtworkWork *work = context;
    const int width = (int)work->box.right, height = (int)work->box.bottom;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t *cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, work->paper.rgb[0] / 255.0, work->paper.rgb[1] / 255.0,
                         work->paper.rgb[2] / 255.0);
    cairo_paint(cairo);
    TRY(artwork_draw(work->artwork, &work->box, cairo, err));
    cairo_surface_flush(surface);
    const unsigned char *rows = cairo_image_surface_get_data(surface);
    for (int y = 0; y < height; y++, rows += cairo_image_surface_get_stride(surface))
        for (int x = 0; x < width; x++) {
            uint32_t pixel;
            memcpy(&pixel, rows + 4 * (size_t)x, sizeof pixel);
            const char rgb[3] = {(char)(pixel >> 16), (char)(pixel >> 8), (char)pixel};
            text_append(bytes, rgb, sizeof rgb);
        }
    return STATUS_OK;
}

Status artwork_rasterize(const FigureArtwork *artwork, int width, int height, FigureColor paper,
                         Picture *out, Err *err)
{
    const ArtworkWork work = {artwork, {0, 0, width, height}, paper};
    Text bytes = TEXT_INIT;
    Status status;
    TRY_GOTO(isolated_run(put_pixels, &work, "the picture", &bytes, err));
    TRY_GOTO(picture_init(out, width, height, 3, 8, err));
    memcpy(out->codes8, text_chars(&bytes), 3 * (size_t)width * (size_t)height);
done:
    text_release(&bytes);
    return status;
}
