/* Writes certificates as JSON. A certificate has the numbers of a scene and, for some pixels, the
 * statements from which the pixel's interval follows. tests/oracle/check_answer.py checks these
 * statements with independent code. Private to the module answer.
 *
 * answer_make calls certificate_begin, then certificate_put_pixel for each pixel, and closes the
 * JSON text. region.c calls the functions certificate_add_*. */
#ifndef CORCAST_ANSWER_CERTIFICATE_H
#define CORCAST_ANSWER_CERTIFICATE_H

#include "answer/region.h"

/* Appends the beginning of a certificate with the scene, up to the list of pixels. */
void certificate_begin(const AnswerPlan *plan, Text *out);
/* Appends the pixel in column i and row j with its interval. `is_first` is true for the first pixel
 * of the certificate. For an area answer, also appends the leaves in work->heap, which must be the
 * leaves of this pixel. */
void certificate_put_pixel(AnswerWorkspace *work, int i, int j, const ColorInterval *interval,
                           bool is_first, Text *out);

/* Both append a part of the current leaf's color to the JSON array *parts. certificate_add_form
 * appends `weight` (the fraction of a light; else 1) times the integral of a color over a polygon.
 * certificate_add_interval appends an area in which the color may be any color of an interval.
 *
 * parts  NULL: no certificate is wanted, and nothing is done. If memory runs out, *parts becomes
 *        NULL, and the Text that it is appended to records the error. */
void certificate_add_form(json_t **parts, const LeafPolygon *polygon, const FormColor *color,
                          double weight);
void certificate_add_interval(json_t **parts, double area, const ColorInterval *interval);

#endif
