/* The geometry of a tree depends on its model, and the appearance on the look and on fields. The
 * two are independent, so that pictures in other colors reuse the geometry. No two surfaces of a
 * model of primitives coincide, because it would be undefined which of two coincident surfaces is
 * visible; coincidence.c ensures this. */
#include "stage/stage.h"

#include "stage/coincidence.h"
#include "stage/joints.h"
#include "stage/solids.h"
#include <stdlib.h>

static Status add_field(const Tree *tree, const Coincidence *coincidence, Geometry *geometry,
                        Err *err)
{
    TRY(mem_calloc(&geometry->segments, tree->n, sizeof *geometry->segments, "segments", err));
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence_draws(coincidence, i))
            geometry->segments[geometry->n_segments++] =
                (FieldSegment){.a = tree->position[tree->parent[i]],
                               .b = tree->position[i],
                               .radius_mm = tree->radius_mm[i],
                               .segment = (uint32_t)i};
    return STATUS_OK;
}

/* Adds the field whose segments blend only where they are connected: the vessels of
 * stage_vessels. */
static Status add_graph(const Tree *tree, const SmoothTree *smooth, Geometry *geometry, Err *err)
{
    VesselTree vessels;
    TRY(stage_vessels(tree, smooth, &vessels, NULL, err));
    Status status = vesseltree_blend(&vessels, &geometry->blend, err);
    geometry->segments = vessels.segments;
    geometry->n_segments = vessels.n_segments;
    vessels.segments = NULL;
    vesseltree_release(&vessels);
    return status;
}

/* Triangulates the surface of the vessels. */
static Status wall_vessels(VesselTree *vessels, const GeometryParams *params, VesselMesh *mesh,
                           StageReport *counted, Err *err)
{
    MeshReport report;
    uint32_t *thinned = NULL;
    if (params->part_overlaps)
        TRY(vesseltree_thin_overlaps(vessels, &params->mesh, &thinned, &counted->thinned, err));
    free(thinned);
    TRY(vesselmesh_build(vessels, &params->mesh, mesh, &report, err));
    Status status = meshreport_check(&report, vessels, err);
    meshreport_release(&report);
    return status;
}

/* Adds the mesh of the geometry's segments, at their present positions. */
static Status add_mesh(const Tree *tree, const GeometryParams *params, Geometry *geometry,
                       StageReport *counted, Err *err)
{
    VesselTree vessels;
    TRY(stage_vessels(tree, params->smooth, &vessels, NULL, err));
    free(vessels.segments);
    vessels.segments = geometry->segments;
    Status status = wall_vessels(&vessels, params, &geometry->mesh, counted, err);
    vessels.segments = NULL;
    vesseltree_release(&vessels);
    return status;
}

/* Adds what the model draws of a tree or of the pieces of a smooth tree. */
static Status add_items(const Tree *tree, const Coincidence *coincidence,
                        const GeometryParams *params, Geometry *geometry, StageReport *report,
                        Err *err)
{
    if (model_has(geometry->model, MODEL_FIELD))
        return add_field(tree, coincidence, geometry, err);
    TRY(mem_calloc(&geometry->primitives, 2 * tree->n, sizeof *geometry->primitives, "primitives",
                   err));
    return model_has(geometry->model, MODEL_JOINTS)
               ? joints_add(tree, coincidence, params->joints, geometry, report, err)
               : solids_add(tree, coincidence, params, geometry, err);
}

static Status add_model(const Tree *tree, const Coincidence *coincidence,
                        const GeometryParams *params, Geometry *geometry, StageReport *report,
                        Err *err)
{
    const SmoothTree *smooth = params->smooth;
    if (model_has(geometry->model, MODEL_TRIANGLES) ||
        (params->graph && model_has(geometry->model, MODEL_FIELD)))
        return add_graph(tree, smooth, geometry, err);
    if (!smooth)
        return add_items(tree, coincidence, params, geometry, report, err);
    const Coincidence of_pieces = coincidence_of_smooth(smooth);
    return add_items(&smooth->tree, &of_pieces, params, geometry, report, err);
}

/* ---- what all models have -------------------------------------------------------------------- */

static Status copy_ids(const Tree *tree, Geometry *geometry, Err *err)
{
    TRY(mem_calloc(&geometry->ids, tree->n, sizeof *geometry->ids, "segments", err));
    geometry->n_ids = tree->n;
    for (size_t i = 0; i < tree->n; i++)
        geometry->ids[i] = (uint32_t)tree->id[i];
    return STATUS_OK;
}

/* A tree is far from the origin beyond this many times its size. */
static const double far_sizes = 16;

static double largest_of(Vec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

/* Moves a geometry that is far from the origin, compared with its size, next to the origin, by
 * whole millimetres. Otherwise digits are lost: POV-Ray stores bounding boxes in single
 * precision. */
static void move_to_origin(Geometry *geometry)
{
    Vec3 center = box_center(geometry->bounds);
    double size = largest_of(vec3_sub(geometry->bounds.high, geometry->bounds.low));
    if (!(largest_of(center) > far_sizes * size))
        return;
    Vec3 move = {-round(center.x), -round(center.y), -round(center.z)};
    geometry->bounds.low = vec3_add(geometry->bounds.low, move);
    geometry->bounds.high = vec3_add(geometry->bounds.high, move);
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        geometry->primitives[i].a = vec3_add(geometry->primitives[i].a, move);
        geometry->primitives[i].b = vec3_add(geometry->primitives[i].b, move);
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        geometry->segments[i].a = vec3_add(geometry->segments[i].a, move);
        geometry->segments[i].b = vec3_add(geometry->segments[i].b, move);
    }
    geometry->origin = vec3_sub(geometry->origin, move);
}

Status stage_geometry(const Tree *tree, const GeometryParams *params, Geometry *geometry,
                      StageReport *report, Err *err)
{
    Geometry built = {.model = params->model, .open_joints = params->joints == JOINTS_PAPER};
    Coincidence coincidence = {0};
    Status status;
    TRY(coincidence_find(tree, &coincidence, err));
    StageReport counted = coincidence_count(tree, &coincidence);
    if (counted.drawn == 0)
        TRY_GOTO(err_set(err, STATUS_INPUT,
                         "the tree has nothing to draw: no segment is longer than %g mm and has a "
                         "radius above 0",
                         SHORTEST_MM));
    built.drawn = counted.drawn;
    TRY_GOTO(copy_ids(params->smooth ? &params->smooth->tree : tree, &built, err));
    TRY_GOTO(add_model(tree, &coincidence, params, &built, &counted, err));
    TRY_GOTO(geometry_check(&built, err));
    geometry_find_bounds(&built);
    move_to_origin(&built);
    if (model_has(built.model, MODEL_TRIANGLES))
        TRY_GOTO(add_mesh(tree, params, &built, &counted, err));
    *geometry = built;
    built = (Geometry){0};
    if (report)
        *report = counted;
done:
    coincidence_release(&coincidence);
    geometry_release(&built);
    return status;
}

/* ---- appearance ------------------------------------------------------------------------------ */

Status stage_appearance(const Look *look, const Field *field, const ColorScale *scale,
                        Appearance *appearance, Err *err)
{
    Appearance made = {.finish = look->finish, .color = look->color};
    Status status;
    if (field) {
        TRY_GOTO(mem_calloc(&made.colors, field->n, sizeof *made.colors, "colors", err));
        TRY_GOTO(mem_calloc(&made.values, field->n, sizeof *made.values, "values", err));
        TRY_GOTO(mem_strdup(&made.name, scale->name ? scale->name : "", err));
        TRY_GOTO(mem_strdup(&made.unit, scale->unit ? scale->unit : "", err));
        made.scale = *scale;
        made.scale.name = made.name;
        made.scale.unit = made.unit;
        made.n_values = field->n;
    }
    for (size_t i = 0; field && i < field->n; i++) {
        float rgb[3];
        colorscale_linear(scale, field->value[i], rgb);
        made.colors[i] = (Rgb){rgb[0], rgb[1], rgb[2]};
        made.values[i] = field->value[i];
    }
    *appearance = made;
    return STATUS_OK;
done:
    appearance_release(&made);
    return status;
}

Status stage_blend(Appearance *appearance, Err *err)
{
    const size_t n = appearance->n_values;
    TRY(mem_calloc(&appearance->ramp, 1, sizeof *appearance->ramp, "colors", err));
    TRY(mem_calloc(&appearance->positions, n, sizeof *appearance->positions, "coincidence", err));
    colorramp_init(appearance->ramp, &appearance->scale.map);
    for (size_t i = 0; i < n; i++) {
        appearance->positions[i] = colorscale_position(&appearance->scale, appearance->values[i]);
        appearance->colors[i] = appearance_blended(appearance, appearance->positions[i]);
    }
    return STATUS_OK;
}
