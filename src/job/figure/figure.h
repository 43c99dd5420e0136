/* The operation `figure`: draws a page of panels that a recipe describes. A recipe [figure_plan.h]
 * is an INI file with a section per panel, inset and text.
 *
 * figure_make reads the recipe, places the panels in a grid of cells, draws each panel as `render`
 * does, and fills a page. figure_write writes the page. The caller ends with figure_done. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_H
#define CORCAST_JOB_FIGURE_FIGURE_H

#include "job/figure/figure_plan.h"
#include "job/figure/figure_trees.h"
#include "job/picture/press.h"
#include "job/picture/render_panel.h"

/* The letters of the panels: a, b, ...; A, B, ...; or none. */
typedef enum Letters { LETTERS_LOWER, LETTERS_UPPER, LETTERS_NONE } Letters;

typedef struct FigureOptions {
    const char *output; /* path of the page; borrowed */
    PressOptions press;
    PictureSize size;         /* size of the page */
    int columns;              /* number of columns of the grid of cells */
    double gap_mm, margin_mm; /* space between cells; space around the grid */
    double text_pt;           /* font size */
    bool same_scale;          /* all panels show their trees at one scale */
    Letters letters;
    Vec3 background; /* sRGB in [0, 1] */
} FigureOptions;

/* The rectangle of a panel, in pixels from the page's upper left corner, and the file that the
 * panel shows. */
typedef struct PanelRect {
    int left, top, width, height;
    double title_mm; /* height of the title line above the panel, mm */
    char *path;      /* path of the panel's tree or image; NULL: a command makes the tree
                      * [figure_trees.h]; owned */
} PanelRect;

/* A figure: its panels and its page. Zero it before use; release it with figure_done. All members
 * are owned unless noted. */
typedef struct Figure {
    const FigureOptions *options; /* borrowed */
    Parsed *parsed;               /* borrowed */
    char *folder;                 /* folder of the recipe: ends with '/', or "" */
    FigurePlan plan;
    MadeTrees trees;
    Press press; /* output profile of a page that is written as an image */
    Sheet sheet; /* the page and its metadata */
    Text recipe; /* with --dump-recipe: the recipe with all defaults, which the caller prints; else
                  * empty */
    PanelRect *rects;        /* per section of the recipe; zeroed unless it is a panel */
    Panel *panels;           /* per section; zeroed unless it is a panel that shows a tree */
    FigureArtwork *artworks; /* per section; zeroed unless it is a panel that shows an image */
    PanelInset *insets;      /* the insets only, in the order of their panels */
    FigureColor ink;         /* black or white, whichever contrasts with the background */
} Figure;

/* Reads the recipe that the first operand of `parsed` names, draws its panels, and fills the page.
 * The operand is a path if it contains a '/' or ends in .ini. Otherwise it is a name in
 * templates/figures. Options of the command line take precedence over the recipe.
 *
 * figure  zeroed before; the caller calls figure_done even after an error.
 * Errors  STATUS_USAGE and STATUS_INPUT, with the recipe's line or section; the errors of
 *         panel_draw; STATUS_IO; STATUS_CANCELLED; STATUS_MEMORY. */
MUST_CHECK Status figure_make(const FigureOptions *options, Parsed *parsed, Figure *figure,
                              Err *err);
/* Writes the page to options->output, a .pdf, .eps, .svg, .png, .tif or .jpg file. Errors:
 * STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status figure_write(Figure *figure, Err *err);
void figure_done(Figure *figure);

/* ---- the parts of figure_make --------------------------------------------------------------- */

/* figure_make calls figure_place_panels, then for each panel figure_plan_insets, panel_draw
 * [render_panel.h] and figure_put_insets. `i` and `of` (the section of a panel) are indices into
 * figure->plan.sections. */

/* Returns true if section `i` is a panel. */
static inline bool figure_is_panel(const Figure *figure, size_t i)
{
    return figure->plan.sections[i]->kind == SECTION_PANEL;
}

/* Returns true if section `i` is a panel that shows a tree. */
static inline bool figure_has_tree(const Figure *figure, size_t i)
{
    const Section *section = figure->plan.sections[i];
    return section->kind == SECTION_PANEL && !((const PanelOptions *)section->own.options)->image;
}

/* Places the panels in the cells of the grid. Sets figure->rects, and allocates panels, insets and
 * artworks. Errors: STATUS_USAGE, with the panel's name, if the page has no room for the panel, or
 * if the panel spans more columns than there are; STATUS_MEMORY. */
MUST_CHECK Status figure_place_panels(Figure *figure, Err *err);
/* Returns the box of panel `i` on the page, in mm. Section `i` must be a panel. */
FigureBox figure_panel_box(const Figure *figure, size_t i);

/* Reads the insets of panel `of` and stores them in figure->insets from index `first` on. *n
 * receives the number of insets of the panel; `first` of the next panel is `first` + *n. Errors:
 * STATUS_USAGE, with the inset's name, if its panel, its `at` or its `place` is missing. */
MUST_CHECK Status figure_plan_insets(Figure *figure, size_t of, size_t first, size_t *n, Err *err);
/* Appends the insets of panel `of` to the page: picture, frames, lines between the frames, scale
 * bar. The panel must have been drawn. Errors: STATUS_USAGE if an inset is not inside the page;
 * STATUS_MEMORY. */
MUST_CHECK Status figure_put_insets(Figure *figure, size_t of, Err *err);

#endif
