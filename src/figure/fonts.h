/* Lines of text as glyphs; private to the room figure. */
#ifndef CORCAST_FIGURE_FONTS_H
#define CORCAST_FIGURE_FONTS_H

#include "figure/figure.h"
#include <ft2build.h>
#include FT_FREETYPE_H

/* A letter of a line. */
typedef struct Glyph {
    unsigned index;
    int bytes; /* of the text */
    double x;  /* from where the line begins, in sizes of the font */
} Glyph;

typedef struct Glyphs {
    Glyph *glyph; /* owned */
    size_t n;
    double width;     /* in sizes of the font */
    uint32_t missing; /* the first letter that the font lacks; 0: none */
} Glyphs;

/* STATUS_MEMORY; *out is owned (glyphs_release). */
MUST_CHECK Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out,
                              Err *err);
void glyphs_release(Glyphs *glyphs);

FT_Library fonts_library(const FigureFonts *fonts);
FT_Face fonts_face(const FigureFonts *fonts, bool bold);

/* How high capitals are, and how far letters reach below the baseline, over the font's size. */
#define FONT_CAPITALS 0.73
#define FONT_DESCENT 0.21

#endif
