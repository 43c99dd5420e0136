/* Panels: pictures, or lines, for a page that holds several of them. */
#ifndef CORCAST_JOB_PICTURE_RENDER_PANEL_H
#define CORCAST_JOB_PICTURE_RENDER_PANEL_H

#include "image/image.h"
#include "job/picture/render.h"

/* A part of a panel, magnified. */
typedef struct PanelInset {
    double
        at[2]; /* middle of the part, from the panel's upper left corner, in widths and heights */
    double magnify;
    int pixels[2];   /* width and height of the inset */
    Picture picture; /* result, unless the panel is in lines; owned */
    Strokes strokes; /* result, if the panel is in lines; owned */
} PanelInset;

/* A picture of a tree on a page. */
typedef struct Panel {
    const char *name;         /* "[panel a]", for sentences; borrowed */
    const FigureFonts *fonts; /* of the page; borrowed */
    PanelInset *insets;       /* borrowed */
    size_t n_insets;
    bool in_lines;         /* result: --ink was given */
    Picture picture;       /* result, of 8 bits, unless it is in lines; owned */
    Strokes strokes;       /* result, if it is in lines; owned */
    Scene scene;           /* result; owned */
    PictureReport report;  /* result: what the scene has lost; the caller says it */
    Annotation annotation; /* result: legend, scale bar and letter, which the caller draws */
} Panel;

/* Returns the part of the camera's picture that an inset shows, in widths and heights. */
FigureBox panel_part(const PanelInset *inset, const Camera *camera);
/* Returns the view of an inset. */
View panel_inset_view(const PanelInset *inset, const View *view);

/* Draws a panel and its insets into memory. parsed->options are RenderOptions without output,
 * planes, JSON, parts and animation.
 *
 * panel   owned; the caller calls panel_release even after an error.
 * Errors  STATUS_USAGE for insets of a picture in perspective; errors of render_make. */
MUST_CHECK Status panel_draw(Parsed *parsed, Panel *panel, Err *err);
void panel_release(Panel *panel);

#endif
