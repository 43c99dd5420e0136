/* FreeType reads the two files, HarfBuzz turns a line into glyphs and places them, with the font's
 * kerning, and cairo draws these. Pango does the same, but finds fonts through fontconfig, whose
 * choice depends on what is installed; here no file but the two is opened, and without hinting the
 * places of glyphs depend neither on the resolution nor on FreeType's settings. */
#include "figure/fonts.h"

#include <cairo-ft.h>
#include <hb.h>
#include <stdlib.h>
#include <string.h>

enum { REGULAR, BOLD, FACES };

struct FigureFonts {
    FT_Library library;
    FT_Face face[FACES];
    hb_font_t *shaper[FACES];
    cairo_font_face_t *cairo[FACES];
};

static Status load_face(FigureFonts *fonts, int i, const char *path, Err *err)
{
    hb_codepoint_t glyph;
    FT_Error failed = FT_New_Face(fonts->library, path, 0, &fonts->face[i]);
    if (failed == FT_Err_Out_Of_Memory)
        return mem_out_of("to read", path, err);
    if (failed)
        return err_set(err, STATUS_IO, "%s: the font is missing or cannot be read", path);
    hb_blob_t *file = hb_blob_create_from_file(path);
    hb_face_t *face = hb_face_create(file, 0);
    fonts->shaper[i] = hb_font_create(face);
    hb_face_destroy(face);
    hb_blob_destroy(file);
    fonts->cairo[i] = cairo_ft_font_face_create_for_ft_face(fonts->face[i], FT_LOAD_NO_HINTING);
    if (cairo_font_face_status(fonts->cairo[i]) != CAIRO_STATUS_SUCCESS ||
        !hb_font_get_nominal_glyph(fonts->shaper[i], 'x', &glyph))
        return mem_out_of("to read", path, err);
    return STATUS_OK;
}

static Status load(FigureFonts *fonts, const char *templates, Err *err)
{
    static const char *const files[FACES] = {"fonts/LiberationSans-Regular.ttf",
                                             "fonts/LiberationSans-Bold.ttf"};
    Status status = STATUS_OK;
    if (FT_Init_FreeType(&fonts->library))
        return mem_out_of("to read", "fonts", err);
    for (int i = 0; i < FACES && status == STATUS_OK; i++) {
        char *path = NULL;
        TRY(file_join(templates, files[i], &path, err));
        status = load_face(fonts, i, path, err);
        free(path);
    }
    return status;
}

Status figurefonts_load(const char *templates, FigureFonts **out, Err *err)
{
    FigureFonts *fonts;
    TRY(mem_calloc(&fonts, 1, sizeof *fonts, "fonts", err));
    Status status = load(fonts, templates, err);
    if (status == STATUS_OK)
        *out = fonts;
    else
        figurefonts_free(fonts);
    return status;
}

/* cairo keeps what it has drawn with a face for a while, and FreeType counts who holds it: the
 * library's own hold goes last. */
void figurefonts_free(FigureFonts *fonts)
{
    if (!fonts)
        return;
    for (int i = 0; i < FACES; i++) {
        cairo_font_face_destroy(fonts->cairo[i]);
        hb_font_destroy(fonts->shaper[i]);
    }
    cairo_debug_reset_static_data();
    for (int i = 0; i < FACES; i++)
        if (fonts->face[i])
            FT_Done_Face(fonts->face[i]);
    if (fonts->library)
        FT_Done_FreeType(fonts->library);
    free(fonts);
}

cairo_font_face_t *fonts_cairo(const FigureFonts *fonts, bool bold)
{
    return fonts->cairo[bold ? BOLD : REGULAR];
}

void glyphs_release(Glyphs *glyphs)
{
    free(glyphs->glyph);
    free(glyphs->cluster);
    *glyphs = (Glyphs){0};
}

/* A cluster is the glyphs of the same bytes, and these are all up to those of the next. */
static void fill(const hb_glyph_info_t *info, const hb_glyph_position_t *at, int n, double em,
                 unsigned bytes, Glyphs *out)
{
    for (int i = 0; i < n; i++) {
        out->glyph[i] = (cairo_glyph_t){.index = info[i].codepoint,
                                        .x = out->width + at[i].x_offset / em,
                                        .y = -at[i].y_offset / em};
        out->width += at[i].x_advance / em;
        if (i == 0 || info[i].cluster != info[i - 1].cluster)
            out->n_clusters++;
        cairo_text_cluster_t *cluster = &out->cluster[out->n_clusters - 1];
        cluster->num_glyphs++;
        cluster->num_bytes = (int)(bytes - info[i].cluster);
        if (cluster > out->cluster && cluster->num_glyphs == 1)
            cluster[-1].num_bytes -= cluster->num_bytes;
    }
    out->n = n;
}

static Status shape(const FigureFonts *fonts, hb_buffer_t *buffer, const char *text, int face,
                    Glyphs *out, Err *err)
{
    hb_buffer_add_utf8(buffer, text, -1, 0, -1);
    hb_buffer_set_direction(buffer, HB_DIRECTION_LTR);
    hb_buffer_guess_segment_properties(buffer);
    hb_buffer_set_language(buffer, hb_language_from_string("en", -1));
    hb_shape(fonts->shaper[face], buffer, NULL, 0);
    if (!hb_buffer_allocation_successful(buffer))
        return mem_out_of("for", "glyphs", err);
    unsigned n;
    const hb_glyph_info_t *info = hb_buffer_get_glyph_infos(buffer, &n);
    const hb_glyph_position_t *at = hb_buffer_get_glyph_positions(buffer, NULL);
    TRY(mem_calloc(&out->glyph, n, sizeof *out->glyph, "glyphs", err));
    TRY(mem_calloc(&out->cluster, n, sizeof *out->cluster, "glyphs", err));
    fill(info, at, (int)n, fonts->face[face]->units_per_EM, (unsigned)strlen(text), out);
    return STATUS_OK;
}

Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out, Err *err)
{
    Glyphs made = {0};
    hb_buffer_t *buffer = hb_buffer_create();
    Status status = shape(fonts, buffer, text, bold ? BOLD : REGULAR, &made, err);
    hb_buffer_destroy(buffer);
    if (status == STATUS_OK)
        *out = made;
    else
        glyphs_release(&made);
    return status;
}

uint32_t fonts_missing(const FigureFonts *fonts, const char *text, bool bold)
{
    hb_buffer_t *buffer = hb_buffer_create();
    hb_buffer_add_utf8(buffer, text, -1, 0, -1);
    unsigned n;
    uint32_t missing = 0, glyph;
    const hb_glyph_info_t *letter = hb_buffer_get_glyph_infos(buffer, &n);
    for (unsigned i = 0; i < n && !missing; i++)
        if (!hb_font_get_nominal_glyph(fonts->shaper[bold ? BOLD : REGULAR], letter[i].codepoint,
                                       &glyph))
            missing = letter[i].codepoint;
    hb_buffer_destroy(buffer);
    return missing;
}

double figure_text_width(const FigureFonts *fonts, const char *text, double size_pt, bool bold)
{
    Glyphs glyphs = {0};
    if (fonts_shape(fonts, text, bold, &glyphs, NULL) != STATUS_OK)
        return 0;
    double width = glyphs.width * size_pt * MM_PER_POINT;
    glyphs_release(&glyphs);
    return width;
}
