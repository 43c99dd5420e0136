/* Branches are placed from the last to the first, which are their ancestors: when a branch's turn
 * comes, the branches that leave it are laid out with all that hangs on them, each between two
 * contours, how far it reaches up and down from its row as a function of the path from the root.
 * They are set onto the branch's own contours from the last to leave it to the first, each as near
 * as the contours allow and on the side where that is nearer [as Reingold & Tilford, IEEE Trans.
 * Softw. Eng. 7 (1981) 223-228, do level by level]. What leaves later begins farther right, so that
 * a link to a branch farther out crosses none farther in. A last pass from the roots on adds the
 * rows up.
 *
 * A contour is a list of steps from left to right whose heights are kept as differences, so that it
 * is raised at its first step alone. Of a branch that is set onto another the inner contour is
 * walked along once and dropped, and the outer one covers what it was walked along, so that all
 * contours together take O(n). */
#include "diagram/diagram.h"

#include "derive/derive.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char branch_field[] = "branch";

enum { NONE = -1, UP = 0, DOWN = 1 };

/* From the end of the step before, or where the branch begins, on. */
typedef struct ContourStep {
    double to_mm;
    double rise_mm; /* over the step before; of the first over the branch's row */
    int32_t next;   /* NONE: it is the last */
} ContourStep;

typedef struct Contour {
    int32_t first, last;
    double last_mm; /* height of the last step over the row */
} Contour;

typedef struct LayoutBranch {
    int32_t number;        /* the branch, from 0 on: what it leaves has a lower number */
    int32_t parent;        /* the branch that it leaves; NONE of a root */
    int32_t first;         /* node: its first segment */
    double from_mm, to_mm; /* paths from the root */
    double radius_mm;      /* of its thickest segment */
    Contour contour[2];    /* of all that hangs on it, both to the same end */
    double reach_mm[2];    /* their largest heights */
    double offset_mm;      /* of its row, down from the row it leaves */
    int side;              /* of that row */
    double row_mm;         /* from the top */
} LayoutBranch;

typedef struct TreeLayout {
    const Tree *tree;
    double *path_mm;  /* from the root to each node */
    int32_t *of_node; /* the branch of each segment, NONE at roots */
    LayoutBranch *branch;
    size_t n;
    /* The branches that leave branch b are leaving[begin[b + 1]] up to leaving[begin[b + 2] - 1],
     * the last to leave first; those of roots begin with 0. */
    int32_t *leaving;
    size_t *begin;
    ContourStep
        *step; /* at most 4 a branch: two of its own, one where it is set on, one at its end */
    size_t n_steps;
} TreeLayout;

enum { STEPS_A_BRANCH = 4 };

static void layout_release(TreeLayout *layout)
{
    free(layout->path_mm);
    free(layout->of_node);
    free(layout->branch);
    free(layout->leaving);
    free(layout->begin);
    free(layout->step);
}

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

/* By what they leave; of those the last to leave first. */
static int compare_branches(const void *a, const void *b)
{
    const LayoutBranch *p = a, *q = b;
    if (p->parent != q->parent)
        return p->parent < q->parent ? -1 : 1;
    if (p->from_mm != q->from_mm)
        return p->from_mm > q->from_mm ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

/* Fills `leaving` and `begin`. */
static Status sort_branches(TreeLayout *layout, Err *err)
{
    LayoutBranch *order = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&order, layout->n, sizeof *order, "branches", err));
    TRY_GOTO(mem_calloc(&layout->leaving, layout->n, sizeof *layout->leaving, "branches", err));
    TRY_GOTO(mem_calloc(&layout->begin, layout->n + 2, sizeof *layout->begin, "branches", err));
    memcpy(order, layout->branch, layout->n * sizeof *order);
    qsort(order, layout->n, sizeof *order, compare_branches);
    for (size_t k = 0; k < layout->n; k++) {
        layout->leaving[k] = order[k].number;
        layout->begin[order[k].parent + 2]++;
    }
    for (size_t b = 1; b < layout->n + 2; b++)
        layout->begin[b] += layout->begin[b - 1];
done:
    free(order);
    return status;
}

static int32_t add_step(TreeLayout *layout, ContourStep step)
{
    layout->step[layout->n_steps] = step;
    return (int32_t)layout->n_steps++;
}

/* A place on a contour. */
typedef struct ContourWalk {
    int32_t step; /* NONE behind the end */
    double height_mm;
} ContourWalk;

static ContourWalk walk_from(const TreeLayout *layout, const Contour *contour)
{
    return (ContourWalk){contour->first, layout->step[contour->first].rise_mm};
}

static void walk_on(const TreeLayout *layout, ContourWalk *walk)
{
    walk->step = layout->step[walk->step].next;
    if (walk->step != NONE)
        walk->height_mm += layout->step[walk->step].rise_mm;
}

/* Where the step ends; infinity behind the end. */
static double walk_to(const TreeLayout *layout, const ContourWalk *walk)
{
    return walk->step == NONE ? HUGE_VAL : layout->step[walk->step].to_mm;
}

/* How far from the row of `contour` a row has to be whose contour towards it is `inner`, so that
 * they are `gap_mm` apart, and so that nothing crosses the row where `contour` has ended; in
 * *behind where `contour` goes on behind the end of `inner`. */
static double distance(const TreeLayout *layout, const Contour *contour, const Contour *inner,
                       double gap_mm, ContourWalk *behind)
{
    double least = 0;
    ContourWalk outer = walk_from(layout, contour), own = walk_from(layout, inner);
    while (own.step != NONE) {
        double height = outer.step == NONE ? 0 : outer.height_mm;
        least = fmax(least, height + gap_mm + own.height_mm);
        double outer_to = walk_to(layout, &outer), own_to = walk_to(layout, &own);
        if (outer_to <= own_to)
            walk_on(layout, &outer);
        if (own_to <= outer_to)
            walk_on(layout, &own);
    }
    *behind = outer;
    return least;
}

/* Puts the contour of a branch, `height_mm` above the row, over the beginning of `contour` from the
 * place where the branch leaves to its end, behind which `contour` goes on at `behind`. */
static void cover(TreeLayout *layout, Contour *contour, const LayoutBranch *branch,
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

/* Sets a branch beside the row that it leaves. */
static void set_on(TreeLayout *layout, LayoutBranch *row, LayoutBranch *branch, double gap_mm)
{
    ContourWalk behind[2];
    double height[2];
    for (int side = UP; side <= DOWN; side++)
        height[side] =
            distance(layout, &row->contour[side], &branch->contour[!side], gap_mm, &behind[side]);
    int side = height[DOWN] < height[UP] ? DOWN : UP;
    branch->side = side;
    branch->offset_mm = side == DOWN ? height[side] : -height[side];
    row->reach_mm[side] = fmax(row->reach_mm[side], height[side] + branch->reach_mm[side]);
    cover(layout, &row->contour[side], branch, height[side], behind[side]);
}

/* The contours of the branch's own bars. */
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

/* Leads the shorter contour on, at the height of the row, which all on its other side keeps below.
 */
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

/* The height of the diagram whose rows are `gap_mm` apart. */
static double place(TreeLayout *layout, double gap_mm)
{
    double height = 0;
    layout->n_steps = 0;
    for (size_t b = layout->n; b-- > 0;) {
        LayoutBranch *own = &layout->branch[b];
        begin_contours(layout, own);
        for (size_t k = layout->begin[b + 1]; k < layout->begin[b + 2]; k++)
            set_on(layout, own, &layout->branch[layout->leaving[k]], gap_mm);
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

/* The median diameter of the terminals, which are the last segments of branches. */
static Status least_gap_mm(const TreeLayout *layout, double *gap_mm, Err *err)
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

/* The gap of the wanted height, as far as the height grows with the gap as it does at first. */
static Status choose_gap(TreeLayout *layout, double *gap_mm, Err *err)
{
    double least, wanted = DIAGRAM_ASPECT * widest_mm(layout);
    TRY(least_gap_mm(layout, &least, err));
    double height = place(layout, least), growth = place(layout, 2 * least) - height;
    *gap_mm = least;
    if (growth > 0 && wanted > height)
        *gap_mm += (wanted - height) / growth * least;
    return STATUS_OK;
}

/* From the edge of the bar that the branch leaves to that of its own first one; a link has a
 * quarter of the width of what it leads to. */
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

static FigureBar bar_of(const TreeLayout *layout, size_t node)
{
    const Tree *tree = layout->tree;
    double row = layout->branch[layout->of_node[node]].row_mm, radius = tree->radius_mm[node];
    return (FigureBar){.x = {layout->path_mm[tree->parent[node]], layout->path_mm[node]},
                       .y = {row - radius, row + radius},
                       .index = (int32_t)node};
}

static Status make_bars(const TreeLayout *layout, Diagram *diagram, Err *err)
{
    TRY(mem_calloc(&diagram->bar, layout->n + layout->tree->n, sizeof *diagram->bar, "bars", err));
    for (size_t b = 0; b < layout->n; b++)
        if (layout->branch[b].parent != NONE)
            diagram->bar[diagram->n_links++] = link_to(layout, &layout->branch[b]);
    diagram->n = diagram->n_links;
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
        status = err_set(err, STATUS_INPUT, "no segment has a length");
        goto done;
    }
    TRY_GOTO(number_branches(&layout, err));
    TRY_GOTO(find_branches(&layout, err));
    TRY_GOTO(sort_branches(&layout, err));
    TRY_GOTO(
        mem_calloc(&layout.step, STEPS_A_BRANCH * layout.n, sizeof *layout.step, "steps", err));
    if (!(gap_mm > 0))
        TRY_GOTO(choose_gap(&layout, &gap_mm, err));
    made.height_mm = place(&layout, gap_mm);
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
