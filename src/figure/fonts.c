/* FreeType reads the two files, and no other font is looked for: Pango and fontconfig would choose
 * by what is installed. A line is its letters one after another, moved together as the font's table
 * of pairs says; sizes are those of the design, unhinted, so that a line has the same form at every
 * resolution. That is all that Latin, Greek and Cyrillic need; the fonts have no other scripts that
 * need more. */
#include "figure/fonts.h"

#include <stdlib.h>
#include <string.h>

enum { REGULAR, BOLD, FACES };

struct FigureFonts {
    FT_Library library;
    FT_Face face[FACES];
};

const char *const figure_font_files[] = {[REGULAR] = "fonts/LiberationSans-Regular.ttf",
                                         [BOLD] = "fonts/LiberationSans-Bold.ttf",
                                         [FACES] = NULL};

static Status load_face(FigureFonts *fonts, int i, const char *path, Err *err)
{
    FT_Error failed = FT_New_Face(fonts->library, path, 0, &fonts->face[i]);
    if (failed == FT_Err_Out_Of_Memory)
        return mem_out_of("to read", path, err);
    if (failed || !FT_IS_SCALABLE(fonts->face[i]) || !FT_HAS_KERNING(fonts->face[i]))
        return err_set(err, STATUS_IO, "%s: the font is missing or cannot be read", path);
    return STATUS_OK;
}

static Status load(FigureFonts *fonts, const char *templates, Err *err)
{
    Status status = STATUS_OK;
    if (FT_Init_FreeType(&fonts->library))
        return mem_out_of("to read", "fonts", err);
    for (int i = 0; i < FACES && status == STATUS_OK; i++) {
        char *path = NULL;
        TRY(file_join(templates, figure_font_files[i], &path, err));
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

void figurefonts_free(FigureFonts *fonts)
{
    if (!fonts)
        return;
    for (int i = 0; i < FACES; i++)
        if (fonts->face[i])
            FT_Done_Face(fonts->face[i]);
    if (fonts->library)
        FT_Done_FreeType(fonts->library);
    free(fonts);
}

FT_Library fonts_library(const FigureFonts *fonts)
{
    return fonts->library;
}

FT_Face fonts_face(const FigureFonts *fonts, bool bold)
{
    return fonts->face[bold ? BOLD : REGULAR];
}

void glyphs_release(Glyphs *glyphs)
{
    free(glyphs->glyph);
    *glyphs = (Glyphs){0};
}

/* The character at the start of well-formed UTF-8, or the one that stands for what is none. */
static uint32_t character(const char *at, size_t length)
{
    static const unsigned char firsts[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    if (length == 0)
        return 0xfffd;
    uint32_t code = (unsigned char)*at & firsts[length];
    for (size_t i = 1; i < length; i++)
        code = code << 6 | ((unsigned char)at[i] & 0x3f);
    return code;
}

/* FreeType fails here only where memory does. */
static Status add_letter(FT_Face face, uint32_t letter, int bytes, Glyphs *glyphs, Err *err)
{
    const double em = face->units_per_EM;
    const unsigned before = glyphs->n ? glyphs->glyph[glyphs->n - 1].index : 0;
    const unsigned index = FT_Get_Char_Index(face, letter);
    FT_Vector pair = {0, 0};
    if (before && index)
        (void)!FT_Get_Kerning(face, before, index, FT_KERNING_UNSCALED, &pair);
    if (!index && !glyphs->missing)
        glyphs->missing = letter;
    if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE))
        return mem_out_of("for", "letters", err);
    glyphs->glyph[glyphs->n++] =
        (Glyph){.index = index, .bytes = bytes, .x = glyphs->width + (double)pair.x / em};
    glyphs->width += ((double)pair.x + (double)face->glyph->advance.x) / em;
    return STATUS_OK;
}

Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out, Err *err)
{
    Glyphs made = {0};
    TRY(mem_calloc(&made.glyph, strlen(text), sizeof *made.glyph, "letters", err));
    for (const char *at = text; *at;) {
        size_t length = utf8_length(at);
        size_t bytes = length ? length : 1;
        Status status =
            add_letter(fonts_face(fonts, bold), character(at, length), (int)bytes, &made, err);
        if (status != STATUS_OK) {
            glyphs_release(&made);
            return status;
        }
        at += bytes;
    }
    *out = made;
    return STATUS_OK;
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
