/* The operation `figure`: draws a page of panels that a recipe describes.
 *
 * A recipe [figure_plan.h] has a section per panel, inset and text. figure_make places the panels
 * in a grid of cells, draws each as `render` does, and fills a Sheet, the page; figure_write writes
 * the page. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_H
#define CORCAST_JOB_FIGURE_FIGURE_H

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
    bool same_scale; /* all panels show their trees at one scale */
    Letters letters;
    Vec3 background; /* sRGB in [0, 1] */
} FigureOptions;

/* Where a panel is, in pixels from the page's upper left corner, and the file that it shows. */
typedef struct PanelRect {
    int left, top, width, height;
    double title_mm; /* height of the line above the panel */
    char *path;      /* path of the panel's tree or image; NULL: the recipe makes the tree; owned */
} PanelRect;

/* A figure: its panels and its page. Zero it before use; release it with figure_done. */
typedef struct Figure {
    const FigureOptions *options; /* borrowed, as is `parsed` */
    Parsed *parsed;
    char *folder; /* folder of the recipe: ends with '/', or ""; owned */
    FigurePlan plan;
    MadeTrees trees;
    Press press; /* bits, compression and CMYK conversion of a page in pixels */
    Sheet sheet; /* the page and its metadata */
    Text recipe; /* with --dump-recipe: the recipe with all defaults, which the caller prints; else
                  * empty */
    /* Arrays with one element per section; elements of sections of another kind are zeroed. Owned.
     * Exception: insets are packed, in the order of their panels. */
    PanelRect *rects;
    Panel *panels;
    PanelInset *insets;
    FigureArtwork *artworks; /* the images of panels that show no tree */
    FigureColor ink;         /* black or white, whichever contrasts with the background */
} Figure;

/* Reads the recipe that the first operand of `parsed` names, draws its panels, and fills the page.
 * The recipe is a path, if it has a '/' or the extension .ini, or a name in templates/figures.
 * Options of the command line take precedence over the recipe.
 *
 * figure  zeroed before; the caller calls figure_done even after an error.
 * Errors  STATUS_USAGE and STATUS_INPUT, naming the recipe's line or section; the errors of
 *         render_make; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status figure_make(const FigureOptions *options, Parsed *parsed, Figure *figure,
                              Err *err);
/* Writes the page to the output: .pdf, .eps, .svg, .png, .tif or .jpg. Errors: STATUS_IO,
 * STATUS_MEMORY.
 */
MUST_CHECK Status figure_write(Figure *figure, Err *err);
void figure_done(Figure *figure);

/* ---- the parts of figure_make --------------------------------------------------------------- */

/* Call figure_place_panels first. Then, for each panel: call figure_plan_insets, draw the panel,
 * and call figure_put_insets. `i` and `of` (a panel) are indices into figure->plan.sections. */

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

/* Places the panels in the cells of the grid: sets figure->rects, and allocates panels, insets and
 * artworks. Errors: STATUS_USAGE, naming the panel, if there is no room for it on the page, or if
 * it spans more columns than there are; STATUS_MEMORY. */
MUST_CHECK Status figure_place_panels(Figure *figure, Err *err);
/* Returns the box of a panel on the page, in mm. */
FigureBox figure_panel_box(const Figure *figure, size_t i);

/* Reads the insets of panel `of` and stores them in figure->insets from index `first` on. *n
 * receives their number. Errors: STATUS_USAGE, naming the inset, if its panel, its `at` or its
 * `place` is missing. */
MUST_CHECK Status figure_plan_insets(Figure *figure, size_t of, size_t first, size_t *n, Err *err);
/* Appends the insets of a panel to the page: picture, frames, lines between the frames, scale bar.
 * The panel must have been drawn. Errors: STATUS_USAGE if an inset is not inside the page;
 * STATUS_MEMORY. */
MUST_CHECK Status figure_put_insets(Figure *figure, size_t of, Err *err);

#endif
