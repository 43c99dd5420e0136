/* Reads and writes the recipe of a figure, an INI file. Its sections are [figure], [panels], [panel
 * NAME], [inset NAME] and [text NAME]. The keys of a section are options: a panel, for example, has
 * the options of `render`. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_PLAN_H
#define CORCAST_JOB_FIGURE_FIGURE_PLAN_H

#include "figure/figure.h"
#include "job/picture/placing.h"
#include "job/tree/makers.h"
#include "options/options.h"

/* The options that a panel has in addition to the options of `render`. The strings of this struct
 * and of the next two are borrowed from FigurePlan.text. */
typedef struct PanelOptions {
    const char *tree, *title; /* tree: the path of the tree's file. NULL: Section.maker makes the
                               * tree, or the panel shows `image`. title: the title of the panel;
                               * NULL: no title */
    const char *image; /* file of an image, made by another program, that the panel shows instead of
                        * a tree; NULL: none */
    int span;          /* number of columns that the panel covers */
    double aspect;     /* width / height of the panel; 0: the aspect of its cell */
} PanelOptions;

/* The options of an inset: a magnified part of a panel. has_at, has_place and has_scale_bar are
 * true if the recipe specifies `at`, `place` and `scale_bar_mm`; without a scale bar's length,
 * there is no scale bar. Positions are relative to the panel. */
typedef struct InsetOptions {
    const char *of; /* name of the panel */
    Vec3 at, place; /* centre of the magnified part, and centre of the inset: x and y as fractions
                     * of the panel's width and height, from its upper left corner; z is ignored */
    double magnify; /* magnification relative to the panel */
    double width_mm, height_mm; /* size of the inset on the page; height 0: equal to the width */
    double scale_bar_mm;        /* length in the tree that the scale bar shows, mm */
    Corner scale_bar_at;        /* corner of the inset for the scale bar */
    bool has_at, has_place, has_scale_bar;
    bool leaders; /* two lines connect the magnified part with the inset */
} InsetOptions;

/* The options of a line of text on the page. */
typedef struct TextOptions {
    const char *text;
    Vec3 at; /* a point on the baseline: mm from the page's upper left corner, right and down */
    double text_pt; /* font size, if has_text_pt; else the figure's font size applies */
    bool bold, has_at, has_text_pt;
    FigureAlign align; /* `at` is the beginning, the centre or the end of the text */
    Vec3 color;        /* sRGB in [0, 1] */
} TextOptions;

typedef enum SectionKind { SECTION_PANEL, SECTION_INSET, SECTION_TEXT } SectionKind;

/* A section [panel NAME], [inset NAME] or [text NAME], with the values of its keys. */
typedef struct Section {
    SectionKind kind;
    const char *name;       /* borrowed from FigurePlan.text */
    Parsed own;             /* own.options is a PanelOptions, InsetOptions or TextOptions */
    Parsed render;          /* panels: render.options is a RenderOptions; else zeroed */
    const TreeMaker *maker; /* panels: the command that makes the tree in memory, such as `grow`;
                             * NULL: the panel shows a file */
    const char *arguments;  /* arguments of the maker, as in the recipe; borrowed from
                             * FigurePlan.text; NULL without a maker */
    char tree_name[40]; /* name of the tree in messages: "the tree of grow"; only with a maker */
    bool made; /* true: `maker` was specified in the panel's own section. false: there is no
                * maker, or [panels] specifies it */
} Section;

typedef struct FigurePlan {
    Section **sections; /* in the order of the recipe; the array and each section are owned */
    size_t n, capacity;
    char *text; /* contents of the recipe; names and values point into it; owned */
} FigurePlan;

/* Reads a recipe.
 *
 * Keys of [figure] set options of `figure`. Values from the command line take precedence over them.
 * Keys of [panels] apply to every panel; the section must precede all panels. Values in a panel's
 * own section take precedence over them.
 *
 * figure  the parsed command line of `figure`. figure->find_command must be set: a recipe may have
 *         a section for each command [options/options.h]. Afterwards, also after an error, the
 *         options of `figure` may borrow strings from plan->text.
 * plan    zeroed before. The caller releases it with figureplan_release even after an error.
 * Errors  STATUS_USAGE, with file and line, for an unknown or repeated section or key, and for a
 *         value that its option does not accept; STATUS_USAGE, with the file, if there is no panel,
 *         or if a panel has neither a tree nor an image; STATUS_INPUT for a malformed line;
 *         STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status figureplan_read(const char *path, Parsed *figure, FigurePlan *plan, Err *err);
/* Releases the plan and zeroes it. The options of `figure` that borrow strings from the plan must
 * not be used afterwards. */
void figureplan_release(FigurePlan *plan);

/* Appends a complete recipe to `text`: the recipe that was read, the options of the command line,
 * and all defaults. If memory runs out, `text` records it. */
void figureplan_put(const FigurePlan *plan, const Parsed *figure, Text *text);

#endif
