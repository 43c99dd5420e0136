/* Lays out a line of text as glyphs. fonts_shape makes the glyphs of a line. glyphs_run returns how
 * many consecutive glyphs can be drawn in one call. Private to the module figure. */
#ifndef CORCAST_FIGURE_FONTS_H
#define CORCAST_FIGURE_FONTS_H

#include "figure/figure.h"
#include <ft2build.h>
#include FT_FREETYPE_H

/* The fonts of a page: four faces of Liberation Sans, and FACE_FALLBACK. A character that
 * Liberation Sans lacks is drawn in FACE_FALLBACK, DejaVu Sans, which is upright and of regular
 * weight. FACES is the number of fonts. */
typedef enum FontFace {
    FACE_REGULAR,
    FACE_BOLD,
    FACE_ITALIC,
    FACE_BOLD_ITALIC,
    FACE_FALLBACK,
    FACES
} FontFace;

/* A character of a line. Lengths are multiples of the font size. */
typedef struct Glyph {
    FontFace face;
    unsigned index;  /* index of the glyph in its face; 0: a box for a character that no font has */
    uint32_t drawn;  /* the character that the glyph shows, such as '9' for a superscript nine */
    uint32_t letter; /* the character that stands for the glyph in the text of a PDF, such as U+2079
                      * for a superscript nine. Usually equal to `drawn` */
    double x;        /* distance from the beginning of the line */
    double scale;    /* size of the glyph: 1, or less in superscripts and subscripts */
    double rise;     /* height of the glyph's baseline above the line's baseline */
} Glyph;

/* A laid-out line of text. */
typedef struct Glyphs {
    Glyph *glyph; /* owned */
    size_t n;
    double width;           /* multiple of the font size */
    double ascent, descent; /* height above and depth below the baseline, as multiples of the font
                             * size; at least FONT_CAPITALS and FONT_DESCENT */
    FigureLetters missing;  /* characters of the text that Liberation Sans lacks */
    bool unclosed;          /* true: the text has an unclosed group of markup [FigureText] */
} Glyphs;

/* Adds the characters of `from` that are not in `to`. */
void letters_add(FigureLetters *to, const FigureLetters *from);

/* Lays out a line of text with markup [FigureText, figure.h]. Bytes that are not UTF-8 become
 * U+FFFD. `bold` makes the whole line bold. Release *out with glyphs_release. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out,
                              Err *err);
void glyphs_release(Glyphs *glyphs);

/* Returns the number of consecutive glyphs, from index `first` on, that have the same face, scale
 * and rise as glyph `first`. */
size_t glyphs_run(const Glyphs *glyphs, size_t first);

/* Return the FreeType objects of the fonts, borrowed. Loading a glyph changes the face, so only one
 * thread at a time may use the fonts. */
FT_Library fonts_library(const FigureFonts *fonts);
FT_Face fonts_face(const FigureFonts *fonts, FontFace face);

/* Height of the capitals of Liberation Sans above the baseline, and depth of its letters below the
 * baseline, as multiples of the font size. */
#define FONT_CAPITALS 0.73
#define FONT_DESCENT 0.21

#endif
