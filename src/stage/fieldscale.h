/* The scale from the values of a field to colors: its ends, its classes, and the meaning of the
 * colors in words.
 *
 *     TRY(fieldvalues_take(&tree, &series, "mmHg", &values, err));
 *     TRY(fieldscale_color(&params, &map, &values, &values, &appearance, err));
 *     fieldvalues_release(&values);
 *
 * `appearance` then has the color of each segment and states the meaning in Appearance.meaning. */
#ifndef CORCAST_STAGE_FIELDSCALE_H
#define CORCAST_STAGE_FIELDSCALE_H

#include "base/base.h"
#include "derive/derive.h"
#include "scene/scene.h"
#include "tree/tree.h"

struct Look;

/* The values of one field. Release them with fieldvalues_release. */
typedef struct FieldValues {
    FieldSeries series;
    double *drawn; /* values of the segments that can be drawn, in all frames; owned */
    size_t n_drawn;
} FieldValues;

/* Converts a field of a tree to another unit.
 *
 * series  the field; moved to *out and zeroed, also on failure.
 * unit    NULL keeps the field's unit.
 * out     release it with fieldvalues_release, even after an error.
 * Errors  STATUS_USAGE if the field cannot be in this unit; STATUS_MEMORY. */
MUST_CHECK Status fieldvalues_take(const Tree *tree, FieldSeries *series, const char *unit,
                                   FieldValues *out, Err *err);
/* Frees the values and zeroes *values. */
void fieldvalues_release(FieldValues *values);

/* Parameters of fieldscale_color. Numbers are in the unit of the values. */
typedef struct FieldScaleParams {
    const struct Look *look; /* the finish of the vessels; borrowed */
    bool has_ends;         /* false: the ends of the scale are the minimum and the maximum value */
    double ends[2];        /* values, the first at most the second, or */
    bool percent[2];       /* percentiles of the values, 0..100 */
    bool log;              /* colors are linear in the logarithm of the value */
    bool of_tree;          /* the range is that of the whole tree; read for the words only */
    const double *classes; /* one number: the count of equal classes, 1..256, where 1 is no classes;
                            * several numbers: ascending bounds between classes; borrowed */
    size_t n_classes;      /* at least 1, at most COLORSCALE_MAX_BOUNDS */
    ScaleColor under, over, none; /* as in ColorScale */
    const char *map_name;         /* of the color map, for sentences */
    int frame; /* of values that change with time, the frame that is shown, from 1; 0: all */
} FieldScaleParams;

/* Makes a scale for a field, and the appearance in which each segment has the color of its value.
 * Appearance.meaning states what the colors mean.
 *
 * map         the colors of the scale; moved to *appearance on success.
 * range_of    the values that determine the ends of the scale.
 * drawn       the values that are shown; its times are moved to *appearance. May be `range_of`.
 * appearance  release it with appearance_release. Set on success only.
 * Errors      STATUS_INPUT if no value can be shown; STATUS_USAGE if ends or classes do not ascend,
 *             if an end is not above 0 with `log`, if `frame` is beyond the last frame, or if the
 *             map has separate colors and values are not integers; STATUS_MEMORY. Messages put the
 *             names of options in backquotes. */
MUST_CHECK Status fieldscale_color(const FieldScaleParams *params, Colormap *map,
                                   const FieldValues *range_of, FieldValues *drawn,
                                   Appearance *appearance, Err *err);

/* Returns the number of decades that a logarithmic scale of an appearance would span; 0 if its
 * scale has fixed ends, is logarithmic or divided, or if a value is negative. */
double fieldscale_decades(const Appearance *appearance);

/* Checks that the field `name`, which has `frames` frames, has frame number `frame`, counted from
 * 1. Errors: STATUS_USAGE if it has not. */
MUST_CHECK Status fieldscale_check_frame(int frame, const char *name, size_t frames, Err *err);

#endif
