/* Intervals of linear colors that are proven to contain a true color. Private to the module answer.
 */
#ifndef CORCAST_ANSWER_INTERVAL_H
#define CORCAST_ANSWER_INTERVAL_H

#include "answer/light.h"

/* Lower and upper bounds per channel: red, green, blue. */
typedef struct ColorInterval {
    double low[3], high[3];
} ColorInterval;

/* Returns the interval that contains every color of the scene: AnswerPlan.least to .most. */
ColorInterval interval_of_scene(const AnswerPlan *plan);
/* Returns the interval that contains only the background's color. */
ColorInterval interval_of_background(const AnswerPlan *plan);
/* Returns the interval of all values of a form, intersected with interval_of_scene. If the form has
 * a NaN, the bound is that of interval_of_scene. */
ColorInterval interval_of_form(const AnswerPlan *plan, const FormColor *color);
/* Extends *interval so that it contains *other. */
void interval_include(ColorInterval *interval, const ColorInterval *other);
/* Returns the width of the widest channel, in sRGB from 0 to 1. Ignores rounding errors, because
 * the proof of the bounds does not depend on the width: it only decides which leaf is divided next,
 * and which pixels count as decided. */
double interval_width(const ColorInterval *interval);
/* Sets slopes[c] to the slope of the sRGB curve at the middle of channel c: sRGB per linear color.
 */
void interval_slopes(const ColorInterval *interval, double slopes[3]);

#endif
