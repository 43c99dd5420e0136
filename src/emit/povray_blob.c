/* Writes a blob: one call of Vessel_Blob for each segment. POV-Ray's precision decreases with the
 * number of components along a ray and with the distance between them [docs/POVRAY.md section 9]. A
 * large tree is therefore divided into cells. Its box is halved recursively along the longest side
 * until few segments reach into a box. Each cell becomes a separate blob that is clipped to the
 * cell.
 *
 * If segments differ in color or id, a pigment function finds the segment whose term is largest at
 * a point. POV-Ray's own blending of the textures of a blob is not used, because it mixes the
 * textures by strength. The pigment function is a bounding box hierarchy: the function of a box
 * calls the functions of its halves only if the box contains the point. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

#include <stdlib.h>

/* A map of POV-Ray (color_map, pigment_map, texture_map) has at most 256 entries. A map of GROUP
 * maps of GROUP entries selects among MAX_PAINTED segments. LEAF is the maximum number of
 * segments in a leaf of the hierarchy. Larger leaves evaluate more terms at each point; smaller
 * ones declare more functions, which POV-Ray reads slowly. */
enum { GROUP = 256, MAX_PAINTED = GROUP * GROUP, LEAF = 4 };

/* Maximum number of segments of a cell, unless too many of them would reach into both halves
 * [halve]. Larger cells lose precision; smaller ones repeat more segments that reach into several
 * cells. */
enum { CELL = 128 };

/* POV-Ray's time per ray grows with the square of the number of segments that overlap on the ray.
 * If more than CROWD segments overlap at a point, a picture takes minutes, and the scene is
 * refused. The test points are the middles of about PROBES segments of a cell. */
enum { CROWD = 64, PROBES = 64 };

/* Each cell extends into its neighbours by this much, so that no ray passes between two cells. It
 * is above POV-Ray's rounding errors, and far below the size of a cell. */
static const double overlap_mm = 1e-3;

/* Returns the bounds of the points where the term of a segment is not 0. `reach` is blob_reach. */
static Box influence_box(const FieldSegment *segment, double reach)
{
    double mm = reach * segment->radius_mm;
    return box_with_ball(box_with_ball(box_empty(), segment->a, mm), segment->b, mm);
}

/* ---- cells ----------------------------------------------------------------------------------- */

typedef struct BlobCells {
    const Scene *scene;
    const RayVolume *volume; /* cells that no ray of the part can hit are left out; NULL: there is
                              * no part */
    Text *text;              /* receives the cells; NULL: they are not written */
    bool *is_hit;            /* per segment: receives true if a cell that is not left out has the
                              * segment; NULL: not needed */
    double reach;            /* blob_reach, in units of a segment's radius */
    uint32_t *lists; /* a stack of lists of segments: the lists of the two halves of a cell follow
                      * the list of the cell; owned */
    size_t capacity;
    size_t written; /* number of cells that were written; 0 if the object is one blob */
} BlobCells;

/* A list of segments on the stack of cells. */
typedef struct CellList {
    size_t first, n;
} CellList;

/* Returns the number of segments of a list whose term is not 0 at x. */
static size_t count_overlapping(const BlobCells *cells, const uint32_t *list, size_t n, Vec3 x)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += blob_segment_value(&cells->scene->geometry.segments[list[i]], x) != 0;
    return count;
}

/* Refuses a cell in which more than CROWD segments overlap at one of the test points. */
static Status check_crowd(const BlobCells *cells, const uint32_t *list, size_t n, Err *err)
{
    if (n <= CROWD)
        return STATUS_OK;
    for (size_t i = 0; i < n; i += n / PROBES) {
        const FieldSegment *segment = &cells->scene->geometry.segments[list[i]];
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        size_t n_overlapping = count_overlapping(cells, list, n, middle);
        if (n_overlapping > CROWD)
            return err_set(
                err, STATUS_INFEASIBLE,
                "%zu segments overlap at (%.6g, %.6g, %.6g), too many for POV-Ray to draw a blob "
                "in reasonable time; leave out thin ones (`prune_radius`) or choose another model",
                n_overlapping, middle.x, middle.y, middle.z);
    }
    return STATUS_OK;
}

/* Writes the blob of the segments of a list. With `clip` the blob is a cell that is clipped to the
 * box. Errors: STATUS_INFEASIBLE if POV-Ray cannot draw it; STATUS_MEMORY. */
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

/* Returns the list of the segments of `from` that reach into the box. The list is stored on the
 * stack at `top`. */
static CellList segments_in_box(const BlobCells *cells, CellList from, size_t top, Box box)
{
    const FieldSegment *segments = cells->scene->geometry.segments;
    const uint32_t *list = cells->lists + from.first;
    CellList taken = {top, 0};
    for (size_t i = 0; i < from.n; i++)
        if (box_overlaps(influence_box(&segments[list[i]], cells->reach), box))
            cells->lists[top + taken.n++] = list[i];
    return taken;
}

/* The two halves of a cell. */
typedef struct CellHalves {
    Box box[2];
    CellList list[2];
    bool is_split; /* the cell is divided into these halves */
} CellHalves;

/* Halves a box, and lists the segments of `list` that reach into each half, on the stack from `top`
 * on. Sets out->is_split to false if the list has at most CELL segments, or if the two new lists
 * together are more than 1.5 times as long as the list. */
static Status halve(BlobCells *cells, CellList list, size_t top, Box box, CellHalves *out, Err *err)
{
    *out = (CellHalves){.box = {box, box}};
    if (list.n <= CELL)
        return STATUS_OK;
    TRY(mem_reserve(&cells->lists, &cells->capacity, top + 2 * list.n, sizeof *cells->lists,
                    "cells", err));
    Box *half = out->box;
    Vec3 middle = box_center(box);
    int axis = box_longest_axis(box);
    if (axis == 0)
        half[0].high.x = half[1].low.x = middle.x;
    else if (axis == 1)
        half[0].high.y = half[1].low.y = middle.y;
    else
        half[0].high.z = half[1].low.z = middle.z;
    out->list[0] = segments_in_box(cells, list, top, half[0]);
    out->list[1] = segments_in_box(cells, list, top + out->list[0].n, half[1]);
    out->is_split = 2 * (out->list[0].n + out->list[1].n) <= 3 * list.n;
    return STATUS_OK;
}

/* Divides a box recursively into cells and writes them. The segments of `list` reach into the box.
 * The stack is free from `top` on. `whole` is true for the box of the object. */
static Status put_cells_of(BlobCells *cells, CellList list, size_t top, Box box, bool whole,
                           Err *err)
{
    CellHalves halves;
    if (!whole && !rayvolume_meets(cells->volume, box_padded(box, overlap_mm)))
        return STATUS_OK;
    TRY(halve(cells, list, top, box, &halves, err));
    for (size_t i = 0; !halves.is_split && cells->is_hit && i < list.n; i++)
        cells->is_hit[cells->lists[list.first + i]] = true;
    if (!halves.is_split)
        return cells->text ? put_cell(cells, list, whole ? NULL : &box, err) : STATUS_OK;
    top += halves.list[0].n + halves.list[1].n;
    for (int i = 0; i < 2; i++)
        if (halves.list[i].n)
            TRY(put_cells_of(cells, halves.list[i], top, halves.box[i], false, err));
    return STATUS_OK;
}

/* Returns the list of all segments of the object. */
static CellList all_of(const PovrayGeometry *geometry)
{
    return (CellList){0, geometry->objects[geometry->object].n};
}

/* Initialises *cells with the segments of the object, and computes the box that they reach into.
 * The caller frees cells->lists, even after an error. */
static Status cells_begin(const PovrayGeometry *geometry, Text *text, BlobCells *cells, Box *box,
                          Err *err)
{
    const Geometry *all = &geometry->scene->geometry;
    const PovrayItems *items = &geometry->objects[geometry->object];
    *cells = (BlobCells){.scene = geometry->scene,
                         .volume = geometry->volume,
                         .text = text,
                         .reach = blob_reach(&blob_shape),
                         .capacity = items->n};
    TRY(mem_calloc(&cells->lists, cells->capacity, sizeof *cells->lists, "cells", err));
    *box = box_empty();
    for (size_t i = 0; i < items->n; i++) {
        cells->lists[i] = items->index[i];
        *box = box_union(*box, influence_box(&all->segments[items->index[i]], cells->reach));
    }
    return STATUS_OK;
}

/* Sets *whole to true if the object is one blob, and to false if it is divided into cells. */
static Status blob_is_whole(const PovrayGeometry *geometry, bool *whole, Err *err)
{
    BlobCells cells = {0};
    Box box;
    CellHalves halves;
    const CellList all = all_of(geometry);
    Status status;
    TRY_GOTO(cells_begin(geometry, NULL, &cells, &box, err));
    TRY_GOTO(halve(&cells, all, all.n, box, &halves, err));
    *whole = !halves.is_split;
done:
    free(cells.lists);
    return status;
}

/* Appends the members of the object: its blob, or the blobs of its cells. */
static Status put_blobs(Text *out, const void *context, Err *err)
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

Status put_blob(Text *out, const PovrayGeometry *geometry, Err *err)
{
    bool whole;
    TRY(blob_is_whole(geometry, &whole, err));
    return put_declaration(out, geometry, whole ? "blob" : "union", put_blobs, err);
}

Status find_visible_segments(PovrayGeometry *geometry, Err *err)
{
    const PovrayItems all = geometry->objects[0];
    uint32_t *index = geometry->indices + all.n;
    BlobCells cells = {0};
    Box box;
    size_t n = 0;
    Status status;
    geometry->visible_segments = all;
    if (!geometry->volume)
        return STATUS_OK;
    TRY_GOTO(cells_begin(geometry, NULL, &cells, &box, err));
    TRY_GOTO(mem_calloc(&cells.is_hit, all.n, sizeof *cells.is_hit, "segments", err));
    TRY_GOTO(put_cells_of(&cells, all_of(geometry), all.n, box, true, err));
    for (size_t i = 0; i < all.n; i++)
        if (cells.is_hit[i])
            index[n++] = (uint32_t)i;
    geometry->is_empty = n == 0;
    geometry->visible_segments = n ? (PovrayItems){index, n} : (PovrayItems){all.index, 1};
done:
    free(cells.is_hit);
    free(cells.lists);
    return status;
}

/* ---- which term is largest ------------------------------------------------------------------- */

typedef struct PaintItem {
    double key;
    uint32_t segment; /* index in Paints.painted */
} PaintItem;

typedef struct Paints {
    const Scene *scene;
    PovrayItems painted;     /* the segments that may be visible; "number" below is an index in this
                              * list */
    const double *positions; /* positions on the color scale, for colors that blend; NULL: functions
                              * that find the largest term */
    const Tmpl *node;        /* template of the function of a box */
    bool in_matrices;        /* coefficients are in matrices [put_matrices] */
    double grid_mm;          /* the bounds of boxes are rounded outwards to multiples of this */
    PaintItem *items;
    Text *text;
    unsigned nodes;
} Paints;

static const FieldSegment *painted_segment(const Paints *paints, uint32_t number)
{
    return &paints->scene->geometry.segments[paints->painted.index[number]];
}

static int compare_keys(const void *a, const void *b)
{
    const PaintItem *x = a, *y = b;
    const int order = compare_numbers(x->key, y->key);
    return order ? order : compare_numbers(x->segment, y->segment);
}

/* Returns the position of a segment's value on the color scale; 0 if it has none. */
static double scale_position(const Paints *paints, uint32_t number)
{
    const double *positions = paints->scene->appearance.positions;
    double position = positions ? positions[painted_segment(paints, number)->segment] : 0;
    return isnan(position) ? 0 : position;
}

/* Returns a column of a matrix that stores a value: the column's value at the origin. The column
 * cannot be constant, because POV-Ray refuses a matrix without an inverse. */
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

/* Declares two matrices per segment. The columns of Vs are the linear functions v, w and start. The
 * columns of Ve are the linear function end, the segment's number, and its position on the color
 * scale; the last two are the values of their columns at the origin. */
static Status put_matrices(const Paints *paints, const Tmpl *matrix, Err *err)
{
    put_matrix_arrays(paints->text, paints->painted.n);
    for (uint32_t i = 0; i < paints->painted.n; i++) {
        const TermForm form = term_form(painted_segment(paints, i));
        const int axis = largest_factor(&form.end);
        const Linear number = value_and_axis(i, (axis + 1) % 3),
                     position = value_and_axis(scale_position(paints, i), (axis + 2) % 3);
        const Linear *const start[] = {&form.v, &form.w, &form.start};
        const Linear *const end[] = {&form.end, &number, &position};
        TRY(put_matrix(paints->text, matrix, 's', i, start, err));
        TRY(put_matrix(paints->text, matrix, 'e', i, end, err));
    }
    return STATUS_OK;
}

/* Appends the linear functions v, w, start and end of a segment as four arguments. */
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
                !isnan(paints->positions[painted_segment(paints, number)->segment]));
    if (paints->in_matrices)
        put_column(text, 'e', number, "0,0,0", 'z');
    else
        text_number(text, scale_position(paints, number));
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

/* Formats the centre and half of the extent of a box along an axis, rounded outwards to grid_mm. */
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

/* Declares the function of a box. At points in the box it is the maximum, or the sum, of the terms
 * in `list`; elsewhere it is 0. */
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
    qsort(items, n, sizeof *items, compare_keys);
}

/* Returns the bounds of the points where a term of items[first .. first + n) is not 0. */
static Box box_of_items(const Paints *paints, size_t first, size_t n)
{
    const double reach = blob_reach(&blob_shape);
    Box box = box_empty();
    for (size_t i = first; i < first + n; i++)
        box =
            box_union(box, influence_box(painted_segment(paints, paints->items[i].segment), reach));
    return box;
}

/* Declares the function of items[first .. first + n), after the functions of the two halves that it
 * calls. */
static Status put_node(Paints *paints, size_t first, size_t n, Err *err)
{
    PaintItem *items = paints->items + first;
    Text list = {.digits = paints->text->digits};
    const Box box = box_of_items(paints, first, n);
    if (n > LEAF) {
        sort_along(paints, items, n, box_longest_axis(box));
        for (int half = 0; half < 2; half++) {
            TRY(put_node(paints, half ? first + n / 2 : first, half ? n - n / 2 : n / 2, err));
            text_printf(&list, paints->positions ? "+Fw[%u](x,y,z,k)" : ",Fn[%u](x,y,z)",
                        paints->nodes - 1);
        }
    }
    for (size_t i = 0; n <= LEAF && i < n; i++)
        (paints->positions ? put_weight : put_term)(&list, paints, items[i].segment);
    Status status = put_function(paints, box, &list, err);
    text_release(&list);
    return status;
}

/* Returns the number of functions that put_node declares for n items. */
static size_t count_nodes(size_t n)
{
    return n <= LEAF ? 1 : 1 + count_nodes(n / 2) + count_nodes(n - n / 2);
}

/* Returns the grid for the bounds of boxes: a power of 2, 1/2048 to 1/1024 of the longest side of
 * the box. This is fine enough for boxes of a few segments. It is so coarse that few different
 * numbers occur, among which POV-Ray finds each number quickly. */
static double grid_of(Box box)
{
    Vec3 size = vec3_sub(box.high, box.low);
    return ldexp(1, ilogb(fmax(size.x, fmax(size.y, size.z))) - 10);
}

/* Appends the hierarchy of functions. If `positions` is NULL, the functions find the largest term,
 * and the matrices are declared before them. Otherwise the functions sum terms for the mean of the
 * positions on the color scale. */
static Status put_hierarchy(Text *out, const PovrayGeometry *geometry, const double *positions,
                            Err *err)
{
    const char *const names[] = {positions ? "povray/blob_weight.inc" : "povray/blob_node.inc",
                                 "povray/matrix.inc"};
    Tmpl templates[2] = {0};
    const size_t n = geometry->visible_segments.n;
    Paints paints = {.scene = geometry->scene,
                     .painted = geometry->visible_segments,
                     .positions = positions,
                     .node = &templates[0],
                     .in_matrices = n > MAX_INLINE_TERMS,
                     .text = out};
    Status status;
    TRY_GOTO(load_templates(templates, geometry->params, names, 2, err));
    TRY_GOTO(mem_calloc(&paints.items, n, sizeof *paints.items, "segments", err));
    for (size_t i = 0; i < n; i++)
        paints.items[i].segment = (uint32_t)i;
    paints.grid_mm = grid_of(box_of_items(&paints, 0, n));
    if (paints.in_matrices && !positions)
        TRY_GOTO(put_matrices(&paints, &templates[1], err));
    text_printf(out, "#declare F%c=array[%zu]\n", positions ? 'w' : 'n', count_nodes(n));
    TRY_GOTO(put_node(&paints, 0, n, err));
done:
    free(paints.items);
    release_templates(templates, 2);
    return status;
}

/* Appends the functions that find the segment of a point. */
static Status put_functions(Text *out, const void *context, Err *err)
{
    return put_hierarchy(out, context, NULL, err);
}

/* Appends the functions that find the mean position on the color scale. */
static Status put_weights(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    return put_hierarchy(out, geometry, geometry->scene->appearance.positions, err);
}

/* Appends the paint of a segment. Paints are grouped by GROUP, the maximum size of a map. */
static void put_paint_of(Text *out, const void *context, size_t i)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems painted = geometry->visible_segments;
    const FieldSegment *segment = &geometry->scene->geometry.segments[painted.index[i]];
    if (i % GROUP == 0)
        put_text(out, "Blob_Group(%z)\n", i / GROUP);
    put_text(out, "Blob_Color(%z,%n,", i, segment->radius_mm);
    put_paint(out, geometry->params, segment->segment);
    text_puts(out, ")\n");
    if (i % GROUP == GROUP - 1 || i + 1 == painted.n)
        put_text(out, "Blob_Group_End(%z)\n", i / GROUP);
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

Status put_blob_macros(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    size_t n = geometry->visible_segments.n;
    bool painted = povray_has_several_paints(geometry);
    Values values = {.digits = geometry->params->digits};
    if (painted && n > MAX_PAINTED)
        return err_set(
            err, STATUS_INFEASIBLE,
            "POV-Ray can color at most %d segments of a blob separately; this one has %zu",
            MAX_PAINTED, n);
    add_shape(&values);
    add_flag(&values, "painted", painted);
    add_flag(&values, "blended", povray_blends(geometry));
    text_printf(add_value(&values, "top"), "Fn[%zu]", count_nodes(n) - 1);
    text_printf(add_value(&values, "top_weight"), "Fw[%zu]", count_nodes(n) - 1);
    add_count(&values, "n_groups", (n + GROUP - 1) / GROUP);
    add_part(&values, "paint", put_functions, context);
    add_part(&values, "nodes", put_weights, context);
    add_list(&values, "groups", put_paint_of, geometry, n);
    return values_expand(&values, geometry->params, "povray/blob.inc", out, err);
}
