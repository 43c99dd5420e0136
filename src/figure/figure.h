/* The public header of the module figure: lays out a page of pictures, diagrams, color bars, scale
 * bars and text, and writes the page as PDF, EPS, SVG or pixels. A page is built in this order:
 * figure_init, figure_add_..., figure_check, one or more of figure_write_pdf, figure_put_svg and
 * figure_draw, figure_release.
 *
 *     figure_init(&page, 89, 60, 300, fonts);
 *     figure_add_picture(&page, &picture, 0, 0);
 *     figure_add_text(&page, &(FigureText){.text = "a", .x = 2, .y = 5, .size_pt = 8});
 *     TRY_GOTO(figure_check(&page, err));
 *     TRY_GOTO(figure_write_pdf(&page, &notes, false, "figure.pdf", err));
 *     figure_release(&page);
 *
 * Lengths are mm from the page's upper left corner, x to the right and y down. Sizes of text are
 * points (1/72 inch). Pictures are drawn first, below all other items. The pixels of a picture are
 * pixels of the page at the page's resolution, so that no picture is resampled. */
#ifndef CORCAST_FIGURE_FIGURE_H
#define CORCAST_FIGURE_FIGURE_H

#include "base/base.h"
#include "image/image.h"
#include "scene/scene.h"
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define MM_PER_POINT (MM_PER_INCH / 72)

/* ---- fonts ----------------------------------------------------------------------------------- */

/* The fonts in templates/fonts: Liberation Sans, regular, bold, italic and bold italic; and DejaVu
 * Sans for letters that Liberation Sans lacks. No other font is used. */
typedef struct FigureFonts FigureFonts;

/* The font files, relative to the folder of templates; NULL ends the list. */
extern const char *const figure_font_files[];

/* Loads the fonts from the folder of templates. Free *out with figurefonts_free. Errors: STATUS_IO,
 * naming the file, if it is missing or not a font; STATUS_MEMORY. */
MUST_CHECK Status figurefonts_load(const char *templates, FigureFonts **out, Err *err);
void figurefonts_free(FigureFonts *fonts); /* NULL is allowed */

/* Returns the width, in mm, of a line of text with markup [FigureText]; 0 if memory runs out. */
double figure_text_width(const FigureFonts *fonts, const char *text, double size_pt, bool bold);

/* The Unicode characters in texts that Liberation Sans lacks. Each character is listed once, in the
 * order of appearance. At most FIGURE_LETTERS characters of each kind are listed, which is
 * sufficient for a message. */
enum { FIGURE_LETTERS = 8 };
typedef struct FigureLetters {
    uint32_t fallback[FIGURE_LETTERS]; /* drawn in DejaVu Sans */
    uint32_t boxed[FIGURE_LETTERS];    /* in no font: drawn as a box */
    int n_fallback, n_boxed;
} FigureLetters;

/* ---- a page ---------------------------------------------------------------------------------- */

/* A point of the page, mm. */
typedef struct FigurePoint {
    double x, y;
} FigurePoint;

/* A rectangle of the page, mm; left <= right, top <= bottom. */
typedef struct FigureBox {
    double left, top, right, bottom;
} FigureBox;

/* Returns true if two boxes overlap by more than `slack` mm in both directions. */
static inline bool figure_boxes_overlap(const FigureBox *a, const FigureBox *b, double slack)
{
    return fmin(a->right, b->right) - fmax(a->left, b->left) > slack &&
           fmin(a->bottom, b->bottom) - fmax(a->top, b->top) > slack;
}

/* A color, as 8-bit sRGB codes. */
typedef struct FigureColor {
    uint8_t rgb[3];
} FigureColor;

/* Returns the sRGB codes of a linear color. */
FigureColor figure_color(const float linear[3]);

typedef enum FigureAlign { ALIGN_LEFT, ALIGN_CENTER, ALIGN_RIGHT } FigureAlign;

/* The kinds of items. */
typedef enum FigureKind {
    FIGURE_PICTURE,
    FIGURE_SHAPE, /* a polygon, filled */
    FIGURE_LINE,  /* a polyline, stroked */
    FIGURE_RAMP,  /* a rectangle whose color changes from left to right, or from bottom to top */
    FIGURE_TEXT,
    FIGURE_STROKES, /* a line drawing */
    FIGURE_BARS,    /* a diagram */
    FIGURE_ARTWORK, /* an image or vector file of another program */
    FIGURE_KINDS
} FigureKind;

/* Maximum number of points of a shape or line, and number of colors of a ramp; reason of the second
 * value not recorded. */
enum { FIGURE_CORNERS = 4, FIGURE_STOPS = 65 };

/* A bar of a diagram: a rectangle. Lengths are mm. */
typedef struct FigureBar {
    double x[2], y[2]; /* left and right side, upper and lower side */
    int32_t index;     /* index in FigureBars.color */
} FigureBar;

/* The bars of a diagram. No two overlap. All members are borrowed. */
typedef struct FigureBars {
    const FigureBar *bars;
    size_t n;
    const float (*color)[3]; /* linear RGB, by FigureBar.index */
    /* Appends the id and the title of a bar for an SVG. The callback must escape the title for XML.
     */
    void (*put_label)(const void *context, size_t bar, Text *id, Text *title);
    const void *context; /* passed to put_label */
} FigureBars;

/* An artwork: a file that another program made. It is a page of a PDF, an SVG, or pixels. */
typedef struct FigureArtwork {
    const char *path;     /* borrowed */
    char *bytes;          /* content of a PDF or SVG, owned; NULL for pixels */
    size_t size;          /* number of bytes */
    bool pdf;             /* true: the bytes are a PDF; false: an SVG */
    double width, height; /* > 0, in any unit: only their ratio is used */
    Picture picture;      /* pixels, of 3 channels of 8 bits; zeroed for a PDF or SVG; owned */
} FigureArtwork;

/* Reads an artwork.
 *
 * path     a .pdf of one page, .svg, .png, .tif or .jpg. The format is recognised by the content.
 * paper    color behind transparent pixels of a .png or .tif.
 * artwork  borrows `path`. The caller releases it with figureartwork_release even after an error.
 * Errors   STATUS_INPUT, with the file's name, if the file is missing, larger than 100 MB, of
 *          another format or broken. STATUS_TOOL if the library that reads a PDF (poppler-glib) or
 *          an SVG (librsvg) is not installed. STATUS_MEMORY. */
MUST_CHECK Status figureartwork_read(const char *path, FigureColor paper, FigureArtwork *artwork,
                                     Err *err);
void figureartwork_release(FigureArtwork *artwork);

/* One item of a page. The members that a kind does not use are zero. */
typedef struct FigureItem {
    FigureKind kind;
    FigureBox box; /* bounds of the drawn item */
    FigureColor color;
    int n;             /* number of points in `at` */
    bool closed;       /* a line: its last point is connected to its first */
    bool upwards;      /* a ramp: its color changes from bottom to top */
    bool bold;         /* a text */
    bool solid;        /* a text that overlaps this item is reported [figure_put_collisions] */
    FigureAlign align; /* alignment of a text relative to at[0], a point on its baseline */
    FigurePoint at[FIGURE_CORNERS];
    double width_mm;              /* line: its width */
    double size_pt;               /* text: its size */
    double outline_mm;            /* text: width of the outline around its filled letters */
    double halo_mm;               /* width of the halo around the item; 0: none */
    FigureColor halo;             /* color of the halo */
    char *text;                   /* owned */
    FigureColor *ramp;            /* owned; FIGURE_STOPS colors at equal distances */
    const Strokes *strokes;       /* line drawing, borrowed; the upper left corner of its paper is
                                   * at at[0] */
    const FigureBars *bars;       /* diagram, borrowed; its origin is at at[0] */
    const FigureArtwork *artwork; /* borrowed */
    const Picture *picture;       /* borrowed; 8 bits */
    int column, row;              /* pixel position of the picture's first pixel on the page */
} FigureItem;

/* A page and its items. */
typedef struct FigurePage {
    double width_mm, height_mm, dpi; /* 0 < dpi */
    bool exact;                      /* true: an SVG states the page's size with all digits; false:
                                      * rounded to 0.001 mm */
    FigureColor background;
    const Inks *inks;         /* converts the colors of a PDF to CMYK, with 8 bits; borrowed; NULL:
                               * the PDF is sRGB */
    const FigureFonts *fonts; /* borrowed; NULL: the page has no text */
    FigureItem *items;        /* owned */
    size_t n, capacity;
    bool failed;           /* true: memory ran out while an item was added [figure_check] */
    FigureLetters missing; /* characters of all texts that Liberation Sans lacks */
    const char *unclosed;  /* the first text with an unclosed group of markup; borrowed from its
                            * item; NULL: none */
} FigurePage;

/* Makes an empty page with a white background. `dpi` is its resolution in pixels per inch. The
 * fonts are borrowed; NULL for a page without text. */
void figure_init(FigurePage *page, double width_mm, double height_mm, double dpi,
                 const FigureFonts *fonts);
/* Frees the items and zeroes *page. */
void figure_release(FigurePage *page);
/* Converts a length to pixels of the page, rounded to the nearest integer. */
int figure_pixels(const FigurePage *page, double mm);

/* The following functions append an item to the page. If memory runs out, they mark the page as
 * failed; figure_check then returns STATUS_MEMORY. Borrowed objects must outlive the page. (column,
 * row) is the position on the page of the picture's first pixel, in pixels. */
void figure_add_picture(FigurePage *page, const Picture *picture, int column, int row);
void figure_add_box(FigurePage *page, FigureBox box, FigureColor color);
/* Appends a filled polygon of `n` corners; n must be at most FIGURE_CORNERS. */
void figure_add_shape(FigurePage *page, const FigurePoint *corner, int n, FigureColor color);
/* Appends a polyline of `n` points, at most FIGURE_CORNERS. `closed`: the last is connected to the
 * first. */
void figure_add_line(FigurePage *page, const FigurePoint *corner, int n, bool closed,
                     double width_mm, FigureColor color);
/* Appends a rectangle whose color changes along the stops, to the right or `upwards`. */
void figure_add_ramp(FigurePage *page, FigureBox box, bool upwards,
                     const FigureColor stops[FIGURE_STOPS]);

/* Appends a line drawing, borrowed. The upper left corner of its paper is at the point `at`. */
void figure_add_strokes(FigurePage *page, const Strokes *strokes, FigurePoint at,
                        FigureColor color);

/* Appends a diagram, borrowed, of `width_mm` x `height_mm`. The origin of the bars' coordinates,
 * their upper left, is at the point `at`. */
void figure_add_bars(FigurePage *page, const FigureBars *bars, FigurePoint at, double width_mm,
                     double height_mm);

/* Appends an artwork, borrowed, stretched to the box. In a PDF, SVG or EPS, vectors stay vectors,
 * and pixels are not resampled. */
void figure_add_artwork(FigurePage *page, const FigureArtwork *artwork, FigureBox box);

/* The markup of texts, as the help of options describes it. */
#define FIGURE_MARKUP "*r* is italic, _{w} a subscript, ^{-3} a superscript"

/* A line of text, which may contain markup:
 *
 *     *r*                      italic
 *     _{w}  ^{-3}              a group: subscript or superscript; groups may be nested
 *     \*  \_  \^  \{  \}  \\    the character itself
 *
 * A star without a matching star, or next to a blank, is drawn as a star. A hyphen at either end of
 * a group is drawn as a minus sign. An unclosed group ends at the end of the text.
 *
 * Superscript and subscript characters of Unicode, such as U+207B, are drawn like groups. */
typedef struct FigureText {
    const char *text; /* one line of UTF-8; copied. Control characters become blanks */
    double x, y;      /* position on the baseline */
    double size_pt;
    bool bold;
    FigureAlign align;
    FigureColor color;
} FigureText;
/* Appends a text. */
void figure_add_text(FigurePage *page, const FigureText *text);

/* Returns STATUS_MEMORY if an item could not be added, else STATUS_OK. */
MUST_CHECK Status figure_check(const FigurePage *page, Err *err);
/* Appends a sentence that lists characters of the page that Liberation Sans lacks: if `boxed` is
 * true, the characters that no font has; otherwise the characters that are drawn in DejaVu Sans.
 * Appends nothing if there are none. */
void figure_put_missing(const FigurePage *page, bool boxed, Text *out);

/* Appends a sentence about the first text with an unclosed group. Appends nothing if there is
 * none. */
void figure_put_unclosed(const FigurePage *page, Text *out);

/* Appends a sentence that lists two kinds of texts: texts that overlap another text or a solid item
 * (a scale bar or a legend), and texts that extend beyond the page. Appends nothing if there are
 * none. Cost: O(n^2) for n texts. */
void figure_put_collisions(const FigurePage *page, Text *out);

/* Returns the bounds of the items from index `first` on. If there are none, left and top are
 * INFINITY, right and bottom -INFINITY. */
FigureBox figure_bounds(const FigurePage *page, size_t first);
/* Moves the items from index `first` on by (dx, dy) mm. None of them may be a picture. */
void figure_move(FigurePage *page, size_t first, double dx, double dy);
/* Marks the items from index `first` on as solid, except texts. */
void figure_mark_solid(FigurePage *page, size_t first);

/* Gives the item with index `item` a halo, which is drawn below the item. The halo of a text
 * follows its letters; the halo of any other item is a rectangle around the item's box. */
void figure_set_halo(FigurePage *page, size_t item, double width_mm, FigureColor color);

/* ---- legends --------------------------------------------------------------------------------- */

/* A legend of a color scale. All pointers are borrowed. */
typedef struct FigureLegend {
    const ColorScale *scale;
    ScaleOutside outside;   /* counts of the visible values outside the range */
    bool integers;          /* all values are integers, so ticks are integers as well */
    const double *swatches; /* values that are drawn as swatches instead of a bar; borrowed */
    int n_swatches;         /* number of swatches; 0: a bar is drawn */
    const char *title;      /* the quantity, followed by its unit in parentheses, if any; UTF-8 */
    bool horizontal;        /* the bar runs from left to right; false: from bottom to top */
    double length_mm;       /* length of the bar */
    double size_pt;
    FigureColor ink;
} FigureLegend;

/* Appends a legend: a title, and a color bar with ticks at round numbers.
 *
 * An end of the bar is pointed if values are beyond this end of the range. A swatch is added if
 * there are vessels without a value. A logarithmic bar has numbers at its ends and minor ticks.
 * Very large or small numbers share a power of ten. If integers select the colors
 * [colorscale_selects_by_integer], one swatch per color replaces the bar. The legend is placed near
 * the origin of the page: use figure_bounds and figure_move to position it. */
void figure_add_legend(FigurePage *page, const FigureLegend *legend);

/* Appends a scale bar of this length at the origin, with its label centred above it. Use
 * figure_move to position it. */
void figure_add_scale_bar(FigurePage *page, double length_mm, const char *label, double size_pt,
                          FigureColor ink);

enum { FIGURE_TICKS = 32 };
/* Computes about `wanted` round numbers within the range of a scale, ascending, at least two if
 * `wanted` is above 1 and the range is not empty. Returns their count, at most FIGURE_TICKS.
 * colorscale_selects_by_integer must be false for the scale. If `integers` is true, all numbers on
 * a linear scale are integers. */
int figure_ticks(const ColorScale *scale, int wanted, bool integers, double ticks[FIGURE_TICKS]);

/* ---- files ----------------------------------------------------------------------------------- */

/* Metadata of the file of a page. Each string is borrowed and has one line. */
typedef struct FigureNotes {
    const char *templates;   /* the folder of templates */
    const char *description; /* title of the page */
    const char *generator;   /* program and version */
    const char *command;     /* the command line that makes the page */
} FigureNotes;

/* Appends the page as SVG. Texts become `text` elements, and pictures become embedded PNGs. `out`
 * may have a stream [base/text.h]. Errors: STATUS_INPUT if a template is missing or lacks a
 * placeholder; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status figure_put_svg(const FigurePage *page, const FigureNotes *notes, Text *out,
                                 Err *err);
enum { FIGURE_PDF_SIDE = 32767 };
/* Writes the page as PDF 1.5 or, if `eps` is true, as encapsulated PostScript of level 3. Text
 * stays text, in embedded fonts. Equal pages give equal bytes. Errors: STATUS_USAGE if a side of a
 * picture has more than FIGURE_PDF_SIDE pixels, a limit of the library cairo; STATUS_IO;
 * STATUS_MEMORY. */
MUST_CHECK Status figure_write_pdf(const FigurePage *page, const FigureNotes *notes, bool eps,
                                   const char *path, Err *err);

/* Draws a band of the page over `rows`, a picture of 3 or 4 channels at the page's resolution. The
 * first row of the band is row `first` of the page. A fourth channel, which must be 0 before,
 * receives black ink: items whose color is 0 0 0 are drawn into it instead of into the colors.
 * Items other than pictures are antialiased. The pixels do not depend on how the page is divided
 * into bands. Errors: STATUS_MEMORY. */
MUST_CHECK Status figure_draw(const FigurePage *page, int first, Picture *rows, Err *err);

/* Draws bars into `color`, a plane of 3 channels of linear RGB, and overwrites all its pixels. The
 * color of a pixel is the mean over its area, so that a bar thinner than a pixel appears
 * proportionally fainter.
 *
 * scale       pixels per mm
 * offset      pixel position of the bars' origin
 * background  linear RGB
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status figure_draw_bars(const FigureBars *bars, double scale, const double offset[2],
                                   const float background[3], Plane *color, Err *err);

/* Appends the names and versions of the libraries that the module uses. */
void figure_put_libraries(Text *text);

#endif
