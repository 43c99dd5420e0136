/* Draws the diagram of a tree: one bar per segment, as long as the segment and as high as its
 * diameter. A diagram is one item of a page, which the module figure writes as SVG and PDF. Pixels
 * are drawn by figure_draw_bars instead, because bars may be thinner than a pixel. */
#include "diagram/diagram.h"

#include <math.h>

/* A FigureBars.put_label: writes the id of a bar, a letter for its kind and the segment's id, and
 * its title, which a viewer shows: the segment and its value. */
static void put_label(const void *context, size_t bar, Text *id, Text *title)
{
    const DiagramStyle *style = context;
    const Diagram *diagram = style->diagram;
    const int32_t node = diagram->bar[bar].index, segment = style->tree->id[node];
    const char kind = bar < diagram->n_links                        ? 'l'
                      : bar < diagram->n_links + diagram->n_crosses ? 'c'
                                                                    : 's';
    text_printf(id, "%c%d", kind, segment);
    text_printf(title, "segment %d", segment);
    if (!style->name)
        return;
    text_puts(title, ", ");
    text_escaped(title, style->name);
    if (isnan(style->values[node])) {
        text_puts(title, " not known");
        return;
    }
    Text unit = TEXT_INIT;
    text_unit(&unit, style->unit);
    text_printf(title, " %s ", READABLE(style->values[node], 4));
    text_escaped(title, text_chars(&unit));
    text_release(&unit);
}

FigureBars diagram_bars(const DiagramStyle *style)
{
    return (FigureBars){.bars = style->diagram->bar,
                        .n = style->diagram->n,
                        .color = style->color,
                        .put_label = put_label,
                        .context = style};
}

void diagram_make_page(const DiagramStyle *style, const FigureBars *bars, FigurePage *page)
{
    const Diagram *diagram = style->diagram;
    const double margin =
        style->margin / (1 - 2 * style->margin) * fmax(diagram->width_mm, diagram->height_mm);
    figure_init(page, diagram->width_mm + 2 * margin, diagram->height_mm + 2 * margin, 72, NULL);
    page->exact = true;
    page->background = figure_color(style->background);
    figure_add_bars(page, bars, (FigurePoint){margin, margin}, diagram->width_mm,
                    diagram->height_mm);
}

Status diagram_draw(const DiagramStyle *style, const FigureBars *bars, const int size[2],
                    const int reserved[2], Plane *color, Err *err)
{
    const double wide = size[0] - reserved[0], high = size[1] - reserved[1];
    const double share = 1 - 2 * style->margin;
    const double width_mm = style->diagram->width_mm, height_mm = style->diagram->height_mm;
    const double scale = fmin(share * wide / width_mm, share * high / height_mm);
    const double offset[2] = {(wide - scale * width_mm) / 2, (high - scale * height_mm) / 2};
    Plane made;
    TRY(plane_init(&made, size[0], size[1], 3, err));
    Status status = figure_draw_bars(bars, scale, offset, style->background, &made, err);
    if (status == STATUS_OK)
        *color = made;
    else
        plane_release(&made);
    return status;
}
