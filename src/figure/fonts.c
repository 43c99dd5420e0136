/* FreeType reads the two font files. No other font is used: Pango and fontconfig would choose by
 * what is installed. A line is a sequence of glyphs, moved together by the font's table of kerning
 * pairs. Sizes are those of the design, unhinted, so that a line has the same shape at every
 * resolution. That suffices for Latin, Greek and Cyrillic; the fonts have no scripts that need
 * more. */
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

FT_Face fonts_face(const FigureFonts *fonts, bool bold)
{
    return fonts->face[bold ? BOLD : REGULAR];
}

void glyphs_release(Glyphs *glyphs)
{
    free(glyphs->glyph);
    *glyphs = (Glyphs){0};
}

/* Returns the character at the start of well-formed UTF-8; U+FFFD for other bytes. */
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

/* ---- letters that the font lacks ------------------------------------------------------------- */

typedef enum SubstituteForm { SAME_SIZE, RAISED, LOWERED } SubstituteForm;

/* How a character that the font lacks is drawn as one that it has. */
typedef struct FontSubstitute {
    uint32_t letter, drawn;
    SubstituteForm form;
} FontSubstitute;

static const FontSubstitute substitutes[] = {
    {0x2011, '-', SAME_SIZE},  {0x2070, '0', RAISED},    {0x2071, 'i', RAISED},
    {0x207a, '+', RAISED},     {0x207b, 0x2212, RAISED}, {0x207c, '=', RAISED},
    {0x207d, '(', RAISED},     {0x207e, ')', RAISED},    {0x208a, '+', LOWERED},
    {0x208b, 0x2212, LOWERED}, {0x208c, '=', LOWERED},   {0x208d, '(', LOWERED},
    {0x208e, ')', LOWERED},    {0x2095, 'h', LOWERED},   {0x2096, 'k', LOWERED},
    {0x2097, 'l', LOWERED},    {0x2098, 'm', LOWERED},   {0x2099, 'n', LOWERED},
    {0x209a, 'p', LOWERED},    {0x209b, 's', LOWERED},   {0x209c, 't', LOWERED},
    {0x2c7c, 'j', LOWERED},
};

/* Size and baseline of the superscript and subscript digits of Liberation Sans, so that both kinds
 * match: U+2074 is 812 units high, a 4 is 1409, and U+2074 is 525 of 2048 units above the line,
 * U+2084 175 below. */
static const double small_scale = 0.576, raised_by = 0.256, lowered_by = -0.085;

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
    for (int i = 0; i < from->n_substituted; i++)
        list_letter(to->substituted, &to->n_substituted, from->substituted[i]);
    for (int i = 0; i < from->n_boxed; i++)
        list_letter(to->boxed, &to->n_boxed, from->boxed[i]);
}

/* Returns the glyph of a character, and lists the character if the font lacks it. */
static Glyph find_glyph(FT_Face face, uint32_t letter, FigureLetters *replaced)
{
    Glyph glyph = {.index = FT_Get_Char_Index(face, letter), .scale = 1};
    if (glyph.index)
        return glyph;
    for (size_t i = 0; i < sizeof substitutes / sizeof *substitutes; i++) {
        const FontSubstitute *by = &substitutes[i];
        if (by->letter != letter)
            continue;
        list_letter(replaced->substituted, &replaced->n_substituted, letter);
        glyph.index = FT_Get_Char_Index(face, by->drawn);
        glyph.scale = by->form == SAME_SIZE ? 1 : small_scale;
        glyph.rise = by->form == RAISED ? raised_by : by->form == LOWERED ? lowered_by : 0;
        return glyph;
    }
    list_letter(replaced->boxed, &replaced->n_boxed, letter);
    return glyph;
}

/* ---- lines ----------------------------------------------------------------------------------- */

/* FreeType fails here only if memory runs out. */
static Status add_letter(FT_Face face, uint32_t letter, int bytes, Glyphs *glyphs, Err *err)
{
    const double em = face->units_per_EM;
    const Glyph *before = glyphs->n ? &glyphs->glyph[glyphs->n - 1] : NULL;
    Glyph glyph = find_glyph(face, letter, &glyphs->replaced);
    FT_Vector pair = {0, 0};
    if (before && before->index && glyph.index && before->scale == 1 && glyph.scale == 1)
        (void)!FT_Get_Kerning(face, before->index, glyph.index, FT_KERNING_UNSCALED, &pair);
    if (FT_Load_Glyph(face, glyph.index, FT_LOAD_NO_SCALE))
        return mem_out_of("for", "letters", err);
    glyph.bytes = bytes;
    glyph.x = glyphs->width + (double)pair.x / em;
    glyphs->width += ((double)pair.x + glyph.scale * (double)face->glyph->advance.x) / em;
    glyphs->glyph[glyphs->n++] = glyph;
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
