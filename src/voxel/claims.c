/* Reserves one voxel for each label.
 *
 * The assignment of voxels to labels is a bipartite matching. A label is said to hold its voxel.
 *
 * First, a label holds a voxel that it fills most of. The voxels that its axes pass are tried
 * first, from the middle of each axis on, then the voxels next to them. A label that fills most of
 * no such voxel then takes a voxel that no label holds, or a voxel whose holder can move to another
 * one. These are augmenting paths [Kuhn, Naval Research Logistics Quarterly 2 (1955) 83-97], so a
 * label gets no voxel only if there are more labels than voxels for them. A voxel that is held
 * stays held, possibly by another label. */
#include "voxel/claims.h"

#include <stdlib.h>

/* The axis of a vessel, as the index of its cylinder, and the vessel's label. */
typedef struct ClaimAxis {
    uint32_t label, body;
} ClaimAxis;

/* A voxel that a label holds. */
typedef struct Held {
    int64_t voxel;
    size_t label; /* index of the label's first axis in Claimer.axes */
    size_t visit; /* number of the last search that tried to move the label */
} Held;

typedef ARRAY(int64_t) VoxelList;

typedef struct Claimer {
    const RowSource *source;
    ClaimAxis *axes; /* by rising label */
    size_t n_axes;
    ARRAY(Held) held;
    KeyMap by_voxel; /* voxel -> index in `held` */
    size_t visit;    /* number of the current search */
    BodyList near;
    VoxelList path;
} Claimer;

/* Maximum length of an augmenting path, which bounds the depth of the recursion. A path of 64 moves
 * crosses a crowd of 64 labels; if no shorter path exists, the label is refused, although a longer
 * path could exist. */
enum { MAX_MOVES = 64 };

/* ---- voxels along an axis -------------------------------------------------------------------- */

static Status push_voxel(const VoxelGrid *grid, const int64_t at[3], VoxelList *list, Err *err)
{
    return ARRAY_PUSH(list, "voxels", err, (at[2] * grid->n[1] + at[1]) * grid->n[0] + at[0]);
}

/* Lists the voxels that the axis passes, from its start to its end. */
static Status list_axis(const VoxelGrid *grid, const Body *body, VoxelList *list, Err *err)
{
    Vec3 end = vec3_add_scaled(body->start, body->axis, body->length);
    int64_t at[3], last[3], left = 0;
    double next[3], step[3];
    for (int axis = 0; axis < 3; axis++) {
        double start = vec3_component(body->start, axis), mm = vec3_component(grid->step, axis);
        double rise = vec3_component(body->axis, axis);
        at[axis] = grid_index(grid, axis, start);
        last[axis] = grid_index(grid, axis, vec3_component(end, axis));
        left += llabs(last[axis] - at[axis]);
        double face =
            vec3_component(grid->first, axis) + ((double)at[axis] + (rise > 0 ? 0.5 : -0.5)) * mm;
        next[axis] = (face - start) / rise;
        step[axis] = mm / fabs(rise);
    }
    list->n = 0;
    TRY(push_voxel(grid, at, list, err));
    for (; left > 0; left--) {
        int axis = -1;
        for (int i = 0; i < 3; i++)
            if (at[i] != last[i] && (axis < 0 || next[i] < next[axis]))
                axis = i;
        at[axis] += last[axis] > at[axis] ? 1 : -1;
        next[axis] += step[axis];
        TRY(push_voxel(grid, at, list, err));
    }
    return STATUS_OK;
}

static VoxelCell numbered_cell(const VoxelGrid *grid, int64_t voxel)
{
    int64_t row = voxel / grid->n[0];
    return grid_cell(grid, voxel % grid->n[0], row % grid->n[1], row / grid->n[1]);
}

/* Appends the neighbours of a voxel that the body fills at least in part. Every voxel that a body
 * meets has neighbours on all sides, because the grid has a margin. */
static Status list_neighbours(const VoxelGrid *grid, const Body *body, int64_t voxel,
                              VoxelList *list, Err *err)
{
    for (int i = 0; i < 27; i++) {
        int64_t row = voxel / grid->n[0];
        const int64_t at[3] = {voxel % grid->n[0] + i % 3 - 1, row % grid->n[1] + i / 3 % 3 - 1,
                               row / grid->n[1] + i / 9 - 1};
        VoxelCell cell = grid_cell(grid, at[0], at[1], at[2]);
        if (i != 13 && body_meets(body, &cell) && body_fraction(body, &cell) > 0)
            TRY(push_voxel(grid, at, list, err));
    }
    return STATUS_OK;
}

/* Lists the voxels that a label may hold for a body: first the voxels that the body's axis passes,
 * from its middle on; then, if `about` is true, the neighbours of these voxels. */
static Status list_voxels(Claimer *claimer, const Body *body, bool about, VoxelList *list, Err *err)
{
    const VoxelGrid *grid = claimer->source->grid;
    VoxelList *path = &claimer->path;
    TRY(list_axis(grid, body, path, err));
    list->n = 0;
    TRY(ARRAY_RESERVE(list, path->n, "voxels", err));
    for (; list->n < path->n; list->n++)
        list->items[list->n] = path->items[(path->n / 2 + list->n) % path->n];
    for (size_t i = 0; i < path->n && about; i++)
        TRY(list_neighbours(grid, body, list->items[i], list, err));
    return STATUS_OK;
}

/* Sets *label to the label of the segment that fills most of a voxel, or to 0 if the voxel is
 * empty. */
static Status find_owner(Claimer *claimer, int64_t voxel, uint32_t *label, Err *err)
{
    const RowSource *source = claimer->source;
    const VoxelGrid *grid = source->grid;
    VoxelCell cell = numbered_cell(grid, voxel);
    BodyList *near = &claimer->near;
    TRY(bodies_in(source->bodies, cell_box(&cell), near, err));
    *label = near->n ? source->labels[cell_owner(source->bodies, near->items, near->n, &cell)] : 0;
    return STATUS_OK;
}

/* ---- the table ------------------------------------------------------------------------------- */

/* Returns the entry of a voxel, or NULL if no label holds it. Borrowed until the next hold. */
static Held *find_held(const Claimer *claimer, int64_t voxel)
{
    const uint32_t *index = keymap_find(&claimer->by_voxel, (uint64_t)voxel);
    return index ? &claimer->held.items[*index] : NULL;
}

/* Lets a label, given by its first axis, hold a voxel that no label holds. */
static Status hold(Claimer *claimer, int64_t voxel, size_t first, Err *err)
{
    uint32_t *index;
    bool is_new;
    TRY(keymap_put(&claimer->by_voxel, (uint64_t)voxel, &index, &is_new, err));
    *index = (uint32_t)claimer->held.n;
    return ARRAY_PUSH(&claimer->held, "labels", err, (Held){voxel, first, claimer->visit});
}

static int compare_labels(const void *a, const void *b)
{
    const ClaimAxis *first = a, *second = b;
    if (first->label != second->label)
        return first->label < second->label ? -1 : 1;
    return (first->body > second->body) - (first->body < second->body);
}

/* Lists the axes by label, and reserves the table. */
static Status claimer_init(Claimer *claimer, Err *err)
{
    const Bodies *bodies = claimer->source->bodies;
    TRY(mem_calloc(&claimer->axes, bodies->n, sizeof *claimer->axes, "vessels", err));
    for (uint32_t i = 0; i < bodies->n; i++)
        if (!body_is_ball(&bodies->body[i]))
            claimer->axes[claimer->n_axes++] =
                (ClaimAxis){claimer->source->labels[bodies->body[i].segment], i};
    qsort(claimer->axes, claimer->n_axes, sizeof *claimer->axes, compare_labels);
    return keymap_begin(&claimer->by_voxel, claimer->n_axes, "labels", err);
}

static void claimer_release(Claimer *claimer)
{
    free(claimer->axes);
    ARRAY_RELEASE(&claimer->held);
    keymap_release(&claimer->by_voxel);
    ARRAY_RELEASE(&claimer->near);
    ARRAY_RELEASE(&claimer->path);
}

/* ---- assignment ------------------------------------------------------------------------------ */

static const Body *axis_body(const Claimer *claimer, size_t axis)
{
    return &claimer->source->bodies->body[claimer->axes[axis].body];
}

static bool has_label_of(const Claimer *claimer, size_t axis, size_t first)
{
    return axis < claimer->n_axes && claimer->axes[axis].label == claimer->axes[first].label;
}

/* Lets a label, given by its first axis, hold a voxel that it fills most of. *done receives false
 * if there is none. */
static Status hold_filled_voxel(Claimer *claimer, size_t first, bool about, bool *done, Err *err)
{
    VoxelList list = {0};
    Status status = STATUS_OK;
    *done = false;
    for (size_t axis = first; !*done && has_label_of(claimer, axis, first); axis++) {
        TRY_GOTO(list_voxels(claimer, axis_body(claimer, axis), about, &list, err));
        for (size_t i = 0; i < list.n && !*done; i++) {
            uint32_t owner;
            TRY_GOTO(find_owner(claimer, list.items[i], &owner, err));
            *done = owner == claimer->axes[first].label;
            if (*done)
                TRY_GOTO(hold(claimer, list.items[i], first, err));
        }
    }
done:
    ARRAY_RELEASE(&list);
    return status;
}

static Status hold_any(Claimer *claimer, size_t first, int moves, bool *done, Err *err);

/* Lets the label hold one of the listed voxels: a voxel that no label holds, or one whose holder
 * can move to another voxel. */
static Status hold_one_of(Claimer *claimer, const VoxelList *list, size_t first, int moves,
                          bool *done, Err *err)
{
    for (size_t i = 0; i < list->n && !*done; i++) {
        *done = !find_held(claimer, list->items[i]);
        if (*done)
            TRY(hold(claimer, list->items[i], first, err));
    }
    for (size_t i = 0; i < list->n && !*done && moves < MAX_MOVES; i++) {
        Held *held = find_held(claimer, list->items[i]);
        if (held->visit == claimer->visit)
            continue;
        held->visit = claimer->visit;
        TRY(hold_any(claimer, held->label, moves + 1, done, err));
        if (*done)
            find_held(claimer, list->items[i])->label = first;
    }
    return STATUS_OK;
}

static Status hold_any(Claimer *claimer, size_t first, int moves, bool *done, Err *err)
{
    VoxelList list = {0};
    Status status = STATUS_OK;
    *done = false;
    for (size_t axis = first; !*done && has_label_of(claimer, axis, first); axis++) {
        TRY_GOTO(list_voxels(claimer, axis_body(claimer, axis), true, &list, err));
        TRY_GOTO(hold_one_of(claimer, &list, first, moves, done, err));
    }
done:
    ARRAY_RELEASE(&list);
    return status;
}

/* Sets the error that a label gets no voxel. */
static Status no_voxel(const Claimer *claimer, const Geometry *geometry, size_t axis, Err *err)
{
    Vec3 step = claimer->source->grid->step;
    const Body *body = axis_body(claimer, axis);
    return err_set(err, STATUS_INFEASIBLE,
                   "`voxel` %g x %g x %g mm: segment %u, %.3g mm long, has no voxel for its label, "
                   "because other labels need every voxel that it touches; use smaller voxels",
                   step.x, step.y, step.z, (unsigned)geometry->ids[body->segment], body->length);
}

/* Lets every label hold a voxel: first the labels that fill most of a voxel, then the others, whose
 * number is added to *taken. */
static Status hold_all(Claimer *claimer, const Geometry *geometry, size_t *taken, Err *err)
{
    uint8_t *lack;
    Status status = STATUS_OK;
    TRY(mem_calloc(&lack, claimer->n_axes, 1, "labels", err));
    claimer->visit = 1;
    for (size_t axis = 0; axis < claimer->n_axes; axis++) {
        bool done = axis > 0 && has_label_of(claimer, axis, axis - 1);
        for (int about = 0; about < 2 && !done; about++)
            TRY_GOTO(hold_filled_voxel(claimer, axis, about, &done, err));
        lack[axis] = !done;
    }
    for (size_t axis = 0; axis < claimer->n_axes; axis++) {
        bool done = true;
        claimer->visit++;
        if (lack[axis])
            TRY_GOTO(hold_any(claimer, axis, 0, &done, err));
        if (!done)
            TRY_GOTO(no_voxel(claimer, geometry, axis, err));
        *taken += lack[axis];
    }
done:
    free(lack);
    return status;
}

static int compare_voxels(const void *a, const void *b)
{
    const Claim *first = a, *second = b;
    return (first->voxel > second->voxel) - (first->voxel < second->voxel);
}

Status claims_make(const RowSource *source, const Geometry *geometry, Claims *out, Err *err)
{
    Claimer claimer = {.source = source};
    Claims made = {0};
    Status status;
    TRY_GOTO(claimer_init(&claimer, err));
    TRY_GOTO(hold_all(&claimer, geometry, &made.n_taken, err));
    TRY_GOTO(mem_calloc(&made.claim, claimer.n_axes, sizeof *made.claim, "labels", err));
    for (; made.n < claimer.held.n; made.n++) {
        const Held *held = &claimer.held.items[made.n];
        made.claim[made.n] = (Claim){held->voxel, claimer.axes[held->label].label};
    }
    qsort(made.claim, made.n, sizeof *made.claim, compare_voxels);
    *out = made;
done:
    claimer_release(&claimer);
    return status;
}

void claims_release(Claims *claims)
{
    free(claims->claim);
    *claims = (Claims){0};
}

size_t claims_first_at(const Claims *claims, int64_t voxel)
{
    size_t low = 0, high = claims->n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (claims->claim[middle].voxel < voxel)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
