/* What explains a picture, drawn over it or beside it: color bar, scale bar, letter. */
#ifndef CORCAST_JOB_PICTURE_ANNOTATION_H
#define CORCAST_JOB_PICTURE_ANNOTATION_H

#include "figure/figure.h"
#include "job/picture/picture.h"
#include "options/options.h"

typedef enum LegendSide { LEGEND_RIGHT, LEGEND_BOTTOM } LegendSide;

typedef struct Annotation {
    bool legend, has_side, has_title;
    LegendSide legend_at;
    const char *title;   /* of the legend; NULL: the field's name and unit */
    const char *letter;  /* NULL: none */
    double scale_bar_mm; /* of the tree */
    bool has_scale_bar;
    double text_pt;
} Annotation;

/* Of a zeroed Annotation. */
void annotation_set_defaults(Annotation *annotation);
extern const OptionTable annotation_table; /* sets an Annotation */

/* Whether there is anything to draw. */
bool annotation_is_any(const Annotation *annotation);

/* STATUS_USAGE when a legend has no colors to explain, a scale bar is asked for in perspective,
 * where no length of the picture is one of the tree. */
MUST_CHECK Status annotation_check(const Annotation *annotation, const PictureOptions *picture,
                                   Err *err);

/* Pixels an inch of a picture on a page: its own, or 300 where its size is in pixels. */
double annotation_dpi(const PictureOptions *picture);

/* Has a camera that frames the tree leave room for the legend: sets the view's room in *picture.
 * STATUS_USAGE when the legend leaves none for the tree. */
MUST_CHECK Status annotation_make_room(const Annotation *annotation, const FigureFonts *fonts,
                                       const Appearance *appearance, PictureOptions *picture,
                                       Err *err);

/* Appends all of it to a page, for the picture of a scene that stands at `where` on it.
 * STATUS_USAGE when the scale bar is longer than the picture is wide; as figure_check. */
MUST_CHECK Status annotation_put(const Annotation *annotation, const Scene *scene, FigureBox where,
                                 FigurePage *page, Err *err);

/* The color as a page has it. */
FigureColor annotation_color(Rgb linear);
/* Black or white, whichever is read on this color. */
FigureColor annotation_ink(Rgb background);

#endif
