/* The recipe of a figure: sections of an INI file, each with the options that its kind has. */
#ifndef CORCAST_JOB_FIGURE_FIGURE_PLAN_H
#define CORCAST_JOB_FIGURE_FIGURE_PLAN_H

#include "figure/figure.h"
#include "job/tree/makers.h"
#include "options/options.h"

/* What a panel is beside a picture of `render`. */
typedef struct PanelOptions {
    const char *tree, *title;
    int span;
    double aspect; /* width over height; 0: the cell's */
} PanelOptions;

typedef struct InsetOptions {
    const char *of; /* the panel */
    Vec3 at, place; /* middles, from the panel's upper left corner, over width and height */
    double magnify;
    double width_mm, height_mm; /* 0: as wide */
    double scale_bar_mm;
    bool has_at, has_place, has_scale_bar;
} InsetOptions;

typedef struct TextOptions {
    const char *text;
    Vec3 at; /* mm from the page's upper left corner; of the baseline */
    double text_pt;
    bool bold, has_at, has_text_pt;
    FigureAlign align;
    Vec3 color; /* sRGB in [0, 1] */
} TextOptions;

typedef enum SectionKind { SECTION_PANEL, SECTION_INSET, SECTION_TEXT } SectionKind;

typedef struct Section {
    SectionKind kind;
    const char *name;       /* borrowed from the plan's text */
    Parsed own;             /* of PanelOptions, InsetOptions or TextOptions */
    Parsed render;          /* of a panel: those of `render` */
    const TreeMaker *maker; /* makes the panel's tree; NULL: the tree is a file */
    const char *arguments;  /* of the maker; borrowed from the plan's text */
    char tree_name[40];     /* "the tree of grow"; meaningless without a maker */
    bool made;              /* the panel itself says by what, not [panels] */
} Section;

typedef struct FigurePlan {
    Section **sections; /* owned, and each of them; in the order of the recipe */
    size_t n, capacity;
    char *text; /* owned; what values point into */
} FigurePlan;

/* Reads a recipe; `figure->find_command` must be set. Keys of [figure] go to `figure`'s options,
 * where the command line does not say otherwise; those of [panels], which stands before all panels,
 * are every panel's. STATUS_USAGE or STATUS_INPUT, naming file and line, for sections and keys that
 * there are none of, or that stand there twice, and for values that options do not take. *plan is
 * owned (figureplan_release), also on failure. */
MUST_CHECK Status figureplan_read(const char *path, Parsed *figure, FigurePlan *plan, Err *err);
void figureplan_release(FigurePlan *plan);

/* Appends a recipe that says all that this one and the command line do, and what holds without
 * their saying. */
void figureplan_put(const FigurePlan *plan, const Parsed *figure, Text *text);

#endif
