/* Certificates: the numbers of a scene and, for some pixels, the claims from which their answers
 * follow, as JSON that tests/oracle/check_answer.py checks with code of its own. */
#ifndef CORCAST_ANSWER_CERTIFICATE_H
#define CORCAST_ANSWER_CERTIFICATE_H

#include "answer/region.h"

/* Append the scene, and a pixel with its interval and, for area answers, its leaves. Numbers have
 * all digits. */
void certificate_put_scene(const AnswerPlan *plan, Text *out);
void certificate_put_pixel(AnswerWork *work, int i, int j, const ColorSpan *span, Text *out);

/* Append the integral of a form over a polygon, and an area with any color of a span, as parts of
 * the present leaf. Do nothing if `out` is NULL. */
void certificate_put_form(Text *out, const LeafPolygon *polygon, const FormColor *color,
                          double weight);
void certificate_put_span(Text *out, double area, const ColorSpan *span);

#endif
