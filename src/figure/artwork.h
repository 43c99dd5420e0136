/* Draws artwork, which is an image or vector file that another program made, with cairo.
 * artwork_draw_picture and artwork_draw must be called in a child process, because the libraries
 * that they use may fail or crash [base/isolated.h]. Private to the module figure. */
#ifndef CORCAST_FIGURE_ARTWORK_H
#define CORCAST_FIGURE_ARTWORK_H

#include "figure/figure.h"

#include <cairo.h>

/* Draws a picture so that it fills a box of the page. The unit of the cairo context is the mm.
 *
 * filter   resampling filter: used here if the context produces pixels, and stored for viewers in
 *          vector output.
 * Errors   STATUS_USAGE if a side has more than FIGURE_PDF_SIDE pixels; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status artwork_draw_picture(const Picture *picture, const FigureBox *box,
                                       cairo_filter_t filter, cairo_t *cairo, Err *err);
/* Draws an artwork so that it fills a box of the page. Vectors stay vectors. Errors: STATUS_TOOL if
 * the library that draws it is not installed; STATUS_INPUT if the library cannot read it; the
 * errors of artwork_draw_picture. */
MUST_CHECK Status artwork_draw(const FigureArtwork *artwork, const FigureBox *box, cairo_t *cairo,
                               Err *err);

/* Draws a vector artwork of `width_mm` x `height_mm` and appends it as SVG. Starts the child
 * process itself. Errors: those of artwork_draw. */
MUST_CHECK Status artwork_put_svg(const FigureArtwork *artwork, double width_mm, double height_mm,
                                  Text *svg, Err *err);
/* Draws an artwork as a picture of 3 channels of 8 bits. `paper` shows through where the artwork is
 * transparent. The caller releases *out with picture_release. Starts the child process itself.
 * Errors: those of artwork_draw. */
MUST_CHECK Status artwork_rasterize(const FigureArtwork *artwork, int width, int height,
                                    FigureColor paper, Picture *out, Err *err);

/* Converts a status of cairo to a Status; sets *err if it is not STATUS_OK. */
MUST_CHECK Status artwork_check_cairo(cairo_status_t status, Err *err);
/* A cairo_write_func_t: appends the n bytes at `from` to the Text that `bytes` points to. */
cairo_status_t artwork_take_bytes(void *bytes, const unsigned char *from, unsigned int n);

#endif
