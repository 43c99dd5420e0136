/* What `render` does, for a page of several pictures. */
#ifndef CORCAST_JOB_PICTURE_RENDER_PANEL_H
#define CORCAST_JOB_PICTURE_RENDER_PANEL_H

#include "image/image.h"
#include "job/picture/annotation.h"
#include "job/picture/sheet.h"
#include "scene/scene.h"

/* A part of a panel, larger. */
typedef struct PanelInset {
    double at[2]; /* its middle, from the panel's upper left corner, over width and height */
    double magnify;
    int pixels[2];   /* of the inset itself */
    Picture picture; /* made; owned */
    Strokes strokes; /* made in its place, of a panel in lines; owned */
} PanelInset;

/* A picture of a tree. */
typedef struct Panel {
    const FigureFonts *fonts; /* borrowed */
    PanelInset *insets;       /* borrowed */
    size_t n_insets;
    bool made_tree; /* the tree is a command's, whose file nobody knows: nothing is said of how it
                       reads */
    bool in_lines;
    Picture picture;       /* made, of 8 bits, unless in lines; owned */
    Strokes strokes;       /* made, in lines; owned */
    Scene scene;           /* made; owned */
    PictureReport made;    /* what the scene has lost, to be reported by the caller */
    Annotation annotation; /* what the options ask for, to be drawn by the caller */
} Panel;

/* The part of a camera's picture that an inset shows, over width and height, and its own view. */
FigureBox panel_part(const PanelInset *inset, const Camera *camera);
View panel_inset_view(const PanelInset *inset, const View *view);

/* Draws what options of `render` ask for that come from anywhere but a command line: the tree is
 * the first operand; there are no output, planes, JSON, parts and animations. Checks and sentences
 * are those of the command. STATUS_USAGE for insets in perspective. *panel is owned
 * (panel_release), also on failure. */
MUST_CHECK Status panel_draw(Parsed *parsed, Panel *panel, Err *err);
void panel_release(Panel *panel);

#endif
