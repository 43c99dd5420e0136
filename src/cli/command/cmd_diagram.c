/* One layout, drawn as SVG or as pixels: the output's extension says which. */
#include "cli/commands.h"
#include "diagram/diagram.h"
#include "job/picture/coloring.h"
#include "job/picture/frames.h"
#include "job/picture/picture.h"
#include "job/picture/press.h"
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
} DiagramOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, DiagramOptions, output),
     .argument = "D.svg",
     .help = "the diagram: .svg, true to size, or .png, .tif, .jpg, .ppm"},
    {.name = "gap",
     SETS(NUMBER, DiagramOptions, gap_mm),
     FROM_TO(0, 1e7),
     .group = GROUP_VESSELS,
     .unit = "mm",
     .otherwise = "by the height that suits the width",
     .help = "space between two branches"},
    {.name = "prune-radius",
     SETS(NUMBER, DiagramOptions, prune_radius_mm),
     .group = GROUP_VESSELS,
     .range = &prune_range,
     .unit = "mm",
     .otherwise = "",
     .help = "drop segments thinner than this"},
    {.name = "size",
     SETS(SIZE, DiagramOptions, size),
     FROM_TO(1, IMAGE_MAX_SIDE),
     .group = GROUP_CAMERA,
     .when = WHEN(PIXELS),
     .help = "pixels, or on paper, as 89mmx60mm; 89mm is a square"},
    {DPI_OF_SIZE(DiagramOptions, size), .group = GROUP_CAMERA,
     .when = WHEN(PIXELS) | WHEN(ON_PAPER_OR_KEPT),
     .help = "pixels an inch on paper, which .png, .tif and .jpg keep"},
    {.name = "margin",
     SETS(NUMBER, DiagramOptions, margin),
     FROM_TO(0, 0.45),
     .group = GROUP_CAMERA,
     .help = "free part on each side"},
    {.name = "look",
     SETS(LOOKUP, DiagramOptions, look),
     .group = GROUP_COLOR,
     .list = "looks",
     .help = "colour of what no field colours: a file of templates/looks, or a path"},
    {.name = "background",
     SETS(COLOR, DiagramOptions, background),
     .group = GROUP_LIGHT,
     .help = "sRGB, each from 0 to 1"},
};

static bool is_svg(const DiagramOptions *options)
{
    return strcmp(file_extension(options->output), "svg") == 0;
}

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    const DiagramOptions *options = set;
    if (!options->output)
        return 0;
    return is_svg(options) ? WHEN(PIXELS)
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
}

/* What the diagram is drawn of. */
typedef struct Drawing {
    PictureTree of;
    Look look;
    Appearance appearance;
    Diagram diagram;
    DiagramStyle style;
    FigureBars bars;
    float (*color)[3]; /* owned; what style.color borrows */
} Drawing;

static void drawing_release(Drawing *drawing)
{
    picture_tree_release(&drawing->of);
    appearance_release(&drawing->appearance);
    diagram_release(&drawing->diagram);
    free(drawing->color);
}

static Status paint(const DiagramOptions *options, Drawing *drawing, Err *err)
{
    size_t n = drawing->of.tree.n;
    TRY(mem_calloc(&drawing->color, n, sizeof *drawing->color, "colours", err));
    for (size_t i = 0; i < n; i++) {
        Rgb color = appearance_color(&drawing->appearance, (uint32_t)i);
        memcpy(drawing->color[i], &color, sizeof color);
    }
    const Rgb background = rgb_of_option(options->background);
    const Appearance *appearance = &drawing->appearance;
    drawing->style = (DiagramStyle){.diagram = &drawing->diagram,
                                    .tree = &drawing->of.tree,
                                    .color = (const float(*)[3])drawing->color,
                                    .background = {background.r, background.g, background.b},
                                    .margin = options->margin,
                                    .name = appearance->colors ? appearance->scale.name : NULL,
                                    .unit = appearance->scale.unit,
                                    .values = appearance->values};
    return STATUS_OK;
}

static Status make_drawing(const DiagramOptions *options, const Parsed *parsed, Drawing *drawing,
                           Err *err)
{
    const PictureTree *of = &drawing->of;
    TRY(coloring_read_look(options->look, &drawing->look, err));
    TRY(picture_read_tree(&options->coloring, options->prune_radius_mm, parsed, &drawing->of, err));
    if (of->pruned > 0 && !parsed->common.quiet)
        fprintf(stderr, "corcast: %zu segment%s pruned\n", of->pruned,
                of->pruned == 1 ? " is" : "s are");
    const ColoredTree tree = picture_colored_tree(of);
    TRY(coloring_appearance(&options->coloring, &tree, &drawing->look, &drawing->appearance, err));
    coloring_say(&drawing->appearance, parsed->common.talk);
    TRY(paint(options, drawing, err));
    Status status = diagram_lay_out(&drawing->of.tree, options->gap_mm, &drawing->diagram, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", of->path);
    drawing->bars = diagram_bars(&drawing->style);
    return status;
}

static Status write_picture(const DiagramOptions *options, const Drawing *drawing,
                            const Press *press, const char *command, Err *err)
{
    Frame frame = {0};
    TRY(picture_fits(options->size.pixels[0], options->size.pixels[1], 40, err));
    TRY(diagram_draw(&drawing->style, &drawing->bars, options->size.pixels[0],
                     options->size.pixels[1], &frame.color, err));
    const FramesForm form = {.path = options->output,
                             .bits = press->bits,
                             .packing = press->packing,
                             .encoding = ENCODING_SRGB,
                             .picture = true,
                             .dpi = options->size.dpi,
                             .provenance = command,
                             .colors = drawing->appearance.said};
    Status status = frames_write(&frame, &form, err);
    frame_release(&frame);
    return status;
}

static Status write_svg(const DiagramOptions *options, const Drawing *drawing, const char *tree,
                        const char *command, Err *err)
{
    char *templates = NULL, *name = NULL;
    FigurePage page = {0};
    Status status = STATUS_OK;
    TRY_GOTO(templates_folder(&templates, err));
    TRY_GOTO(shown_name(tree, &name, err));
    const FigureNotes notes = {
        .templates = templates, .description = name, .generator = GENERATOR, .command = command};
    diagram_make_page(&drawing->style, &drawing->bars, &page);
    TRY_GOTO(figure_check(&page, err));
    status = frames_write_page(&page, &notes, options->output, err);
done:
    figure_release(&page);
    free(templates);
    free(name);
    return status;
}

static Status check(const DiagramOptions *options, Err *err)
{
    if (is_svg(options))
        return STATUS_OK;
    TRY(press_check(&options->press, options->output, err));
    return frames_check_output(options->output, false, err);
}

Status run_diagram(void *options, Parsed *parsed, Err *err)
{
    const DiagramOptions *own_options = options;
    Drawing drawing = {0};
    char *command = NULL;
    Status status;
    Press press = {0};
    TRY(check(own_options, err));
    TRY(press_open(&own_options->press, own_options->output, parsed->common.threads, &press, err));
    TRY_GOTO(make_drawing(own_options, parsed, &drawing, err));
    TRY_GOTO(command_line_text(parsed, &command, err));
    if (is_svg(own_options))
        status = write_svg(own_options, &drawing, parsed->operands[0], command, err);
    else
        status = write_picture(own_options, &drawing, &press, command, err);
done:
    free(command);
    drawing_release(&drawing);
    press_release(&press);
    return status;
}

const Command command_diagram = {
    .name = "diagram",
    .summary = "draw a tree unrolled flat, lengths and diameters true",
    .operands = "T.swc -o D.svg",
    .examples = "  corcast diagram tree.swc --color-by wss -o wss.svg\n"
                "  corcast diagram tree.swc --color-by pressure --size 2400x1800 -o pressure.png\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(DiagramOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               COLORING_TABLES(DiagramOptions, coloring),
               {&press_table, offsetof(DiagramOptions, press)}},
};
