/* The surface is proved before anything is written: a mesh that is not sound becomes no file. */
#include "app/meshing.h"

#include "app/progress.h"
#include "stage/stage.h"
#include "tree/tree.h"
#include "treeio/treeio.h"
#include <stdio.h>

static Status read_vessels(const char *path, double prune_radius_mm, VesselTree *vessels, Err *err)
{
    Tree tree, pruned;
    size_t dropped;
    TRY(tree_read(&tree, path, err));
    Status status = STATUS_OK;
    if (prune_radius_mm > 0) {
        TRY_GOTO(tree_pruned(&tree, prune_radius_mm, &pruned, err));
        tree_release(&tree);
        tree = pruned;
    }
    TRY_GOTO(stage_vessels(&tree, vessels, &dropped, err));
    if (dropped)
        fprintf(stderr, "corcast: %zu segments have no length or no radius and are left out\n",
                dropped);
done:
    tree_release(&tree);
    return status;
}

/* STATUS_DIFFERS, saying what is wrong with a mesh that is not sound. */
static Status check_sound(const VesselTree *vessels, const MeshReport *report, Err *err)
{
    if (meshreport_is_sound(report))
        return STATUS_OK;
    if (report->n_missing)
        return err_set(err, STATUS_DIFFERS,
                       "%zu segments have no triangles, segment %u among them; nothing is written",
                       report->n_missing, vessels->ids[report->missing[0]]);
    return err_set(err, STATUS_DIFFERS,
                   "the surface is not sound: %zu parts for %zu trees, genus %zu, %zu open edges, "
                   "%zu crossing pairs of triangles, %zu bridges; nothing is written (a smaller "
                   "--tolerance may help)",
                   report->components, report->trees, report->genus, report->open_edges,
                   report->crossings, report->bridges);
}

/* Says before the work how much of it there is. */
static Status say_estimate(const VesselTree *vessels, const MeshParams *params, bool quiet,
                           Err *err)
{
    double triangles, bytes;
    char text[BYTES_TEXT_SIZE];
    vesselmesh_estimate(vessels, params, &triangles, &bytes);
    if (!quiet)
        fprintf(stderr, "corcast: about %.2g triangles, which take %s of memory\n", triangles,
                bytes_text(bytes, text));
    return mem_check(bytes, "the mesh", err);
}

static void say_result(const MeshReport *report, const VesselMesh *mesh, bool quiet)
{
    if (report->n_swallowed)
        fprintf(stderr, "corcast: %zu segments lie wholly within others and have no wall\n",
                report->n_swallowed);
    if (report->n_round && !quiet)
        fprintf(stderr,
                "corcast: %zu ends are round, because other vessels are in the way of a flat one\n",
                report->n_round);
    if (report->n_near && !quiet)
        fprintf(stderr, "corcast: %zu pairs of vessels that do not belong together come near\n",
                report->n_near);
    if (!quiet)
        fprintf(stderr, "corcast: %zu triangles, %.6g mm^3\n", mesh->n_triangles,
                report->volume_mm3);
}

static Status triangulate(Meshing *made, double tolerance, const Common *common, Err *err)
{
    Progress progress;
    MeshParams params = {.tolerance = tolerance,
                         .threads = common->threads,
                         .progress = progress_report,
                         .context = &progress};
    TRY(say_estimate(&made->vessels, &params, common->quiet, err));
    progress_start(&progress, "triangulating", common->quiet);
    Status status = vesselmesh_build(&made->vessels, &params, &made->mesh, &made->report, err);
    progress_end(&progress);
    return status;
}

Status meshing_make(const char *tree_path, double prune_radius_mm, double tolerance,
                    const Common *common, Meshing *made, Err *err)
{
    Meshing built = {0};
    Status status;
    TRY_GOTO(read_vessels(tree_path, prune_radius_mm, &built.vessels, err));
    TRY_GOTO(triangulate(&built, tolerance, common, err));
    TRY_GOTO(check_sound(&built.vessels, &built.report, err));
    say_result(&built.report, &built.mesh, common->quiet);
    *made = built;
    return STATUS_OK;
done:
    meshing_release(&built);
    return status;
}

void meshing_release(Meshing *made)
{
    vesseltree_release(&made->vessels);
    vesselmesh_release(&made->mesh);
    meshreport_release(&made->report);
}
