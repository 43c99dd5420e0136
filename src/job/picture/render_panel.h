/* Draws a panel for a page with several panels: one picture of a tree, with its insets. A panel is
 * an image or, with --ink, a line drawing. Set the first four members of a Panel, call panel_draw,
 * put the results on the page, and call panel_release. */
#ifndef CORCAST_JOB_PICTURE_RENDER_PANEL_H
#define CORCAST_JOB_PICTURE_RENDER_PANEL_H

#include "image/image.h"
#include "job/picture/render.h"

/* An inset: a magnified part of a panel. The results must be zeroed before panel_draw. */
typedef struct PanelInset {
    double at[2]; /* centre of the part, from the panel's upper left corner: x as a fraction of the
                   * panel's width, y as a fraction of its height */
    double magnify;  /* magnification relative to the panel */
    int pixels[2];   /* width and height of the inset */
    Picture picture; /* result, unless Panel.in_lines; owned */
    Strokes strokes; /* result, if Panel.in_lines; owned */
} PanelInset;

/* A panel. The caller sets the first four members, and zeroes the results before panel_draw. */
typedef struct Panel {
    const char *name;         /* "[panel a]", for messages; borrowed */
    const FigureFonts *fonts; /* the fonts of the page; borrowed */
    PanelInset *insets;       /* the array is borrowed; panel_release releases its results */
    size_t n_insets;
    bool in_lines;         /* result: the panel is a line drawing, because --ink is specified */
    Picture picture;       /* result, unless in_lines: 8 bits per channel; owned */
    Strokes strokes;       /* result, if in_lines; owned */
    Scene scene;           /* result; owned */
    PictureReport report;  /* result: what the scene does not show; the caller reports it */
    Annotation annotation; /* result: legend, scale bar and letter, which the caller draws; borrows
                            * from the Parsed */
} Panel;

/* Returns the part of the panel that an inset shows: left and right as fractions of the panel's
 * width, top and bottom as fractions of its height. `camera` is the camera of the panel. */
FigureBox panel_part(const PanelInset *inset, const Camera *camera);
/* Returns the view of an inset. `view` is the view of the panel, with an orthographic camera. */
View panel_inset_view(const PanelInset *inset, const View *view);

/* Computes the scale of a panel, without drawing it.
 *
 * parsed        as for panel_draw.
 * fonts         the fonts of the page.
 * mm_per_pixel  receives the length in the tree that one pixel of the panel shows, mm.
 * Errors        STATUS_USAGE if the panel is in perspective; the errors of rendering_open. */
MUST_CHECK Status panel_scale(Parsed *parsed, const FigureFonts *fonts, double *mm_per_pixel,
                              Err *err);

/* Draws a panel and its insets into memory.
 *
 * parsed  parsed->options is a RenderOptions. It must not specify output, planes, JSON, tiles or
 *         animation.
 * panel   the caller releases it with panel_release even after an error.
 * Errors  STATUS_USAGE for insets in a perspective picture, and for a legend in a line drawing; the
 *         errors of rendering_open and rendering_draw_result. */
MUST_CHECK Status panel_draw(Parsed *parsed, Panel *panel, Err *err);
/* Releases the results of the panel and of its insets. */
void panel_release(Panel *panel);

#endif
