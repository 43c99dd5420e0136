/* Loads the fonts with FreeType and lays out lines of text. Only the font files of corcast are
 * used: Pango and fontconfig would choose among the installed fonts. A line is a sequence of glyphs
 * with pairwise kerning. Widths are those of the unhinted design, so that a line has the same shape
 * at every resolution. This simple layout suffices for Latin, Greek and Cyrillic. Letters are
 * neither joined nor reordered, as Arabic and Hebrew would require. */
#include "figure/fonts.h"

#include "figure/textmarkup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct FigureFonts {
    FT_Library library;
    FT_Face face[FACES];
};

const char *const figure_font_files[] = {[FACE_REGULAR] = "fonts/LiberationSans-Regular.ttf",
                                         [FACE_BOLD] = "fonts/LiberationSans-Bold.ttf",
                                         [FACE_ITALIC] = "fonts/LiberationSans-Italic.ttf",
                                         [FACE_BOLD_ITALIC] = "fonts/LiberationSans-BoldItalic.ttf",
                                         [FACE_FALLBACK] = "fonts/DejaVuSans-subset.ttf",
                                         [FACES] = NULL};

static Status load_face(FigureFonts *fonts, int i, const char *path, Err *err)
{
    FT_Error failed = FT_New_Face(fonts->library, path, 0, &fonts->face[i]);
    if (failed == FT_Err_Out_Of_Memory)
        return mem_out_of("to read", path, err);
    if (failed || !FT_IS_SCALABLE(fonts->face[i]))
        return err_set(err, STATUS_IO, "%s: the font is missing or cannot be read", path);
    return STATUS_OK;
}

static Status load(FigureFonts *fonts, const char *templates, Err *err)
{
    if (FT_Init_FreeType(&fonts->library))
        return mem_out_of("to read", "fonts", err);
    for (int i = 0; i < FACES; i++) {
        char *path = NULL;
        TRY(file_join(templates, figure_font_files[i], &path, err));
        Status status = load_face(fonts, i, path, err);
        free(path);
        TRY(status);
    }
    return STATUS_OK;
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

FT_Face fonts_face(const FigureFonts *fonts, FontFace face)
{
    return fonts->face[face];
}

void glyphs_release(Glyphs *glyphs)
{
    free(glyphs->glyph);
    *glyphs = (Glyphs){0};
}

static void list_letter(uint32_t *list, int *n, uint32_t letter)
{
    for (int i = 0; i < *n; i++)
        if (list[i] == letter)
            return;
    if (*n < FIGURE_LETTERS)
        list[(*n)++] = letter;
}

void letters_add(FigureLetters *to, const FigureLetters *from)
{
    for (int i = 0; i < from->n_fallback; i++)
        list_letter(to->fallback, &to->n_fallback, from->fallback[i]);
    for (int i = 0; i < from->n_boxed; i++)
        list_letter(to->boxed, &to->n_boxed, from->boxed[i]);
}

/* Chooses the face and the glyph of a character, and lists the character if Liberation Sans lacks
 * it. */
static void find_glyph(const FigureFonts *fonts, Glyph *glyph, FigureLetters *missing)
{
    glyph->index = FT_Get_Char_Index(fonts->face[glyph->face], glyph->drawn);
    if (glyph->index)
        return;
    const unsigned index = FT_Get_Char_Index(fonts->face[FACE_FALLBACK], glyph->drawn);
    if (index) {
        glyph->face = FACE_FALLBACK;
        glyph->index = index;
        list_letter(missing->fallback, &missing->n_fallback, glyph->drawn);
    } else {
        list_letter(missing->boxed, &missing->n_boxed, glyph->drawn);
    }
}

/* Returns true if two letters can be drawn by one call. */
static bool same_run(const Glyph *a, const Glyph *b)
{
    return a->face == b->face && a->scale == b->scale && a->rise == b->rise;
}

size_t glyphs_run(const Glyphs *glyphs, size_t first)
{
    size_t n = 1;
    while (first + n < glyphs->n && same_run(&glyphs->glyph[first], &glyphs->glyph[first + n]))
        n++;
    return n;
}

/* Appends a glyph to the line. FreeType fails here only if memory runs out. */
static Status add_glyph(FT_Face face, Glyph glyph, Glyphs *glyphs, Err *err)
{
    const double unit = glyph.scale / face->units_per_EM;
    const Glyph *before = glyphs->n ? &glyphs->glyph[glyphs->n - 1] : NULL;
    FT_Vector pair = {0, 0};
    if (before && before->index && glyph.index && same_run(before, &glyph))
        (void)!FT_Get_Kerning(face, before->index, glyph.index, FT_KERNING_UNSCALED, &pair);
    if (FT_Load_Glyph(face, glyph.index, FT_LOAD_NO_SCALE))
        return mem_out_of("for", "letters", err);
    glyph.x = glyphs->width + (double)pair.x * unit;
    glyphs->width = glyph.x + (double)face->glyph->advance.x * unit;
    glyphs->ascent = fmax(glyphs->ascent, glyph.rise + glyph.scale * FONT_CAPITALS);
    glyphs->descent = fmax(glyphs->descent, glyph.scale * FONT_DESCENT - glyph.rise);
    glyphs->glyph[glyphs->n++] = glyph;
    return STATUS_OK;
}

static Status add_letter(const FigureFonts *fonts, const StyledLetter *letter, bool bold,
                         Glyphs *glyphs, Err *err)
{
    static const FontFace faces[2][2] = {{FACE_REGULAR, FACE_ITALIC},
                                         {FACE_BOLD, FACE_BOLD_ITALIC}};
    Glyph glyph = {.face = faces[bold][letter->italic],
                   .drawn = letter->drawn,
                   .letter = letter->letter,
                   .scale = letter->scale,
                   .rise = letter->rise};
    find_glyph(fonts, &glyph, &glyphs->missing);
    return add_glyph(fonts->face[glyph.face], glyph, glyphs, err);
}

Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out, Err *err)
{
    Glyphs made = {.ascent = FONT_CAPITALS, .descent = FONT_DESCENT};
    MarkupReader reader = {.at = text};
    StyledLetter letter;
    TRY(mem_calloc(&made.glyph, strlen(text), sizeof *made.glyph, "letters", err));
    while (markup_next(&reader, &letter)) {
        Status status = add_letter(fonts, &letter, bold, &made, err);
        if (status != STATUS_OK) {
            glyphs_release(&made);
            return status;
        }
    }
    made.unclosed = reader.depth > 0;
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
