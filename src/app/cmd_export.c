/* The surface is proved before anything is written: what the manifest says is of the very triangles
 * that go into the file, and a mesh that is not sound becomes no file. */
#include "app/commands.h"
#include "app/progress.h"
#include "emit/emit.h"
#include "stage/stage.h"
#include "surface/surface.h"
#include "tree/tree.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct ExportOptions {
    const char *output;
    double tolerance;
    double prune_radius_mm;
} ExportOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, ExportOptions, output),
     .argument = "M.stl",
     .help = "the mesh; its extension chooses the format"},
    {.name = "tolerance",
     SETS(NUMBER, ExportOptions, tolerance),
     .group = GROUP_VESSELS,
     FROM_TO(0.002, 0.2),
     .help = "how far triangles may be off the surface, over the local radius"},
    {.name = "prune-radius",
     SETS(NUMBER, ExportOptions, prune_radius_mm),
     .group = GROUP_VESSELS,
     FROM_TO(0, 1e7),
     .unit = "mm",
     .otherwise = "",
     .help = "drop segments thinner than this"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    ((ExportOptions *)options)->tolerance = 0.02;
}

static Status find_format(const char *output, const MeshFormat **format, Err *err)
{
    *format = mesh_format_of_extension(file_extension(output));
    if (*format)
        return STATUS_OK;
    Text known = TEXT_INIT;
    for (const MeshFormat *row = mesh_formats; row->name; row++)
        text_printf(&known, "%s.%s",
                    row == mesh_formats ? ""
                    : row[1].name       ? ", "
                                        : " or ",
                    row->extension);
    Status status =
        err_set(err, STATUS_USAGE, "-o: '%s' does not end in %s", output, text_chars(&known));
    text_release(&known);
    return status;
}

static Status read_vessels(const ExportOptions *options, const char *path, VesselTree *vessels,
                           Err *err)
{
    Tree tree, pruned;
    size_t dropped;
    TRY(tree_read(&tree, path, err));
    Status status = STATUS_OK;
    if (options->prune_radius_mm > 0) {
        TRY_GOTO(tree_pruned(&tree, options->prune_radius_mm, &pruned, err));
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

static json_t *id_list(const VesselTree *vessels, const uint32_t *list, size_t n)
{
    json_t *ids = json_array();
    for (size_t i = 0; i < n; i++)
        ids = json_with_item(ids, json_integer(vessels->ids[list[i]]));
    return ids;
}

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

static json_t *count(size_t n)
{
    return json_integer((json_int_t)n);
}

static json_t *manifest(const VesselTree *vessels, const VesselMesh *mesh, const MeshReport *report)
{
    const JsonMember members[] = {
        {"generator", json_text(GENERATOR)},
        {"unit", json_text("mm")},
        {"trees", count(report->trees)},
        {"components", count(report->components)},
        {"genus", count(report->genus)},
        {"euler", json_integer(report->euler)},
        {"watertight", json_boolean(report->open_edges == 0)},
        {"self_intersections", count(report->crossings)},
        {"bridges", count(report->bridges)},
        {"segments", count(vessels->n_segments)},
        {"segments_present", count(vessels->n_segments - report->n_missing - report->n_swallowed)},
        {"segments_missing", id_list(vessels, report->missing, report->n_missing)},
        {"segments_swallowed", id_list(vessels, report->swallowed, report->n_swallowed)},
        {"round_ends", id_list(vessels, report->round, report->n_round)},
        {"near_pairs", pair_list(vessels, report)},
        {"triangles", count(mesh->n_triangles)},
        {"points", count(mesh->n_points)},
        {"volume_mm3", json_number(report->volume_mm3)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
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

/* The mesh and its manifest take their names together. */
static Status write_files(const MeshFormat *format, const MeshFile *file, const char *paths[2],
                          json_t *json, Err *err)
{
    OutFile files[2] = {0};
    Text out = TEXT_INIT, text = TEXT_INIT;
    Status status;
    text_json(&text, json, 2);
    text_puts(&text, "\n");
    for (int i = 0; i < 2; i++)
        TRY_GOTO(outfile_open(&files[i], paths[i], err));
    out = TEXT_TO(files[0].stream);
    TRY_GOTO(format->write(file, &out, err));
    TRY_GOTO(text_flush(&out, err));
    TRY_GOTO(text_check(&text, err));
    Text manifest_text = TEXT_TO(files[1].stream);
    text_add(&manifest_text, &text);
    status = text_flush(&manifest_text, err);
    text_release(&manifest_text);
    if (status == STATUS_OK)
        status = outfiles_commit(files, 2, err);
    else
        goto done;
    text_release(&out);
    text_release(&text);
    return status;
done:
    text_release(&out);
    text_release(&text);
    outfile_discard(&files[0]);
    outfile_discard(&files[1]);
    return status;
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

static Status make_mesh(const ExportOptions *options, const Common *common,
                        const VesselTree *vessels, VesselMesh *mesh, MeshReport *report, Err *err)
{
    Progress progress;
    MeshParams params = {.tolerance = options->tolerance,
                         .threads = common->threads,
                         .progress = progress_report,
                         .context = &progress};
    TRY(say_estimate(vessels, &params, common->quiet, err));
    progress_start(&progress, "triangulating", common->quiet);
    Status status = vesselmesh_build(vessels, &params, mesh, report, err);
    progress_end(&progress);
    return status;
}

static Status run_export(void *options, Parsed *parsed, Err *err)
{
    const ExportOptions *own_options = options;
    const MeshFormat *format;
    VesselTree vessels = {0};
    VesselMesh mesh = {0};
    MeshReport report = {0};
    Text beside = TEXT_INIT;
    Status status;
    TRY(find_format(own_options->output, &format, err));
    text_printf(&beside, "%s.json", own_options->output);
    TRY_GOTO(text_check(&beside, err));
    const char *paths[2] = {own_options->output, text_chars(&beside)};
    TRY_GOTO(files_write(&parsed->files, "the manifest", paths[1], err));
    TRY_GOTO(read_vessels(own_options, parsed->operands[0], &vessels, err));
    TRY_GOTO(make_mesh(own_options, &parsed->common, &vessels, &mesh, &report, err));
    TRY_GOTO(check_sound(&vessels, &report, err));
    say_result(&report, &mesh, parsed->common.quiet);
    const MeshFile file = {&mesh, &vessels, GENERATOR};
    TRY_GOTO(write_files(format, &file, paths, manifest(&vessels, &mesh, &report), err));
done:
    text_release(&beside);
    vesseltree_release(&vessels);
    vesselmesh_release(&mesh);
    meshreport_release(&report);
    return status;
}

const Command command_export = {
    .name = "export",
    .summary = "write the vessels' surface as a closed mesh",
    .operands = "T.swc -o M.stl",
    .examples = "  corcast export tree.swc -o tree.stl\n"
                "  corcast export tree.swc --tolerance 0.05 -o tree.ply\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .size = sizeof(ExportOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}},
    .run = run_export,
};
