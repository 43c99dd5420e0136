/* Converts the colors of a PDF or an EPS from sRGB to the inks of a printer (CMYK). The file must
 * have been written by cairo. Private to the module figure. */
#ifndef CORCAST_FIGURE_PDF_INKS_H
#define CORCAST_FIGURE_PDF_INKS_H

#include "figure/figure.h"

/* Replaces the page of a PDF or an EPS by the same page in CMYK.
 *
 * Black of sRGB becomes black ink only, so that letters and lines have no fringes of other inks.
 * All other colors, gradients and pictures are converted by the ICC profile of `inks`, except
 * shades of grey in an EPS, which cairo writes as grey: they become black ink only. A PDF contains
 * the profile as its output intent; an EPS has no place for it.
 *
 * inks     the conversion from sRGB to CMYK, for 8 bits per channel.
 * is_eps   true: `page` is an EPS; false: a PDF.
 * page     contains the file; receives the result; unchanged after an error.
 * Errors   STATUS_INPUT if the page contains a JPEG that cannot be read; STATUS_IO if the file is
 *          not as cairo 1.16 writes it; STATUS_MEMORY. */
MUST_CHECK Status page_to_inks(const Inks *inks, bool is_eps, Text *page, Err *err);

#endif
