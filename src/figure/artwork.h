/* Draws artwork with cairo. An artwork is an image file or vector file that another program made:
 * pixels, a PDF page or an SVG.
 *
 * Call artwork_draw_picture and artwork_draw only in a child process [base/isolated.h], because the
 * libraries that draw PDF and SVG may crash. The other functions start the child process
 * themselves. Private to the module figure. */
#ifndef CORCAST_FIGURE_ARTWORK_H
#define CORCAST_FIGURE_ARTWORK_H

#include "figure/figure.h"

#include <cairo.h>

/* Draws a picture, stretched to a box of the page. The unit of the cairo context is the mm.
 *
 * filter   resampling filter. It is applied at once if the context produces pixels. In vector
 *          output it is stored for the viewer that resamples the picture.
 * Errors   STATUS_USAGE if a side has more than FIGURE_PDF_SIDE pixels; STATUS_IO;
 *          STATUS_MEMORY. */
MUST_CHECK Status artwork_draw_picture(const Picture *picture, const FigureBox *box,
                                       cairo_filter_t filter, cairo_t *cairo, Err *err);
/* Draws an artwork, stretched to a box of the page. Vectors stay vectors. Errors: STATUS_TOOL if
 * the library that draws this kind of artwork is not installed; STATUS_INPUT if the library cannot
 * read it; the errors of artwork_draw_picture. */
MUST_CHECK Status artwork_draw(const FigureArtwork *artwork, const FigureBox *box, cairo_t *cairo,
                               Err *err);

/* Draws an artwork of a PDF or SVG, `width_mm` x `height_mm`, and appends it as SVG to `svg`.
 * Starts the child process itself. Errors: those of artwork_draw; `svg` may then be incomplete. */
MUST_CHECK Status artwork_put_svg(const FigureArtwork *artwork, double width_mm, double height_mm,
                                  Text *svg, Err *err);
/* Draws an artwork as a picture of 3 channels of 8 bits and of width x height pixels. `paper` is
 * the color behind transparent parts. Release *out with picture_release. Starts the child process
 * itself. Errors: those of artwork_draw. */
MUST_CHECK Status artwork_rasterize(const FigureArtwork *artwork, int width, int height,
                                    FigureColor paper, Picture *out, Err *err);

/* Converts a status of cairo to a Status. Sets *err if the result is not STATUS_OK. */
MUST_CHECK Status artwork_check_cairo(cairo_status_t status, Err *err);
/* A cairo_write_func_t for output to a Text: appends the n bytes at `from` to the Text that `bytes`
 * points to. Returns CAIRO_STATUS_WRITE_ERROR if memory runs out. */
cairo_status_t artwork_write_to_text(void *bytes, const unsigned char *from, unsigned int n);

#endif
