/* Builds the surface mesh of a tree.
 *
 * The tree is cut into junction regions and tubes (junctions.c). The surface of each region is
 * extracted from a lattice of its own, and is proved to be a sphere with holes (junctionmesh.c).
 * Strips and caps join the regions (assemble.c). The regions are spheres with holes, the strips are
 * rings, and the caps are discs, so together they are one sphere per tree. Each loop of a network
 * adds a handle. Two faults remain possible: vessels that meet although they do not blend, and
 * rounding. Both are found on the finished triangles (topology.c, crossings.c). If triangles cross,
 * the whole mesh is built again, with smaller cells in the regions near the crossings.
 *
 * Two simpler ways fail. One octree for all regions gives meshes that are not valid, because cells
 * join vessels whose gap is narrower than a cell. Swept rings alone are not enough, because two
 * junctions of five are in regions of several nodes. */
#include "mesh/mesh.h"

#include "mesh/assemble.h"
#include "mesh/precision.h"
#include "mesh/proof/meshcheck.h"

#include <stdatomic.h>
#include <stdlib.h>

/* How the members of MeshFineness follow from the tolerance. At the tolerance
 * `reference_tolerance`, cells have the side cell_ratio, in local radii, and the bend
 * bending_ratio. The side grows with the square root of the tolerance, because the distance of a
 * chord from its arc does. The four factors are distances in units of the tolerance. The numbers
 * were chosen by measurement: the mean distance of the mesh from the surface is below 0.15
 * tolerances, and one sample of a thousand is beyond the tolerance. */
static const double reference_tolerance = 0.02, cell_ratio = 0.54, bending_ratio = 0.25,
                    sagitta_factor = 0.325, split_factor = 0.65, cap_factor = 0.2,
                    repair_factor = 1.4, rebuild_factor = 2.25;
/* The values of sagitta_factor and repair_factor for BODY_ROUND. The sagitta is smaller, because
 * balls are curved in both directions. The other distance is larger, because triangles cut creases
 * off. */
static const double round_sagitta_factor = 0.24, round_repair_factor = 1.75;

/* Maximum number of cells of a junction region. 5 million cells, with their lattice, take 4 GB of
 * memory. */
enum { MAX_CELLS = 5000000 };

/* If triangles cross, the mesh is built again, up to MAX_ROUNDS times. In round k, the cells of the
 * regions near the crossings have refine_factor^k times their first side: after four rounds 0.41
 * times, which makes 6 times as many triangles. More rounds would mainly repeat crossings that come
 * from rounding. */
enum { MAX_ROUNDS = 4 };
/* In a tree far from the origin, the mesh is not built again if there are more crossings than
 * triangles / FOLDED_PART. So many crossings come from rounding, which smaller triangles make
 * worse. The number decides only how early a mesh is refused. */
enum { FOLDED_PART = 20 };
static const double refine_factor = 0.8;

/* After a region with more terms, a thread releases its workspace, because most regions need a
 * tenth of it. */
enum { TERMS_TO_KEEP = 100 };

typedef struct MeshBuild {
    const VesselTree *tree;
    const MeshParams *params;
    int n_workers;
    Junctions junctions;
    MeshFineness fineness;
    JunctionMesh *meshes;          /* per region */
    JunctionWorkspace *workspaces; /* per thread */
    uint8_t *segment_status;       /* per segment: SegmentStatus */
    uint8_t *finer; /* per region: the last round that made its cells finer; 0: none */
    atomic_size_t done;
} MeshBuild;

/* Returns the fineness for a tolerance. Cells are never wider than 0.7 radii, because wider ones do
 * not resolve the circle of a tube. */
static MeshFineness fineness_of(const VesselTree *tree, double tolerance, double grid_mm)
{
    bool is_round = tree->body == BODY_ROUND;
    double ratio = fmin(cell_ratio * sqrt(tolerance / reference_tolerance), 0.7);
    return (MeshFineness){{ratio, bending_ratio * tolerance / reference_tolerance, MAX_CELLS},
                          (is_round ? round_sagitta_factor : sagitta_factor) * tolerance,
                          split_factor * tolerance,
                          (is_round ? round_repair_factor : repair_factor) * tolerance,
                          rebuild_factor * tolerance,
                          grid_mm};
}

static int workers_of(const MeshParams *params)
{
    return params->threads > 0 ? params->threads : threads_available();
}

/* Returns the number of sides, at least 8, of a regular polygon that is within `sagitta` radii of
 * its circle. */
static uint32_t sides_within(double sagitta)
{
    return (uint32_t)fmax(8, ceil(PI / elementary_acos(1 - sagitta)));
}

/* The estimated cost of a mesh. The number of triangles per radius of vessel length is triangles_a
 * / tolerance + triangles_b, and at least min_triangles. The time per radius is seconds_a /
 * tolerance + seconds_b, in seconds. A segment counts with at most max_counted_radii of its length,
 * because the triangles of a tube are as long as the tube. The program itself takes base_bytes of
 * memory. Measured on grown trees of 200 to 20,000 segments at tolerances of 0.005 to 1.6. */
static const double max_counted_radii = 6, triangles_a = 1.9, triangles_b = 5, min_triangles = 8,
                    seconds_a = 1.15e-5, seconds_b = 1.6e-4, bytes_per_triangle = 50,
                    base_bytes = 24e6;
/* The cost of BODY_ROUND divided by that of BODY_POTENTIAL; measured. */
static const double round_cost_factor = 2.7;
/* A tolerance above this does not lower the number of triangles: cells and polygons are as coarse
 * as they may be. */
static const double max_useful_tolerance = 1.6;

/* Returns the tolerance whose mesh has about `lod` times the triangles. */
static double tolerance_with_lod(const MeshParams *params)
{
    double lod = params->lod > 0 ? params->lod : 1;
    double inverse = lod / params->tolerance - (1 - lod) * triangles_b / triangles_a;
    return inverse * max_useful_tolerance > 1 ? 1 / inverse : max_useful_tolerance;
}

MeshEstimate vesselmesh_estimate(const VesselTree *tree, const MeshParams *params)
{
    double radii = 0, per_tolerance = 1 / tolerance_with_lod(params), rims = 0;
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *segment = &tree->segments[i];
        double length = vec3_distance(segment->a, segment->b) / segment->radius_mm;
        radii += fmin(length, max_counted_radii);
        rims += params->tube_edge > 0 ? length / params->tube_edge : 0;
    }
    radii *= tree->body == BODY_ROUND ? round_cost_factor : 1;
    double triangles = radii * fmax(triangles_a * per_tolerance + triangles_b, min_triangles);
    triangles += 2 * rims * sides_within(cap_factor / per_tolerance);
    return (MeshEstimate){.triangles = triangles,
                          .bytes = base_bytes + bytes_per_triangle * triangles,
                          .seconds =
                              radii * (seconds_a * per_tolerance + seconds_b) / workers_of(params)};
}

static void release_workspaces(MeshBuild *build)
{
    for (int i = 0; i < build->n_workers && build->workspaces; i++)
        junctionworkspace_release(&build->workspaces[i]);
    free(build->workspaces);
    build->workspaces = NULL;
}

static void release_build(MeshBuild *build)
{
    release_workspaces(build);
    for (uint32_t i = 0; i < build->junctions.n_junctions && build->meshes; i++)
        junctionmesh_release(&build->meshes[i]);
    junctions_release(&build->junctions);
    free(build->meshes);
    free(build->segment_status);
    free(build->finer);
}

/* Returns the fineness of one region, whose cells previous rounds may have made smaller. */
static MeshFineness junction_fineness(const MeshBuild *build, size_t junction)
{
    MeshFineness fineness = build->fineness;
    double factor = elementary_pow(refine_factor, build->finer[junction]);
    fineness.cells.ratio *= factor;
    fineness.cells.bending *= factor * factor;
    fineness.sagitta *= factor * factor;
    return fineness;
}

/* Builds the mesh of one region, as the body of a parallel loop. Only worker 0, the calling thread,
 * reports progress. */
static Status build_junction(size_t index, int worker, void *context, Err *err)
{
    MeshBuild *build = context;
    const MeshFineness fineness = junction_fineness(build, index);
    JunctionWorkspace *workspace = &build->workspaces[worker];
    JunctionPlan plan;
    TRY(junctionplan_make(build->tree, &build->junctions, (uint32_t)index, &plan, err));
    const JunctionInput input = {build->tree, &plan, &fineness};
    Status status =
        junctionmesh_make(workspace, &input, &build->meshes[index], build->segment_status, err);
    if (plan.field.n_terms > TERMS_TO_KEEP)
        junctionworkspace_release(workspace);
    junctionplan_release(&plan);
    TRY(status);
    double done = (double)(atomic_fetch_add(&build->done, 1) + 1);
    if (!build->params->progress || worker != 0)
        return STATUS_OK;
    bool goes_on = build->params->progress(done / (double)build->junctions.n_junctions,
                                           build->params->context);
    return goes_on ? STATUS_OK : err_cancelled(err);
}

/* Allocates the arrays of the build. */
static Status reserve_build(MeshBuild *build, Err *err)
{
    size_t n = build->junctions.n_junctions, n_segments = build->tree->n_segments;
    TRY(mem_calloc(&build->meshes, n, sizeof *build->meshes, "junctions", err));
    TRY(mem_calloc(&build->finer, n, sizeof *build->finer, "junctions", err));
    return mem_calloc(&build->segment_status, n_segments, sizeof *build->segment_status, "segments",
                      err);
}

/* Builds the meshes of all regions. */
static Status build_junctions(MeshBuild *build, Err *err)
{
    TRY(mem_calloc(&build->workspaces, (size_t)build->n_workers, sizeof *build->workspaces,
                   "threads", err));
    atomic_store(&build->done, 0);
    for (size_t i = 0; i < build->tree->n_segments; i++)
        build->segment_status[i] = build->junctions.is_tube[i] ? SEGMENT_PRESENT : SEGMENT_MISSING;
    Status status =
        threads_try(build->junctions.n_junctions, build->n_workers, build_junction, build, err);
    release_workspaces(build);
    return status;
}

/* Finds the segments that have a surface but no triangle of the mesh. */
static Status find_slivers(MeshBuild *build, const VesselMesh *mesh, Err *err)
{
    bool *has_triangle = NULL;
    size_t n = build->tree->n_segments;
    TRY(mem_calloc(&has_triangle, n, sizeof *has_triangle, "segments", err));
    for (size_t i = 0; i < mesh->n_triangles; i++)
        has_triangle[mesh_segment(mesh, i)] = true;
    for (size_t i = 0; i < n; i++)
        if (build->segment_status[i] == SEGMENT_PRESENT && !has_triangle[i])
            build->segment_status[i] = SEGMENT_SLIVER;
    free(has_triangle);
    return STATUS_OK;
}

/* Lists the segments with this status in *list, which is owned by the caller. */
static Status list_status(const MeshBuild *build, SegmentStatus status, uint32_t **list, size_t *n,
                          Err *err)
{
    size_t count = 0;
    for (size_t i = 0; i < build->tree->n_segments; i++)
        count += build->segment_status[i] == status;
    TRY(mem_calloc(list, count, sizeof **list, "segments", err));
    for (uint32_t i = 0; i < build->tree->n_segments; i++)
        if (build->segment_status[i] == status)
            (*list)[(*n)++] = i;
    return STATUS_OK;
}

/* Lists the segments with a free end that is not cut off flat. */
static Status list_round(const MeshBuild *build, MeshReport *report, Err *err)
{
    const VesselTree *tree = build->tree;
    size_t capacity = 0;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            uint32_t node = tree->nodes[i][end];
            const uint32_t *first = &build->junctions.incident.first[node];
            if (first[1] - first[0] != 1 || build->junctions.of_node[node] == NO_JUNCTION)
                continue;
            TRY(mem_reserve(&report->round_ends, &capacity, report->n_round_ends + 1,
                            sizeof *report->round_ends, "segments", err));
            report->round_ends[report->n_round_ends++] = i;
        }
    return STATUS_OK;
}

static Status refuse_overlap(const MeshBuild *build, Err *err)
{
    const NearPair *pair = build->junctions.unconnected;
    const uint32_t *ids = build->tree->ids;
    return err_set(
        err, STATUS_INPUT,
        "the vessels of segments %u and %u are unconnected, but overlap by %.3g mm (pairs "
        "of this kind: %zu), so they have no valid surface; `part_overlaps` thins them",
        ids[pair->segments[0]], ids[pair->segments[1]], -pair->gap_mm,
        build->junctions.n_overlapping);
}

/* Finds the topology of the mesh, and that of a valid one. */
static Status find_topology(const MeshBuild *build, const VesselMesh *mesh, MeshReport *report,
                            Err *err)
{
    uint32_t *trees = NULL, *loops = NULL;
    Status status;
    TRY_GOTO(meshcheck_trees(build->tree, &trees, &report->trees, err));
    TRY_GOTO(meshcheck_loops(build->tree, trees, report->trees, &loops, err));
    report->expected_components = report->trees;
    for (size_t i = 0; i < report->trees; i++)
        report->expected_genus += loops[i];
    TRY_GOTO(meshcheck_topology(mesh, trees, report, err));
done:
    free(trees);
    free(loops);
    return status;
}

static Status fill_report(MeshBuild *build, const VesselMesh *mesh, atomic_bool *crossed,
                          MeshReport *report, Err *err)
{
    TRY(find_topology(build, mesh, report, err));
    TRY(meshcheck_crossings(mesh, build->fineness.grid_mm, build->params->threads, crossed,
                            &report->crossings, err));
    TRY(find_slivers(build, mesh, err));
    TRY(list_status(build, SEGMENT_SLIVER, &report->slivers, &report->n_slivers, err));
    TRY(list_status(build, SEGMENT_MISSING, &report->missing, &report->n_missing, err));
    TRY(list_status(build, SEGMENT_ENCLOSED, &report->enclosed, &report->n_enclosed, err));
    return build->tree->body != BODY_ROUND ? list_round(build, report, err) : STATUS_OK;
}

/* Builds all regions and joins them to the mesh. */
static Status make_mesh(MeshBuild *build, VesselMesh *mesh, MeshReport *report, Err *err)
{
    const MeshParams *params = build->params;
    TRY(build_junctions(build, err));
    *report = (MeshReport){.tolerance = tolerance_with_lod(params),
                           .junctions = build->junctions.n_junctions};
    for (uint32_t z = 0; z < build->junctions.n_junctions; z++) {
        report->refined += build->meshes[z].retries > 0 || build->finer[z] > 0;
        report->deviation.mm = fmax(report->deviation.mm, build->meshes[z].deviation.mm);
        report->deviation.ratio = fmax(report->deviation.ratio, build->meshes[z].deviation.ratio);
    }
    const TubeParams tubes = {sides_within(cap_factor * report->tolerance), params->tube_edge,
                              build->fineness.grid_mm};
    return assemble_mesh(build->tree, &build->junctions, build->meshes, &tubes, mesh,
                         &report->deviation, err);
}

/* Makes the cells smaller in the regions at both ends of each segment with a crossing triangle.
 * Returns true if there is such a region. */
static bool refine_crossed(MeshBuild *build, const VesselMesh *mesh, const atomic_bool *crossed,
                           int round)
{
    const Junctions *junctions = &build->junctions;
    bool any = false;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int end = 0; end < 2 && crossed[i]; end++) {
            uint32_t junction = junctions->of_node[build->tree->nodes[mesh_segment(mesh, i)][end]];
            if (junction == NO_JUNCTION)
                continue;
            build->finer[junction] = (uint8_t)round;
            any = true;
        }
    return any;
}

/* Runs one round of vesselmesh_build. *again receives true if another round may help. */
static Status build_once(MeshBuild *build, int round, VesselMesh *mesh, MeshReport *report,
                         bool *again, Err *err)
{
    atomic_bool *crossed = NULL;
    Status status;
    vesselmesh_release(mesh);
    meshreport_release(report);
    TRY_GOTO(make_mesh(build, mesh, report, err));
    TRY_GOTO(mem_calloc(&crossed, mesh->n_triangles, sizeof *crossed, "triangles", err));
    TRY_GOTO(fill_report(build, mesh, crossed, report, err));
    /* Where rounding folds many triangles over each other, smaller triangles make it worse. */
    bool hopeless = precision_explains_crossings(build->tree) &&
                    report->crossings > mesh->n_triangles / FOLDED_PART;
    *again = report->crossings > 0 && round < MAX_ROUNDS && !hopeless &&
             refine_crossed(build, mesh, crossed, round + 1);
done:
    free(crossed);
    return status;
}

Status vesselmesh_build(const VesselTree *tree, const MeshParams *params, VesselMesh *mesh,
                        MeshReport *report, Err *err)
{
    double grid_mm = mesh_grid(fmax(mesh_max_coordinate(tree), params->max_coordinate_mm));
    MeshBuild build = {.tree = tree,
                       .params = params,
                       .n_workers = workers_of(params),
                       .fineness = fineness_of(tree, tolerance_with_lod(params), grid_mm)};
    Junctions *junctions = &build.junctions;
    VesselMesh made = {0};
    MeshReport found = {0};
    Status status;
    bool again = true;
    TRY_GOTO(junctions_find(tree, params, junctions, err));
    if (junctions->n_overlapping)
        TRY_GOTO(refuse_overlap(&build, err));
    TRY_GOTO(reserve_build(&build, err));
    for (int round = 0; again; round++)
        TRY_GOTO(build_once(&build, round, &made, &found, &again, err));
    found.near = junctions->unconnected;
    found.n_near = junctions->n_unconnected;
    found.n_overlapping = junctions->n_overlapping;
    junctions->unconnected = NULL;
    *mesh = made;
    *report = found;
    made = (VesselMesh){0};
    found = (MeshReport){0};
done:
    vesselmesh_release(&made);
    meshreport_release(&found);
    release_build(&build);
    return status;
}
