/* Writes the vessels of a tree as voxel volumes. Volumes that are too large for the format, the
 * memory or the disk are refused before the work begins. */
#include "job/export/volumes.h"

#include "derive/derive.h"
#include "emit/emit.h"
#include "options/output.h"
#include "options/reading.h"
#include "options/talk.h"
#include "options/templates.h"
#include "stage/stage.h"
#include "treeio/treeio.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The values of --depth, by SampleType. */
static const char *const depths[] = {"8", "16", "float", NULL};

typedef enum LabelKind { LABEL_NONE, LABEL_SEGMENT, LABEL_STRAHLER, LABEL_TREE } LabelKind;
static const char *const label_kinds[] = {"none", "segment", "strahler", "tree", NULL};

/* Default number of voxels along the longest side. The help states it. A volume then has at most
 * 256^3 = 1.7e7 voxels; larger: finer and slower. */
enum { USUAL_VOXELS = 256 };

static const Option volume_options[] = {
    {.name = "spacing",
     .former = "voxel",
     SETS(NUMBERS, VolumeOptions, voxel),
     .group = GROUP_VOXELS,
     .argument = "MM",
     .otherwise = "1/256 of the longest side",
     .help = "edge length of the voxels, mm: one length, or three lengths X,Y,Z"},
    {.name = "depth",
     SETS(CHOICE, VolumeOptions, depth),
     .choices = depths,
     .group = GROUP_VOXELS,
     .help = "number type of a voxel's value, which is the fraction of the voxel that vessels "
             "fill: 8 (8-bit integer, 255 is full), 16 (16-bit integer, 65535 is full), float "
             "(32 bits, 1 is full)"},
    {.name = "labels",
     SETS(CHOICE, VolumeOptions, labels),
     .choices = label_kinds,
     .group = GROUP_VOXELS,
     .help = "label of the voxels in a second volume, which is written to V.labels.nii.gz for "
             "the output V.nii.gz: none (no second volume), segment (id of the segment that "
             "fills most of the voxel), strahler (Strahler order of this segment), tree (number "
             "of its tree). The label is 0 where no vessel fills any part of the voxel"},
    {.name = "centreline",
     SETS(OUTPUT, VolumeOptions, centreline),
     .argument = "C.nii.gz",
     .group = GROUP_VOXELS,
     .help = "second volume to write: 1 in each voxel that the axis of a segment passes through, "
             "else 0"},
};

const OptionTable volume_table = OPTION_TABLE(volume_options);

void volumes_extensions(Text *out)
{
    for (const VolumeFormat *format = volume_formats; format->suffix; format++)
        text_printf(out, "%s%s", format == volume_formats ? "" : ", ", format->suffix);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* The output files: indices in FileSet.at. The first three are volumes. */
typedef enum VolumeFile {
    FILE_VALUES,
    FILE_LABELS,
    FILE_CENTRELINE,
    FILE_TREE,
    FILE_SCENE, /* of a density file */
    FILE_MANIFEST,
    VOLUMES = FILE_TREE
} VolumeFile;

/* Sets the path of a file to `output` with its end `replaced` replaced by `suffix`. If `replaced`
 * is "", the suffix is appended. */
static Status name_beside(const char *output, const char *replaced, const char *suffix,
                          const char *role, FileSlot *file, Err *err)
{
    const size_t kept = strlen(output) - strlen(replaced);
    file->role = role;
    return mem_printf(&file->path, err, "%.*s%s", (int)kept, output, suffix);
}

Status volumes_name(const VolumeOptions *options, const VolumeFormat *format, const char *output,
                    FileSet *files, Err *err)
{
    FileSlot *at = files->at;
    const char *own = format->suffix;
    char labels[32];
    snprintf(labels, sizeof labels, ".labels%s", own);
    TRY(mem_strdup(&at[FILE_VALUES].path, output, err));
    if (options->labels)
        TRY(name_beside(output, own, labels, "the labels", &at[FILE_LABELS], err));
    if (options->centreline)
        TRY(mem_strdup(&at[FILE_CENTRELINE].path, options->centreline, err));
    if (format->is_density)
        TRY(name_beside(output, own, ".pov", "the scene", &at[FILE_SCENE], err));
    TRY(name_beside(output, own, ".csv", "the tree beside it", &at[FILE_TREE], err));
    return name_beside(output, "", ".json", "the manifest", &at[FILE_MANIFEST], err);
}

/* ---- the work -------------------------------------------------------------------------------- */

/* The job of making the volumes. */
typedef struct Volumes {
    const VolumeOptions *options;
    const PictureTree *of;
    Geometry geometry;
    size_t within;    /* number of segments that share both nodes with a thicker segment and have no
                       * voxels */
    uint32_t *labels; /* per segment index; owned */
    uint32_t most_label; /* maximum label, which decides the number of bytes of a voxel */
    VoxelParams params;
    VoxelReport report;
    VolumeStream streams[VOLUMES];
} Volumes;

static Status take_geometry(Volumes *made, const Talk *talk, Err *err)
{
    StageReport report;
    const GeometryParams rounded = {.model = model_with(MODEL_VOXELS),
                                    .smooth = picture_pieces(made->of)};
    TRY(stage_geometry(&made->of->tree, &rounded, &made->geometry, &report, err));
    if (report.dropped)
        talk_warn(talk, "%zu segment%s no length or no radius and %s left out", report.dropped,
                  report.dropped == 1 ? " has" : "s have", report.dropped == 1 ? "is" : "are");
    made->within = report.covered;
    if (made->within)
        talk_warn(
            talk,
            "%zu segment%s inside other segments between the same two points, without voxels of "
            "their own",
            made->within, made->within == 1 ? " is" : "s are");
    return STATUS_OK;
}

/* Sets the labels of the segments; none if no labels are written. */
static Status label_segments(Volumes *made, Err *err)
{
    const SmoothTree *pieces = picture_pieces(made->of);
    const Tree *tree = pieces ? &pieces->tree : &made->of->tree; /* pieces have the same labels */
    LabelKind kind = (LabelKind)made->options->labels;
    Field field = {0};
    if (kind == LABEL_NONE)
        return STATUS_OK;
    if (kind == LABEL_STRAHLER)
        TRY(reading_refuse_loops(tree, made->of->path, "--labels strahler", err));
    TRY(mem_calloc(&made->labels, tree->n, sizeof *made->labels, "labels", err));
    if (kind != LABEL_SEGMENT)
        TRY(derive_computed_field(tree, &(TreeMeta){0}, label_kinds[kind], &field, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        made->labels[i] = kind == LABEL_SEGMENT ? (uint32_t)tree->id[i] : (uint32_t)field.value[i];
        made->most_label = made->labels[i] > made->most_label ? made->labels[i] : made->most_label;
    }
    field_release(&field);
    return STATUS_OK;
}

/* Makes the grid of voxels from --spacing, or with USUAL_VOXELS along the longest side. */
static Status make_grid(Volumes *made, Err *err)
{
    const NumberList *sides = &made->options->voxel;
    Vec3 size = vec3_sub(made->geometry.bounds.high, made->geometry.bounds.low);
    double usual = fmax(size.x, fmax(size.y, size.z)) / USUAL_VOXELS;
    if (sides->n > 1 && sides->n != 3)
        return err_set(err, STATUS_USAGE, "--spacing takes one number or three, not %zu", sides->n);
    for (size_t i = 0; i < sides->n; i++)
        if (!(sides->at[i] > 0))
            return err_set(err, STATUS_USAGE, "--spacing: %g is not above 0", sides->at[i]);
    Vec3 step = sides->n == 3   ? vec3(sides->at[0], sides->at[1], sides->at[2])
                : sides->n == 1 ? vec3(sides->at[0], sides->at[0], sides->at[0])
                                : vec3(usual, usual, usual);
    return voxelgrid_make(&made->geometry, step, &made->params.grid, err);
}

/* Sets the sample type of each volume, and checks that the formats can store the volumes. */
static Status choose_formats(Volumes *made, const VolumeFormat *format, const FileSet *files,
                             Err *err)
{
    const char *centreline = made->options->centreline;
    VolumeStream *streams = made->streams;
    VoxelParams *params = &made->params;
    const SampleType types[VOLUMES] = {(SampleType)made->options->depth,
                                       made->most_label > UINT16_MAX ? SAMPLE_32 : SAMPLE_16,
                                       SAMPLE_8};
    for (int i = 0; i < VOLUMES; i++)
        streams[i] = (VolumeStream){.format = format, .type = types[i]};
    if (centreline && !(streams[FILE_CENTRELINE].format = volume_format_find(centreline)))
        return err_set(err, STATUS_USAGE,
                       "--centreline: '%s' must end in .nii.gz or the extension of another format "
                       "of volumes",
                       centreline);
    for (int i = 0; i < VOLUMES; i++)
        if (files->at[i].path)
            TRY(volume_check(streams[i].format, &params->grid, types[i], i == FILE_VALUES, err));
    params->fraction = &streams[FILE_VALUES];
    params->label = made->labels ? &streams[FILE_LABELS] : NULL;
    params->labels = made->labels;
    params->centreline = centreline ? &streams[FILE_CENTRELINE] : NULL;
    return STATUS_OK;
}

static WorkCost estimate_volumes(const void *job, const Talk *talk)
{
    const Volumes *made = job;
    const VoxelEstimate estimate = voxels_estimate(&made->geometry, &made->params);
    const int64_t *n = made->params.grid.n;
    char bytes[BYTES_TEXT_SIZE], memory[BYTES_TEXT_SIZE];
    talk_note(
        talk, "expecting %lld x %lld x %lld voxels, about %.*f s, %s of memory and %s of disk",
        (long long)n[0], (long long)n[1], (long long)n[2], estimate.seconds < 10, estimate.seconds,
        bytes_text(estimate.memory, memory), bytes_text(estimate.bytes, bytes));
    return (WorkCost){estimate.memory, estimate.bytes};
}

static Status fill_streams(void *job, Progress *progress, Err *err)
{
    Volumes *made = job;
    made->params.progress = progress_report;
    made->params.context = progress;
    for (int i = 0; i < VOLUMES; i++)
        if (made->streams[i].to)
            TRY(volume_begin(&made->streams[i], &made->params.grid, i == FILE_VALUES, GENERATOR,
                             err));
    return voxels_write(&made->geometry, &made->params, &made->report, err);
}

/* Sends notes about the result. Rounding voxel values to few bits changes the total volume, mainly
 * where vessels are thin, so a difference above 0.1 % is a warning. (Reason of 0.1 % not recorded;
 * larger: fewer warnings.) */
static void say_result(const Volumes *made, const Talk *talk)
{
    const VoxelReport *report = &made->report;
    double more = 100 * (report->volume_mm3 / report->union_mm3 - 1);
    if (fabs(more) > 0.1)
        talk_warn(talk,
                  "rounded to %s bits, voxels hold %.3g %% %s than the vessels; use a larger "
                  "--depth",
                  depths[made->options->depth], fabs(more), more > 0 ? "more" : "less");
    if (report->n_reserved_labels)
        talk_warn(talk, "%zu label%s no voxel; each received a voxel that it touches",
                  report->n_reserved_labels,
                  report->n_reserved_labels == 1 ? " dominates" : "s dominate");
    talk_note(talk, "%lld voxels contain vessels, %s mm\xC2\xB3", (long long)report->filled,
              READABLE(report->volume_mm3, 6));
}

static json_t *json_vector(Vec3 v)
{
    return json_numbers((const double[]){v.x, v.y, v.z}, 3);
}

static json_t *manifest(const Volumes *made, const char *command)
{
    const VoxelGrid *grid = &made->params.grid;
    const VoxelReport *report = &made->report;
    Vec3 first = vec3_add(grid->first, grid->origin);
    return JSON_OBJECT({"generator", json_text(GENERATOR)}, {"command", json_text(command)},
                       {"model", json_text("rounded")}, {"unit", json_text("mm")},
                       {"voxels", json_pack("[I,I,I]", (json_int_t)grid->n[0],
                                            (json_int_t)grid->n[1], (json_int_t)grid->n[2])},
                       {"voxel_mm", json_vector(grid->step)},
                       {"first_voxel_mm", json_vector(first)},
                       {"full", json_number(sample_full(made->streams[0].type))},
                       {"segments", json_count(made->geometry.drawn)},
                       {"segments_within_others", json_count(made->within)},
                       {"labels", json_text(label_kinds[made->options->labels])},
                       {"labels_given_a_voxel", json_count(report->n_reserved_labels)},
                       {"filled_voxels", json_integer(report->filled)},
                       {"volume_mm3", json_number(report->volume_mm3)},
                       {"union_mm3", json_number(report->union_mm3)});
}

/* Returns the volume's box, as the scene of a density file needs it. The first voxel's position is
 * its centre, so the box begins half a voxel before it. */
static DensityBox density_box(const Volumes *made)
{
    const VoxelGrid *grid = &made->params.grid;
    const Vec3 low = vec3_add_scaled(grid->first, grid->step, -0.5);
    const Vec3 size = vec3((double)grid->n[0] * grid->step.x, (double)grid->n[1] * grid->step.y,
                           (double)grid->n[2] * grid->step.z);
    DensityBox density = {.origin = grid->origin, .box = {low, vec3_add(low, size)}};
    for (int axis = 0; axis < 3; axis++)
        density.n[axis] = grid->n[axis];
    for (size_t i = 0; i < made->geometry.n_primitives; i++)
        density.thickest_mm = fmax(density.thickest_mm, 2 * made->geometry.primitives[i].radius_mm);
    return density;
}

/* Appends the POV-Ray scene that draws the volume as a glowing medium. */
static Status put_scene(const Volumes *made, const char *command, FileSlot files[], Err *err)
{
    const DensityBox density = density_box(made);
    Text description = TEXT_INIT;
    char *templates = NULL;
    Status status;
    TRY_GOTO(templates_folder(&templates, err));
    picture_description(&made->geometry, made->of->path, &description);
    const EmitParams params = {.templates = templates,
                               .file = file_name(files[FILE_SCENE].path),
                               .second_file = file_name(files[FILE_VALUES].path),
                               .description = text_chars(&description),
                               .generator = GENERATOR,
                               .command = command};
    status = emit_density(&params, &density, &files[FILE_SCENE].text, err);
done:
    text_release(&description);
    free(templates);
    return status;
}

/* Appends all files except the volumes, which were written while they were filled. */
static Status put_beside(const void *job, const char *command, FileSlot files[], Err *err)
{
    const Volumes *made = job;
    TRY(tree_write_bytes(&made->of->tree, files[FILE_TREE].path, &files[FILE_TREE].text, err));
    if (files[FILE_SCENE].path)
        TRY(put_scene(made, command, files, err));
    work_put_json(&files[FILE_MANIFEST], manifest(made, command));
    return STATUS_OK;
}

/* Checks and prepares all that can fail before the long work, and opens the files. */
static Status prepare(Volumes *made, const VolumeFormat *format, FileSet *files, const Talk *talk,
                      Err *err)
{
    TRY(take_geometry(made, talk, err));
    TRY(label_segments(made, err));
    TRY(make_grid(made, err));
    TRY(choose_formats(made, format, files, err));
    TRY(fileset_open(files, err));
    for (int i = 0; i < VOLUMES; i++)
        made->streams[i].to = files->at[i].stream;
    return STATUS_OK;
}

Status volumes_write(const VolumeOptions *options, const VolumeFormat *format,
                     const PictureTree *of, FileSet *files, const Parsed *parsed, Err *err)
{
    static const Work work = {"filling voxels", "the volume", estimate_volumes, fill_streams};
    const Talk *talk = parsed->common.talk;
    Volumes made = {.options = options, .of = of, .params.threads = parsed->common.threads};
    Status status;
    TRY_GOTO(prepare(&made, format, files, talk, err));
    TRY_GOTO(work_make(&work, &made, files, talk, err));
    TRY_GOTO(work_write(files, put_beside, &made, parsed, err));
    say_result(&made, talk);
done:
    geometry_release(&made.geometry);
    free(made.labels);
    return status;
}
