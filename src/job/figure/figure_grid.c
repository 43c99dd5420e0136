/* Places panels in a grid whose columns have one width and whose rows have one height. Positions
 * are whole pixels of the page, so that no picture is resampled. */
#include "job/figure/figure.h"

#include <math.h>
#include <stdlib.h>

/* Finds the cell in which each panel begins: cell[i] is its column and row. Returns the number of
 * rows. */
static int find_cells(const Figure *figure, int (*cell)[2])
{
    const int columns = figure->options->columns;
    int row = 0, column = 0;
    for (size_t i = 0; i < figure->plan.n; i++) {
        const Section *section = figure->plan.sections[i];
        if (!figure_is_panel(figure, i))
            continue;
        int span = ((const PanelOptions *)section->own.options)->span;
        if (column + span > columns) {
            row++;
            column = 0;
        }
        cell[i][0] = column;
        cell[i][1] = row;
        column += span;
    }
    return row + 1;
}

/* Returns true if any panel of the row has a title. All panels of the row then leave space for a
 * title. */
static bool has_titles(const Figure *figure, int (*cell)[2], int row)
{
    for (size_t i = 0; i < figure->plan.n; i++)
        if (figure_is_panel(figure, i) && cell[i][1] == row &&
            ((const PanelOptions *)figure->plan.sections[i]->own.options)->title)
            return true;
    return false;
}

/* Places a panel in its cells, below the title, centred if it has an aspect ratio of its own. */
static Status place_panel(const Figure *figure, const FigureBox *cell, double title_mm, size_t i,
                          Err *err)
{
    const Section *section = figure->plan.sections[i];
    const PanelOptions *panel = section->own.options;
    double width = cell->right - cell->left, height = cell->bottom - cell->top - title_mm;
    double left = cell->left, top = cell->top + title_mm;
    if (panel->aspect > 0 && width > 0 && height > 0) {
        double fitting = fmin(width, height * panel->aspect);
        left += (width - fitting) / 2;
        top += (height - fitting / panel->aspect) / 2;
        width = fitting;
        height = fitting / panel->aspect;
    }
    const FigurePage *page = &figure->sheet.page;
    PanelRect rect = {
        .left = figure_pixels(page, left), .top = figure_pixels(page, top), .title_mm = title_mm};
    rect.width = figure_pixels(page, left + width) - rect.left;
    rect.height = figure_pixels(page, top + height) - rect.top;
    if (rect.width < 1 || rect.height < 1)
        return err_set(err, STATUS_USAGE,
                       "[panel %s] does not fit: the page has %.4g x %.4g mm, including "
                       "`margin_mm` and `gap_mm`",
                       section->name, page->width_mm, page->height_mm);
    figure->rects[i] = rect;
    return STATUS_OK;
}

/* Places all panels. A title takes 1.7 times the text size: a line, and the space around it. */
static Status lay_out(Figure *figure, int (*cell)[2], Err *err)
{
    const FigureOptions *options = figure->options;
    const FigurePage *page = &figure->sheet.page;
    const int rows = find_cells(figure, cell);
    double margin = options->margin_mm, gap = options->gap_mm;
    double wide = (page->width_mm - 2 * margin - gap * (options->columns - 1)) / options->columns;
    double high = (page->height_mm - 2 * margin - gap * (rows - 1)) / rows;
    for (size_t i = 0; i < figure->plan.n; i++) {
        if (!figure_is_panel(figure, i))
            continue;
        const Section *section = figure->plan.sections[i];
        int span = ((const PanelOptions *)section->own.options)->span;
        if (span > options->columns)
            return err_set(err, STATUS_USAGE, "[panel %s] spans %d columns, but the figure has %d",
                           section->name, span, options->columns);
        double left = margin + cell[i][0] * (wide + gap), top = margin + cell[i][1] * (high + gap);
        double title =
            has_titles(figure, cell, cell[i][1]) ? 1.7 * options->text_pt * MM_PER_POINT : 0;
        const FigureBox box = {left, top, left + span * wide + (span - 1) * gap, top + high};
        TRY(place_panel(figure, &box, title, i, err));
    }
    return STATUS_OK;
}

Status figure_place_panels(Figure *figure, Err *err)
{
    int(*cell)[2];
    size_t n = figure->plan.n;
    TRY(mem_calloc(&figure->rects, n, sizeof *figure->rects, "panels", err));
    TRY(mem_calloc(&figure->panels, n, sizeof *figure->panels, "panels", err));
    TRY(mem_calloc(&figure->insets, n, sizeof *figure->insets, "insets", err));
    TRY(mem_calloc(&figure->artworks, n, sizeof *figure->artworks, "images", err));
    TRY(mem_calloc(&cell, n, sizeof *cell, "panels", err));
    Status status = lay_out(figure, cell, err);
    free(cell);
    return status;
}

FigureBox figure_panel_box(const Figure *figure, size_t i)
{
    const PanelRect *rect = &figure->rects[i];
    double pixel = MM_PER_INCH / figure->sheet.page.dpi;
    return (FigureBox){rect->left * pixel, rect->top * pixel, (rect->left + rect->width) * pixel,
                       (rect->top + rect->height) * pixel};
}
