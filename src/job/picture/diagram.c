/* Runs the operation `diagram`: draws a tree unrolled flat, one bar per segment, in true lengths
 * and diameters. Lays the tree out once [diagram/diagram.h], and draws the layout on a page or as
 * pixels. The extension of the output selects which. */
#include "job/picture/diagram.h"

#include "diagram/diagram.h"
#include "job/picture/annotation.h"
#include "job/picture/coloring.h"
#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"
#include "job/picture/sheet.h"
#include "options/output.h"
#include "options/templates.h"
#include <stdlib.h>
#include <string.h>

typedef struct DiagramOptions {
    const char *output, *look;
    PictureSize size;
    double gap_mm, prune_radius_mm, margin;
    Vec3 background; /* sRGB in [0, 1] */
    Coloring coloring;
    PressOptions press;
    Annotation annotation; /* its legend */
} DiagramOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, DiagramOptions, output),
     .argument = "D.svg",
     .help = "file to write: a page true to size (.svg, .pdf or .eps), or an image (.png, .tif, "
             ".jpg or .ppm)"},
    {.name = "gap",
     SETS(NUMBER, DiagramOptions, gap_mm),
     FROM_TO(0, 1e7),
     .group = GROUP_VESSELS,
     .unit = "mm",
     .otherwise =
         "the median diameter of terminals, or more so that the height of the diagram is at "
         "least 3/4 of its width",
     .help = "minimum vertical distance between neighboring branches, in mm of the tree; 0 "
             "chooses the default"},
    {.name = "prune-radius",
     SETS(NUMBER, DiagramOptions, prune_radius_mm),
     .group = GROUP_VESSELS,
     .range = &prune_range,
     .unit = "mm",
     .otherwise = "0",
     .help = "radius below which segments are dropped, with their subtrees; 0 drops none"},
    {.name = "size",
     SETS(SIZE, DiagramOptions, size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_CAMERA,
     .when = WHEN(PIXELS),
     .help = "size of the image: in pixels (800x600), or on paper with a unit (89mmx60mm; mm, "
             "cm, in or pt), which --dpi converts to pixels; one length with a unit gives a "
             "square (89mm)"},
    {DPI_OF_SIZE(DiagramOptions, size), .group = GROUP_CAMERA,
     .when = WHEN(PIXELS) | WHEN(ON_PAPER_OR_KEPT),
     .help = "pixels per inch. With a --size on paper, it sets the number of pixels. With a "
             "--size in pixels, it is only stored in the image file, if the format can store it"},
    {.name = "margin",
     SETS(NUMBER, DiagramOptions, margin),
     FROM_TO(0, 0.45),
     .group = GROUP_CAMERA,
     .argument = "FRACTION",
     .help = "empty border on each side, as a fraction of the image's width and height (in a "
             ".svg, .pdf or .eps: of its longer side)"},
    {.name = "look",
     SETS(LOOKUP, DiagramOptions, look),
     .group = GROUP_COLOR,
     .list = "looks",
     .help = "look that sets the color of vessels without --color-by. A value with a '/', such as "
             "./my.ini, is the path of a file of your own"},
    {.name = "background",
     SETS(COLOR, DiagramOptions, background),
     .group = GROUP_LIGHT,
     .help = "background color: a CSS name, #RRGGBB, or R,G,B each 0..1"},
};

/* Returns true if the diagram is a page: in a file of a page, and in memory, where there is no
 * file. */
static bool is_page(const DiagramOptions *options)
{
    return !options->output || frames_is_page(options->output);
}

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const DiagramOptions *options = set;
    return is_page(options) ? WHEN(PIXELS)
                            : picture_unmet_dpi(&options->size, options_output(parsed));
}

static const OptionTable own_table = {OPTION_ROWS(own), .unmet = unmet};

static void set_defaults(void *options)
{
    DiagramOptions *own_options = options;
    *own_options = (DiagramOptions){
        .look = "cast", .size = {.pixels = {1200, 900}}, .margin = 0.05, .background = {1, 1, 1}};
    coloring_set_defaults(&own_options->coloring);
    press_set_defaults(&own_options->press);
    annotation_set_defaults(&own_options->annotation);
}

/* A diagram, and the data that it is drawn from. All arrays are owned. It must not be moved,
 * because it points to itself. */
typedef struct MadeDiagram {
    bool is_page;    /* true: the result is `page`; false: the result is `pixels` */
    FigurePage page; /* vector graphics in true size; zeroed if not is_page */
    Frame pixels;    /* pixels.color is the image; zeroed if is_page */
    Press press;     /* how the image is stored in its file; zeroed if is_page */
    PictureTree of;  /* the tree */
    Appearance appearance;
    Diagram layout;
    DiagramStyle style; /* borrows from the other members */
    FigureBars bars;
    float (*color)[3]; /* per node: linear RGB */
    Sheet sheet; /* templates and fonts, and the page that lies over `pixels`; only opened for a
                  * legend */
} MadeDiagram;

/* Sets the color of each segment and the style of the drawing, which borrows the colors. */
static Status paint(const DiagramOptions *options, MadeDiagram *made, Err *err)
{
    const Tree *tree = &made->of.tree;
    const Appearance *appearance = &made->appearance;
    const Rgb background = rgb_of_option(options->background);
    TRY(mem_calloc(&made->color, tree->n, sizeof *made->color, "colors", err));
    for (size_t i = 0; i < tree->n; i++) {
        Rgb color = appearance_color(appearance, (uint32_t)i);
        memcpy(made->color[i], &color, sizeof color);
    }
    made->style = (DiagramStyle){.diagram = &made->layout,
                                 .tree = tree,
                                 .color = (const float(*)[3])made->color,
                                 .background = {background.r, background.g, background.b},
                                 .margin = options->margin,
                                 .name = appearance->colors ? appearance->scale.name : NULL,
                                 .unit = appearance->scale.unit,
                                 .values = appearance->values};
    return STATUS_OK;
}

/* Reads the tree and its colors, and lays the tree out. */
static Status lay_out(const DiagramOptions *options, const Parsed *parsed, MadeDiagram *made,
                      Err *err)
{
    const Talk *talk = parsed->common.talk;
    PictureTree *of = &made->of;
    Look look;
    TRY(coloring_read_look(options->look, &look, err));
    TRY(picture_read_tree(&options->coloring, options->prune_radius_mm, parsed, of, err));
    if (of->pruned > 0)
        talk_note(talk, "%zu segment%s pruned", of->pruned, of->pruned == 1 ? " is" : "s are");
    const ColoredTree tree = picture_colored_tree(of);
    TRY(coloring_appearance(&options->coloring, &tree, &look, &made->appearance, err));
    coloring_report(&made->appearance, talk);
    TRY(paint(options, made, err));
    Status status = diagram_lay_out(&of->tree, options->gap_mm, &made->layout, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", of->path);
    made->bars = diagram_bars(&made->style);
    return status;
}

static Status check(const DiagramOptions *options, Err *err)
{
    TRY(annotation_check_legend(&options->annotation, &options->coloring, err));
    if (is_page(options))
        return STATUS_OK;
    TRY(annotation_check_file(&options->annotation, options->output, err));
    TRY(press_check(&options->press, options->output, err));
    return frames_check_output(options->output, false, err);
}

/* A width of journals' pages, mm: two columns. A diagram in true size can be much larger, and is
 * scaled down for printing. The text of its legend has its size in points on a page of this width.
 * Larger: smaller text. */
static const double widest_mm = 180;

/* Makes the page larger, and adds the legend there. */
static Status add_legend(const DiagramOptions *options, MadeDiagram *made, Err *err)
{
    FigurePage *page = &made->page;
    Annotation legend = options->annotation;
    double size[2];
    page->fonts = made->sheet.fonts;
    legend.text_pt *= fmax(page->width_mm, page->height_mm) / widest_mm;
    TRY(annotation_measure_legend(&legend, &made->appearance, page, size, err));
    const int side = legend.legend_at == LEGEND_RIGHT ? 0 : 1;
    page->width_mm = side ? fmax(page->width_mm, size[0]) : page->width_mm + size[0];
    page->height_mm = side ? page->height_mm + size[1] : fmax(page->height_mm, size[1]);
    const FigureBox whole = {0, 0, page->width_mm, page->height_mm};
    return annotation_put_legend(&legend, &made->appearance,
                                 annotation_text_color(rgb_of_option(options->background)), whole,
                                 page, err);
}

/* Draws the bars beside the space of the legend, which becomes the page over the pixels. */
static Status draw_pixels(DiagramOptions *options, MadeDiagram *made, Err *err)
{
    const int *size = options->size.pixels;
    const FigureColor ink = annotation_text_color(rgb_of_option(options->background));
    int room[2] = {0, 0};
    TRY(picture_check_memory(size[0], size[1], 40, err)); /* bytes per pixel, as in render.c */
    TRY(annotation_reserve_space(&options->annotation, made->sheet.fonts, &made->appearance,
                                 &options->size, room, err));
    TRY(diagram_draw(&made->style, &made->bars, size, room, &made->pixels.color, err));
    if (!options->annotation.legend)
        return STATUS_OK;
    sheet_begin(&made->sheet, size, annotation_dpi(&options->size));
    const FigurePage *page = &made->sheet.page;
    const FigureBox whole = {0, 0, page->width_mm, page->height_mm};
    return annotation_put_legend(&options->annotation, &made->appearance, ink, whole,
                                 &made->sheet.page, err);
}

/* Makes the diagram of the options, as a page or as pixels. */
static Status make(DiagramOptions *options, const Parsed *parsed, MadeDiagram *made, Err *err)
{
    TRY(check(options, err));
    if (!made->is_page)
        TRY(press_open(&options->press, options->output, parsed->common.threads, &made->press,
                       err));
    if (options->annotation.legend)
        TRY(sheet_open(&made->sheet, err));
    TRY(lay_out(options, parsed, made, err));
    if (!made->is_page)
        return draw_pixels(options, made, err);
    diagram_make_page(&made->style, &made->bars, &made->page);
    if (options->annotation.legend)
        TRY(add_legend(options, made, err));
    return figure_check(&made->page, err);
}

static void madediagram_release(MadeDiagram *made)
{
    figure_release(&made->page);
    sheet_release(&made->sheet);
    frame_release(&made->pixels);
    press_release(&made->press);
    picture_tree_release(&made->of);
    appearance_release(&made->appearance);
    diagram_release(&made->layout);
    free(made->color);
}

static Status write_pixels(const DiagramOptions *options, MadeDiagram *made, const char *command,
                           Err *err)
{
    const FramesForm form = {.path = options->output,
                             .bits = made->press.bits,
                             .packing = made->press.packing,
                             .encoding = ENCODING_SRGB,
                             .picture = true,
                             .dpi = options->size.dpi,
                             .provenance = command,
                             .page = made->sheet.fonts ? &made->sheet.page : NULL,
                             .colors = made->appearance.meaning};
    return frames_write(&made->pixels, &form, err);
}

static Status write_page(const DiagramOptions *options, const MadeDiagram *made,
                         const char *command, Err *err)
{
    char *templates = NULL, *name = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(templates_folder(&templates, err));
    TRY_GOTO(shown_name(made->of.path, &name, err));
    const FigureNotes notes = {
        .templates = templates, .description = name, .generator = GENERATOR, .command = command};
    status = frames_write_page(&made->page, &notes, options->output, err);
done:
    free(templates);
    free(name);
    return status;
}

Status diagram_run(void *options, Parsed *parsed, Err *err)
{
    MadeDiagram made = {.is_page = is_page(options)};
    char *command = NULL;
    Status status;
    TRY_GOTO(make(options, parsed, &made, err));
    TRY_GOTO(command_line_text(parsed, &command, err));
    status = made.is_page ? write_page(options, &made, command, err)
                          : write_pixels(options, &made, command, err);
done:
    free(command);
    madediagram_release(&made);
    return status;
}

const Command command_diagram = {
    .name = "diagram",
    .summary = "draw a tree unrolled flat, with true lengths and diameters",
    .operands = "T.swc -o D.svg",
    .examples = "  corcast diagram tree.swc --color-by wss --log --legend -o wss.svg\n"
                "  corcast diagram tree.swc --color-by pressure --size 2400x1800 -o pressure.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(DiagramOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               COLORING_TABLES(DiagramOptions, coloring),
               {&legend_table, offsetof(DiagramOptions, annotation)},
               {&press_table, offsetof(DiagramOptions, press)}},
};
