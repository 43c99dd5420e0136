/* Assembles the solid of a print from closed surfaces.
 *
 * The two sides of a wall are meshed in the same way: the lumen from the vessels, the outer side
 * from vessels whose radii are larger by the wall. The flat ends of both are in the same planes and
 * have rims with the same number of points, so a flat ring joins them. No boolean operation is
 * needed. Both surfaces are proved to be valid before they are joined. The only new fault that is
 * possible is that one surface crosses the other, so the whole solid is searched for crossings. */
#include "print/print.h"

#include "mesh/mesh.h"
#include "print/block.h"
#include "print/seams.h"
#include "print/solid.h"
#include "print/supportpins.h"
#include <stdlib.h>
#include <string.h>

/* One of the two surfaces of a wall, and its flat ends. */
typedef struct PrintSide {
    VesselMesh mesh;
    MeshReport report;
    CutEnds ends;
} PrintSide;

typedef struct PrintBuild {
    VesselTree *tree;
    VesselTree outer; /* the vessels with their walls, and with pins */
    SupportPins pins;
    PrintParams params;
    PrintSide sides[2]; /* the outer side, and the side of the lumen */
    Casing casing;      /* the block or the plate */
    Solid solid;
    SeamGraph seams;
    PrintReport report;
} PrintBuild;

void printreport_release(PrintReport *report)
{
    free(report->closed);
    free(report->lengthened);
    free(report->thinned);
    *report = (PrintReport){0};
}

static void release_side(PrintSide *side)
{
    vesselmesh_release(&side->mesh);
    meshreport_release(&side->report);
    cutends_release(&side->ends);
}

static void release_making(PrintBuild *build)
{
    vesseltree_release(&build->outer);
    supportpins_release(&build->pins);
    release_side(&build->sides[0]);
    release_side(&build->sides[1]);
    solid_release(&build->solid);
    seams_release(&build->seams);
    printreport_release(&build->report);
}

/* Returns the radius of the outer side of a vessel. */
static double outer_radius(const PrintParams *params, double radius_mm)
{
    return radius_mm * (1 + params->wall_ratio) + params->wall_mm;
}

/* Copies the tree with the radii of the outer side. */
static Status make_outer_tree(PrintBuild *build, Err *err)
{
    VesselTree *outer = &build->outer;
    const VesselTree *tree = build->tree;
    size_t n = outer->n_segments = tree->n_segments;
    outer->n_nodes = tree->n_nodes;
    outer->body = tree->body;
    TRY(mem_calloc(&outer->segments, n, sizeof *outer->segments, "segments", err));
    TRY(mem_calloc(&outer->nodes, n, sizeof *outer->nodes, "segments", err));
    TRY(mem_calloc(&outer->ids, n, sizeof *outer->ids, "segments", err));
    memcpy(outer->nodes, tree->nodes, n * sizeof *outer->nodes);
    memcpy(outer->ids, tree->ids, n * sizeof *outer->ids);
    for (size_t i = 0; i < tree->n_segments; i++) {
        outer->segments[i] = tree->segments[i];
        outer->segments[i].radius_mm = outer_radius(&build->params, tree->segments[i].radius_mm);
    }
    return STATUS_OK;
}

/* Applies to the tree the changes that thinning and lengthening made to the outer tree: the inner
 * and outer radii stay a wall apart. */
static Status apply_changes(PrintBuild *build, Err *err)
{
    const PrintParams *params = &build->params;
    const PrintReport *report = &build->report;
    VesselTree *tree = build->tree;
    for (size_t i = 0; i < report->n_lengthened; i++) {
        uint32_t k = report->lengthened[i];
        tree->segments[k].a = build->outer.segments[k].a;
        tree->segments[k].b = build->outer.segments[k].b;
    }
    for (size_t i = 0; i < report->n_thinned; i++) {
        uint32_t k = report->thinned[i];
        double *radius = &tree->segments[k].radius_mm, before = *radius;
        *radius = (build->outer.segments[k].radius_mm - params->wall_mm) / (1 + params->wall_ratio);
        if (*radius < 0.05 * before)
            return err_set(
                err, STATUS_INPUT,
                "the wall of segment %u is so close to an unconnected vessel that thinning leaves "
                "it no lumen; use a thinner wall",
                tree->ids[k]);
    }
    return STATUS_OK;
}

/* Thins overlaps, lengthens ends and adds pins. */
static Status prepare(PrintBuild *build, Err *err)
{
    const PrintParams *params = &build->params;
    PrintReport *report = &build->report;
    TRY(make_outer_tree(build, err));
    if (params->part_overlaps)
        TRY(vesseltree_thin_overlaps(&build->outer, &params->mesh, &report->thinned,
                                     &report->n_thinned, err));
    if (print_is_hollow(params))
        TRY(vesseltree_lengthen_ends(&build->outer, &params->mesh, &report->lengthened,
                                     &report->n_lengthened, err));
    TRY(apply_changes(build, err));
    TRY(vesseltree_closest_pair(&build->outer, &params->mesh, &report->closest,
                                &report->has_closest, err));
    if (!params->base.is_wanted)
        return STATUS_OK;
    TRY(supportpins_add(&build->outer, &params->base, print_has_wall(params), &params->mesh,
                        &build->pins, err));
    report->pins = build->pins.n_pins;
    report->unsupported = build->pins.n_unsupported;
    if (report->pins == 0)
        return err_set(
            err, STATUS_INFEASIBLE,
            "no support pin is possible: at all %zu points that need one, vessels or open "
            "ends are in the way",
            report->unsupported);
    return STATUS_OK;
}

static double rounded(double x, double step)
{
    return round(x / step) * step;
}

/* Finds the grid of all coordinates, and puts the block on it. */
static Status choose_grid(PrintBuild *build, Err *err)
{
    Casing *casing = &build->casing;
    double reach = mesh_max_coordinate(&build->outer), grid;
    if (build->params.block.is_wanted)
        TRY(block_casing(build->tree, &build->params.block, casing, err));
    if (build->params.base.is_wanted)
        *casing = supportpins_base_plate(&build->outer, &build->params.base, &build->pins);
    for (int face = 0; face < CASING_FACES; face++)
        reach = fmax(reach, fabs(face_coordinate(casing, face)));
    build->params.mesh.max_coordinate_mm = reach;
    build->solid.grid_mm = grid = mesh_grid(reach);
    Vec3 *ends[2] = {&casing->box.low, &casing->box.high};
    for (int end = 0; end < 2; end++)
        *ends[end] = vec3(rounded(ends[end]->x, grid), rounded(ends[end]->y, grid),
                          rounded(ends[end]->z, grid));
    return STATUS_OK;
}

/* Meshes one side, and finds its flat ends. */
static Status build_side(const VesselTree *tree, const MeshParams *params, PrintSide *side,
                         Err *err)
{
    TRY(vesselmesh_build(tree, params, &side->mesh, &side->report, err));
    TRY(meshreport_check(&side->report, tree, err));
    return cutends_find(&side->mesh, &side->ends, err);
}

/* Meshes both sides of the wall, or the one side of a print without a wall. */
static Status build_sides(PrintBuild *build, Err *err)
{
    const PrintParams *params = &build->params;
    Status status = build_side(&build->outer, &params->mesh, &build->sides[0], err);
    if (status != STATUS_OK && print_has_wall(params))
        err_prefix(err, "with their walls, ");
    TRY(status);
    if (!print_has_wall(params))
        return STATUS_OK;
    status = build_side(build->tree, &params->mesh, &build->sides[1], err);
    if (status != STATUS_OK)
        err_prefix(err, "inside the walls, ");
    return status;
}

/* Opens the ends of pins, and the ends that are cut flat on both sides of the wall. */
static void open_ends(PrintBuild *build)
{
    CutEnds *ends = &build->sides[0].ends;
    for (size_t i = 0; i < ends->n; i++) {
        CutEnd *end = &ends->items[i];
        if (build->pins.n_pins)
            end->opened = supportpins_is_pin(&build->pins, end->segment);
        CutEnd *other = cutends_at(&build->sides[1].ends, end->segment, end->end);
        if (other)
            end->opened = other->opened = true;
    }
}

/* Joins the sides where they are open. */
static Status join_sides(PrintBuild *build, Err *err)
{
    const CutEnds *ends = &build->sides[0].ends;
    for (size_t i = 0; i < ends->n; i++) {
        const CutEnd *end = &ends->items[i];
        const CutEnd *other = cutends_at(&build->sides[1].ends, end->segment, end->end);
        if (!other)
            continue;
        TRY(solid_ring(&build->solid, end->end ? end->rim : other->rim,
                       end->end ? other->rim : end->rim, end->n, end->segment | MESH_CAP, err));
        seams_add_ring(&build->seams, end->segment, end->segment | MESH_LUMEN);
        build->report.openings++;
    }
    return STATUS_OK;
}

/* Adds the surfaces of the vessels to the solid, joins them, and adds the base plate. */
static Status add_vessels(PrintBuild *build, Err *err)
{
    PrintSide *outer = &build->sides[0], *lumen = &build->sides[1];
    open_ends(build);
    if (print_has_wall(&build->params)) {
        for (uint32_t i = 0; i < build->tree->n_segments; i++)
            seams_add_surface(&build->seams, i | MESH_LUMEN);
        TRY(solid_surface(&build->solid, &lumen->mesh, &lumen->ends, (SurfaceUse){true, MESH_LUMEN},
                          err));
    }
    TRY(solid_surface(&build->solid, &outer->mesh, &outer->ends, (SurfaceUse){0}, err));
    TRY(join_sides(build, err));
    if (!build->params.base.is_wanted)
        return STATUS_OK;
    return supportpins_join(&build->solid, &build->casing, &outer->ends, &build->pins,
                            &build->seams, err);
}

/* Adds everything to the solid. */
static Status add_all(PrintBuild *build, Err *err)
{
    PrintSide *outer = &build->sides[0];
    for (uint32_t i = 0; i < build->outer.n_segments; i++)
        seams_add_surface(&build->seams, i);
    if (build->params.block.is_wanted)
        return block_add(&build->solid,
                         &(const BlockInput){&build->outer, &outer->mesh, &outer->ends,
                                             &build->params.block, &build->casing},
                         &build->seams, &build->report.openings, err);
    return add_vessels(build, err);
}

/* Lists the segments with an end that nothing meets and that is not open. */
static Status list_closed(PrintBuild *build, Err *err)
{
    PrintReport *report = &build->report;
    const VesselTree *tree = build->tree;
    IndexLists incident = {0};
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &incident, err));
    TRY_GOTO(
        mem_calloc(&report->closed, 2 * tree->n_segments, sizeof *report->closed, "ends", err));
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            const uint32_t *first = &incident.first[tree->nodes[i][end]];
            const CutEnd *at = cutends_at(&build->sides[0].ends, i, end);
            if (first[1] - first[0] == 1 && !(at && at->opened))
                report->closed[report->n_closed++] = i;
        }
done:
    indexlists_release(&incident);
    return status;
}

/* Replaces the indices of added segments by those of the original segments, in labels and reports.
 */
static void restore_original_segments(PrintBuild *build, MeshReport *report)
{
    const SupportPins *pins = &build->pins;
    VesselMesh *mesh = &build->solid.mesh;
    uint32_t *const lists[] = {report->enclosed, report->slivers, report->round_ends};
    const size_t counts[] = {report->n_enclosed, report->n_slivers, report->n_round_ends};
    enum { LISTS = sizeof counts / sizeof *counts };
    if (pins->added.n == 0)
        return;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t segment = mesh_segment(mesh, i);
        mesh->labels[i] = (mesh->labels[i] & MESH_FLAGS) |
                          supportpins_original_segment(pins, segment) |
                          (supportpins_is_pin(pins, segment) ? MESH_FRAME : 0);
    }
    for (int k = 0; k < LISTS; k++)
        for (size_t i = 0; i < counts[k]; i++)
            lists[k][i] = supportpins_original_segment(pins, lists[k][i]);
    for (size_t i = 0; i < report->n_near; i++)
        for (int k = 0; k < 2; k++)
            report->near[i].segments[k] =
                supportpins_original_segment(pins, report->near[i].segments[k]);
}

/* Fills the report of the solid and checks it. Facts about segments are those of the outer side. */
static Status prove(PrintBuild *build, MeshReport *report, Err *err)
{
    PrintSide *outer = &build->sides[0];
    *report = outer->report;
    outer->report = (MeshReport){0};
    build->report.outer_mm3 = report->volume_mm3;
    build->report.lumen_mm3 = vesselmesh_volume(&build->sides[print_has_wall(&build->params)].mesh);
    if (print_is_hollow(&build->params)) {
        TRY(list_closed(build, err));
        build->report.cavities =
            seams_count_unjoined(&build->seams, print_has_wall(&build->params) ? MESH_LUMEN : 0);
    }
    if (print_has_wall(&build->params)) {
        report->deviation.mm = fmax(report->deviation.mm, build->sides[1].report.deviation.mm);
        report->deviation.ratio =
            fmax(report->deviation.ratio, build->sides[1].report.deviation.ratio);
    }
    build->report.rings = build->seams.n_rings;
    TRY(seams_prove(&build->seams, &build->solid.mesh, build->solid.grid_mm,
                    build->params.mesh.threads, report, err));
    TRY(meshreport_check(report, &build->outer, err));
    restore_original_segments(build, report);
    return STATUS_OK;
}

/* Adds a disc to each opening of the lumen, facing out of the lumen. */
static Status add_lids(PrintBuild *build, Err *err)
{
    const CutEnds *ends = &build->sides[1].ends;
    const PrintReport *report = &build->report;
    if (report->n_closed)
        return err_set(
            err, STATUS_INPUT,
            "the lumen of segment %u cannot be open at its end, because another vessel is "
            "too close to its wall",
            build->tree->ids[report->closed[0]]);
    for (size_t i = 0; i < ends->n; i++) {
        const CutEnd *end = &ends->items[i];
        const FieldSegment *segment = &build->tree->segments[end->segment];
        Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
        uint32_t middle;
        TRY(solid_point(&build->solid, end->end ? segment->b : segment->a,
                        vec3_scale(axis, end->end ? 1 : -1), &middle, err));
        for (uint32_t k = 0; k < end->n; k++) {
            uint32_t one = end->rim[k], next = end->rim[(k + 1) % end->n];
            TRY(solid_triangle(&build->solid, middle, end->end ? one : next, end->end ? next : one,
                               end->segment | MESH_CAP | MESH_LUMEN, err));
        }
    }
    return STATUS_OK;
}

Status print_build(VesselTree *tree, const PrintParams *params, VesselMesh *mesh,
                   MeshReport *report, PrintReport *print, Err *err)
{
    PrintBuild build = {.tree = tree, .params = *params};
    MeshReport found = {0};
    Status status;
    TRY_GOTO(prepare(&build, err));
    TRY_GOTO(choose_grid(&build, err));
    TRY_GOTO(build_sides(&build, err));
    TRY_GOTO(seams_make(&build.outer, &build.seams, err));
    TRY_GOTO(add_all(&build, err));
    TRY_GOTO(prove(&build, &found, err));
    if (print_has_wall(params) && params->lids)
        TRY_GOTO(add_lids(&build, err));
    *mesh = build.solid.mesh;
    *report = found;
    *print = build.report;
    build.solid.mesh = (VesselMesh){0};
    build.report = (PrintReport){0};
    found = (MeshReport){0};
done:
    meshreport_release(&found);
    release_making(&build);
    return status;
}
