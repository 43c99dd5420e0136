/* Draws the annotations of a picture: legend, scale bar and panel letter.
 *
 * The legend explains the colors: a color bar or a row of swatches, with ticks, the name of the
 * field and its unit. The scale bar shows a length of the tree. The letter is the "a" or "b" of a
 * panel in a figure. All three are appended to a FigurePage [figure/figure.h]. If the output is an
 * image, the page is drawn over the picture; otherwise the page contains the picture:
 *
 *     annotation_check(annotation, picture, err);                 // before the scene is made
 *     annotation_reserve_space(annotation, fonts, appearance, size, space, err); // then the view
 *     annotation_put(annotation, scene, where, page, err);        // after the view is made */
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
    const char *title;   /* title of the legend; NULL: the name and the unit of the field */
    const char *letter;  /* the panel letter; NULL: none */
    double scale_bar_mm; /* length in the tree that the scale bar stands for */
    bool has_scale_bar;  /* a scale bar is drawn */
    Corner scale_bar_at; /* corner of the picture that the scale bar is in */
    double text_pt;      /* font size of legend and scale bar, points */
} Annotation;

/* Sets the defaults of a zeroed Annotation. */
void annotation_set_defaults(Annotation *annotation);
/* legend_table sets the legend and the font size of an Annotation; annotation_table sets the scale
 * bar and the letter. */
extern const OptionTable legend_table, annotation_table;

/* Returns true if a legend, a scale bar or a letter is drawn. */
bool annotation_is_wanted(const Annotation *annotation);

/* Checks the options. Errors: STATUS_USAGE if there is a legend but no --color-by, or a scale bar
 * in a perspective picture, where a length of the tree has no fixed length in the picture. */
MUST_CHECK Status annotation_check(const Annotation *annotation, const PictureOptions *picture,
                                   Err *err);

/* Checks that a legend has colors to explain; for operations that have no PictureOptions. Errors:
 * STATUS_USAGE if there is no --color-by. */
MUST_CHECK Status annotation_check_legend(const Annotation *annotation, const Coloring *coloring,
                                          Err *err);

/* Checks that annotations can be drawn into the file `output`. Errors: STATUS_USAGE if there are
 * annotations and the file stores floats, into which text is not drawn. */
MUST_CHECK Status annotation_check_file(const Annotation *annotation, const char *output, Err *err);

/* Returns the resolution of the page in pixels per inch: the resolution of a size on paper; 300,
 * the usual requirement of publishers, if the size is in pixels. */
double annotation_dpi(const PictureSize *size);

/* Reserves space for the legend. A camera that is fitted to the tree leaves this space empty.
 *
 * annotation  receives the side of the legend, if no option specifies the side.
 * space       space[0] receives the reserved width of a legend at the right, or space[1] the
 *             reserved height of a legend at the bottom, in pixels. The other element is unchanged.
 *             Without a legend both are unchanged.
 * Errors      STATUS_USAGE if the legend leaves no space for the tree; STATUS_MEMORY. */
MUST_CHECK Status annotation_reserve_space(Annotation *annotation, const FigureFonts *fonts,
                                           const Appearance *appearance, const PictureSize *picture,
                                           int space[2], Err *err);

/* Measures the legend that a page of this size would have, and chooses its side if no option
 * specifies the side. The side is the bottom if the page is higher than wide and a legend at the
 * bottom leaves a larger square for the tree. Otherwise it is the right.
 *
 * annotation  receives the side.
 * page        only its size and its fonts are used.
 * size        receives width and height of the legend, with the gap to the edge, mm.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status annotation_measure_legend(Annotation *annotation, const Appearance *appearance,
                                            const FigurePage *page, double size[2], Err *err);

/* Appends the legend to a page, at its side of the rectangle `where`, with text of the color `ink`.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status annotation_put_legend(const Annotation *annotation, const Appearance *appearance,
                                        FigureColor ink, FigureBox where, FigurePage *page,
                                        Err *err);

/* Appends legend, scale bar and letter to a page. Text and lines in front of vessels get a halo: an
 * outline in the color of the background.
 *
 * where   the rectangle of the page that the picture of `scene` covers, mm.
 * Errors  STATUS_USAGE if the scale bar is longer than the width of the picture; the errors of
 *         figure_check; STATUS_MEMORY. */
MUST_CHECK Status annotation_put(const Annotation *annotation, const Scene *scene, FigureBox where,
                                 FigurePage *page, Err *err);

/* Returns the width, mm, of the halo around text of this font size. */
double annotation_halo_width(double text_pt);

/* Converts a linear RGB color to the color type of pages. */
FigureColor annotation_color(Rgb linear);
/* Returns black or white, whichever is readable on the background. */
FigureColor annotation_text_color(Rgb background);

#endif
