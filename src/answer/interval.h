/* Intervals of linear colors that are proven to contain a true color. */
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
/* Returns the interval of all values of a form, clamped to interval_of_scene. A NaN in the form
 * gives the bound of interval_of_scene. */
ColorInterval interval_of_form(const AnswerPlan *plan, const FormColor *color);
/* Extends *interval so that it contains *other. */
void interval_include(ColorInterval *interval, const ColorInterval *other);
/* Returns the width of the widest channel, in sRGB from 0 to 1. Ignores rounding errors: the width
 * only chooses which leaf is divided and which pixel counts as decided. The proof of the bounds
 * does not depend on it. */
double interval_width(const ColorInterval *interval);
/* Sets slopes[c] to the slope of the sRGB curve at the middle of channel c: sRGB per linear color.
 */
void interval_slopes(const ColorInterval *interval, double slopes[3]);

#endif
