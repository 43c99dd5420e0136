/* Lines of text as glyphs; private to the room figure. */
#ifndef CORCAST_FIGURE_FONTS_H
#define CORCAST_FIGURE_FONTS_H

#include "figure/figure.h"
#include <ft2build.h>
#include FT_FREETYPE_H

/* A letter of a line. Lengths are in sizes of the font. */
typedef struct Glyph {
    unsigned index; /* 0: the font's box for a letter that it lacks */
    int bytes;      /* of the text */
    double x;       /* from where the line begins */
    double scale;   /* of the glyph: 1, or less for a substitute of a superscript or subscript */
    double rise;    /* of the glyph's baseline above the line's */
} Glyph;

typedef struct Glyphs {
    Glyph *glyph; /* owned */
    size_t n;
    double width;           /* in sizes of the font */
    FigureLetters replaced; /* letters of the text that the font lacks */
} Glyphs;

/* Adds those letters of `from` that `to` does not list yet. */
void letters_add(FigureLetters *to, const FigureLetters *from);

/* Lays out a line of text. A letter that the font lacks becomes a substitute or a box.
 * STATUS_MEMORY; *out is owned (glyphs_release). */
MUST_CHECK Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out,
                              Err *err);
void glyphs_release(Glyphs *glyphs);

FT_Library fonts_library(const FigureFonts *fonts);
FT_Face fonts_face(const FigureFonts *fonts, bool bold);

/* How high capitals are, and how far letters reach below the baseline, over the font's size. */
#define FONT_CAPITALS 0.73
#define FONT_DESCENT 0.21

#endif
