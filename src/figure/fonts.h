/* Lines of text as glyphs; private to the room figure. */
#ifndef CORCAST_FIGURE_FONTS_H
#define CORCAST_FIGURE_FONTS_H

#include "figure/figure.h"
#include <cairo.h>

/* A line as cairo draws it, from the origin on, in units of the font's size. */
typedef struct Glyphs {
    cairo_glyph_t *glyph;          /* owned */
    cairo_text_cluster_t *cluster; /* owned; which bytes of the text which glyphs stand for */
    int n, n_clusters;
    double width;
} Glyphs;

/* STATUS_MEMORY; *out is owned (glyphs_release). */
MUST_CHECK Status fonts_shape(const FigureFonts *fonts, const char *text, bool bold, Glyphs *out,
                              Err *err);
void glyphs_release(Glyphs *glyphs);

cairo_font_face_t *fonts_cairo(const FigureFonts *fonts, bool bold);

/* How high capitals are, and how far letters reach below the baseline, over the font's size. */
#define FONT_CAPITALS 0.73
#define FONT_DESCENT 0.21

/* The first letter of a text that a font lacks; 0: none. */
uint32_t fonts_missing(const FigureFonts *fonts, const char *text, bool bold);

#endif
