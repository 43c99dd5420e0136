/* Converts the colors of a PDF or an EPS from sRGB to the inks of a printer (CMYK). The file must
 * have been written by cairo. Private to the module figure. */
#ifndef CORCAST_FIGURE_PDF_INKS_H
#define CORCAST_FIGURE_PDF_INKS_H

#include "figure/figure.h"

/* Replaces a PDF by a PDF of the same page in CMYK.
 *
 * Black of sRGB becomes black ink only, so that letters and lines have no fringes of other inks.
 * All other colors, gradients and pictures are converted by the ICC profile of `inks`. The file
 * contains this profile as its output intent.
 *
 * inks     the conversion, for codes of 8 bits.
 * pdf      contains the PDF; receives the result; unchanged after an error.
 * Errors   STATUS_INPUT if the page contains a JPEG that cannot be read; STATUS_IO if the file is
 *          not as cairo 1.16 writes it; STATUS_MEMORY. */
MUST_CHECK Status pdf_to_inks(const Inks *inks, Text *pdf, Err *err);

/* Does the same for an EPS, which has no output intent. cairo writes shades of grey as such: they
 * are black ink alone. Errors: as pdf_to_inks. */
MUST_CHECK Status eps_to_inks(const Inks *inks, Text *eps, Err *err);

#endif
