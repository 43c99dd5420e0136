/* What may stop the work, sizes that a format or a disk does not hold, is asked before it. */
#include "job/export/volumes.h"

#include "derive/derive.h"
#include "emit/emit.h"
#include "options/output.h"
#include "options/talk.h"
#include "options/templates.h"
#include "stage/stage.h"
#include "treeio/treeio.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* By SampleType. */
static const char *const depths[] = {"8", "16", "float", NULL};

typedef enum LabelKind { LABEL_NONE, LABEL_SEGMENT, LABEL_STRAHLER, LABEL_TREE } LabelKind;
static const char *const label_kinds[] = {"none", "segment", "strahler", "tree", NULL};

/* Voxels along the longest side, without --voxel. */
enum { USUAL_VOXELS = 256 };

static const Option volume_options[] = {
    {.name = "voxel",
     SETS(NUMBERS, VolumeOptions, voxel),
     .group = GROUP_VOXELS,
     .argument = "MM",
     .otherwise = "a 256th of the longest side",
     .help = "their size, mm; of different sides X,Y,Z"},
    {.name = "depth",
     SETS(CHOICE, VolumeOptions, depth),
     .choices = depths,
     .group = GROUP_VOXELS,
     .help = "bits that say how much of a voxel is filled, or a float"},
    {.name = "labels",
     SETS(CHOICE, VolumeOptions, labels),
     .choices = label_kinds,
     .group = GROUP_VOXELS,
     .help = "a second volume, V.labels, of what fills the most of each voxel: the id of the "
             "segment, its order, or the number of its tree"},
    {.name = "centreline",
     SETS(OUTPUT, VolumeOptions, centreline),
     .argument = "C.nii.gz",
     .group = GROUP_VOXELS,
     .help = "another volume, 1 where the axis of a segment passes"},
};

const OptionTable volume_table = OPTION_TABLE(volume_options);

void volumes_extensions(Text *out)
{
    for (const VolumeFormat *format = volume_formats; format->suffix; format++)
        text_printf(out, "%s%s", format == volume_formats ? "" : ", ", format->suffix);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* The volumes, and what stands beside them. */
typedef enum VolumeFile {
    FILE_VALUES,
    FILE_LABELS,
    FILE_CENTRELINE,
    FILE_TREE,
    FILE_SCENE, /* of a density file */
    FILE_MANIFEST,
    FILES
} VolumeFile;

typedef struct Paths {
    char *of[FILES]; /* owned; NULL: there is none */
} Paths;

static void paths_release(Paths *paths)
{
    for (int i = 0; i < FILES; i++)
        free(paths->of[i]);
}

/* `output` with `suffix` in the place of the format's, or behind it. */
static Status beside(const char *output, const VolumeFormat *format, bool behind,
                     const char *suffix, char **out, Err *err)
{
    Text path = TEXT_INIT;
    text_append(&path, output, strlen(output) - (behind ? 0 : strlen(format->suffix)));
    text_puts(&path, suffix);
    Status status = text_take(&path, out, err);
    text_release(&path);
    return status;
}

static Status find_paths(const VolumeOptions *options, const VolumeFormat *format,
                         const char *output, Paths *paths, Err *err)
{
    char labels[32];
    snprintf(labels, sizeof labels, ".labels%s", format->suffix);
    TRY(mem_strdup(&paths->of[FILE_VALUES], output, err));
    if (options->labels)
        TRY(beside(output, format, false, labels, &paths->of[FILE_LABELS], err));
    if (options->centreline)
        TRY(mem_strdup(&paths->of[FILE_CENTRELINE], options->centreline, err));
    if (format->is_density)
        TRY(beside(output, format, false, ".pov", &paths->of[FILE_SCENE], err));
    TRY(beside(output, format, false, ".csv", &paths->of[FILE_TREE], err));
    return beside(output, format, true, ".json", &paths->of[FILE_MANIFEST], err);
}

Status volumes_note(const VolumeOptions *options, const VolumeFormat *format, const char *output,
                    Files *files, Err *err)
{
    Paths paths = {0};
    Status status;
    TRY_GOTO(find_paths(options, format, output, &paths, err));
    if (paths.of[FILE_LABELS])
        TRY_GOTO(files_write(files, "the labels", paths.of[FILE_LABELS], err));
    if (paths.of[FILE_SCENE])
        TRY_GOTO(files_write(files, "the scene", paths.of[FILE_SCENE], err));
    TRY_GOTO(files_write(files, "the tree beside it", paths.of[FILE_TREE], err));
    TRY_GOTO(files_write(files, "the manifest", paths.of[FILE_MANIFEST], err));
done:
    paths_release(&paths);
    return status;
}

/* ---- what is written ------------------------------------------------------------------------- */

typedef struct Volumes {
    const VolumeOptions *options;
    const PictureTree *of;
    Geometry geometry;
    size_t within;    /* segments that have both ends of thicker ones */
    uint32_t *labels; /* of segments; owned */
    uint32_t most_label;
    VoxelParams params;
    VoxelReport report;
    VolumeStream streams[3]; /* by VolumeFile */
    Paths paths;
    OutFile files[FILES];
} Volumes;

static Status take_geometry(Volumes *made, Err *err)
{
    StageReport report;
    const GeometryParams rounded = {.model = model_with(MODEL_VOXELS)};
    TRY(stage_geometry(&made->of->tree, &rounded, &made->geometry, &report, err));
    if (report.dropped)
        fprintf(stderr, "corcast: %zu segments have no length or no radius and are left out\n",
                report.dropped);
    made->within = made->geometry.drawn;
    for (size_t i = 0; i < made->geometry.n_primitives; i++)
        made->within -= made->geometry.primitives[i].kind == PRIMITIVE_CYLINDER;
    if (made->within)
        fprintf(stderr, "corcast: %zu segments have both ends of thicker ones and no voxels\n",
                made->within);
    return STATUS_OK;
}

static Status label_segments(Volumes *made, Err *err)
{
    const Tree *tree = &made->of->tree;
    LabelKind kind = (LabelKind)made->options->labels;
    Field field = {0};
    if (kind == LABEL_NONE)
        return STATUS_OK;
    TRY(mem_calloc(&made->labels, tree->n, sizeof *made->labels, "labels", err));
    if (kind != LABEL_SEGMENT)
        TRY(derive_rule(tree, &(TreeMeta){0}, label_kinds[kind], &field, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        made->labels[i] = kind == LABEL_SEGMENT ? (uint32_t)tree->id[i] : (uint32_t)field.value[i];
        made->most_label = made->labels[i] > made->most_label ? made->labels[i] : made->most_label;
    }
    field_release(&field);
    return STATUS_OK;
}

static Status make_grid(Volumes *made, Err *err)
{
    const NumberList *sides = &made->options->voxel;
    Vec3 size = vec3_sub(made->geometry.bounds.high, made->geometry.bounds.low);
    double usual = fmax(size.x, fmax(size.y, size.z)) / USUAL_VOXELS;
    if (sides->n > 1 && sides->n != 3)
        return err_set(err, STATUS_USAGE, "--voxel takes one number or three, not %zu", sides->n);
    for (size_t i = 0; i < sides->n; i++)
        if (!(sides->at[i] > 0))
            return err_set(err, STATUS_USAGE, "--voxel: %g is not above 0", sides->at[i]);
    Vec3 step = sides->n == 3   ? vec3(sides->at[0], sides->at[1], sides->at[2])
                : sides->n == 1 ? vec3(sides->at[0], sides->at[0], sides->at[0])
                                : vec3(usual, usual, usual);
    return voxelgrid_make(&made->geometry, step, &made->params.grid, err);
}

static Status choose_formats(Volumes *made, const VolumeFormat *format, Err *err)
{
    const char *centreline = made->options->centreline;
    const SampleType types[] = {(SampleType)made->options->depth,
                                made->most_label > UINT16_MAX ? SAMPLE_32 : SAMPLE_16, SAMPLE_8};
    for (int i = 0; i < 3; i++)
        made->streams[i] = (VolumeStream){.format = format, .type = types[i]};
    if (centreline && !(made->streams[2].format = volume_format_find(centreline)))
        return err_set(err, STATUS_USAGE,
                       "--centreline: '%s' does not end as a volume does, in .nii.gz", centreline);
    for (int i = 0; i < 3; i++)
        if (made->paths.of[i])
            TRY(volume_check(made->streams[i].format, &made->params.grid, types[i],
                             i == FILE_VALUES, err));
    made->params.values = &made->streams[0];
    made->params.label = made->labels ? &made->streams[1] : NULL;
    made->params.labels = made->labels;
    made->params.centreline = centreline ? &made->streams[2] : NULL;
    return STATUS_OK;
}

/* Says before the work how much of it there is, and whether there is room for it. */
static Status say_estimate(const Volumes *made, bool quiet, Err *err)
{
    VoxelEstimate estimate = voxels_estimate(&made->geometry, &made->params);
    const int64_t *n = made->params.grid.n;
    char bytes[BYTES_TEXT_SIZE], memory[BYTES_TEXT_SIZE];
    if (!quiet)
        fprintf(stderr,
                "corcast: %lld x %lld x %lld voxels, which take about %.*f s, %s of memory and %s "
                "of disk\n",
                (long long)n[0], (long long)n[1], (long long)n[2], estimate.seconds < 10,
                estimate.seconds, bytes_text(estimate.memory, memory),
                bytes_text(estimate.bytes, bytes));
    TRY(mem_check(estimate.memory, "the volume", err));
    return outfile_check_room(&made->files[FILE_VALUES], estimate.bytes, err);
}

/* Vessels that are thin for the samples weigh more than they should. */
static void say_result(const Volumes *made, bool quiet)
{
    const VoxelReport *report = &made->report;
    double more = 100 * (report->volume_mm3 / report->union_mm3 - 1);
    if (fabs(more) > 0.1)
        fprintf(stderr,
                "corcast: rounded to %s bits, voxels hold %.3g %% %s than the vessels; take a "
                "--depth of more\n",
                depths[made->options->depth], fabs(more), more > 0 ? "more" : "less");
    if (report->claimed)
        fprintf(stderr,
                "corcast: %zu labels fill the most of no voxel, and each has one that it meets\n",
                report->claimed);
    if (!quiet)
        fprintf(stderr, "corcast: %lld voxels hold vessels, %.6g mm^3\n", (long long)report->filled,
                report->volume_mm3);
}

static Status begin_streams(Volumes *made, Err *err)
{
    for (int i = 0; i < FILES; i++)
        if (made->paths.of[i])
            TRY(outfile_open(&made->files[i], made->paths.of[i], err));
    for (int i = 0; i < 3; i++) {
        made->streams[i].to = made->files[i].stream;
        made->streams[i].path = made->paths.of[i];
    }
    return STATUS_OK;
}

static Status fill_streams(Volumes *made, const Common *common, Err *err)
{
    Progress progress;
    made->params.threads = common->threads;
    made->params.progress = progress_report;
    made->params.context = &progress;
    for (int i = 0; i < 3; i++)
        if (made->streams[i].to)
            TRY(volume_begin(&made->streams[i], &made->params.grid, i == FILE_VALUES, GENERATOR,
                             err));
    progress_start(&progress, "filling voxels", common->talk);
    Status status = voxels_write(&made->geometry, &made->params, &made->report, err);
    progress_end(&progress);
    return status;
}

static json_t *triple(double x, double y, double z)
{
    json_t *list = json_with_item(json_array(), json_number(x));
    return json_with_item(json_with_item(list, json_number(y)), json_number(z));
}

static json_t *manifest(const Volumes *made, const char *command)
{
    const VoxelGrid *grid = &made->params.grid;
    const VoxelReport *report = &made->report;
    Vec3 first = vec3_add(grid->first, grid->origin);
    const JsonMember members[] = {
        {"generator", json_text(GENERATOR)},
        {"command", json_text(command)},
        {"model", json_text("rounded")},
        {"unit", json_text("mm")},
        {"voxels", json_pack("[I,I,I]", (json_int_t)grid->n[0], (json_int_t)grid->n[1],
                             (json_int_t)grid->n[2])},
        {"voxel_mm", triple(grid->step.x, grid->step.y, grid->step.z)},
        {"first_voxel_mm", triple(first.x, first.y, first.z)},
        {"full", json_number(sample_full(made->streams[0].type))},
        {"segments", json_count(made->geometry.drawn)},
        {"segments_within_others", json_count(made->within)},
        {"labels", json_text(label_kinds[made->options->labels])},
        {"labels_given_a_voxel", json_count(report->claimed)},
        {"filled_voxels", json_integer(report->filled)},
        {"volume_mm3", json_number(report->volume_mm3)},
        {"union_mm3", json_number(report->union_mm3)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}

/* Appends a scene in which the volume glows. */
static Status put_scene(const Volumes *made, const char *command, Text *out, Err *err)
{
    const VoxelGrid *grid = &made->params.grid;
    Vec3 low = vec3_add_scaled(grid->first, grid->step, -0.5), size = grid->step;
    DensityBox density = {.origin = grid->origin};
    Text description = TEXT_INIT;
    char *templates = NULL;
    Status status;
    for (int axis = 0; axis < 3; axis++)
        density.n[axis] = grid->n[axis];
    size =
        vec3((double)grid->n[0] * size.x, (double)grid->n[1] * size.y, (double)grid->n[2] * size.z);
    density.box = (Box){low, vec3_add(low, size)};
    for (size_t i = 0; i < made->geometry.n_primitives; i++)
        density.thickest_mm = fmax(density.thickest_mm, 2 * made->geometry.primitives[i].radius_mm);
    TRY_GOTO(templates_folder(&templates, err));
    picture_description(&made->geometry, made->of->path, &description);
    const EmitParams params = {.templates = templates,
                               .file = file_name(made->paths.of[FILE_SCENE]),
                               .second_file = file_name(made->paths.of[FILE_VALUES]),
                               .description = text_chars(&description),
                               .generator = GENERATOR,
                               .command = command};
    status = emit_density(&params, &density, out, err);
done:
    text_release(&description);
    free(templates);
    return status;
}

/* The tree, the manifest and the scene. */
static Status write_beside(Volumes *made, const Parsed *parsed, Err *err)
{
    Text said[FILES];
    char *line = NULL;
    Status status;
    for (int i = 0; i < FILES; i++)
        said[i] = TEXT_TO(made->files[i].stream);
    TRY_GOTO(command_line_text(parsed, &line, err));
    TRY_GOTO(tree_write_text(&made->of->tree, made->paths.of[FILE_TREE], &said[FILE_TREE], err));
    if (made->paths.of[FILE_SCENE])
        TRY_GOTO(put_scene(made, line, &said[FILE_SCENE], err));
    text_json(&said[FILE_MANIFEST], manifest(made, line), 2);
    text_puts(&said[FILE_MANIFEST], "\n");
    for (int i = FILE_TREE; i < FILES; i++)
        if (said[i].stream)
            TRY_GOTO(text_flush(&said[i], err));
done:
    free(line);
    for (int i = 0; i < FILES; i++)
        text_release(&said[i]);
    return status;
}

static Status make(Volumes *made, const VolumeFormat *format, const char *output,
                   const Parsed *parsed, Err *err)
{
    const Common *common = &parsed->common;
    TRY(find_paths(made->options, format, output, &made->paths, err));
    TRY(take_geometry(made, err));
    TRY(label_segments(made, err));
    TRY(make_grid(made, err));
    TRY(choose_formats(made, format, err));
    TRY(begin_streams(made, err));
    TRY(say_estimate(made, common->quiet, err));
    TRY(fill_streams(made, common, err));
    TRY(write_beside(made, parsed, err));
    say_result(made, common->quiet);
    return STATUS_OK;
}

/* Moves the files that there are to the front: how many. */
static size_t close_ranks(OutFile files[FILES])
{
    size_t n = 0;
    for (int i = 0; i < FILES; i++)
        if (files[i].stream) {
            OutFile file = files[i];
            files[i] = (OutFile){0};
            files[n++] = file;
        }
    return n;
}

Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                     const PictureTree *of, const char *output, const Parsed *parsed, Err *err)
{
    Volumes made = {.options = options, .of = of};
    Status status;
    TRY_GOTO(make(&made, format, output, parsed, err));
    TRY_GOTO(outfiles_commit(made.files, close_ranks(made.files), err));
done:
    for (int i = 0; i < FILES; i++)
        outfile_discard(&made.files[i]);
    geometry_release(&made.geometry);
    free(made.labels);
    paths_release(&made.paths);
    return status;
}
