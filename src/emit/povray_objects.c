/* What a geometry declares: all of it as one object and, of a forest, each of its trees as one. The
 * items of the trees are found by a counting sort, which keeps their order.
 *
 * Trees of primitives and of triangles are members of the whole. Those of a field cannot be: where
 * trees come near, the whole is the level set of the sum over all of them, so that each tree is a
 * field of its own segments, beside it. The cells of an isosurface are found anew for each, with
 * the whole's numbers, so that all call the same functions.
 *
 * Of a part of the picture the items are those that its rays can meet; of a field, whose numbers
 * are sums over segments that may stand elsewhere, so are the cells that space is cut into, each
 * with all that it has in the whole. So POV-Ray meets in a part the very pieces that it meets in
 * the whole. */
#include "emit/povray_members.h"
#include "emit/values.h"

#include <assert.h>
#include <stdlib.h>

static bool is_field(const PovrayGeometry *geometry)
{
    return model_has(geometry->scene->geometry.model, MODEL_FIELD);
}

/* Else they are field segments. */
static bool items_are_primitives(const Geometry *all)
{
    return model_has(all->model, MODEL_PRIMITIVES);
}

static uint32_t segment_of_item(const PovrayGeometry *geometry, size_t item)
{
    const Geometry *all = &geometry->scene->geometry;
    return items_are_primitives(all) ? all->primitives[item].segment : all->segments[item].segment;
}

/* Sorts the items by tree, behind those of the whole. */
static void sort_items(PovrayGeometry *geometry, uint32_t *index)
{
    const uint32_t *tree = geometry->params->anatomy->tree;
    const size_t n = geometry->objects[0].n;
    for (size_t i = 0; i < n; i++)
        geometry->objects[1 + tree[segment_of_item(geometry, i)]].n++;
    for (size_t k = 1; k < geometry->n_objects; k++) {
        geometry->objects[k].index = index;
        index += geometry->objects[k].n;
        geometry->objects[k].n = 0;
    }
    for (size_t i = 0; i < n; i++) {
        PovrayItems *object = &geometry->objects[1 + tree[segment_of_item(geometry, i)]];
        geometry->indices[(size_t)(object->index - geometry->indices) + object->n++] = (uint32_t)i;
    }
}

/* Marks the segments of which rays of the part can meet a triangle. */
static void mark_triangles(const PovrayGeometry *geometry, bool *is_met)
{
    const VesselMesh *mesh = &geometry->scene->geometry.mesh;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        Box box = box_empty();
        for (int k = 0; k < 3; k++)
            box = box_with_ball(box, mesh_point(mesh, mesh->triangles[i][k]), 0);
        bool *met = &is_met[mesh_segment(mesh, i)];
        *met = *met || sight_meets(geometry->sight, box);
    }
}

static bool meets_primitive(const PovrayGeometry *geometry, size_t item)
{
    Box box = box_empty();
    for (size_t end = 0; end < 2; end++) {
        Ball ball = geometry_ball(&geometry->scene->geometry, 2 * item + end);
        box = box_with_ball(box, ball.center, ball.radius);
    }
    return sight_meets(geometry->sight, box);
}

/* Keeps of all items those that rays of the part can meet. */
static Status choose_items(PovrayGeometry *geometry, Err *err)
{
    PovrayItems *all = &geometry->objects[0];
    bool *is_met, primitives = items_are_primitives(&geometry->scene->geometry);
    size_t n = 0;
    TRY(mem_calloc(&is_met, all->n, sizeof *is_met, "pieces", err));
    if (!primitives)
        mark_triangles(geometry, is_met);
    for (size_t i = 0; i < all->n; i++)
        if (primitives ? meets_primitive(geometry, i) : is_met[i])
            geometry->indices[n++] = (uint32_t)i;
    all->n = n;
    geometry->nothing = n == 0;
    free(is_met);
    return STATUS_OK;
}

static Status find_items(PovrayGeometry *geometry, Err *err)
{
    const Anatomy *anatomy = geometry->params->anatomy;
    const Geometry *all = &geometry->scene->geometry;
    const size_t n = items_are_primitives(all) ? all->n_primitives : all->n_segments;
    geometry->n_objects = anatomy && anatomy->n_trees > 1 ? 1 + anatomy->n_trees : 1;
    TRY(mem_calloc(&geometry->objects, geometry->n_objects, sizeof *geometry->objects, "trees",
                   err));
    TRY(mem_calloc(&geometry->indices, 2 * n, sizeof *geometry->indices, "trees", err));
    for (size_t i = 0; i < n; i++)
        geometry->indices[i] = (uint32_t)i;
    geometry->objects[0] = (PovrayItems){geometry->indices, n};
    if (geometry->sight && !is_field(geometry))
        TRY(choose_items(geometry, err));
    if (geometry->n_objects > 1)
        sort_items(geometry, geometry->indices + n);
    return STATUS_OK;
}

/* The cells of a part of the geometry, with the numbers of the whole. */
static Status part_cells(const PovrayGeometry *geometry, PovrayItems items, CellTree *cells,
                         Err *err)
{
    Geometry part = {0};
    TRY(geometry_part(&geometry->scene->geometry, items.index, items.n, &part, err));
    Status status = celltree_build(&part, &geometry->params->cells, cells, err);
    geometry_release(&part);
    for (size_t i = 0; i < cells->n_terms; i++)
        cells->terms[i].segment = items.index[cells->terms[i].segment];
    for (size_t i = 0; i < cells->n_cells; i++)
        if (cells->cells[i].largest != CELL_MIXED)
            cells->cells[i].largest = items.index[cells->cells[i].largest];
    return status;
}

/* Those of the cells that are built that rays of the part can meet. */
static Status take_cells(PovrayGeometry *geometry, Err *err)
{
    const CellTree *built = geometry->params->built;
    TRY(mem_calloc(&geometry->met, built->n_cells, sizeof *geometry->met, "cells", err));
    size_t n = 0;
    for (size_t i = 0; i < built->n_cells; i++) {
        const Cell *cell = &built->cells[i];
        if (sight_meets(geometry->sight, (Box){cell->low, cell->high}))
            geometry->met[n++] = *cell;
    }
    geometry->cells[0] = *built;
    geometry->cells[0].cells = geometry->met;
    geometry->cells[0].n_cells = n;
    return STATUS_OK;
}

Status povray_objects_find(PovrayGeometry *geometry, Err *err)
{
    const EmitParams *params = geometry->params;
    const Scene *scene = geometry->scene;
    const bool cut = model_has(scene->geometry.model, MODEL_POTENTIAL);
    assert(!params->part || (!params->anatomy && (!cut || params->built)));
    if (params->part)
        TRY(sight_new(&scene->view, scene->geometry.bounds, *params->part, params->shadows,
                      &geometry->sight, err));
    TRY(find_items(geometry, err));
    if (model_has(scene->geometry.model, MODEL_BLOB))
        return find_painted(geometry, err);
    if (!cut)
        return STATUS_OK;
    TRY(mem_calloc(&geometry->cells, geometry->n_objects, sizeof *geometry->cells, "cells", err));
    if (params->built)
        TRY(take_cells(geometry, err));
    else
        TRY(celltree_build(&scene->geometry, &params->cells, &geometry->cells[0], err));
    for (size_t k = 1; k < geometry->n_objects; k++)
        if (geometry->objects[k].n)
            TRY(part_cells(geometry, geometry->objects[k], &geometry->cells[k], err));
    return STATUS_OK;
}

void povray_objects_release(PovrayGeometry *geometry)
{
    for (size_t k = geometry->params->built ? 1 : 0; geometry->cells && k < geometry->n_objects;
         k++)
        celltree_release(&geometry->cells[k]);
    free(geometry->cells);
    free(geometry->met);
    free(geometry->objects);
    free(geometry->indices);
    sight_free(geometry->sight);
}

size_t povray_pieces(const PovrayGeometry *geometry)
{
    if (geometry->cells)
        return geometry->cells[0].n_cells;
    return is_field(geometry) ? geometry->painted.n : geometry->objects[0].n;
}

Status put_declaration(Text *out, PovrayGeometry *geometry, const char *kind,
                       Status (*put_members)(Text *, void *, Err *), Err *err)
{
    Values values = {0};
    Text *name = add_value(&values, "name");
    text_puts(name, "Tree");
    if (geometry->object > 0)
        text_printf(name, "_%zu", geometry->object);
    text_puts(add_value(&values, "kind"), kind);
    add_part(&values, "members", put_members, geometry);
    return values_expand(&values, geometry->params, "povray/tree.inc", out, err);
}

/* What stands for a tree of which nothing is drawn. */
static Status put_nothing(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {0};
    return values_expand(&values, geometry->params, "povray/nothing.inc", out, err);
}

/* The trees, as members of the whole. */
static Status put_trees(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Tmpl member = {0};
    TRY(load_template(&member, geometry->params, "povray/member.inc", err));
    Status status = STATUS_OK;
    for (size_t k = 1; status == STATUS_OK && k < geometry->n_objects; k++) {
        char number[NUMBER_TEXT_SIZE];
        status = tmpl_apply(&member, (TmplValue[]){{"number", number_text((double)k, number)}}, 1,
                            out, err);
    }
    tmpl_release(&member);
    return status;
}

Status put_objects(Text *out, PovrayGeometry *geometry,
                   Status (*put_object)(Text *, PovrayGeometry *, Err *), Err *err)
{
    for (geometry->object = 1; geometry->object < geometry->n_objects; geometry->object++)
        if (geometry->objects[geometry->object].n)
            TRY(put_object(out, geometry, err));
        else
            TRY(put_declaration(out, geometry, "object", put_nothing, err));
    geometry->object = 0;
    if (geometry->nothing)
        return put_declaration(out, geometry, "object", put_nothing, err);
    if (geometry->n_objects > 1 && !is_field(geometry))
        return put_declaration(out, geometry, "Tree_Of()", put_trees, err);
    return put_object(out, geometry, err);
}
