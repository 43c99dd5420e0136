/* Places annotations where they cover few vessels, and adds halos. Coverage is measured on a grid
 * of cells in each box, because pictures may be too large to be drawn at once. The vessels are the
 * geometry's pairs of balls, projected: capsules whose radius changes from end to end. */
#include "job/picture/placing.h"

#include "job/picture/annotation.h"
#include <math.h>
#include <stdlib.h>

const char *const corner_names[] = {
    [CORNER_EMPTIEST] = "emptiest",         [CORNER_BOTTOM_LEFT] = "bottom-left",
    [CORNER_BOTTOM_RIGHT] = "bottom-right", [CORNER_TOP_RIGHT] = "top-right",
    [CORNER_TOP_LEFT] = "top-left",         [CORNER_CHOICES] = NULL};

/* ---- coverage -------------------------------------------------------------------------------- */

/* Cells per side of a box. A vessel thinner than a cell counts as one cell wide. More cells
 * distinguish boxes whose coverage hardly differs; the cost grows with their square. */
enum { CELLS = 48 };

/* A vessel in the picture: a line whose width changes. Lengths are mm on the page. */
typedef struct Capsule {
    double x[2], y[2], radius[2];
} Capsule;

/* Returns false if an end is not in front of the camera. */
static bool project(const PlacedPicture *picture, size_t item, Capsule *out)
{
    const Geometry *geometry = &picture->scene->geometry;
    const Camera *camera = &picture->scene->view.camera;
    const FigureBox *where = &picture->where;
    const double mm_x = (where->right - where->left) / camera->width;
    const double mm_y = (where->bottom - where->top) / camera->height;
    for (int k = 0; k < 2; k++) {
        const Ball ball = geometry_ball(geometry, 2 * item + (size_t)k);
        const CameraPoint at = camera_point(camera, ball.center);
        /* The ball of a field segment has twice the radius of the vessel. */
        const double radius = item < geometry->n_primitives ? ball.radius : ball.radius / 2;
        if (!(at.per_mm > 0))
            return false;
        out->x[k] = where->left + mm_x * at.x;
        out->y[k] = where->top + mm_y * at.y;
        out->radius[k] = mm_x * at.per_mm * radius;
    }
    return true;
}

/* Returns true if the capsule, made at least `least` wide to each side, contains the point. */
static bool contains(const Capsule *capsule, double x, double y, double least)
{
    const double along_x = capsule->x[1] - capsule->x[0], along_y = capsule->y[1] - capsule->y[0];
    const double from_x = x - capsule->x[0], from_y = y - capsule->y[0];
    const double square = along_x * along_x + along_y * along_y;
    const double part = square > 0 ? (from_x * along_x + from_y * along_y) / square : 0;
    const double t = fmin(fmax(part, 0), 1);
    const double radius = capsule->radius[0] + t * (capsule->radius[1] - capsule->radius[0]);
    const double off_x = from_x - t * along_x, off_y = from_y - t * along_y;
    const double reach = fmax(radius, least);
    return off_x * off_x + off_y * off_y <= reach * reach;
}

static void mark_cells(const FigureBox *box, const Capsule *capsule, bool *cells)
{
    const double wide = (box->right - box->left) / CELLS, high = (box->bottom - box->top) / CELLS;
    if (!(wide > 0 && high > 0))
        return;
    const double least = fmax(wide, high) / 2;
    const double reach = fmax(fmax(capsule->radius[0], capsule->radius[1]), least);
    if (fmin(capsule->x[0], capsule->x[1]) - reach > box->right ||
        fmax(capsule->x[0], capsule->x[1]) + reach < box->left ||
        fmin(capsule->y[0], capsule->y[1]) - reach > box->bottom ||
        fmax(capsule->y[0], capsule->y[1]) + reach < box->top)
        return;
    for (int i = 0; i < CELLS * CELLS; i++)
        cells[i] |= contains(capsule, box->left + (i % CELLS + 0.5) * wide,
                             box->top + (i / CELLS + 0.5) * high, least);
}

/* Stores the number of cells of each of `n` boxes that vessels cover. */
static Status measure(const PlacedPicture *picture, const FigureBox *boxes, size_t n, int *covered,
                      Err *err)
{
    const size_t items = geometry_balls(&picture->scene->geometry) / 2;
    bool *cells = NULL;
    TRY(mem_calloc(&cells, n * CELLS * CELLS, sizeof *cells, "annotations", err));
    for (size_t item = 0; item < items; item++) {
        Capsule capsule;
        if (project(picture, item, &capsule))
            for (size_t i = 0; i < n; i++)
                mark_cells(&boxes[i], &capsule, cells + i * CELLS * CELLS);
    }
    for (size_t i = 0; i < n; i++) {
        covered[i] = 0;
        for (size_t k = 0; k < CELLS * CELLS; k++)
            covered[i] += cells[i * CELLS * CELLS + k];
    }
    free(cells);
    return STATUS_OK;
}

/* ---- corners --------------------------------------------------------------------------------- */

/* Returns true if the box has the picture in it, up to the rounding to pixels: 0.2 mm is more than
 * a pixel at 150 dpi. */
static bool holds(const FigureBox *box, const FigureBox *where)
{
    const double slack = 0.2;
    return box->left <= where->left + slack && box->right >= where->right - slack &&
           box->top <= where->top + slack && box->bottom >= where->bottom - slack;
}

/* Returns true if one of the first `n` items of the page is in the box. */
static bool is_taken(const FigurePage *page, size_t n, const FigureBox *where, const FigureBox *box)
{
    for (size_t i = 0; i < n; i++) {
        const FigureItem *item = &page->items[i];
        const bool open = item->kind == FIGURE_LINE && !item->closed;
        if (!open && !holds(&item->box, where) && figure_boxes_overlap(&item->box, box, 0))
            return true;
    }
    return false;
}

/* Returns where a box of this size is in a corner. */
static FigureBox box_in(const FigureBox *where, Corner corner, double width, double height,
                        double gap)
{
    const bool right = corner == CORNER_BOTTOM_RIGHT || corner == CORNER_TOP_RIGHT;
    const bool top = corner == CORNER_TOP_LEFT || corner == CORNER_TOP_RIGHT;
    const double x = right ? where->right - gap - width : where->left + gap;
    const double y = top ? where->top + gap : where->bottom - gap - height;
    return (FigureBox){x, y, x + width, y + height};
}

Status placing_move(FigurePage *page, size_t first, const PlacedPicture *picture, Corner corner,
                    double gap_mm, Err *err)
{
    const FigureBox group = figure_bounds(page, first);
    FigureBox boxes[CORNER_CHOICES];
    int covered[CORNER_CHOICES];
    for (int k = 0; k < CORNER_CHOICES; k++)
        boxes[k] = box_in(&picture->where, (Corner)k, group.right - group.left,
                          group.bottom - group.top, gap_mm);
    if (corner == CORNER_EMPTIEST) {
        TRY(measure(picture, boxes, CORNER_CHOICES, covered, err));
        corner = CORNER_BOTTOM_LEFT;
        for (int k = CORNER_BOTTOM_LEFT; k < CORNER_CHOICES; k++) {
            if (is_taken(page, first, &picture->where, &boxes[k]))
                covered[k] += CELLS * CELLS;
            if (covered[k] < covered[corner])
                corner = (Corner)k;
        }
    }
    figure_move(page, first, boxes[corner].left - group.left, boxes[corner].top - group.top);
    return STATUS_OK;
}

/* ---- halos ----------------------------------------------------------------------------------- */

/* Returns the part of a box that is in the picture. Its width or height is negative if there is
 * none. */
static FigureBox part_in(const FigureBox *where, const FigureBox *box)
{
    return (FigureBox){fmax(where->left, box->left), fmax(where->top, box->top),
                       fmin(where->right, box->right), fmin(where->bottom, box->bottom)};
}

Status placing_add_halos(FigurePage *page, size_t first, const PlacedPicture *picture,
                         double width_mm, Err *err)
{
    const FigureColor paper = annotation_color(picture->scene->view.background);
    const size_t n = page->n - first;
    FigureBox *boxes = NULL;
    int *covered = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&boxes, n, sizeof *boxes, "annotations", err));
    TRY_GOTO(mem_calloc(&covered, n, sizeof *covered, "annotations", err));
    for (size_t i = 0; i < n; i++)
        boxes[i] = part_in(&picture->where, &page->items[first + i].box);
    TRY_GOTO(measure(picture, boxes, n, covered, err));
    for (size_t i = 0; i < n; i++)
        if (covered[i] > 0)
            figure_set_halo(page, first + i, width_mm, paper);
done:
    free(boxes);
    free(covered);
    return status;
}
