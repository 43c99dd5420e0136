/* Writes certificates as JSON. A certificate has the numbers of a scene and, for some pixels, the
 * statements from which the interval of the pixel follows. tests/oracle/check_answer.py checks
 * these statements with independent code. Private to the module answer. */
#ifndef CORCAST_ANSWER_CERTIFICATE_H
#define CORCAST_ANSWER_CERTIFICATE_H

#include "answer/region.h"

/* Appends the beginning of a certificate with the scene, up to the list of pixels. */
void certificate_begin(const AnswerPlan *plan, Text *out);
/* Appends the pixel in column i and row j with its interval `interval`. For an area answer, also
 * appends the leaves in work->heap, which must be those of this pixel. */
void certificate_put_pixel(AnswerWorkspace *work, int i, int j, const ColorInterval *interval,
                           bool is_first, Text *out);

/* Add a part of the present leaf to AnswerWorkspace.record: `weight` times the integral of a color
 * over a polygon, or an area in which the color may be any of an interval. Do nothing if `parts` is
 * NULL. */
void certificate_add_form(json_t **parts, const LeafPolygon *polygon, const FormColor *color,
                          double weight);
void certificate_add_interval(json_t **parts, double area, const ColorInterval *interval);

#endif
