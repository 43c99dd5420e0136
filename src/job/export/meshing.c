/* The surface is proved before anything is written: what the manifest says is of the very triangles
 * that go into the file, and a mesh that is not sound becomes no file. */
#include "job/export/meshing.h"

#include "derive/derive.h"
#include "job/export/scenefiles.h"
#include "job/export/solver_files.h"
#include "job/picture/picture.h"
#include "options/output.h"
#include "options/talk.h"
#include "stage/stage.h"
#include "tree/tree.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct Meshing {
    const PictureTree *of;
    Appearance appearance; /* with orders and anatomy: for an emitter with colours */
    Field orders;
    Anatomy anatomy;
    VesselTree vessels;
    VesselMesh mesh;
    MeshReport report;
    MeshEnds ends;              /* for an emitter with parts */
    Text beside[BESIDES];       /* what stands beside the mesh; empty: nothing */
    const PrintSettings *print; /* NULL: none */
    PrintChanges changes;
    PrintReport printed;
    uint32_t *thinned; /* indices of segments, by --part-overlaps */
    uint32_t *longer;  /* likewise, so that ends can be cut off flat, for an emitter with parts */
    size_t n_thinned, n_longer;
} Meshing;

const char *const vessel_body_names[] = {
    [BODY_POTENTIAL] = "isosurface", [BODY_ROUND] = "rounded", NULL};

static Status take_vessels(Meshing *made, VesselBody body, Err *err)
{
    StageReport report;
    TRY(stage_vessels(&made->of->tree, &made->vessels, &report, err));
    made->vessels.body = body;
    if (report.dropped)
        fprintf(stderr, "corcast: %zu segments have no length or no radius and are left out\n",
                report.dropped);
    if (report.covered)
        fprintf(stderr,
                "corcast: %zu segments lie within others between the same two points and are "
                "left out\n",
                report.covered);
    return STATUS_OK;
}

/* What the segments look like, and by which orders they are grouped. */
static Status color_vessels(const MeshingOptions *options, const Talk *talk, Meshing *made,
                            Err *err)
{
    const ColoredTree tree = picture_colored_tree(made->of);
    Look look;
    TRY(coloring_read_look(options->look, &look, err));
    TRY(coloring_appearance(&options->coloring, &tree, &look, &made->appearance, err));
    coloring_say(&made->appearance, talk);
    TRY(stage_anatomy(tree.drawn, vec3(0, 0, 0), &made->anatomy, err));
    return derive_rule(tree.drawn, &(TreeMeta){0}, "strahler", &made->orders, err);
}

/* Says before the work how much of it there is. */
static Status say_estimate(const VesselTree *vessels, const MeshParams *params, bool quiet,
                           Err *err)
{
    char memory[BYTES_TEXT_SIZE];
    MeshEstimate estimate = vesselmesh_estimate(vessels, params);
    if (!quiet)
        fprintf(stderr, "corcast: about %.2g triangles, which take %.*f s and %s of memory\n",
                estimate.triangles, estimate.seconds < 10, estimate.seconds,
                bytes_text(estimate.bytes, memory));
    return mem_check(estimate.bytes, "the mesh", err);
}

static void say_result(const Meshing *made, bool quiet)
{
    const MeshReport *report = &made->report;
    if (made->n_thinned)
        fprintf(stderr,
                "corcast: %zu segment%s thinned, because of an overlap with others that do not "
                "belong there, or blend with such\n",
                made->n_thinned, made->n_thinned == 1 ? " is" : "s are");
    if (made->n_longer)
        fprintf(stderr, "corcast: %zu end%s lengthened to be cut off flat\n", made->n_longer,
                made->n_longer == 1 ? " is" : "s are");
    if (report->n_enclosed)
        fprintf(stderr, "corcast: %zu segments lie wholly within others and have no wall\n",
                report->n_enclosed);
    if (report->n_round && !quiet)
        fprintf(stderr,
                "corcast: %zu ends are round, because other vessels are in the way of a flat one\n",
                report->n_round);
    if (report->n_near && !quiet)
        fprintf(stderr, "corcast: %zu pairs of vessels that do not belong together come near\n",
                report->n_near);
    if (!quiet)
        fprintf(stderr, "corcast: %zu triangles, %.6g mm^3\n", made->mesh.n_triangles,
                report->volume_mm3);
}

static Status print_vessels(Meshing *made, const MeshParams *mesh, bool part_overlaps, Err *err)
{
    PrintReport *printed = &made->printed;
    PrintParams params = made->print->params;
    params.mesh = *mesh;
    params.part_overlaps = part_overlaps;
    TRY(print_build(&made->vessels, &params, &made->mesh, &made->report, printed, err));
    made->thinned = printed->thinned;
    made->n_thinned = printed->n_thinned;
    printed->thinned = NULL;
    return printing_check_bed(made->print, &made->mesh, err);
}

static Status build(Meshing *made, const MeshParams *params, bool part_overlaps, bool parts,
                    Err *err)
{
    if (made->print)
        return print_vessels(made, params, part_overlaps, err);
    if (part_overlaps)
        TRY(vesseltree_part(&made->vessels, params, &made->thinned, &made->n_thinned, err));
    if (parts && made->vessels.body == BODY_POTENTIAL)
        TRY(vesseltree_free_ends(&made->vessels, params, &made->longer, &made->n_longer, err));
    return vesselmesh_build(&made->vessels, params, &made->mesh, &made->report, err);
}

static Status triangulate(Meshing *made, const MeshingOptions *options, bool parts,
                          const Common *common, Err *err)
{
    Progress progress;
    MeshParams params = {.tolerance = options->tolerance,
                         .lod = options->lod,
                         .tube_edge = options->tube_edge,
                         .threads = common->threads,
                         .progress = progress_report,
                         .context = &progress};
    TRY(say_estimate(&made->vessels, &params, common->quiet, err));
    progress_start(&progress, "triangulating", common->talk);
    Status status = build(made, &params, options->part_overlaps, parts, err);
    progress_end(&progress);
    return status;
}

static Printing printing_of(const Meshing *made)
{
    return (Printing){made->print,    &made->changes, made->of->pruned,
                      &made->vessels, &made->printed, &made->mesh};
}

static Status make(const Common *common, const MeshingOptions *options, const Emitter *emitter,
                   Meshing *made, Err *err)
{
    TRY(take_vessels(made, (VesselBody)options->body, err));
    if (made->print)
        TRY(printing_prepare(made->print, &made->vessels, &made->changes, err));
    if (emitter->has_colors)
        TRY(color_vessels(options, common->talk, made, err));
    if (emitter->of_lines)
        return STATUS_OK;
    TRY(triangulate(made, options, emitter->has_parts, common, err));
    TRY(meshreport_check(&made->report, &made->vessels, err));
    say_result(made, common->quiet);
    const Printing print = printing_of(made);
    if (made->print && !made->print->params.lids && !common->quiet)
        printing_say(&print);
    return STATUS_OK;
}

/* ---- the manifest ---------------------------------------------------------------------------- */

static json_t *pair_list(const VesselTree *vessels, const MeshReport *report)
{
    json_t *pairs = json_array();
    for (size_t i = 0; i < report->n_near; i++) {
        const NearPair *pair = &report->near[i];
        const JsonMember members[] = {
            {"segments", json_pack("[i,i]", (int)vessels->ids[pair->segments[0]],
                                   (int)vessels->ids[pair->segments[1]])},
            {"gap_mm", json_number(pair->gap_mm)},
        };
        pairs = json_with_item(pairs, json_with_members(json_object(), members, 2));
    }
    return pairs;
}

static json_t *manifest(const Meshing *made)
{
    const VesselTree *vessels = &made->vessels;
    const VesselMesh *mesh = &made->mesh;
    const MeshReport *report = &made->report;
    const JsonMember members[] = {
        {"generator", json_text(GENERATOR)},
        {"model", json_text(vessel_body_names[vessels->body])},
        {"unit", json_text("mm")},
        {"trees", json_count(report->trees)},
        {"components", json_count(report->components)},
        {"genus", json_count(report->genus)},
        {"euler", json_integer(report->euler)},
        {"watertight", json_boolean(report->open_edges == 0)},
        {"self_intersections", json_count(report->crossings)},
        {"bridges", json_count(report->bridges)},
        {"segments", json_count(vessels->n_segments)},
        {"segments_present", json_count(vessels->n_segments - report->n_missing -
                                        report->n_enclosed - report->n_slivers)},
        {"segments_missing", segment_ids(vessels, report->missing, report->n_missing)},
        {"segments_swallowed", segment_ids(vessels, report->enclosed, report->n_enclosed)},
        {"segments_slivers", segment_ids(vessels, report->slivers, report->n_slivers)},
        {"segments_thinned", segment_ids(vessels, made->thinned, made->n_thinned)},
        {"segments_lengthened", segment_ids(vessels, made->longer, made->n_longer)},
        {"round_ends", segment_ids(vessels, report->round, report->n_round)},
        {"near_pairs", pair_list(vessels, report)},
        {"triangles", json_count(mesh->n_triangles)},
        {"points", json_count(mesh->n_points)},
        {"volume_mm3", json_number(report->volume_mm3)},
        {"tolerance", json_number(report->tolerance)},
        {"max_distance_mm", json_number(report->off.mm)},
        {"max_distance_over_radius", json_number(report->off.ratio)},
    };
    json_t *all = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (!made->print)
        return all;
    const Printing print = printing_of(made);
    return json_with(all, "print", printing_json(&print));
}

static Status write_beside(bool parts, const char *output, Meshing *made, Err *err)
{
    Text *beside = made->beside;
    text_json(&beside[BESIDE_MANIFEST], manifest(made), 2);
    text_puts(&beside[BESIDE_MANIFEST], "\n");
    TRY(text_check(&beside[BESIDE_MANIFEST], err));
    if (!parts)
        return STATUS_OK;
    TRY(meshends_find(&made->mesh, &made->vessels, &made->ends, err));
    solver_gmsh(&made->ends, file_name(output), &beside[BESIDE_GMSH]);
    TRY(text_check(&beside[BESIDE_GMSH], err));
    TRY(solver_ends(&made->ends, &made->of->tree, &made->vessels, &beside[BESIDE_ENDS], err));
    return solver_centerline(&made->of->tree, &made->vessels, &beside[BESIDE_CENTERLINE], err);
}

static void release(Meshing *made)
{
    appearance_release(&made->appearance);
    field_release(&made->orders);
    anatomy_release(&made->anatomy);
    vesseltree_release(&made->vessels);
    vesselmesh_release(&made->mesh);
    meshreport_release(&made->report);
    meshends_release(&made->ends);
    printreport_release(&made->printed);
    for (size_t i = 0; i < BESIDES; i++)
        text_release(&made->beside[i]);
    free(made->thinned);
    free(made->longer);
}

Status meshing_write(const Emitter *emitter, const MeshingOptions *options, const PictureTree *of,
                     const char *output, const Parsed *parsed, Err *err)
{
    Meshing made = {.of = of, .print = options->print};
    char *line = NULL;
    Status status;
    TRY_GOTO(make(&parsed->common, options, emitter, &made, err));
    if (emitter->of_meshes)
        TRY_GOTO(write_beside(emitter->has_parts, output, &made, err));
    TRY_GOTO(command_line_text(parsed, &line, err));
    EmitParams params = {.mesh = &made.mesh,
                         .vessels = &made.vessels,
                         .appearance = &made.appearance,
                         .orders = made.orders.value,
                         .anatomy = emitter->has_colors ? &made.anatomy : NULL,
                         .ends = &made.ends,
                         .command = line};
    for (size_t i = 0; i < BESIDES; i++)
        params.beside[i] = &made.beside[i];
    TRY_GOTO(scene_files_write(emitter, &params, of->path, output, false, NULL, err));
done:
    free(line);
    release(&made);
    return status;
}
