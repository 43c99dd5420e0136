/* A figure being made: what the files of the command `figure` share. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_MAKING_H
#define CORCAST_JOB_FIGURE_FIGURE_MAKING_H

#include "job/figure/figure_plan.h"
#include "job/figure/figure_trees.h"
#include "job/picture/press.h"
#include "job/picture/render_panel.h"

typedef enum Letters { LETTERS_LOWER, LETTERS_UPPER, LETTERS_NONE } Letters;

typedef struct FigureOptions {
    const char *output;
    PressOptions press;
    PictureSize size;
    int columns;
    double gap_mm, margin_mm, text_pt;
    Letters letters;
    Vec3 background; /* sRGB in [0, 1] */
} FigureOptions;

/* A panel on the page: pixels from its upper left corner. */
typedef struct Place {
    int left, top, width, height;
    double title_mm; /* height of the line above it */
} Place;

typedef struct Figure {
    const FigureOptions *options;
    Parsed *parsed;
    FigurePlan plan;
    MadeTrees trees;
    Press press; /* of pictures */
    Sheet sheet;
    Place *places;      /* of the sections that are panels; owned */
    Panel *panels;      /* likewise */
    FigureColor ink;    /* read on the page's paper */
    PanelInset *insets; /* of the sections that are insets, in the order of their panels; owned */
} Figure;

static inline bool figure_is_panel(const Figure *figure, size_t i)
{
    return figure->plan.sections[i]->kind == SECTION_PANEL;
}

/* Places the panels in the cells of the grid, and makes room for what is drawn of them.
 * STATUS_USAGE, naming the panel, when there is no room on the page, or it spans more columns than
 * there are. */
MUST_CHECK Status figure_place_panels(Figure *figure, Err *err);
/* A panel's place in mm. */
FigureBox figure_panel_box(const Figure *figure, size_t i);

/* The insets of panel `of` in figure->insets from `first` on; how many in *n. STATUS_USAGE, naming
 * the inset, when its panel or its places are missing. */
MUST_CHECK Status figure_plan_insets(Figure *figure, size_t of, size_t first, size_t *n, Err *err);
/* Appends the insets of a panel that is drawn to the page: picture, frames, lines between them,
 * scale bar. STATUS_USAGE when one does not lie on the page. */
MUST_CHECK Status figure_put_insets(Figure *figure, size_t of, Err *err);

#endif
