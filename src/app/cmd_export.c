/* What the manifest says is of the very triangles that go into the file. */
#include "app/commands.h"
#include "app/meshing.h"
#include "emit/emit.h"

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
    ((ExportOptions *)options)->tolerance = MESHING_TOLERANCE;
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

static Status run_export(void *options, Parsed *parsed, Err *err)
{
    const ExportOptions *own_options = options;
    const MeshFormat *format;
    Meshing made = {0};
    Text beside = TEXT_INIT;
    Status status;
    TRY(find_format(own_options->output, &format, err));
    text_printf(&beside, "%s.json", own_options->output);
    TRY_GOTO(text_check(&beside, err));
    const char *paths[2] = {own_options->output, text_chars(&beside)};
    TRY_GOTO(files_write(&parsed->files, "the manifest", paths[1], err));
    TRY_GOTO(meshing_make(parsed->operands[0], own_options->prune_radius_mm, own_options->tolerance,
                          &parsed->common, &made, err));
    const MeshFile file = {&made.mesh, &made.vessels, GENERATOR};
    TRY_GOTO(
        write_files(format, &file, paths, manifest(&made.vessels, &made.mesh, &made.report), err));
done:
    text_release(&beside);
    meshing_release(&made);
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
