/* Colors vessels by the values of a field: determines the ends and the classes of the color scale,
 * computes the color of each segment, and writes the legend.
 *
 * fieldvalues_show_pieces is called between the two if the pieces of smooth curves [smooth.h] are
 * drawn in place of segments.
 *
 *     TRY(fieldvalues_take(&tree, &series, "mmHg", &values, err));
 *     TRY(fieldscale_color(&params, &map, &values, &values, &appearance, err));
 *     fieldvalues_release(&values);
 *
 * `appearance` then contains the color of each segment. Appearance.meaning is the legend in
 * words. */
#ifndef CORCAST_STAGE_FIELDSCALE_H
#define CORCAST_STAGE_FIELDSCALE_H

#include "base/base.h"
#include "derive/derive.h"
#include "scene/scene.h"
#include "tree/tree.h"

struct Look;

/* The values of one field. Release them with fieldvalues_release. */
typedef struct FieldValues {
    FieldSeries series;   /* the values that are shown, in all frames: of all segments, or of their
                           * pieces; owned */
    double *scale_values; /* the values from which scales are computed: those of the segments that
                           * can be drawn, in all frames; owned */
    size_t n_scale_values;
} FieldValues;

/* Makes the FieldValues of a field of a tree, converted to a unit.
 *
 * series  the field; moved to *out and zeroed, also on failure.
 * unit    the unit of the result; NULL: the field's own unit.
 * out     release it with fieldvalues_release, even after an error.
 * Errors  STATUS_USAGE if the field cannot be converted to this unit; STATUS_MEMORY. */
MUST_CHECK Status fieldvalues_take(const Tree *tree, FieldSeries *series, const char *unit,
                                   FieldValues *out, Err *err);
/* Replaces the values that are shown, values->series, by values of the pieces of segments,
 * converted to the unit of *values. The values from which scales are computed stay those of the
 * segments.
 *
 * pieces  the field, one value per piece and frame; moved to *values and zeroed. */
void fieldvalues_show_pieces(FieldValues *values, FieldSeries *pieces);
/* Frees the values and zeroes *values. */
void fieldvalues_release(FieldValues *values);

/* Parameters of fieldscale_color. Numbers are in the unit of the values. */
typedef struct FieldScaleParams {
    const struct Look *look;      /* the finish of the vessels; borrowed */
    bool has_ends;                /* false: the ends of the scale are the minimum and the maximum
                                   * value */
    double ends[2];               /* lower and upper end: values or percentiles, the first at most
                                   * the second */
    bool percent[2];              /* per end: true if it is a percentile of the values, 0 to 100 */
    bool log;                     /* colors are linear in the logarithm of the value */
    bool of_tree;                 /* true: Appearance.meaning states that the ends are those of the
                                   * whole tree; has no other effect */
    const double *classes;        /* if n_classes is 1: the number of equal classes, 1 to 256, where
                                   * 1 is a scale without classes. Else: the bounds between classes,
                                   * ascending. Borrowed */
    size_t n_classes;             /* number of elements of `classes`, 1 to COLORSCALE_MAX_BOUNDS */
    ScaleColor under, over, none; /* as in ColorScale */
    const char *map_name;         /* name of the color map, for messages */
    int frame;                    /* frame that is shown, from 1, if values change with time; 0: all
                                   * frames */
} FieldScaleParams;

/* Makes the color scale of a field, and the appearance in which each segment has the color of its
 * value. Appearance.meaning states what the colors mean.
 *
 * map         the colors of the scale; moved to *appearance on success.
 * range_of    the values from which the ends of the scale are computed.
 * shown       the values that are shown. May be `range_of`. The times of its frames are moved to
 *             *appearance on success; the rest stays valid. The legend counts segments, not pieces,
 *             outside the scale.
 * appearance  release it with appearance_release. Set on success only.
 * Errors      STATUS_INPUT if no value can be shown. STATUS_USAGE if ends or classes do not ascend;
 *             if `log` is true and an end is not above 0; if `frame` is above the number of frames;
 *             or if the map is qualitative (has separate colors) and values are not integers.
 *             STATUS_MEMORY. Messages have option names in backquotes. */
MUST_CHECK Status fieldscale_color(const FieldScaleParams *params, Colormap *map,
                                   const FieldValues *range_of, FieldValues *shown,
                                   Appearance *appearance, Err *err);

/* Returns the number of decades that a logarithmic scale of the appearance's values would span.
 * Returns 0 if the ends of the scale were specified, if the scale is logarithmic already or has
 * classes, or if a value is negative. */
double fieldscale_decades(const Appearance *appearance);

/* Checks that frame `frame`, counted from 1, exists in the field `name`, which has `frames` frames.
 * Errors: STATUS_USAGE if it does not exist. */
MUST_CHECK Status fieldscale_check_frame(int frame, const char *name, size_t frames, Err *err);

#endif
