/* Draws the explanations of a picture: legend, scale bar and panel letter.
 *
 * The legend is a color bar, or a row of swatches, with ticks, the name of the field and its unit.
 * The scale bar shows a length of the tree. The letter is the "a" or "b" of a panel in a figure.
 * All three are appended to a page (FigurePage), which is drawn over the picture or contains it:
 *
 *     annotation_check(annotation, picture, err);                          // before the scene
 *     annotation_reserve_space(annotation, fonts, appearance, size, space, err); // before the view
 *     annotation_put(annotation, scene, where, page, err);                 // after the view */
#ifndef CORCAST_JOB_PICTURE_ANNOTATION_H
#define CORCAST_JOB_PICTURE_ANNOTATION_H

#include "figure/figure.h"
#include "job/picture/picture.h"
#include "job/picture/placing.h"
#include "options/options.h"

/* The side of the picture on which the legend is drawn. */
typedef enum LegendSide { LEGEND_RIGHT, LEGEND_BOTTOM } LegendSide;

/* The options for annotations. Strings are borrowed from the parsed command line. */
typedef struct Annotation {
    bool legend;        /* a legend is drawn */
    bool has_legend_at; /* `legend_at` is specified by an option */
    bool has_title;     /* `title` is specified by an option */
    LegendSide legend_at;
    const char *title;   /* title of the legend; NULL: name and unit of the field */
    const char *letter;  /* NULL: no letter */
    double scale_bar_mm; /* length in the tree that the scale bar stands for */
    bool has_scale_bar;  /* a scale bar is drawn */
    Corner scale_bar_at; /* corner of the picture that the scale bar is in */
    double text_pt;      /* font size of legend and scale bar, points */
} Annotation;

/* Sets the defaults of a zeroed Annotation. */
void annotation_set_defaults(Annotation *annotation);
/* Set an Annotation: the legend and the size of text; scale bar and letter. */
extern const OptionTable legend_table, annotation_table;

/* Returns true if a legend, a scale bar or a letter is to be drawn. */
bool annotation_is_wanted(const Annotation *annotation);

/* Checks the options. Errors: STATUS_USAGE if there is a legend but no --color-by, or a scale bar
 * in a perspective picture, where a length of the tree has no fixed length in the picture. */
MUST_CHECK Status annotation_check(const Annotation *annotation, const PictureOptions *picture,
                                   Err *err);

/* Checks that a legend has colors to explain. Errors: STATUS_USAGE if there is no --color-by. */
MUST_CHECK Status annotation_check_legend(const Annotation *annotation, const Coloring *coloring,
                                          Err *err);

/* Checks that a file can hold annotations. Errors: STATUS_USAGE if it stores floats. */
MUST_CHECK Status annotation_check_file(const Annotation *annotation, const char *output, Err *err);

/* Returns the resolution of the page in dots per inch: that of the picture's size on paper, or 300
 * if the size is in pixels. */
double annotation_dpi(const PictureSize *size);

/* Reserves space for the legend. A camera that is fitted to the tree leaves this space empty.
 *
 * annotation  receives the side of the legend, if no option specifies it.
 * space       [0] receives the reserved width, or [1] the reserved height, in pixels. The other
 *             element is unchanged, and so are both without a legend.
 * Errors      STATUS_USAGE if the legend leaves no space for the tree; STATUS_MEMORY. */
MUST_CHECK Status annotation_reserve_space(Annotation *annotation, const FigureFonts *fonts,
                                           const Appearance *appearance, const PictureSize *picture,
                                           int space[2], Err *err);

/* Measures the legend that a page of this size would have, and chooses its side if no option
 * specifies one. The side is the bottom if the page is upright and the legend then leaves a larger
 * square for the tree, else the right.
 *
 * annotation  receives the side.
 * page        its size and fonts; its items do not matter.
 * size        receives width and height of the legend with the gap to the edge, mm.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status annotation_measure_legend(Annotation *annotation, const Appearance *appearance,
                                            const FigurePage *page, double size[2], Err *err);

/* Appends the legend to a page, at its side of the rectangle `where`. Errors: STATUS_MEMORY. */
MUST_CHECK Status annotation_put_legend(const Annotation *annotation, const Appearance *appearance,
                                        FigureColor ink, FigureBox where, FigurePage *page,
                                        Err *err);

/* Appends legend, scale bar and letter to a page. What lies on vessels gets a halo of the
 * background's color.
 *
 * where   the rectangle of the page that the picture of `scene` covers.
 * Errors  STATUS_USAGE if the scale bar is longer than the width of the picture; the errors of
 *         figure_check; STATUS_MEMORY. */
MUST_CHECK Status annotation_put(const Annotation *annotation, const Scene *scene, FigureBox where,
                                 FigurePage *page, Err *err);

/* Returns the width in mm of halos around text of this size. */
double annotation_halo_width(double text_pt);

/* Converts a linear RGB color to the color type of pages. */
FigureColor annotation_color(Rgb linear);
/* Returns black or white: the one that is readable on the background. */
FigureColor annotation_text_color(Rgb background);

#endif
