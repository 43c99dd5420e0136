/* Intervals of linear colors that are proven to contain a true color. interval_of_scene,
 * interval_of_background and interval_of_form make an interval; the other functions extend and
 * measure it. Private to the module answer. */
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
/* Returns the interval of all values that an affine form [affine.h] takes over its rectangle,
 * intersected with interval_of_scene. A channel with a NaN has the bounds of interval_of_scene. */
ColorInterval interval_of_form(const AnswerPlan *plan, const FormColor *color);
/* Extends *interval so that it contains *other. */
void interval_include(ColorInterval *interval, const ColorInterval *other);
/* Returns the width of the widest channel, in sRGB from 0 to 1. Ignores rounding errors, because
 * the proof of the bounds does not depend on the width: the width only decides which leaf (part of
 * a pixel) is divided next, and which pixels count as decided. */
double interval_width(const ColorInterval *interval);
/* Sets slopes[c] to the slope of the sRGB curve, sRGB per linear color, at the middle of the
 * interval of channel c. */
void interval_slopes(const ColorInterval *interval, double slopes[3]);

#endif
