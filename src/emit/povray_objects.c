/* Divides the geometry of a scene for POV-Ray into objects: the whole tree, and each tree of a
 * forest.
 *
 * The object Tree is the whole geometry. If the trees of a forest consist of primitives or
 * triangles, Tree is the union of the trees. Trees of a field cannot be members of Tree: where
 * trees come close to each other, Tree is the level set of the sum over the segments of all trees.
 * Each tree is therefore declared in addition to Tree, as a field of its own segments.
 *
 * If only a part of the picture is drawn, only items that a ray of the part can hit are written. A
 * field keeps all its segments, because its values are sums over segments elsewhere; its cells are
 * chosen instead (find_cells, find_visible_segments). A ray of the part therefore hits the same
 * pieces as in the whole picture. */
#include "emit/povray_objects.h"

#include <assert.h>
#include <stdlib.h>

static bool is_field(const PovrayGeometry *geometry)
{
    return model_has(geometry->scene->geometry.model, MODEL_FIELD);
}

/* Returns true if the items are primitives. Otherwise they are field segments. */
static bool items_are_primitives(const Geometry *all)
{
    return model_has(all->model, MODEL_PRIMITIVES);
}

/* Lists the items of each tree of a forest. */
static Status sort_items(PovrayGeometry *geometry, Err *err)
{
    const uint32_t *tree = geometry->params->anatomy->component;
    const Geometry *all = &geometry->scene->geometry;
    const size_t n = geometry->objects[0].n;
    IndexLists *trees = &geometry->trees;
    TRY(indexlists_begin(trees, geometry->n_objects - 1, "trees", err));
    for (size_t i = 0; i < n; i++)
        indexlists_count(trees, tree[geometry_segment(all, i)]);
    TRY(indexlists_allot(trees, "trees", err));
    for (size_t i = 0; i < n; i++)
        indexlists_put(trees, tree[geometry_segment(all, i)], (uint32_t)i);
    for (size_t k = 1; k < geometry->n_objects; k++)
        geometry->objects[k] =
            (PovrayItems){trees->items + trees->first[k - 1], indexlists_length(trees, k - 1)};
    return STATUS_OK;
}

/* Marks the segments that have a triangle which a ray of the part can hit. */
static void mark_triangles(const PovrayGeometry *geometry, bool *is_hit)
{
    const VesselMesh *mesh = &geometry->scene->geometry.mesh;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        Box box = box_empty();
        for (int k = 0; k < 3; k++)
            box = box_with_ball(box, mesh_point(mesh, mesh->triangles[i][k]), 0);
        bool *hit = &is_hit[mesh_segment(mesh, i)];
        *hit = *hit || rayvolume_meets(geometry->volume, box);
    }
}

static bool hits_primitive(const PovrayGeometry *geometry, size_t item)
{
    Box box = box_empty();
    for (size_t end = 0; end < 2; end++) {
        Ball ball = geometry_ball(&geometry->scene->geometry, 2 * item + end);
        box = box_with_ball(box, ball.center, ball.radius);
    }
    return rayvolume_meets(geometry->volume, box);
}

/* Drops the items that no ray of the part can hit. */
static Status choose_items(PovrayGeometry *geometry, Err *err)
{
    PovrayItems *all = &geometry->objects[0];
    bool *is_hit, primitives = items_are_primitives(&geometry->scene->geometry);
    size_t n = 0;
    TRY(mem_calloc(&is_hit, all->n, sizeof *is_hit, "pieces", err));
    if (!primitives)
        mark_triangles(geometry, is_hit);
    for (size_t i = 0; i < all->n; i++)
        if (primitives ? hits_primitive(geometry, i) : is_hit[i])
            geometry->indices[n++] = (uint32_t)i;
    all->n = n;
    geometry->is_empty = n == 0;
    free(is_hit);
    return STATUS_OK;
}

Status povray_objects_find(PovrayGeometry *geometry, Err *err)
{
    const EmitParams *params = geometry->params;
    const Scene *scene = geometry->scene;
    const Anatomy *anatomy = params->anatomy;
    const Geometry *all = &scene->geometry;
    const size_t n = items_are_primitives(all) ? all->n_primitives : all->n_segments;
    assert(!params->part || !anatomy);
    if (params->part)
        TRY(rayvolume_new(&scene->view, all->bounds, *params->part, params->shadows,
                          &geometry->volume, err));
    geometry->n_objects = anatomy && anatomy->n_trees > 1 ? 1 + anatomy->n_trees : 1;
    TRY(mem_calloc(&geometry->objects, geometry->n_objects, sizeof *geometry->objects, "trees",
                   err));
    TRY(mem_calloc(&geometry->indices, 2 * n, sizeof *geometry->indices, "trees", err));
    for (size_t i = 0; i < n; i++)
        geometry->indices[i] = (uint32_t)i;
    geometry->objects[0] = (PovrayItems){geometry->indices, n};
    if (geometry->volume && !is_field(geometry))
        TRY(choose_items(geometry, err));
    return geometry->n_objects > 1 ? sort_items(geometry, err) : STATUS_OK;
}

void povray_objects_release(PovrayGeometry *geometry)
{
    for (size_t k = geometry->params->built ? 1 : 0; geometry->cells && k < geometry->n_objects;
         k++)
        celltree_release(&geometry->cells[k]);
    free(geometry->cells);
    free(geometry->hit_cells);
    free(geometry->objects);
    free(geometry->indices);
    indexlists_release(&geometry->trees);
    rayvolume_free(geometry->volume);
}

Status put_declaration(Text *out, const PovrayGeometry *geometry, const char *kind,
                       TmplPut *put_members, Err *err)
{
    Values values = {.digits = geometry->params->digits};
    Text *name = add_value(&values, "name");
    text_puts(name, "Tree");
    if (geometry->object > 0)
        put_text(name, "_%z", geometry->object);
    text_puts(add_value(&values, "kind"), kind);
    add_part(&values, "members", put_members, geometry);
    return values_expand(&values, geometry->params, "povray/tree.inc", out, err);
}

/* Appends an invisible object. */
static Status put_nothing(Text *out, const void *geometry, Err *err)
{
    return put_template(((const PovrayGeometry *)geometry)->params, "povray/nothing.inc", out, err);
}

/* Appends the trees as members of the whole. */
static Status put_trees(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Tmpl member = {0};
    Status status;
    TRY_GOTO(tmpl_load(&member, geometry->params->templates, "povray/member.inc", err));
    for (size_t k = 1; k < geometry->n_objects; k++) {
        char number[NUMBER_TEXT_SIZE];
        const TmplValue value = {"number", number_text((double)k, number)};
        TRY_GOTO(tmpl_apply(&member, &value, 1, out, err));
    }
    status = STATUS_OK;
done:
    tmpl_release(&member);
    return status;
}

Status put_objects(Text *out, const PovrayGeometry *geometry, PovrayPutObject *put_object, Err *err)
{
    PovrayGeometry one = *geometry;
    for (one.object = 1; one.object < one.n_objects; one.object++)
        TRY(one.objects[one.object].n ? put_object(out, &one, err)
                                      : put_declaration(out, &one, "object", put_nothing, err));
    one.object = 0;
    if (one.is_empty)
        return put_declaration(out, &one, "object", put_nothing, err);
    if (one.n_objects == 1 || is_field(&one))
        return put_object(out, &one, err);
    return put_declaration(out, &one, "Tree_Of()", put_trees, err);
}
