/* Lays out the branches of a tree in rows.
 *
 * Branches are laid out from the last to the first, so that a branch comes after all branches that
 * descend from it. A laid out branch, with its descendants, is bounded by two contours: how far it
 * reaches above and below its row, as functions of the path length from the root. The daughters of
 * a branch are attached to the branch's own contours, beginning with the one that leaves last, each
 * as close as the contours allow, on the side where that is closer. Reingold & Tilford, IEEE Trans.
 * Softw. Eng. 7 (1981) 223-228, do this level by level. A daughter that leaves later begins farther
 * right, so the link to a daughter farther out crosses none farther in. A last pass from the roots
 * on adds up the rows.
 *
 * A contour is a list of steps from left to right. Heights are stored as differences, so that
 * raising a contour changes only its first step. When a branch is attached, its inner contour is
 * traversed once and dropped, and its outer contour replaces the traversed part of the row's
 * contour. All contours together therefore take O(n). */
#include "diagram/diagram.h"

#include "derive/derive.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char branch_field[] = "branch";

/* NONE: no index. UP and DOWN are the indices of LayoutBranch.contour. */
enum { NONE = -1, UP = 0, DOWN = 1 };

/* A step of a contour, from the end of the previous step, or from the beginning of the branch. */
typedef struct ContourStep {
    double to_mm;
    double rise_mm; /* height over the previous step, or over the row */
    int32_t next;   /* index of the next step; NONE: this is the last */
} ContourStep;

typedef struct Contour {
    int32_t first, last; /* indices of its steps */
    double last_mm;      /* height of the last step over the row */
} Contour;

typedef struct LayoutBranch {
    int32_t number;        /* index of the branch; its parent has a lower index */
    int32_t parent;        /* index of the parent branch; NONE: a root */
    int32_t first;         /* node at the end of the first segment */
    double from_mm, to_mm; /* path lengths from the root of its ends */
    double radius_mm;      /* largest radius of its segments */
    Contour contour[2];    /* upper and lower contour of the branch and its descendants; both end at
                              the same path length */
    double reach_mm[2];    /* largest heights of the contours */
    double offset_mm;      /* vertical distance of its row below the parent's row */
    int side;              /* UP or DOWN: where the row is relative to the parent's row */
    double row_mm;         /* distance of the row from the top */
} LayoutBranch;

typedef struct TreeLayout {
    const Tree *tree;
    double *path_mm;  /* per node: path length from the root */
    int32_t *of_node; /* per node: branch of its segment; NONE at roots */
    LayoutBranch *branch;
    size_t n;
    IndexLists daughters; /* list b + 1: the daughters of branch b, the last to leave first; list 0:
                           * the roots */
    /* At most 4 per branch: two of its own, one where it is attached, one at its end. */
    ContourStep *step;
    size_t n_steps;
    double gap_mm; /* space between rows */
} TreeLayout;

enum { STEPS_PER_BRANCH = 4 };

static void layout_release(TreeLayout *layout)
{
    free(layout->path_mm);
    free(layout->of_node);
    free(layout->branch);
    indexlists_release(&layout->daughters);
    free(layout->step);
}

/* Sets path_mm. A node comes after its parent. */
static Status find_paths(TreeLayout *layout, Err *err)
{
    const Tree *tree = layout->tree;
    TRY(mem_calloc(&layout->path_mm, tree->n, sizeof *layout->path_mm, "paths", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            layout->path_mm[i] = layout->path_mm[tree->parent[i]] + tree_segment_length(tree, i);
    return STATUS_OK;
}

/* Sets of_node and counts the branches. */
static Status number_branches(TreeLayout *layout, Err *err)
{
    const Tree *tree = layout->tree;
    Field field;
    TRY(mem_calloc(&layout->of_node, tree->n, sizeof *layout->of_node, "branches", err));
    TRY(derive_field(tree, &(TreeMeta){0}, branch_field, &field, err));
    for (size_t i = 0; i < tree->n; i++) {
        layout->of_node[i] = tree_is_segment(tree, i) ? (int32_t)field.value[i] - 1 : NONE;
        if (layout->of_node[i] >= (int32_t)layout->n)
            layout->n = (size_t)layout->of_node[i] + 1;
    }
    field_release(&field);
    return STATUS_OK;
}

/* Sets the first segment, the parent, the ends and the radius of each branch. */
static Status find_branches(TreeLayout *layout, Err *err)
{
    const Tree *tree = layout->tree;
    TRY(mem_calloc(&layout->branch, layout->n, sizeof *layout->branch, "branches", err));
    for (size_t b = 0; b < layout->n; b++)
        layout->branch[b] = (LayoutBranch){.number = (int32_t)b, .first = NONE};
    for (size_t i = 0; i < tree->n; i++) {
        if (layout->of_node[i] == NONE)
            continue;
        LayoutBranch *branch = &layout->branch[layout->of_node[i]];
        branch->radius_mm = fmax(branch->radius_mm, tree->radius_mm[i]);
        branch->to_mm = layout->path_mm[i];
        if (branch->first != NONE)
            continue;
        branch->first = (int32_t)i;
        branch->parent = layout->of_node[tree->parent[i]];
        branch->from_mm = layout->path_mm[tree->parent[i]];
    }
    return STATUS_OK;
}

/* Orders branches by parent. Branches of the same parent are ordered by the path length at which
 * they leave it, the last first. */
static int compare_branches(const void *a, const void *b)
{
    const LayoutBranch *one = a, *other = b;
    const int parent = compare_numbers(one->parent, other->parent);
    const int from = compare_numbers(other->from_mm, one->from_mm);
    return parent ? parent : from ? from : compare_numbers(one->number, other->number);
}

/* Lists the daughters of each branch. */
static Status sort_branches(TreeLayout *layout, Err *err)
{
    IndexLists *daughters = &layout->daughters;
    LayoutBranch *order = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&order, layout->n, sizeof *order, "branches", err));
    TRY_GOTO(indexlists_begin(daughters, layout->n + 1, "branches", err));
    memcpy(order, layout->branch, layout->n * sizeof *order);
    qsort(order, layout->n, sizeof *order, compare_branches);
    for (size_t k = 0; k < layout->n; k++)
        indexlists_count(daughters, (size_t)(order[k].parent + 1));
    TRY_GOTO(indexlists_allot(daughters, "branches", err));
    for (size_t k = 0; k < layout->n; k++)
        indexlists_put(daughters, (size_t)(order[k].parent + 1), (uint32_t)order[k].number);
done:
    free(order);
    return status;
}

static int32_t add_step(TreeLayout *layout, ContourStep step)
{
    layout->step[layout->n_steps] = step;
    return (int32_t)layout->n_steps++;
}

/* A position on a contour. */
typedef struct ContourWalk {
    int32_t step; /* NONE: after the end */
    double height_mm;
} ContourWalk;

/* Starts a walk along a contour, at its first step. */
static ContourWalk contourwalk_start(const TreeLayout *layout, const Contour *contour)
{
    return (ContourWalk){contour->first, layout->step[contour->first].rise_mm};
}

static void contourwalk_advance(const TreeLayout *layout, ContourWalk *walk)
{
    walk->step = layout->step[walk->step].next;
    if (walk->step != NONE)
        walk->height_mm += layout->step[walk->step].rise_mm;
}

/* Returns the end of the step; infinity after the end of the contour. */
static double contourwalk_end(const TreeLayout *layout, const ContourWalk *walk)
{
    return walk->step == NONE ? HUGE_VAL : layout->step[walk->step].to_mm;
}

/* Returns the distance between two rows. `contour` belongs to one row, `inner` to the other and
 * points towards it. The contours must be `gap_mm` apart, and nothing may cross the first row where
 * `contour` has ended. *behind becomes the position on `contour` at the end of `inner`. Both
 * contours are traversed together; each step of their union allows a distance, of which the largest
 * counts. */
static double row_distance(const TreeLayout *layout, const Contour *contour, const Contour *inner,
                           double gap_mm, ContourWalk *behind)
{
    double least = 0;
    ContourWalk outer = contourwalk_start(layout, contour), own = contourwalk_start(layout, inner);
    while (own.step != NONE) {
        double height = outer.step == NONE ? 0 : outer.height_mm;
        least = fmax(least, height + gap_mm + own.height_mm);
        double outer_to = contourwalk_end(layout, &outer), own_to = contourwalk_end(layout, &own);
        if (outer_to <= own_to)
            contourwalk_advance(layout, &outer);
        if (own_to <= outer_to)
            contourwalk_advance(layout, &own);
    }
    *behind = outer;
    return least;
}

/* Replaces `contour`, from where the branch leaves to where the branch ends, by the outer contour
 * of the branch, whose row is `height_mm` away. After it `contour` continues at `behind`. */
static void replace_contour(TreeLayout *layout, Contour *contour, const LayoutBranch *branch,
                            double height_mm, ContourWalk behind)
{
    const Contour *over = &branch->contour[branch->side];
    double row_mm = layout->step[contour->first].rise_mm;
    int32_t front = add_step(
        layout, (ContourStep){.to_mm = branch->from_mm, .rise_mm = row_mm, .next = over->first});
    double first_mm = layout->step[over->first].rise_mm;
    layout->step[over->first].rise_mm = height_mm + first_mm - row_mm;
    contour->first = front;
    layout->step[over->last].next = behind.step;
    if (behind.step == NONE) {
        contour->last = over->last;
        contour->last_mm = height_mm + over->last_mm;
    } else {
        layout->step[behind.step].rise_mm = behind.height_mm - (height_mm + over->last_mm);
    }
}

/* Attaches a branch to the row that it leaves, above or below, where its row is nearer. */
static void attach(TreeLayout *layout, LayoutBranch *row, LayoutBranch *branch, double gap_mm)
{
    ContourWalk behind[2];
    double height[2];
    for (int side = UP; side <= DOWN; side++)
        height[side] = row_distance(layout, &row->contour[side], &branch->contour[!side], gap_mm,
                                    &behind[side]);
    int side = height[DOWN] < height[UP] ? DOWN : UP;
    branch->side = side;
    branch->offset_mm = side == DOWN ? height[side] : -height[side];
    row->reach_mm[side] = fmax(row->reach_mm[side], height[side] + branch->reach_mm[side]);
    replace_contour(layout, &row->contour[side], branch, height[side], behind[side]);
}

/* Makes the contours of the branch without its daughters. */
static void begin_contours(TreeLayout *layout, LayoutBranch *branch)
{
    for (int side = UP; side <= DOWN; side++) {
        int32_t step = add_step(
            layout,
            (ContourStep){.to_mm = branch->to_mm, .rise_mm = branch->radius_mm, .next = NONE});
        branch->contour[side] = (Contour){step, step, branch->radius_mm};
        branch->reach_mm[side] = branch->radius_mm;
    }
}

/* Extends the shorter contour at the height of the row, below which everything on its other side
 * stays. */
static void end_contours(TreeLayout *layout, LayoutBranch *branch)
{
    double to[2];
    for (int side = UP; side <= DOWN; side++)
        to[side] = layout->step[branch->contour[side].last].to_mm;
    int shorter = to[DOWN] < to[UP] ? DOWN : UP;
    if (to[shorter] == to[!shorter])
        return;
    Contour *contour = &branch->contour[shorter];
    int32_t step = add_step(
        layout, (ContourStep){.to_mm = to[!shorter], .rise_mm = -contour->last_mm, .next = NONE});
    layout->step[contour->last].next = step;
    contour->last = step;
    contour->last_mm = 0;
}

/* Lays out all rows and returns the height of the diagram. The first loop attaches each branch to
 * its parent, the last branch first; the second adds up the distances of rows, from the roots on.
 */
static double lay_out_rows(TreeLayout *layout, double gap_mm)
{
    double height = 0;
    layout->n_steps = 0;
    for (size_t b = layout->n; b-- > 0;) {
        LayoutBranch *own = &layout->branch[b];
        begin_contours(layout, own);
        const uint32_t *first = layout->daughters.first + b + 1;
        for (uint32_t k = first[0]; k < first[1]; k++)
            attach(layout, own, &layout->branch[layout->daughters.items[k]], gap_mm);
        end_contours(layout, own);
    }
    for (size_t b = 0; b < layout->n; b++) {
        LayoutBranch *own = &layout->branch[b];
        if (own->parent != NONE) {
            own->row_mm = layout->branch[own->parent].row_mm + own->offset_mm;
            continue;
        }
        height += height > 0 ? gap_mm : 0;
        own->row_mm = height + own->reach_mm[UP];
        height = own->row_mm + own->reach_mm[DOWN];
    }
    return height;
}

static double widest_mm(const TreeLayout *layout)
{
    double width = 0;
    for (size_t i = 0; i < layout->tree->n; i++)
        width = fmax(width, layout->path_mm[i]);
    return width;
}

/* Computes the median diameter of the terminals, which are the last segments of branches. */
static Status default_gap_mm(const TreeLayout *layout, double *gap_mm, Err *err)
{
    const Tree *tree = layout->tree;
    double *diameter;
    TRY(mem_calloc(&diameter, layout->n, sizeof *diameter, "diameters", err));
    for (size_t i = 0; i < tree->n; i++)
        if (layout->of_node[i] != NONE)
            diameter[layout->of_node[i]] = 2 * tree->radius_mm[i];
    sort_numbers(diameter, layout->n);
    *gap_mm = diameter[layout->n / 2];
    free(diameter);
    return STATUS_OK;
}

/* Chooses the gap for which the diagram would have the wanted height, if its height grew linearly
 * with the gap. */
static Status choose_gap(TreeLayout *layout, double *gap_mm, Err *err)
{
    double least, wanted = DIAGRAM_ASPECT * widest_mm(layout);
    TRY(default_gap_mm(layout, &least, err));
    double height = lay_out_rows(layout, least), growth = lay_out_rows(layout, 2 * least) - height;
    *gap_mm = least;
    if (growth > 0 && wanted > height)
        *gap_mm += (wanted - height) / growth * least;
    return STATUS_OK;
}

/* Returns the link from the edge of the parent's bar to the edge of the first bar of the branch. A
 * link is a quarter as wide as that bar. */
static FigureBar link_to(const TreeLayout *layout, const LayoutBranch *branch)
{
    const Tree *tree = layout->tree;
    int32_t from = tree->parent[branch->first];
    double half = tree->radius_mm[branch->first] / 4;
    const LayoutBranch *parent = &layout->branch[branch->parent];
    double start = parent->row_mm, end = branch->row_mm, own = tree->radius_mm[branch->first];
    double x = layout->path_mm[from], edge = tree->radius_mm[from];
    FigureBar bar = {.x = {x, x + 2 * half}, .index = branch->first};
    bar.y[0] = branch->side == DOWN ? start + edge : end + own;
    bar.y[1] = branch->side == DOWN ? end - own : start - edge;
    return bar;
}

/* Returns the bar of a segment: its length along x, its diameter along y. */
static FigureBar bar_of(const TreeLayout *layout, size_t node)
{
    const Tree *tree = layout->tree;
    double row = layout->branch[layout->of_node[node]].row_mm, radius = tree->radius_mm[node];
    return (FigureBar){.x = {layout->path_mm[tree->parent[node]], layout->path_mm[node]},
                       .y = {row - radius, row + radius},
                       .index = (int32_t)node};
}

/* Returns the cross bar at the end of a segment that closes a loop. It extends beyond the segment
 * by at most a third of the space between rows, so that the cross bars of two neighbouring rows do
 * not touch. */
static FigureBar cross_of(const TreeLayout *layout, size_t node)
{
    FigureBar bar = bar_of(layout, node);
    const double radius = layout->tree->radius_mm[node];
    const double beyond = fmin(radius, layout->gap_mm / 3);
    bar.x[0] = fmax(bar.x[0], bar.x[1] - radius / 2);
    bar.y[0] -= beyond;
    bar.y[1] += beyond;
    return bar;
}

static Status make_bars(const TreeLayout *layout, Diagram *diagram, Err *err)
{
    TRY(mem_calloc(&diagram->bar, layout->n + 2 * layout->tree->n, sizeof *diagram->bar, "bars",
                   err));
    for (size_t b = 0; b < layout->n; b++)
        if (layout->branch[b].parent != NONE)
            diagram->bar[diagram->n_links++] = link_to(layout, &layout->branch[b]);
    diagram->n = diagram->n_links;
    for (size_t i = 0; i < layout->tree->n; i++)
        if (tree_has_link(layout->tree, i) && tree_segment_length(layout->tree, i) > 0)
            diagram->bar[diagram->n++] = cross_of(layout, i);
    diagram->n_crosses = diagram->n - diagram->n_links;
    for (size_t i = 0; i < layout->tree->n; i++)
        if (layout->of_node[i] != NONE && tree_segment_length(layout->tree, i) > 0)
            diagram->bar[diagram->n++] = bar_of(layout, i);
    diagram->width_mm = widest_mm(layout);
    return STATUS_OK;
}

Status diagram_lay_out(const Tree *tree, double gap_mm, Diagram *diagram, Err *err)
{
    TreeLayout layout = {.tree = tree};
    Diagram made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(find_paths(&layout, err));
    if (!(widest_mm(&layout) > 0)) {
        status = err_set(err, STATUS_INPUT,
                         "all segments have length 0; a diagram needs at least one with a length");
        goto done;
    }
    TRY_GOTO(number_branches(&layout, err));
    TRY_GOTO(find_branches(&layout, err));
    TRY_GOTO(sort_branches(&layout, err));
    TRY_GOTO(
        mem_calloc(&layout.step, STEPS_PER_BRANCH * layout.n, sizeof *layout.step, "steps", err));
    if (!(gap_mm > 0))
        TRY_GOTO(choose_gap(&layout, &gap_mm, err));
    layout.gap_mm = gap_mm;
    made.height_mm = lay_out_rows(&layout, gap_mm);
    TRY_GOTO(make_bars(&layout, &made, err));
    *diagram = made;
done:
    layout_release(&layout);
    return status;
}

void diagram_release(Diagram *diagram)
{
    free(diagram->bar);
    *diagram = (Diagram){0};
}
