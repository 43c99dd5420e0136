/* The door of the room figure: a page of pictures, colour bars, scale bars, letters and text, as
 * PDF, as SVG and as pixels.
 *
 * Lengths are mm from the page's upper left corner, x to the right and y down; sizes of text are
 * points. Whatever is drawn, pictures lie below all else, each on the pixel grid of the page's
 * resolution, so that none is resampled. */
#ifndef CORCAST_FIGURE_FIGURE_H
#define CORCAST_FIGURE_FIGURE_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"
#include <stddef.h>
#include <stdint.h>

#define MM_PER_POINT (MM_PER_INCH / 72)

/* ---- fonts ----------------------------------------------------------------------------------- */

/* Liberation Sans, regular and bold, of templates/fonts: no other font is looked for. */
typedef struct FigureFonts FigureFonts;

/* Their files in the folder of templates; NULL ends the list. */
extern const char *const figure_font_files[];

/* Loads them from the folder of templates, in *out (owned). STATUS_IO naming the file that is
 * missing or no font. */
MUST_CHECK Status figurefonts_load(const char *templates, FigureFonts **out, Err *err);
void figurefonts_free(FigureFonts *fonts);

/* The width of a line of UTF-8, in mm. */
double figure_text_width(const FigureFonts *fonts, const char *text, double size_pt, bool bold);

/* Letters that the font lacks, each once, in the order of the texts; the first FIGURE_LETTERS of
 * each kind. */
enum { FIGURE_LETTERS = 8 };
typedef struct FigureLetters {
    uint32_t substituted[FIGURE_LETTERS]; /* drawn by other letters: superscripts and subscripts by
                                             small ones */
    uint32_t boxed[FIGURE_LETTERS];       /* drawn as a box */
    int n_substituted, n_boxed;
} FigureLetters;

/* ---- a page ---------------------------------------------------------------------------------- */

typedef struct FigurePoint {
    double x, y;
} FigurePoint;

typedef struct FigureBox {
    double left, top, right, bottom;
} FigureBox;

/* sRGB. */
typedef struct FigureColor {
    uint8_t rgb[3];
} FigureColor;

/* Returns the sRGB codes of a linear colour. */
FigureColor figure_color(const float linear[3]);

typedef enum FigureAlign { ALIGN_LEFT, ALIGN_CENTER, ALIGN_RIGHT } FigureAlign;

typedef enum FigureKind {
    FIGURE_PICTURE,
    FIGURE_SHAPE, /* a polygon, filled */
    FIGURE_LINE,  /* a polyline, stroked */
    FIGURE_RAMP,  /* a rectangle whose colour changes from the left to the right, or upwards */
    FIGURE_TEXT,
    FIGURE_STROKES, /* a line drawing */
    FIGURE_BARS,    /* a diagram */
    FIGURE_KINDS
} FigureKind;

enum { FIGURE_CORNERS = 4, FIGURE_STOPS = 65 };

/* A bar of a diagram: a rectangle, mm. */
typedef struct FigureBar {
    double x[2], y[2]; /* ascending */
    int32_t index;     /* of its colour */
} FigureBar;

/* The bars of a diagram. No two overlap. All members are borrowed. */
typedef struct FigureBars {
    const FigureBar *bars;
    size_t n;
    const float (*color)[3]; /* linear RGB, by FigureBar.index */
    /* Appends what identifies a bar, and what describes it, to texts for an SVG; `title` takes
     * escaped text. */
    void (*put_label)(const void *context, size_t bar, Text *id, Text *title);
    const void *context;
} FigureBars;

typedef struct FigureItem {
    FigureKind kind;
    FigureBox box; /* that it covers */
    FigureColor color;
    int n; /* corners of a shape or line */
    bool closed, upwards, bold;
    FigureAlign align; /* of a text about at[0], which is on its baseline */
    FigurePoint at[FIGURE_CORNERS];
    double width_mm;        /* of a line */
    double size_pt;         /* of a text */
    char *text;             /* owned */
    FigureColor *ramp;      /* owned; FIGURE_STOPS colours at equal distances */
    const Strokes *strokes; /* borrowed; their paper's corner is at at[0] */
    const FigureBars *bars; /* borrowed; their origin is at at[0] */
    const Picture *picture; /* borrowed; 8 bits */
    int column, row;        /* of the picture's first pixel */
} FigureItem;

typedef struct FigurePage {
    double width_mm, height_mm, dpi; /* 0 < dpi */
    bool exact;                      /* an SVG states the size with all digits, else to 0.001 mm */
    FigureColor background;
    const FigureFonts *fonts; /* borrowed; NULL: the page has no text */
    FigureItem *items;        /* owned */
    size_t n, capacity;
    bool failed;            /* memory ran out while something was added */
    FigureLetters replaced; /* letters of all texts that the font lacks */
} FigurePage;

/* *page without items, of a size in mm; the fonts are borrowed. */
void figure_init(FigurePage *page, double width_mm, double height_mm, double dpi,
                 const FigureFonts *fonts);
void figure_release(FigurePage *page);
/* Pixels of the page at its resolution. */
int figure_pixels(const FigurePage *page, double mm);

/* All of these append an item, or mark the page as failed, which figure_check tells. */
void figure_add_picture(FigurePage *page, const Picture *picture, int column, int row);
void figure_add_box(FigurePage *page, FigureBox box, FigureColor color);
/* `n` <= FIGURE_CORNERS points. */
void figure_add_shape(FigurePage *page, const FigurePoint *corner, int n, FigureColor color);
void figure_add_line(FigurePage *page, const FigurePoint *corner, int n, bool closed,
                     double width_mm, FigureColor color);
void figure_add_ramp(FigurePage *page, FigureBox box, bool upwards,
                     const FigureColor stops[FIGURE_STOPS]);

/* A line drawing, borrowed, whose paper has its upper left corner at a point. */
void figure_add_strokes(FigurePage *page, const Strokes *strokes, FigurePoint at,
                        FigureColor color);

/* A diagram, borrowed, whose origin is at a point; it covers `width_mm` x `height_mm`. */
void figure_add_bars(FigurePage *page, const FigureBars *bars, FigurePoint at, double width_mm,
                     double height_mm);

typedef struct FigureText {
    const char *text; /* one line of UTF-8; copied; control characters become blanks */
    double x, y;      /* of the baseline */
    double size_pt;
    bool bold;
    FigureAlign align;
    FigureColor color;
} FigureText;
void figure_add_text(FigurePage *page, const FigureText *text);

/* STATUS_MEMORY when something could not be added. */
MUST_CHECK Status figure_check(const FigurePage *page, Err *err);
/* Prints a warning on standard error for letters that the font lacks: one line for boxes and,
 * unless `quiet`, one for substitutes. Each line begins with `command`. */
void figure_warn(const FigurePage *page, const char *command, bool quiet);

/* What the items from number `first` on cover, and moves them. Not for pictures. */
FigureBox figure_bounds(const FigurePage *page, size_t first);
void figure_move(FigurePage *page, size_t first, double dx, double dy);

/* ---- what explains a picture ------------------------------------------------------------------
 */

typedef struct FigureLegend {
    const ColorScale *scale;
    ScaleOutside outside; /* of the values shown: what lies outside the bar gets its ends */
    bool whole;           /* all values are whole numbers */
    const char *title;    /* UTF-8; a quantity with its unit in parentheses, if it has one */
    bool across;          /* from the left to the right; else upwards */
    double length_mm;     /* of the bar */
    double size_pt;
    FigureColor ink;
} FigureLegend;

/* Appends a colour bar with title, ticks at round numbers, pointed ends where values lie outside
 * the range, and a swatch for what has no value; one swatch a colour where whole numbers choose
 * among separate ones. It stands anywhere: figure_bounds and figure_move find and place it. */
void figure_add_legend(FigurePage *page, const FigureLegend *legend);

/* Likewise a bar of this length with its label above the middle. */
void figure_add_scale_bar(FigurePage *page, double length_mm, const char *label, double size_pt,
                          FigureColor ink);

/* At most FIGURE_TICKS round numbers within the range of a scale that does not count colours, about
 * `most` of them, ascending; how many. With `whole`, whole numbers alone. */
enum { FIGURE_TICKS = 32 };
int figure_ticks(const ColorScale *scale, int most, bool whole, double ticks[FIGURE_TICKS]);

/* ---- files ----------------------------------------------------------------------------------- */

/* What a page tells of itself; all is borrowed, one line each. */
typedef struct FigureNotes {
    const char *templates;   /* the folder */
    const char *description; /* what it shows */
    const char *generator;   /* program and version */
    const char *command;     /* that makes it */
} FigureNotes;

/* Appends the page as SVG: text as `text`, pictures as PNG within. STATUS_INPUT when a template is
 * missing or does not fit. */
MUST_CHECK Status figure_put_svg(const FigurePage *page, const FigureNotes *notes, Text *out,
                                 Err *err);
/* Writes the page as PDF 1.5: text as text in embedded fonts, the same bytes each time. STATUS_IO;
 * STATUS_USAGE when a picture has more than FIGURE_PDF_SIDE pixels a side. */
enum { FIGURE_PDF_SIDE = 32767 };
MUST_CHECK Status figure_write_pdf(const FigurePage *page, const FigureNotes *notes,
                                   const char *path, Err *err);

/* Draws the page over `rows`, of 8 or 16 bits and 3 channels, which are those of the page at its
 * resolution from row `first` on: their pictures, then all else, smoothed. The same pixels whatever
 * parts the page is drawn in. STATUS_MEMORY. */
MUST_CHECK Status figure_draw(const FigurePage *page, int first, Picture *rows, Err *err);

/* Draws bars alone over all of `color`, a plane of 3 channels, in linear light. Every pixel is the
 * mean of what it covers, so that bars thinner than a pixel are as faint as they are thin.
 *
 * scale       pixels per mm
 * offset      pixel position of the bars' origin
 * background  linear RGB
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status figure_draw_bars(const FigureBars *bars, double scale, const double offset[2],
                                   const float background[3], Plane *color, Err *err);

/* Appends the names and versions of the libraries. */
void figure_put_libraries(Text *text);

#endif
