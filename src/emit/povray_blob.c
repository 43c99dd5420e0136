/* One call of Vessel_Blob for each segment. Space is halved, along the longest side of a box each
 * time, until few segments reach into a box; each box is a blob of its own, clipped to the box,
 * because POV-Ray loses precision with the number of components along a ray and the way between
 * them [docs/POVRAY.md section 9].
 *
 * Where segments differ in what they are painted with, a pigment finds out which term is largest at
 * a point: POV-Ray's own blending of a blob's textures is by strength and never lets one segment
 * win. Its function is a hierarchy of boxes, written as functions that call each other and look
 * only into boxes that hold the point. */
#include "emit/povray_text.h"

#include <stdio.h>
#include <stdlib.h>

/* A pigment map holds 256 entries, and so does a colour map: two of them in one another count
 * on. */
enum { GROUP = 256, MAX_PAINTED = GROUP * GROUP, LEAF = 4 };

/* How many segments a cell holds at most, unless halving it would leave most of them in both
 * halves. */
enum { CELL = 128 };

/* POV-Ray's time for a ray grows with the square of the segments that it passes; so many in one
 * another, looked for about so many of a cell, take minutes for a picture. */
enum { CROWD = 64, PROBES = 64 };

/* Cells reach into their neighbours, so that no ray slips between them. */
static const double overlap_mm = 1e-3;

static Box reach_of(const FieldSegment *segment)
{
    double reach = blob_reach(&blob_shape) * segment->radius_mm;
    return box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach);
}

/* ---- cells ----------------------------------------------------------------------------------- */

typedef struct Cells {
    const Scene *scene;
    Text *text;
    uint32_t
        *lists; /* a stack: the segments of a cell follow those of the cell that it is part of */
    size_t room;
    size_t written; /* none when all is one blob */
} Cells;

/* How many segments of a list are felt at x. */
static size_t count_felt(const Cells *cells, const uint32_t *list, size_t n, Vec3 x)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        count += blob_term(&cells->scene->segments[list[i]], x) != 0;
    return count;
}

static Status check_crowd(const Cells *cells, const uint32_t *list, size_t n, Err *err)
{
    if (n <= CROWD)
        return STATUS_OK;
    for (size_t i = 0; i < n; i += n / PROBES) {
        const FieldSegment *segment = &cells->scene->segments[list[i]];
        Vec3 middle = vec3_scale(vec3_add(segment->a, segment->b), 0.5);
        size_t felt = count_felt(cells, list, n, middle);
        if (felt > CROWD)
            return err_set(
                err, STATUS_INFEASIBLE,
                "%zu segments lie in one another at (%.6g, %.6g, %.6g), more than POV-Ray "
                "draws as a blob in good time; leave out thin ones (--prune-radius) or "
                "choose another model",
                felt, middle.x, middle.y, middle.z);
    }
    return STATUS_OK;
}

/* Writes the blob of lists[first .. first + n), clipped to a box or whole. */
static Status put_cell(Cells *cells, size_t first, size_t n, const Box *clip, Err *err)
{
    Text *text = cells->text;
    const uint32_t *list = cells->lists + first;
    if (n * BLOB_POVRAY_COMPONENTS >= BLOB_POVRAY_LIMIT)
        return err_set(
            err, STATUS_INFEASIBLE,
            "%zu segments overlap in one place, more than POV-Ray draws in one blob; leave "
            "out thin ones (--prune-radius) or choose another model",
            n);
    TRY(check_crowd(cells, list, n, err));
    text_puts(text, clip ? "Blob_Cell()\n" : "Blob_Start()\n");
    for (size_t i = 0; i < n; i++) {
        const FieldSegment *segment = &cells->scene->segments[list[i]];
        text_puts(text, "Vessel_Blob(");
        put_vector(text, segment->a);
        text_puts(text, ",");
        put_vector(text, segment->b);
        text_puts(text, ",");
        text_number(text, segment->radius_mm);
        text_puts(text, ")\n");
    }
    if (!clip) {
        text_puts(text, "Blob_Paint()\n");
        return STATUS_OK;
    }
    Vec3 pad = vec3(overlap_mm, overlap_mm, overlap_mm);
    text_puts(text, "Blob_Cell_End(");
    put_vector(text, vec3_sub(clip->low, pad));
    text_puts(text, ",");
    put_vector(text, vec3_add(clip->high, pad));
    text_puts(text, ")\n");
    cells->written++;
    return STATUS_OK;
}

/* The segments of lists[first .. first + n) that reach into the box, appended after those: how
 * many. */
static size_t take_those_in(Cells *cells, size_t first, size_t n, Box box)
{
    uint32_t *list = cells->lists + first;
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        if (box_meets(reach_of(&cells->scene->segments[list[i]]), box))
            list[n + count++] = list[i];
    return count;
}

/* Writes the cells of a box into which lists[first .. first + n) reach. */
static Status put_cells_of(Cells *cells, size_t first, size_t n, Box box, bool whole, Err *err)
{
    if (n <= CELL)
        return put_cell(cells, first, n, whole ? NULL : &box, err);
    TRY(mem_reserve(&cells->lists, &cells->room, first + 2 * n, sizeof *cells->lists, "cells",
                    err));
    Box half[2] = {box, box};
    Vec3 middle = box_center(box);
    switch (box_longest_axis(box)) {
    case 0:
        half[0].high.x = half[1].low.x = middle.x;
        break;
    case 1:
        half[0].high.y = half[1].low.y = middle.y;
        break;
    default:
        half[0].high.z = half[1].low.z = middle.z;
    }
    size_t in_halves = take_those_in(cells, first, n, half[0]);
    in_halves += take_those_in(cells, first, n, half[1]);
    if (2 * in_halves > 3 * n)
        return put_cell(cells, first, n, whole ? NULL : &box, err);
    for (int i = 0; i < 2; i++) {
        size_t count = take_those_in(cells, first, n, half[i]);
        if (count)
            TRY(put_cells_of(cells, first + n, count, half[i], false, err));
    }
    return STATUS_OK;
}

Status put_blob(Text *text, const Scene *scene, size_t *n_cells, Err *err)
{
    Cells cells = {.scene = scene, .text = text, .room = scene->n_segments};
    Box box = box_empty();
    TRY(mem_calloc(&cells.lists, cells.room, sizeof *cells.lists, "cells", err));
    for (size_t i = 0; i < scene->n_segments; i++) {
        cells.lists[i] = (uint32_t)i;
        box = box_union(box, reach_of(&scene->segments[i]));
    }
    Status status = put_cells_of(&cells, 0, scene->n_segments, box, true, err);
    free(cells.lists);
    *n_cells = cells.written;
    return status;
}

/* ---- which term is largest ------------------------------------------------------------------- */

typedef struct Item {
    double key;
    uint32_t segment;
} Item;

typedef struct Paints {
    const Scene *scene;
    Item *items;
    Text *text;
    unsigned nodes;
} Paints;

static int by_key(const void *a, const void *b)
{
    const Item *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->segment < y->segment ? -1 : x->segment > y->segment;
}

static void put_term(Text *text, const Scene *scene, uint32_t number)
{
    TermForm form = term_form(&scene->segments[number]);
    const Linear *const parts[] = {&form.v, &form.w, &form.start, &form.end};
    text_puts(text, "Fn_Blob_Term(");
    for (int i = 0; i < 4; i++) {
        put_linear(text, parts[i]);
        text_puts(text, ",");
    }
    text_printf(text, "%u)", number);
}

/* A little more than the extent along an axis, in few digits. */
static void put_extent_along(Text *text, char name, double low, double high)
{
    double middle = (low + high) / 2, half = (high - low) / 2;
    text_printf(text, "abs(%c-(%.6g))-%.6g", name, middle, half * 1.001 + fabs(middle) * 1e-5);
}

/* Declares the function of items[first .. first + n), after those of its halves: its number. */
static unsigned put_node(Paints *paints, size_t first, size_t n)
{
    Item *items = paints->items + first;
    Box box = box_empty();
    for (size_t i = 0; i < n; i++)
        box = box_union(box, reach_of(&paints->scene->segments[items[i].segment]));
    unsigned half[2] = {0, 0};
    if (n > LEAF) {
        int axis = box_longest_axis(box);
        for (size_t i = 0; i < n; i++) {
            const FieldSegment *segment = &paints->scene->segments[items[i].segment];
            items[i].key = vec3_component(vec3_add(segment->a, segment->b), axis);
        }
        qsort(items, n, sizeof *items, by_key);
        half[0] = put_node(paints, first, n / 2);
        half[1] = put_node(paints, first + n / 2, n - n / 2);
    }
    Text *text = paints->text;
    text_printf(text, "#declare Fn%u=function(x,y,z){select(max(", paints->nodes);
    put_extent_along(text, 'x', box.low.x, box.high.x);
    text_puts(text, ",");
    put_extent_along(text, 'y', box.low.y, box.high.y);
    text_puts(text, ",");
    put_extent_along(text, 'z', box.low.z, box.high.z);
    text_puts(text, "),max(0");
    for (size_t i = 0; n <= LEAF && i < n; i++) {
        text_puts(text, ",");
        put_term(text, paints->scene, items[i].segment);
    }
    for (int i = 0; n > LEAF && i < 2; i++)
        text_printf(text, ",Fn%u(x,y,z)", half[i]);
    text_puts(text, "),0)};\n");
    return paints->nodes++;
}

static void put_groups(Text *text, const Scene *scene)
{
    for (size_t i = 0; i < scene->n_segments; i++) {
        const FieldSegment *segment = &scene->segments[i];
        if (i % GROUP == 0)
            text_printf(text, "Blob_Group(%zu)\n", i / GROUP);
        text_printf(text, "Blob_Color(%zu,", i);
        put_paint(text, scene, segment->id, segment->color);
        text_puts(text, ")\n");
        if (i % GROUP == GROUP - 1 || i + 1 == scene->n_segments)
            text_printf(text, "Blob_Group_End(%zu)\n", i / GROUP);
    }
}

Status put_blob_paint(const Scene *scene, Text *functions, Text *top, Text *groups, Text *n_groups,
                      Err *err)
{
    size_t n = scene->n_segments;
    Paints paints = {.scene = scene, .text = functions};
    if (n > MAX_PAINTED)
        return err_set(err, STATUS_INFEASIBLE,
                       "POV-Ray can paint at most %d segments of a blob one by one, not %zu",
                       MAX_PAINTED, n);
    TRY(mem_calloc(&paints.items, n, sizeof *paints.items, "segments", err));
    for (size_t i = 0; i < n; i++)
        paints.items[i].segment = (uint32_t)i;
    text_printf(top, "Fn%u", put_node(&paints, 0, n));
    free(paints.items);
    put_groups(groups, scene);
    text_printf(n_groups, "%zu", (n + GROUP - 1) / GROUP);
    return STATUS_OK;
}
