/* One call of Vessel_Blob for each segment. Space is halved, along the longest side of a box each
 * time, until few segments reach into a box; each box is a blob of its own, clipped to the box,
 * because POV-Ray loses precision with the number of components along a ray and the way between
 * them [docs/POVRAY.md section 9].
 *
 * Where segments differ in what they are painted with, a pigment finds out which term is largest at
 * a point: POV-Ray's own blending of a blob's textures is by strength and never lets one segment
 * win. Its function is a hierarchy of boxes, written as functions that call each other and look
 * only into boxes that hold the point. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

#include <stdlib.h>

/* A pigment map holds 256 entries, and so does a color map: two of them in one another count
 * on. */
enum { GROUP = 256, MAX_PAINTED = GROUP * GROUP, LEAF = 4 };

/* How many segments a cell holds at most, unless halving it would leave most of them in both
 * halves. */
enum { CELL = 128 };

/* POV-Ray's time for a ray grows with the square of the segments that it passes: where CROWD
 * overlap, which is looked for about PROBES of a cell's segments, a picture takes minutes. */
enum { CROWD = 64, PROBES = 64 };

/* Cells reach into their neighbours, so that no ray slips between them. */
static const double overlap_mm = 1e-3;

/* Where a segment is felt; `reach` is blob_reach. */
static Box reach_of(const FieldSegment *segment, double reach)
{
    double mm = reach * segment->radius_mm;
    return box_with_ball(box_with_ball(box_empty(), segment->a, mm), segment->b, mm);
}

/* ---- cells ----------------------------------------------------------------------------------- */

typedef struct BlobCells {
    const Scene *scene;
    const RayVolume *volume; /* cells that it does not meet are left out */
    Text *text;              /* where the others are written to, or NULL */
    bool *is_met;            /* where the segments of the others are marked, or NULL */
    double reach;            /* of all segments, over their radius */
    uint32_t *lists; /* a stack: the segments of both halves of a cell follow those of the cell */
    size_t room;
    size_t written; /* none when all is one blob */
} BlobCells;

/* A list of segments on the stack of cells. */
typedef struct CellList {
    size_t first, n;
} CellList;

/* How many segments of a list are felt at x. */
static size_t count_felt(const BlobCells *cells, const uint32_t *list, size_t n, Vec3 x)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += blob_term(&cells->scene->geometry.segments[list[i]], x) != 0;
    return count;
}

static Status check_crowd(const BlobCells *cells, const uint32_t *list, size_t n, Err *err)
{
    if (n <= CROWD)
        return STATUS_OK;
    for (size_t i = 0; i < n; i += n / PROBES) {
        const FieldSegment *segment = &cells->scene->geometry.segments[list[i]];
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        size_t felt = count_felt(cells, list, n, middle);
        if (felt > CROWD)
            return err_set(
                err, STATUS_INFEASIBLE,
                "%zu segments overlap at (%.6g, %.6g, %.6g), too many for POV-Ray to draw a blob "
                "in reasonable time; leave out thin ones (`prune_radius`) or choose another model",
                felt, middle.x, middle.y, middle.z);
    }
    return STATUS_OK;
}

/* Writes the blob of the segments of a list, clipped to a box or whole. */
static Status put_cell(BlobCells *cells, CellList from, const Box *clip, Err *err)
{
    Text *text = cells->text;
    const uint32_t *list = cells->lists + from.first;
    const size_t n = from.n;
    if (n * BLOB_POVRAY_COMPONENTS >= BLOB_POVRAY_LIMIT)
        return err_set(err, STATUS_INFEASIBLE,
                       "%zu segments overlap at one point, more than POV-Ray can draw in one blob; "
                       "leave out thin ones (`prune_radius`) or choose another model",
                       n);
    TRY(check_crowd(cells, list, n, err));
    text_puts(text, clip ? "Blob_Cell()\n" : "Blob_Start()\n");
    for (size_t i = 0; i < n; i++) {
        const FieldSegment *segment = &cells->scene->geometry.segments[list[i]];
        put_text(text, "Vessel_Blob(<%v>,<%v>,%n)\n", segment->a, segment->b, segment->radius_mm);
    }
    if (!clip) {
        text_puts(text, "Blob_Paint()\n");
        return STATUS_OK;
    }
    Vec3 pad = vec3(overlap_mm, overlap_mm, overlap_mm);
    put_text(text, "Blob_Cell_End(<%v>,<%v>)\n", vec3_sub(clip->low, pad),
             vec3_add(clip->high, pad));
    cells->written++;
    return STATUS_OK;
}

/* The segments of a list that reach into the box, put on the stack at `top`. */
static CellList take_those_in(const BlobCells *cells, CellList from, size_t top, Box box)
{
    const FieldSegment *segments = cells->scene->geometry.segments;
    const uint32_t *list = cells->lists + from.first;
    CellList taken = {top, 0};
    for (size_t i = 0; i < from.n; i++)
        if (box_meets(reach_of(&segments[list[i]], cells->reach), box))
            cells->lists[top + taken.n++] = list[i];
    return taken;
}

/* The two halves of a cell. */
typedef struct CellHalves {
    Box box[2];
    CellList list[2];
    bool is_cut; /* whether they are cells */
} CellHalves;

/* Halves a box into which the segments of a list reach, with the stack's end at `top`, unless
 * few do or most would reach into both halves. */
static Status halve(BlobCells *cells, CellList list, size_t top, Box box, CellHalves *out, Err *err)
{
    *out = (CellHalves){.box = {box, box}};
    if (list.n <= CELL)
        return STATUS_OK;
    TRY(mem_reserve(&cells->lists, &cells->room, top + 2 * list.n, sizeof *cells->lists, "cells",
                    err));
    Box *half = out->box;
    Vec3 middle = box_center(box);
    int axis = box_longest_axis(box);
    if (axis == 0)
        half[0].high.x = half[1].low.x = middle.x;
    else if (axis == 1)
        half[0].high.y = half[1].low.y = middle.y;
    else
        half[0].high.z = half[1].low.z = middle.z;
    out->list[0] = take_those_in(cells, list, top, half[0]);
    out->list[1] = take_those_in(cells, list, top + out->list[0].n, half[1]);
    out->is_cut = 2 * (out->list[0].n + out->list[1].n) <= 3 * list.n;
    return STATUS_OK;
}

/* Writes the cells of a box into which the segments of a list reach, with the stack's end at
 * `top`. */
static Status put_cells_of(BlobCells *cells, CellList list, size_t top, Box box, bool whole,
                           Err *err)
{
    CellHalves halves;
    if (!whole && !rayvolume_meets(cells->volume, box_padded(box, overlap_mm)))
        return STATUS_OK;
    TRY(halve(cells, list, top, box, &halves, err));
    for (size_t i = 0; !halves.is_cut && cells->is_met && i < list.n; i++)
        cells->is_met[cells->lists[list.first + i]] = true;
    if (!halves.is_cut)
        return cells->text ? put_cell(cells, list, whole ? NULL : &box, err) : STATUS_OK;
    top += halves.list[0].n + halves.list[1].n;
    for (int i = 0; i < 2; i++)
        if (halves.list[i].n)
            TRY(put_cells_of(cells, halves.list[i], top, halves.box[i], false, err));
    return STATUS_OK;
}

/* All of the object's segments. */
static CellList all_of(const PovrayGeometry *geometry)
{
    return (CellList){0, geometry->objects[geometry->object].n};
}

/* The segments of the object, and the box that they reach into. */
static Status cells_begin(const PovrayGeometry *geometry, Text *text, BlobCells *cells, Box *box,
                          Err *err)
{
    const Geometry *all = &geometry->scene->geometry;
    const PovrayItems *items = &geometry->objects[geometry->object];
    *cells = (BlobCells){.scene = geometry->scene,
                         .volume = geometry->volume,
                         .text = text,
                         .reach = blob_reach(&blob_shape),
                         .room = items->n};
    TRY(mem_calloc(&cells->lists, cells->room, sizeof *cells->lists, "cells", err));
    *box = box_empty();
    for (size_t i = 0; i < items->n; i++) {
        cells->lists[i] = items->index[i];
        *box = box_union(*box, reach_of(&all->segments[items->index[i]], cells->reach));
    }
    return STATUS_OK;
}

/* Finds whether all of the object is one blob, and not many blobs, each clipped to a cell. */
static Status blob_is_whole(const PovrayGeometry *geometry, bool *whole, Err *err)
{
    BlobCells cells = {0};
    Box box;
    CellHalves halves;
    const CellList all = all_of(geometry);
    Status status;
    TRY_GOTO(cells_begin(geometry, NULL, &cells, &box, err));
    TRY_GOTO(halve(&cells, all, all.n, box, &halves, err));
    *whole = !halves.is_cut;
done:
    free(cells.lists);
    return status;
}

static Status put_blobs(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    BlobCells cells = {0};
    Box box;
    const CellList all = all_of(geometry);
    Status status;
    TRY_GOTO(cells_begin(geometry, out, &cells, &box, err));
    TRY_GOTO(put_cells_of(&cells, all, all.n, box, true, err));
    geometry->report->cells = cells.written;
    TRY_GOTO(text_check(out, err));
done:
    free(cells.lists);
    return status;
}

Status put_blob(Text *out, PovrayGeometry *geometry, Err *err)
{
    bool whole;
    Values values = {.digits = geometry->params->digits};
    TRY(blob_is_whole(geometry, &whole, err));
    add_part(&values, "members", put_blobs, geometry);
    return put_declaration(out, geometry, whole ? "blob" : "union", &values, err);
}

Status find_visible_segments(PovrayGeometry *geometry, Err *err)
{
    const PovrayItems all = geometry->objects[0];
    uint32_t *index = geometry->indices + all.n;
    BlobCells cells = {0};
    Box box;
    size_t n = 0;
    Status status;
    geometry->painted = all;
    if (!geometry->volume)
        return STATUS_OK;
    TRY_GOTO(cells_begin(geometry, NULL, &cells, &box, err));
    TRY_GOTO(mem_calloc(&cells.is_met, all.n, sizeof *cells.is_met, "segments", err));
    TRY_GOTO(put_cells_of(&cells, all_of(geometry), all.n, box, true, err));
    for (size_t i = 0; i < all.n; i++)
        if (cells.is_met[i])
            index[n++] = (uint32_t)i;
    geometry->is_empty = n == 0;
    geometry->painted = n ? (PovrayItems){index, n} : (PovrayItems){all.index, 1};
done:
    free(cells.is_met);
    free(cells.lists);
    return status;
}

/* ---- which term is largest ------------------------------------------------------------------- */

typedef struct PaintItem {
    double key;
    uint32_t segment; /* by its number among those that are painted */
} PaintItem;

typedef struct Paints {
    const Scene *scene;
    PovrayItems painted;  /* numbered anew, in their order */
    const double *places; /* of sums for colors that blend; NULL: the largest term is found */
    const Tmpl *node;     /* the function of a box */
    bool in_matrices;     /* as put_matrices says */
    double grid_mm;       /* boxes are rounded to */
    PaintItem *items;
    Text *text;
    unsigned nodes;
} Paints;

static const FieldSegment *painted_segment(const Paints *paints, uint32_t number)
{
    return &paints->scene->geometry.segments[paints->painted.index[number]];
}

static int by_key(const void *a, const void *b)
{
    const PaintItem *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->segment < y->segment ? -1 : x->segment > y->segment;
}

/* Where a segment's value is on the scale; 0 for none. */
static double place_of(const Paints *paints, uint32_t number)
{
    const double *places = paints->scene->appearance.positions;
    double place = places ? places[painted_segment(paints, number)->segment] : 0;
    return isnan(place) ? 0 : place;
}

/* A column that is the value at the origin. POV-Ray takes no matrix without an inverse, so that it
 * cannot be the value everywhere. */
static Linear value_and_axis(double value, int axis)
{
    Linear linear = {{0, 0, 0, value}};
    linear.k[axis] = 1;
    return linear;
}

static int largest_factor(const Linear *linear)
{
    int axis = fabs(linear->k[1]) > fabs(linear->k[0]) ? 1 : 0;
    return fabs(linear->k[2]) > fabs(linear->k[axis]) ? 2 : axis;
}

/* For each segment v, w and start are the columns of Vs; end is one of Ve, whose others are the
 * segment's number and place at the origin. */
static Status put_matrices(const Paints *paints, const Tmpl *matrix, Err *err)
{
    put_matrix_arrays(paints->text, paints->painted.n);
    for (uint32_t i = 0; i < paints->painted.n; i++) {
        const TermForm form = term_form(painted_segment(paints, i));
        const int axis = largest_factor(&form.end);
        const Linear number = value_and_axis(i, (axis + 1) % 3),
                     place = value_and_axis(place_of(paints, i), (axis + 2) % 3);
        const Linear *const start[] = {&form.v, &form.w, &form.start};
        const Linear *const end[] = {&form.end, &number, &place};
        TRY(put_matrix(paints->text, matrix, 's', i, start, err));
        TRY(put_matrix(paints->text, matrix, 'e', i, end, err));
    }
    return STATUS_OK;
}

/* v, w, start, end */
static void put_forms(Text *text, const Paints *paints, uint32_t number)
{
    TermForm form = term_form(painted_segment(paints, number));
    const Linear *const parts[] = {&form.v, &form.w, &form.start, &form.end};
    for (int i = 0; i < 4; i++) {
        text_puts(text, i ? "," : "");
        if (paints->in_matrices)
            put_column(text, i < 3 ? 's' : 'e', number, "x,y,z", "xyzx"[i]);
        else
            put_linear(text, parts[i]);
    }
}

static void put_weight(Text *text, const Paints *paints, uint32_t number)
{
    text_puts(text, "+Fn_Blob_Weight(");
    put_forms(text, paints, number);
    text_printf(text, ")*select(k,%d,1,",
                !isnan(paints->places[painted_segment(paints, number)->segment]));
    if (paints->in_matrices)
        put_column(text, 'e', number, "0,0,0", 'z');
    else
        text_number(text, place_of(paints, number));
    text_puts(text, ")");
}

static void put_term(Text *text, const Paints *paints, uint32_t number)
{
    text_puts(text, ",Fn_Blob_Term(");
    put_forms(text, paints, number);
    text_puts(text, ",");
    if (paints->in_matrices)
        put_column(text, 'e', number, "0,0,0", 'y');
    else
        put_text(text, "%u", number);
    text_puts(text, ")");
}

/* The middle and the half of an extent along an axis, rounded outwards. */
static void extent_along(const Paints *paints, double low, double high,
                         char middle[NUMBER_TEXT_SIZE], char half[NUMBER_TEXT_SIZE])
{
    const double grid = paints->grid_mm;
    const int digits = paints->text->digits;
    low = floor(low / grid) * grid;
    high = ceil(high / grid) * grid;
    number_text_rounded((low + high) / 2, digits, middle);
    number_text_rounded((high - low) / 2, digits, half);
}

/* Declares the function of a box: of those listed the largest, or the sum, where the box holds the
 * point. */
static Status put_function(Paints *paints, Box box, const Text *list, Err *err)
{
    char number[NUMBER_TEXT_SIZE], middle[3][NUMBER_TEXT_SIZE], half[3][NUMBER_TEXT_SIZE];
    for (int axis = 0; axis < 3; axis++)
        extent_along(paints, vec3_component(box.low, axis), vec3_component(box.high, axis),
                     middle[axis], half[axis]);
    snprintf(number, sizeof number, "%u", paints->nodes++);
    const TmplValue values[] = {{"number", number},  {"x", middle[0]},          {"half_x", half[0]},
                                {"y", middle[1]},    {"half_y", half[1]},       {"z", middle[2]},
                                {"half_z", half[2]}, {"list", text_chars(list)}};
    return tmpl_apply(paints->node, values, sizeof values / sizeof *values, paints->text, err);
}

static void sort_along(Paints *paints, PaintItem *items, size_t n, int axis)
{
    for (size_t i = 0; i < n; i++) {
        const FieldSegment *segment = painted_segment(paints, items[i].segment);
        items[i].key = vec3_component(vec3_add(segment->a, segment->b), axis);
    }
    qsort(items, n, sizeof *items, by_key);
}

/* Where items[first .. first + n) are felt. */
static Box box_of_items(const Paints *paints, size_t first, size_t n)
{
    const double reach = blob_reach(&blob_shape);
    Box box = box_empty();
    for (size_t i = first; i < first + n; i++)
        box = box_union(box, reach_of(painted_segment(paints, paints->items[i].segment), reach));
    return box;
}

/* Declares the function of items[first .. first + n), after those of its halves. */
static Status put_node(Paints *paints, size_t first, size_t n, Err *err)
{
    PaintItem *items = paints->items + first;
    Text list = {.digits = paints->text->digits};
    const Box box = box_of_items(paints, first, n);
    if (n > LEAF) {
        sort_along(paints, items, n, box_longest_axis(box));
        for (int half = 0; half < 2; half++) {
            TRY(put_node(paints, half ? first + n / 2 : first, half ? n - n / 2 : n / 2, err));
            text_printf(&list, paints->places ? "+Fw[%u](x,y,z,k)" : ",Fn[%u](x,y,z)",
                        paints->nodes - 1);
        }
    }
    for (size_t i = 0; n <= LEAF && i < n; i++)
        (paints->places ? put_weight : put_term)(&list, paints, items[i].segment);
    Status status = put_function(paints, box, &list, err);
    text_release(&list);
    return status;
}

/* How many functions put_node declares. */
static size_t count_nodes(size_t n)
{
    return n <= LEAF ? 1 : 1 + count_nodes(n / 2) + count_nodes(n - n / 2);
}

/* The power of 2 that is some 1/2000 of the box: fine enough for boxes of a few segments, and so
 * few places that POV-Ray finds each number at once. */
static double grid_of(Box box)
{
    Vec3 size = vec3_sub(box.high, box.low);
    return ldexp(1, ilogb(fmax(size.x, fmax(size.y, size.z))) - 10);
}

/* The functions that find the largest term, and the matrices, or those that sum terms for the mean
 * of `places`. */
static Status put_hierarchy(Text *out, const PovrayGeometry *geometry, const double *places,
                            Err *err)
{
    const char *const names[] = {places ? "povray/blob_weight.inc" : "povray/blob_node.inc",
                                 "povray/matrix.inc"};
    Tmpl templates[2] = {0};
    const size_t n = geometry->painted.n;
    Paints paints = {.scene = geometry->scene,
                     .painted = geometry->painted,
                     .places = places,
                     .node = &templates[0],
                     .in_matrices = n > MAX_INLINE_TERMS,
                     .text = out};
    Status status;
    TRY_GOTO(load_templates(templates, geometry->params, names, 2, err));
    TRY_GOTO(mem_calloc(&paints.items, n, sizeof *paints.items, "segments", err));
    for (size_t i = 0; i < n; i++)
        paints.items[i].segment = (uint32_t)i;
    paints.grid_mm = grid_of(box_of_items(&paints, 0, n));
    if (paints.in_matrices && !places)
        TRY_GOTO(put_matrices(&paints, &templates[1], err));
    text_printf(out, "#declare F%c=array[%zu]\n", places ? 'w' : 'n', count_nodes(n));
    TRY_GOTO(put_node(&paints, 0, n, err));
done:
    free(paints.items);
    release_templates(templates, 2);
    return status;
}

static Status put_functions(Text *out, void *context, Err *err)
{
    return put_hierarchy(out, context, NULL, err);
}

static Status put_weights(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    return put_hierarchy(out, geometry, geometry->scene->appearance.positions, err);
}

/* What finds the mean where colors blend. */
static Status put_blend(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {.digits = geometry->params->digits};
    if (!povray_blends(geometry))
        return text_check(out, err);
    text_printf(add_value(&values, "top"), "Fw[%zu]", count_nodes(geometry->painted.n) - 1);
    add_part(&values, "nodes", put_weights, context);
    return values_expand(&values, geometry->params, "povray/blob_blend.inc", out, err);
}

/* Appends the paint of a segment, in groups of as many as a map of textures holds. */
static void put_paint_of(Text *out, const void *context, size_t i)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems painted = geometry->painted;
    const FieldSegment *segment = &geometry->scene->geometry.segments[painted.index[i]];
    if (i % GROUP == 0)
        put_text(out, "Blob_Group(%z)\n", i / GROUP);
    put_text(out, "Blob_Color(%z,%n,", i, segment->radius_mm);
    put_paint(out, geometry->params, segment->segment);
    text_puts(out, ")\n");
    if (i % GROUP == GROUP - 1 || i + 1 == painted.n)
        put_text(out, "Blob_Group_End(%z)\n", i / GROUP);
}

static Status put_nothing(Text *out, void *context, Err *err)
{
    (void)context;
    return text_check(out, err);
}

static void add_shape(Values *values)
{
    const BlobTube *tube = blob_shape.tube;
    const BlobBead *bead = blob_shape.bead;
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"r1", tube[0].radius},   {"s1", tube[0].strength}, {"r2", tube[1].radius},
                   {"s2", tube[1].strength}, {"h1", bead[0].offset},   {"q1", bead[0].radius},
                   {"c1", bead[0].strength}, {"h2", bead[1].offset},   {"q2", bead[1].radius},
                   {"c2", bead[1].strength}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        add_number(values, numbers[i].name, numbers[i].value);
}

Status put_blob_macros(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    size_t n = geometry->painted.n;
    bool painted = geometry->scene->appearance.colors || geometry->params->ids;
    Values values = {.digits = geometry->params->digits};
    if (painted && n > MAX_PAINTED)
        return err_set(
            err, STATUS_INFEASIBLE,
            "POV-Ray can color at most %d segments of a blob separately; this one has %zu",
            MAX_PAINTED, n);
    add_shape(&values);
    add_flag(&values, "painted", painted);
    add_flag(&values, "blended", povray_blends(geometry));
    Text *top = add_value(&values, "top"), *n_groups = add_value(&values, "n_groups");
    if (painted) {
        text_printf(top, "Fn[%zu]", count_nodes(n) - 1);
        put_text(n_groups, "%z", (size_t)((n + GROUP - 1) / GROUP));
    }
    add_part(&values, "paint", painted ? put_functions : put_nothing, context);
    add_part(&values, "blend", put_blend, context);
    add_list(&values, "groups", put_paint_of, geometry, painted ? n : 0);
    return values_expand(&values, geometry->params, "povray/blob.inc", out, err);
}
