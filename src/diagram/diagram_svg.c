/* Two templates: the page, and a bar of it, which is filled in once for each. */
#include "diagram/diagram.h"

#include "tmpl/tmpl.h"
#include <math.h>

/* What the part of the page that holds the bars is made of. */
typedef struct Bars {
    const Diagram *diagram;
    const Tree *tree;
    const DiagramPaint *paint;
    const DiagramSvg *svg;
    Tmpl bar;
} Bars;

typedef struct BarTexts {
    char number[4][NUMBER_TEXT_SIZE], id[32], color[8];
} BarTexts;

/* "#rrggbb" */
static void put_color(const float linear[3], char out[8])
{
    unsigned code[3];
    for (int c = 0; c < 3; c++)
        code[c] = image_code(linear[c], ENCODING_SRGB, 8);
    snprintf(out, 8, "#%02x%02x%02x", code[0], code[1], code[2]);
}

static void put_title(const Bars *bars, int32_t node, Text *title)
{
    const DiagramSvg *svg = bars->svg;
    text_printf(title, "segment %d", bars->tree->id[node]);
    if (!svg->name)
        return;
    text_puts(title, ", ");
    text_escaped(title, svg->name);
    if (isnan(svg->values[node])) {
        text_puts(title, " not known");
        return;
    }
    text_printf(title, " %.4g ", svg->values[node]);
    text_escaped(title, svg->unit);
}

static Status put_bar(const Bars *bars, size_t i, Text *title, Text *out, Err *err)
{
    const DiagramBar *bar = &bars->diagram->bar[i];
    BarTexts texts;
    text_clear(title);
    put_title(bars, bar->node, title);
    TRY(text_check(title, err));
    number_text(bar->x[0], texts.number[0]);
    number_text(bar->y[0], texts.number[1]);
    number_text(bar->x[1] - bar->x[0], texts.number[2]);
    number_text(fmax(0, bar->y[1] - bar->y[0]), texts.number[3]);
    snprintf(texts.id, sizeof texts.id, "%c%d", i < bars->diagram->n_links ? 'l' : 's',
             bars->tree->id[bar->node]);
    put_color(bars->paint->color[bar->node], texts.color);
    const TmplValue values[] = {{"id", texts.id},
                                {"x", texts.number[0]},
                                {"y", texts.number[1]},
                                {"width", texts.number[2]},
                                {"height", texts.number[3]},
                                {"color", texts.color},
                                {"title", text_chars(title)}};
    return tmpl_apply(&bars->bar, values, sizeof values / sizeof *values, out, err);
}

static Status put_bars(Text *out, void *context, Err *err)
{
    const Bars *bars = context;
    Text title = TEXT_INIT;
    Status status = STATUS_OK;
    for (size_t i = 0; i < bars->diagram->n && status == STATUS_OK; i++)
        status = put_bar(bars, i, &title, out, err);
    text_release(&title);
    return status;
}

/* The page's own numbers: it is the diagram with its margins. */
static Status put_page(Bars *bars, const Tmpl *page, Text *out, Err *err)
{
    enum { LEFT, TOP, WIDTH, HEIGHT, NUMBERS };
    const Diagram *diagram = bars->diagram;
    char number[NUMBERS][NUMBER_TEXT_SIZE], background[8];
    double margin = bars->paint->margin / (1 - 2 * bars->paint->margin) *
                    fmax(diagram->width_mm, diagram->height_mm);
    number_text(-margin, number[LEFT]);
    number_text(-margin, number[TOP]);
    number_text(diagram->width_mm + 2 * margin, number[WIDTH]);
    number_text(diagram->height_mm + 2 * margin, number[HEIGHT]);
    put_color(bars->paint->background, background);
    Text said[3] = {TEXT_INIT, TEXT_INIT, TEXT_INIT};
    const char *const lines[] = {bars->svg->description, bars->svg->generator, bars->svg->command};
    for (int i = 0; i < 3; i++)
        text_escaped(&said[i], lines[i]);
    Status status = STATUS_OK;
    for (int i = 0; i < 3; i++)
        TRY_GOTO(text_check(&said[i], err));
    const TmplValue values[] = {{"left", number[LEFT]},
                                {"top", number[TOP]},
                                {"width", number[WIDTH]},
                                {"height", number[HEIGHT]},
                                {"background", background},
                                {"description", text_chars(&said[0])},
                                {"generator", text_chars(&said[1])},
                                {"command", text_chars(&said[2])}};
    const TmplPart parts[] = {{"bars", put_bars, bars}};
    TRY_GOTO(tmpl_stream(page, values, sizeof values / sizeof *values, parts, 1, out, err));
done:
    for (int i = 0; i < 3; i++)
        text_release(&said[i]);
    return status;
}

static Status load(const char *templates, const char *name, Tmpl *tmpl, Err *err)
{
    char *path = NULL;
    TRY(file_join(templates, name, &path, err));
    Status status = tmpl_load(tmpl, path, err);
    free(path);
    return status;
}

Status diagram_put_svg(const Diagram *diagram, const Tree *tree, const DiagramPaint *paint,
                       const DiagramSvg *svg, Text *out, Err *err)
{
    Bars bars = {.diagram = diagram, .tree = tree, .paint = paint, .svg = svg};
    Tmpl page = {0};
    Status status = STATUS_OK;
    TRY_GOTO(load(svg->templates, "diagram/page.svg", &page, err));
    TRY_GOTO(load(svg->templates, "diagram/bar.svg", &bars.bar, err));
    status = put_page(&bars, &page, out, err);
done:
    tmpl_release(&bars.bar);
    tmpl_release(&page);
    return status;
}
