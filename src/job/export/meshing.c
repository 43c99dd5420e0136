/* Makes and writes the surface of a tree's vessels. The mesh is validated before any file is
 * written. The manifest therefore describes exactly the triangles in the file, and an invalid mesh
 * is never written. */
#include "job/export/meshing.h"

#include "derive/derive.h"
#include "job/export/scenefiles.h"
#include "job/export/solver_files.h"
#include "stage/stage.h"
#include <stdlib.h>

const char *const vessel_body_names[] = {
    [BODY_POTENTIAL] = "isosurface", [BODY_ROUND] = "rounded", NULL};

/* Makes the vessels from the tree, and warns of segments that are left out. */
static Status take_vessels(MeshResult *made, VesselBody body, const Talk *talk, Err *err)
{
    StageReport report;
    TRY(stage_vessels(&made->of.tree, picture_pieces(&made->of), &made->vessels, &report, err));
    made->vessels.body = body;
    if (report.dropped)
        talk_warn(talk, "%zu segment%s no length or no radius, and %s left out", report.dropped,
                  report.dropped == 1 ? " has" : "s have", report.dropped == 1 ? "is" : "are");
    if (report.covered)
        talk_warn(talk,
                  "%zu segment%s inside other segments between the same two points and left out",
                  report.covered, report.covered == 1 ? " is" : "s are");
    return STATUS_OK;
}

/* Finds the colors of the segments, and the anatomy, by which the file groups them. */
static Status color_vessels(const MeshingOptions *options, const Talk *talk, MeshResult *made,
                            Err *err)
{
    const ColoredTree tree = picture_colored_tree(&made->of);
    Look look;
    TRY(coloring_read_look(options->look, &look, err));
    TRY(coloring_appearance(&options->coloring, &tree, &look, &made->appearance, err));
    coloring_report(&made->appearance, talk);
    return stage_anatomy(tree.drawn, tree.pieces, vec3(0, 0, 0), &made->anatomy, err);
}

/* ---- triangles ------------------------------------------------------------------------------- */

/* The job of triangulating a surface. */
typedef struct Triangulation {
    MeshResult *made;
    MeshParams params;
    bool part_overlaps;
} Triangulation;

static WorkCost estimate_mesh(const void *job, const Talk *talk)
{
    const Triangulation *work = job;
    char memory[BYTES_TEXT_SIZE];
    const MeshEstimate estimate = vesselmesh_estimate(&work->made->vessels, &work->params);
    talk_note(talk, "expecting about %.2g triangles, %.*f s and %s of memory", estimate.triangles,
              estimate.seconds < 10, estimate.seconds, bytes_text(estimate.bytes, memory));
    return (WorkCost){.memory = estimate.bytes};
}

/* Makes the model for a 3D printer, and checks that it fits the bed. */
static Status print_vessels(const Triangulation *work, Err *err)
{
    MeshResult *made = work->made;
    PrintReport *printed = &made->printed;
    PrintParams params = made->print->params;
    params.mesh = work->params;
    params.part_overlaps = work->part_overlaps;
    TRY(print_build(&made->vessels, &params, &made->mesh, &made->report, printed, err));
    made->thinned = (SegmentList){printed->thinned, printed->n_thinned};
    printed->thinned = NULL;
    return printing_check_bed(made->print, &made->mesh, err);
}

/* Triangulates the vessels. Flat cuts of ends need space, so some ends are made longer; a print
 * does this itself. */
static Status build_mesh(void *job, Progress *progress, Err *err)
{
    Triangulation *work = job;
    MeshResult *made = work->made;
    VesselTree *vessels = &made->vessels;
    work->params.progress = progress_report;
    work->params.context = progress;
    if (made->print)
        return print_vessels(work, err);
    if (work->part_overlaps)
        TRY(vesseltree_thin_overlaps(vessels, &work->params, &made->thinned.at, &made->thinned.n,
                                     err));
    if (made->emitter->has_parts && vessels->body == BODY_POTENTIAL)
        TRY(vesseltree_lengthen_ends(vessels, &work->params, &made->longer.at, &made->longer.n,
                                     err));
    return vesselmesh_build(vessels, &work->params, &made->mesh, &made->report, err);
}

static void say_result(const MeshResult *made, const Talk *talk)
{
    const MeshReport *report = &made->report;
    const size_t n_thinned = made->thinned.n, n_longer = made->longer.n;
    if (n_thinned)
        talk_warn(
            talk,
            "%zu segment%s thinned, so that unconnected vessels no longer overlap; this includes "
            "segments that blend with them",
            n_thinned, n_thinned == 1 ? " is" : "s are");
    if (n_longer)
        talk_warn(talk, "%zu end%s lengthened to make room for a flat cut", n_longer,
                  n_longer == 1 ? " is" : "s are");
    if (report->n_enclosed)
        talk_warn(talk, "%zu segments are inside other vessels and have no surface",
                  report->n_enclosed);
    if (report->n_round_ends)
        talk_note(talk,
                  "%zu end%s could not be cut flat because other vessels are too close; %s rounded",
                  report->n_round_ends, report->n_round_ends == 1 ? "" : "s",
                  report->n_round_ends == 1 ? "it is" : "they are");
    if (report->n_near)
        talk_note(talk, "%zu pair%s of unconnected vessels almost touch", report->n_near,
                  report->n_near == 1 ? "" : "s");
    talk_note(talk, "%zu triangles enclose %s mm\xC2\xB3", made->mesh.n_triangles,
              READABLE(report->volume_mm3, 6));
    if (made->print && !made->print->params.lids)
        mesh_report_print(made, talk);
}

static void say_layers(const PrismLayers *layers, const Talk *talk)
{
    talk_note(talk, "%zu prisms, none of them inverted, fill %s mm\xC2\xB3", layers->n_prisms,
              READABLE(layers->volume_mm3, 6));
    if (layers->n_thinner)
        talk_note(
            talk,
            "the layers are thinner than specified at %zu of %zu points: on average %.3f of the "
            "specified thickness, at least %.2g of it",
            layers->n_thinner, layers->n_wall_points, layers->mean_ratio, layers->min_ratio);
}

/* Makes and checks the triangles, and from them the ends and the layers that the format stores. */
static Status triangulate(const MeshingOptions *options, const Common *common, MeshResult *made,
                          Err *err)
{
    static const Work work = {"triangulating", "the mesh", estimate_mesh, build_mesh};
    Triangulation job = {.made = made,
                         .part_overlaps = options->part_overlaps,
                         .params = {.tolerance = options->tolerance,
                                    .lod = options->lod,
                                    .tube_edge = options->tube_edge,
                                    .threads = common->threads}};
    TRY(work_make(&work, &job, NULL, common->talk, err));
    TRY(meshreport_check(&made->report, &made->vessels, err));
    say_result(made, common->talk);
    if (made->emitter->has_parts)
        TRY(meshends_find(&made->mesh, &made->vessels, &made->ends, err));
    if (!made->emitter->has_layers)
        return STATUS_OK;
    TRY(prismlayers_sweep(&made->mesh, &made->vessels, &options->layers, common->threads,
                          &made->layers, err));
    say_layers(&made->layers, common->talk);
    return STATUS_OK;
}

Status meshing_make(const Emitter *emitter, const MeshingOptions *options, PictureTree *of,
                    const Common *common, MeshResult *out, Err *err)
{
    MeshResult made = {.emitter = emitter,
                       .of = *of,
                       .said = blood_specified(&options->coloring.blood),
                       .print = options->print};
    Status status;
    *of = (PictureTree){0};
    TRY_GOTO(take_vessels(&made, (VesselBody)options->body, common->talk, err));
    if (made.print)
        TRY_GOTO(printing_prepare(made.print, &made.vessels, &made.changes, err));
    if (emitter->has_colors)
        TRY_GOTO(color_vessels(options, common->talk, &made, err));
    if (!emitter->of_lines)
        TRY_GOTO(triangulate(options, common, &made, err));
    *out = made;
    return STATUS_OK;
done:
    meshing_release(&made);
    return status;
}

void meshing_release(MeshResult *mesh)
{
    picture_tree_release(&mesh->of);
    appearance_release(&mesh->appearance);
    anatomy_release(&mesh->anatomy);
    vesseltree_release(&mesh->vessels);
    vesselmesh_release(&mesh->mesh);
    meshreport_release(&mesh->report);
    meshends_release(&mesh->ends);
    prismlayers_release(&mesh->layers);
    printreport_release(&mesh->printed);
    free(mesh->thinned.at);
    free(mesh->longer.at);
    *mesh = (MeshResult){0};
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Appends the files beside the mesh: the manifest, and for flow solvers the ends, the centreline
 * and the geometry for gmsh. */
static Status put_beside(const MeshResult *made, FileSlot files[], Err *err)
{
    work_put_json(&files[MESH_MANIFEST], mesh_manifest(made));
    if (files[MESH_GMSH].path)
        solver_gmsh(&made->ends, file_name(files[SCENE_FILE].path), &files[MESH_GMSH].text);
    if (files[MESH_CORE].path)
        solver_core(&made->ends, &made->layers, file_name(files[SCENE_FILE].path),
                    &files[MESH_CORE].text);
    if (!made->emitter->has_parts)
        return STATUS_OK;
    TRY(solver_ends(&made->ends, &made->of, &made->vessels, &made->said, &files[MESH_ENDS].text,
                    err));
    return solver_centerline(&made->of, &made->vessels, &files[MESH_CENTERLINE].text, err);
}

static Status put_mesh(const void *job, const char *command, FileSlot files[], Err *err)
{
    const MeshResult *made = job;
    const Emitter *emitter = made->emitter;
    const EmitParams params = {.mesh = &made->mesh,
                               .vessels = &made->vessels,
                               .appearance = &made->appearance,
                               .anatomy = emitter->has_colors ? &made->anatomy : NULL,
                               .ends = &made->ends,
                               .layers = &made->layers,
                               .digits = EMIT_DIGITS,
                               .command = command};
    if (emitter->of_meshes)
        TRY(put_beside(made, files, err));
    return scene_files_put(emitter, &params, made->of.path, files, NULL, err);
}

Status meshing_write(const MeshResult *mesh, FileSet *files, const Parsed *parsed, Err *err)
{
    return work_write(files, put_mesh, mesh, parsed, err);
}
