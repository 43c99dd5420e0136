/* Writes certificates as JSON. A certificate has the numbers of a scene and, for some pixels, the
 * statements from which the interval of the pixel follows. tests/oracle/check_answer.py checks
 * these statements with independent code. Private to the module answer. */
#ifndef CORCAST_ANSWER_CERTIFICATE_H
#define CORCAST_ANSWER_CERTIFICATE_H

#include "answer/region.h"

/* Appends the scene. Numbers have 17 digits, so that reading them gives the same doubles. */
void certificate_put_scene(const AnswerPlan *plan, Text *out);
/* Appends the pixel in column i and row j with its interval `span`. For an area answer, also
 * appends the leaves in work->heap, which must be those of this pixel. */
void certificate_put_pixel(AnswerWork *work, int i, int j, const ColorSpan *span, Text *out);

/* Append a part of the present leaf: `weight` times the integral of a color over a polygon, or an
 * area in which the color may be any of a span. Do nothing if `out` is NULL. */
void certificate_put_form(Text *out, const LeafPolygon *polygon, const FormColor *color,
                          double weight);
void certificate_put_span(Text *out, double area, const ColorSpan *span);

#endif
