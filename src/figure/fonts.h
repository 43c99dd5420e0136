/* Lays out lines of text as glyphs of a font. Private to the module figure. */
#ifndef CORCAST_FIGURE_FONTS_H
#define CORCAST_FIGURE_FONTS_H

#include "figure/figure.h"
#include <ft2build.h>
#include FT_FREETYPE_H

/* A character of a line. Lengths are multiples of the font size. */
typedef struct Glyph {
    unsigned index; /* of the glyph; 0: the font's box for a character that it lacks */
    int bytes;      /* number of bytes of the character in the UTF-8 text */
    double x;       /* distance from the beginning of the line */
    double scale; /* size of the glyph: 1, or less for a substitute of a superscript or subscript */
    double rise;  /* height of the glyph's baseline above the line's baseline */
} Glyph;

typedef struct Glyphs {
    Glyph *glyph; /* owned */
    size_t n;
    double width;           /* multiple of the font size */
    FigureLetters replaced; /* characters of the text that the font lacks */
} Glyphs;

/* Adds the characters of `from` that are not in `to`. */
void letters_add(FigureLetters *to, const FigureLetters *from);

/* Lays out a line of text. A character that the font lacks becomes a substitute or a box. Release
 * *out with glyphs_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out,
                              Err *err);
void glyphs_release(Glyphs *glyphs);

FT_Library fonts_library(const FigureFonts *fonts);
FT_Face fonts_face(const FigureFonts *fonts, bool bold);

/* Height of capitals above the baseline, and depth of letters below it, as multiples of the font
 * size.
 */
#define FONT_CAPITALS 0.73
#define FONT_DESCENT 0.21

#endif
