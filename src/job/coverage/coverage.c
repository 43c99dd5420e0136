/* Runs the operation `coverage`: measures distances between tissue and vessels. The volumes are
 * written to their files while they are measured, so that they need no memory. Therefore all
 * options, the tree and the domain are checked before. */
#include "job/coverage/coverage.h"

#include "derive/derive.h"
#include "job/tree/tree_domain.h"
#include "job/work.h"
#include "options/output.h"
#include "options/reading.h"
#include <stdlib.h>
#include <string.h>

/* The quantiles that are reported, as fractions. */
enum { COVERAGE_QUANTILES = 7 };
static const double reported_quantiles[COVERAGE_QUANTILES] = {0.05, 0.25, 0.5, 0.75,
                                                              0.9,  0.95, 0.99};

typedef enum TerritoryKind { TERRITORY_TERMINAL, TERRITORY_SEGMENT, TERRITORY_TREE } TerritoryKind;
static const char *const territory_kinds[] = {"terminal", "segment", "tree", NULL};

/* Number of voxels along the longest side of the domain, without --spacing: two million voxels of a
 * cube, which take seconds. */
enum { USUAL_VOXELS = 128 };

/* Accepted difference between the volume of the domain and that of its voxels, as a fraction. It
 * decides which --spacing is refused as too large: with an error of a tenth in the volume, the
 * shares of tissue that are reported are off by a tenth as well. */
static const double volume_tolerance = 0.1;

typedef struct CoverageOptions {
    const char *domain;                                /* NULL: the tree's */
    double spacing_mm;                                 /* 0: see USUAL_VOXELS */
    NumberList beyond;                                 /* mm */
    const char *output, *territories, *summary, *json; /* files; NULL: not written */
    int kind;                                          /* a TerritoryKind */
} CoverageOptions;

static const Option rows[] = {
    {.name = "output",
     SETS(OUTPUT, CoverageOptions, output),
     .argument = "D.nii.gz",
     .otherwise = "",
     .help = "volume to write: the distance of each voxel from the nearest vessel wall, mm; 0 in "
             "vessels, NaN outside the tissue shape"},
    {.name = "territories",
     SETS(OUTPUT, CoverageOptions, territories),
     .argument = "L.nii.gz",
     .otherwise = "",
     .help = "volume to write: for each voxel, the label of the territory that the voxel belongs "
             "to; 0 outside the tissue shape. A table with the same name (L.csv) lists the volume "
             "and the flow of each territory"},
    {.name = "territory",
     SETS(CHOICE, CoverageOptions, kind),
     .choices = territory_kinds,
     .needs = "territories",
     .help = "with --territories: how a voxel is assigned to a territory: terminal (by the "
             "nearest end of a terminal segment), segment (by the nearest vessel wall; the label "
             "is the id of the segment), tree (by the nearest vessel wall; the label is the "
             "number of the tree)"},
    {.name = "summary",
     SETS(OUTPUT, CoverageOptions, summary),
     .argument = "S.csv",
     .otherwise = "",
     .help = "table to write, as CSV: the results, with the columns quantity, at (a quantile "
             "such as 0.95, or a distance of --beyond), value and unit"},
    {.name = "json",
     SETS(OUTPUT, CoverageOptions, json),
     .otherwise = "",
     .help = "write the results as JSON to FILE"},
    {.name = "domain",
     SETS(TEXT, CoverageOptions, domain),
     .group = GROUP_TREE,
     .argument = "SHAPE",
     .list = "domains",
     .otherwise = "from the tree; if it states none, the option is required",
     .help = "tissue shape whose points are measured, lengths in mm, such as ball:R, mask:FILE, "
             "mesh:FILE, or hull:MM (everything within MM of the tree)"},
    {.name = "spacing",
     .former = "voxel",
     SETS(NUMBER, CoverageOptions, spacing_mm),
     .group = GROUP_VOXELS,
     FROM_TO(DOMAIN_MIN_MM, DOMAIN_MAX_MM),
     .unit = "mm",
     .otherwise = "1/128 of the longest side of the box around the tissue",
     .help = "edge length of the cubic voxels whose centers sample the tissue"},
    {.name = "beyond",
     SETS(NUMBERS, CoverageOptions, beyond),
     .argument = "MM,...",
     .otherwise = "0.1,0.2",
     .help = "increasing distances, mm. For each distance, the report states the share of the "
             "tissue that is farther than this from every vessel wall"},
};

static const OptionTable table = OPTION_TABLE(rows);

/* ---- the tree -------------------------------------------------------------------------------- */

/* Positions in FileSet. */
enum { FILE_DISTANCES, FILE_TERRITORIES, FILE_TABLE, FILE_SUMMARY, FILE_JSON };

/* A measurement. Owns all pointers except those of `options` and `params`. */
typedef struct Measuring {
    const CoverageOptions *options;
    Tree tree;
    Domain domain;
    DomainTube *tubes, *outlets;
    size_t n_tubes, n_outlets;
    uint32_t *tube_node, *outlet_node; /* index of the node of a tube or an outlet */
    size_t n_parts;               /* number of outlets or tubes whose territories are measured */
    const uint32_t *part_node;    /* their nodes: outlet_node or tube_node */
    uint32_t *labels, most_label; /* per outlet or tube */
    VolumeStream distances, territories;
    CoverageParams params;
    CoverageResult *result;
} Measuring;

/* Lists the vessels as tubes, and the ends of terminal vessels, the outlets. */
static Status take_tubes(Measuring *made, const char *path, Err *err)
{
    const Tree *tree = &made->tree;
    int32_t *children = NULL;
    TRY(mem_calloc(&made->tubes, tree->n, sizeof *made->tubes, "vessels", err));
    TRY(mem_calloc(&made->outlets, tree->n, sizeof *made->outlets, "terminals", err));
    TRY(mem_calloc(&made->tube_node, tree->n, sizeof *made->tube_node, "vessels", err));
    TRY(mem_calloc(&made->outlet_node, tree->n, sizeof *made->outlet_node, "terminals", err));
    TRY(tree_child_counts(tree, &children, err));
    for (size_t i = 0; i < tree->n; i++) {
        Vec3 end = tree->position[i];
        if (!tree_is_segment(tree, i))
            continue;
        made->tube_node[made->n_tubes] = (uint32_t)i;
        made->tubes[made->n_tubes++] =
            (DomainTube){tree->position[tree->parent[i]], end, tree->radius_mm[i]};
        if (children[i] > 0)
            continue;
        made->outlet_node[made->n_outlets] = (uint32_t)i;
        made->outlets[made->n_outlets++] = (DomainTube){end, end, 0};
    }
    free(children);
    return made->n_tubes > 0 ? STATUS_OK
                             : err_set(err, STATUS_INPUT, "%s: the tree has no vessels", path);
}

/* Returns the share of the vessels' length in the domain, from 8 points per vessel. The share only
 * decides about an error (0) and a warning; more points cost more time. */
static double share_inside(const Measuring *made)
{
    enum { POINTS = 8 };
    double length = 0, inside = 0;
    for (size_t i = 0; i < made->n_tubes; i++) {
        const DomainTube *tube = &made->tubes[i];
        Vec3 along = vec3_sub(tube->b, tube->a);
        double part = vec3_length(along) / POINTS;
        for (int k = 0; k < POINTS; k++) {
            Vec3 at = vec3_add_scaled(tube->a, along, (k + 0.5) / POINTS);
            length += part;
            inside += domain_inside(&made->domain, at, made->domain.slack_mm) ? part : 0;
        }
    }
    return length > 0 ? inside / length : 1;
}

/* Reads the domain, and checks that the tree is in it. A share of 1 % outside is accepted without a
 * warning, because grown vessels may touch the border. */
static Status take_domain(Measuring *made, const Parsed *parsed, Err *err)
{
    const char *spec = made->options->domain, *path = parsed->operands[0];
    bool found = true;
    TRY(spec ? tree_domain_parse(spec, &made->tree, path, &made->domain, err)
             : tree_domain(&made->tree, &made->domain, &found, err));
    if (!found)
        return err_set(err, STATUS_INPUT,
                       "%s does not state the tissue it supplies; give `domain`, for example "
                       "--domain hull:1, everything within 1 mm of the vessels",
                       path);
    double inside = share_inside(made);
    if (inside == 0)
        return err_set(err, STATUS_INPUT,
                       "%s: no vessel is in the tissue shape; check its place and the unit of the "
                       "tree (--input-unit)",
                       path);
    if (inside < 0.99)
        talk_warn(parsed->common.talk, "%.3g %% of the vessels' length is outside the tissue shape",
                  100 * (1 - inside));
    return STATUS_OK;
}

/* Sets the label of each vessel or outlet: the id of its segment, or the number of its tree. */
static Status label_territories(Measuring *made, Err *err)
{
    const Tree *tree = &made->tree;
    bool by_outlet = made->options->kind == TERRITORY_TERMINAL;
    const uint32_t *node = by_outlet ? made->outlet_node : made->tube_node;
    Field number = {0};
    made->n_parts = by_outlet ? made->n_outlets : made->n_tubes;
    made->part_node = node;
    if (made->n_parts == 0)
        return err_set(err, STATUS_INPUT,
                       "--territories: no vessel ends at a terminal, so no terminal has a "
                       "territory; use --territory segment or tree");
    TRY(mem_calloc(&made->labels, made->n_parts, sizeof *made->labels, "labels", err));
    if (made->options->kind == TERRITORY_TREE)
        TRY(derive_computed_field(tree, &(TreeMeta){0}, "tree", &number, err));
    for (size_t i = 0; i < made->n_parts; i++) {
        made->labels[i] =
            number.value ? (uint32_t)number.value[node[i]] : (uint32_t)tree->id[node[i]];
        made->most_label = made->labels[i] > made->most_label ? made->labels[i] : made->most_label;
    }
    field_release(&number);
    return STATUS_OK;
}

/* ---- volumes --------------------------------------------------------------------------------- */

static Status choose_format(const char *option, const char *path, SampleType type,
                            const VoxelGrid *grid, VolumeStream *stream, Err *err)
{
    const VolumeFormat *format = volume_format_find(path);
    if (!format || format->is_density)
        return err_set(err, STATUS_USAGE,
                       "%s: '%s' must end in .nii.gz, .nii, .nrrd or .mha, the formats of volumes "
                       "of values",
                       option, path);
    *stream = (VolumeStream){.format = format, .type = type};
    return volume_check(format, grid, type, false, err);
}

static Status make_grid(Measuring *made, Err *err)
{
    const Box *bounds = &made->domain.bounds;
    Vec3 size = vec3_sub(bounds->high, bounds->low);
    double longest = fmax(size.x, fmax(size.y, size.z));
    double side =
        made->options->spacing_mm > 0 ? made->options->spacing_mm : longest / USUAL_VOXELS;
    made->result->spacing_mm = side;
    return coveragegrid_make(&made->domain, side, &made->params.grid, err);
}

static Status set_params(Measuring *made, const Parsed *parsed, Err *err)
{
    const CoverageOptions *options = made->options;
    CoverageParams *params = &made->params;
    params->domain = &made->domain;
    params->tubes = made->tubes;
    params->n_tubes = made->n_tubes;
    params->beyond = made->result->beyond.at;
    params->n_beyond = made->result->beyond.n;
    params->threads = parsed->common.threads;
    TRY(make_grid(made, err));
    if (options->output) {
        TRY(choose_format("--output", options->output, SAMPLE_FLOAT, &params->grid,
                          &made->distances, err));
        params->distances = &made->distances;
    }
    if (!options->territories)
        return STATUS_OK;
    TRY(label_territories(made, err));
    TRY(choose_format("--territories", options->territories,
                      made->most_label > UINT16_MAX ? SAMPLE_32 : SAMPLE_16, &params->grid,
                      &made->territories, err));
    params->territories = &made->territories;
    params->labels = made->labels;
    if (options->kind != TERRITORY_TERMINAL)
        return STATUS_OK;
    params->outlets = made->outlets;
    params->n_outlets = made->n_outlets;
    return STATUS_OK;
}

/* Sets the distances of --beyond; 0.1 and 0.2 mm without the option. */
static Status take_beyond(const CoverageOptions *options, NumberList *beyond, Err *err)
{
    *beyond = options->beyond.n ? options->beyond : (NumberList){{0.1, 0.2}, 2};
    for (size_t i = 0; i < beyond->n; i++)
        if (!(beyond->at[i] > 0) || (i > 0 && beyond->at[i] <= beyond->at[i - 1]))
            return err_set(err, STATUS_USAGE,
                           "--beyond: %g is not above %g; give rising distances above 0",
                           beyond->at[i], i > 0 ? beyond->at[i - 1] : 0.0);
    return STATUS_OK;
}

/* ---- the work -------------------------------------------------------------------------------- */

static WorkCost estimate(const void *job, const Talk *talk)
{
    const Measuring *made = job;
    const int64_t *n = made->params.grid.n;
    double voxels = (double)n[0] * (double)n[1] * (double)n[2], disk = 0;
    /* Deflated distances take about 0.9 of their bytes, so they count in full. Labels repeat and
     * deflate well, to less than a tenth. */
    disk += made->params.distances ? voxels * sizeof(float) : 0;
    disk += made->params.territories ? voxels * (double)sample_size(made->territories.type) *
                                           (made->territories.format->deflated ? 0.1 : 1)
                                     : 0;
    talk_note(talk, "measuring at %lld x %lld x %lld voxels", (long long)n[0], (long long)n[1],
              (long long)n[2]);
    return (WorkCost){coverage_memory(&made->params), disk};
}

static Status measure(void *job, Progress *progress, Err *err)
{
    Measuring *made = job;
    CoverageParams *params = &made->params;
    params->progress = progress_report;
    params->context = progress;
    if (params->distances)
        TRY(volume_begin(params->distances, &params->grid, false, GENERATOR, err));
    if (params->territories)
        TRY(volume_begin(params->territories, &params->grid, false, GENERATOR, err));
    return coverage_measure(params, &made->result->report, err);
}

/* Checks that the voxels have about the volume of the domain. Otherwise they are too large for thin
 * parts of the domain. */
static Status check_volume(const Measuring *made, Err *err)
{
    const CoverageReport *report = &made->result->report;
    double volume = report->tissue_volume + report->vessel_volume;
    if (fabs(volume / made->domain.volume - 1) > volume_tolerance)
        return err_set(err, STATUS_USAGE,
                       "`spacing`: voxels of %g mm are too large for the tissue shape; they fill "
                       "%.3g mm\xC2\xB3 of %.3g mm\xC2\xB3",
                       made->result->spacing_mm, volume, made->domain.volume);
    if (report->tissue_voxels == 0)
        return err_set(err, STATUS_INPUT, "the vessels fill all of the tissue shape");
    return STATUS_OK;
}

/* Warns of a flat tree in a domain of three dimensions. All nodes of a flat tree have the same z.
 */
static void warn_flat(const Measuring *made, const Talk *talk)
{
    const Tree *tree = &made->tree;
    bool is_flat = made->domain.dimension == 3;
    for (size_t i = 1; i < tree->n; i++)
        is_flat = is_flat && tree->position[i].z == tree->position[0].z;
    if (is_flat)
        talk_warn(talk, "all nodes of the tree have the same z, but the tissue shape has three "
                        "dimensions; a flat tree supplies a flat shape, such as disc:R");
}

/* Sets the distances that the law of grown trees [COVERAGE_LAW_MEAN] predicts for as many terminals
 * in as much tissue, and the density of terminals that would keep 95 % of the tissue within the
 * last distance of --beyond. The law is for three dimensions. */
static void apply_law(Measuring *made)
{
    CoverageResult *result = made->result;
    result->terminals = made->n_outlets;
    result->dimension = made->domain.dimension;
    result->law = (CoverageLaw){NAN, NAN, NAN, NAN};
    if (made->domain.dimension == 2)
        return;
    double spacing = elementary_cbrt(result->report.tissue_volume / (double)made->n_outlets);
    double ratio = COVERAGE_LAW_95 / result->beyond.at[result->beyond.n - 1];
    result->law = (CoverageLaw){COVERAGE_LAW_MEAN * spacing, COVERAGE_LAW_95 * spacing,
                                COVERAGE_LAW_LARGEST * spacing, ratio * ratio * ratio};
}

/* ---- tables ---------------------------------------------------------------------------------- */

/* Appends a row of the summary; numbers that are NAN are left empty. */
static void put_row(Text *text, const char *quantity, double at, double value, const char *unit)
{
    text_printf(text, "%s,", quantity);
    if (!isnan(at))
        text_printf(text, "%.9g", at);
    text_puts(text, ",");
    if (!isnan(value))
        text_printf(text, "%.9g", value);
    text_printf(text, ",%s\n", unit);
}

/* Appends the share of tissue within each hundredth of the largest distance. */
static void put_histogram(const CoverageReport *report, Text *text)
{
    enum { STEPS = 100 };
    int64_t within = 0;
    size_t bin = 0;
    for (int i = 1; i <= STEPS; i++) {
        size_t end = (size_t)(report->largest_mm * i / STEPS / report->bin_mm) + 1;
        for (; bin < end && bin < COVERAGE_BINS; bin++)
            within += report->bin[bin];
        put_row(text, "share_within", (double)end * report->bin_mm,
                (double)within / (double)report->tissue_voxels, "");
    }
}

static void put_summary(const CoverageResult *result, Text *text)
{
    const CoverageReport *report = &result->report;
    const char *volume = result->dimension == 2 ? "mm2" : "mm3";
    const double tissue = (double)report->tissue_voxels, none = NAN;
    const CoverageLaw *law = &result->law;
    text_puts(text, "quantity,at,value,unit\n");
    put_row(text, "tissue", none, report->tissue_volume, volume);
    put_row(text, "vessels", none, report->vessel_volume, volume);
    put_row(text, "terminals", none, (double)result->terminals, "");
    put_row(text, "mean", none, report->mean_mm, "mm");
    for (int i = 0; i < COVERAGE_QUANTILES; i++)
        put_row(text, "quantile", reported_quantiles[i],
                coverage_quantile(report, reported_quantiles[i]), "mm");
    for (size_t i = 0; i < result->beyond.n; i++)
        put_row(text, "share_beyond", result->beyond.at[i], (double)report->beyond[i] / tissue, "");
    put_row(text, "largest", none, report->largest_mm, "mm");
    for (int axis = 0; axis < 3; axis++)
        put_row(text, "largest_position", axis, vec3_component(report->largest_at, axis), "mm");
    put_row(text, "law_mean", none, law->mean_mm, "mm");
    put_row(text, "law_quantile", 0.95, law->within_95_mm, "mm");
    put_row(text, "law_largest", none, law->largest_mm, "mm");
    put_histogram(report, text);
}

/* Sums over a label. */
typedef struct Territory {
    bool exists;
    int64_t voxels;
    double flow;
} Territory;

/* Adds up the voxels and the flow of each label. Flow is that of the terminals, of the segments, or
 * of the segments that leave the roots; `flow` is NULL if it is unknown. */
static void sum_territories(const Measuring *made, const double *flow, Territory *territory)
{
    const Tree *tree = &made->tree;
    const bool of_trees = made->options->kind == TERRITORY_TREE;
    for (size_t i = 0; i < made->n_parts; i++) {
        const size_t node = made->part_node[i];
        const bool counts = !of_trees || !tree_is_segment(tree, (size_t)tree->parent[node]);
        Territory *own = &territory[made->labels[i]];
        own->voxels += made->result->report.territory[i];
        own->flow += flow && counts ? flow[node] : 0;
        own->exists = true;
    }
}

static void put_territory(size_t label, const Territory *territory, double voxel, bool has_flow,
                          Text *text)
{
    double volume = (double)territory->voxels * voxel;
    text_printf(text, "%zu,%.9g", label, volume);
    if (has_flow)
        text_printf(text, ",%.9g,", territory->flow);
    if (has_flow && volume > 0)
        text_printf(text, "%.9g", 1000 * territory->flow / volume);
    text_puts(text, "\n");
}

/* Appends a row per label. */
static Status put_territories(const Measuring *made, Text *text, Err *err)
{
    Territory *territory = NULL;
    Field flow = {0};
    TRY(mem_calloc(&territory, (size_t)made->most_label + 1, sizeof *territory, "rows", err));
    Status status = derive_field(&made->tree, &(TreeMeta){0}, "flow", &flow, err);
    if (status == STATUS_OK || status == STATUS_INPUT) {
        status = STATUS_OK;
        sum_territories(made, flow.value, territory);
        const char *unit = made->domain.dimension == 2 ? "2" : "3";
        text_printf(text, "id,volume [mm%s]", unit);
        if (flow.value)
            text_printf(text, ",flow [ml/min],perfusion [ml/min/1000 mm%s]", unit);
        text_puts(text, "\n");
        for (size_t label = 1; label <= made->most_label; label++)
            if (territory[label].exists)
                put_territory(label, &territory[label], made->result->report.voxel_volume,
                              flow.value, text);
    }
    field_release(&flow);
    free(territory);
    return status;
}

json_t *coverage_json(const CoverageResult *result, const char *command)
{
    const CoverageReport *report = &result->report;
    const CoverageLaw *law = &result->law;
    json_t *quantiles = json_array(), *beyond = json_array();
    for (int i = 0; i < COVERAGE_QUANTILES; i++) {
        const double part = reported_quantiles[i], distance = coverage_quantile(report, part);
        quantiles = json_with_item(quantiles, JSON_OBJECT({"part", json_number(part)},
                                                          {"distance_mm", json_number(distance)}));
    }
    for (size_t i = 0; i < result->beyond.n; i++) {
        const double share = (double)report->beyond[i] / (double)report->tissue_voxels;
        beyond =
            json_with_item(beyond, JSON_OBJECT({"distance_mm", json_number(result->beyond.at[i])},
                                               {"share", json_number(share)}));
    }
    const Vec3 at = report->largest_at;
    return JSON_OBJECT(
        {"generator", json_text(GENERATOR)}, {"command", json_text(command)},
        {"dimension", json_count((uint64_t)result->dimension)},
        {"voxel_mm", json_number(result->spacing_mm)},
        {"tissue_voxels", json_integer(report->tissue_voxels)},
        {result->dimension == 2 ? "tissue_mm2" : "tissue_mm3", json_number(report->tissue_volume)},
        {result->dimension == 2 ? "vessels_mm2" : "vessels_mm3",
         json_number(report->vessel_volume)},
        {"terminals", json_count(result->terminals)}, {"mean_mm", json_number(report->mean_mm)},
        {"quantiles", quantiles}, {"beyond", beyond},
        {"largest_mm", json_number(report->largest_mm)},
        {"largest_error_mm", json_number(report->largest_error_mm)},
        {"largest_at_mm", json_numbers((const double[]){at.x, at.y, at.z}, 3)},
        {"law_mean_mm", json_number(law->mean_mm)}, {"law_95_mm", json_number(law->within_95_mm)},
        {"law_largest_mm", json_number(law->largest_mm)},
        {"law_terminals_per_mm3", json_number(law->density_needed)});
}

static Status put_files(const void *job, const char *command, FileSlot files[], Err *err)
{
    const Measuring *made = job;
    if (files[FILE_SUMMARY].path)
        put_summary(made->result, &files[FILE_SUMMARY].text);
    if (files[FILE_TABLE].path)
        TRY(put_territories(made, &files[FILE_TABLE].text, err));
    if (files[FILE_JSON].path)
        work_put_json(&files[FILE_JSON], coverage_json(made->result, command));
    return STATUS_OK;
}

/* ---- the operation --------------------------------------------------------------------------- */

/* Names the files. The table of the territories is beside their volume. */
static Status name_files(const CoverageOptions *options, const VolumeFormat *format, FileSet *files,
                         Err *err)
{
    FileSlot *at = files->at;
    const char *const paths[] = {[FILE_DISTANCES] = options->output,
                                 [FILE_TERRITORIES] = options->territories,
                                 [FILE_SUMMARY] = options->summary,
                                 [FILE_JSON] = options->json};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (paths[i])
            TRY(mem_strdup(&at[i].path, paths[i], err));
    if (!options->territories)
        return STATUS_OK;
    const size_t stem = strlen(options->territories) - strlen(format->suffix);
    at[FILE_TABLE].role = "the table of territories";
    return mem_printf(&at[FILE_TABLE].path, err, "%.*s.csv", (int)stem, options->territories);
}

/* Checks options, tree and domain, and opens the files, before the measurement begins. */
static Status prepare(Measuring *made, Parsed *parsed, FileSet *files, Err *err)
{
    TRY(take_beyond(made->options, &made->result->beyond, err));
    TRY(reading_tree(parsed, parsed->operands[0], &made->tree, NULL, err));
    TRY(take_tubes(made, parsed->operands[0], err));
    TRY(take_domain(made, parsed, err));
    TRY(set_params(made, parsed, err));
    TRY(name_files(made->options, made->territories.format, files, err));
    TRY(work_note_files(files, &parsed->files, err));
    TRY(fileset_open(files, err));
    made->distances.to = files->at[FILE_DISTANCES].stream;
    made->territories.to = files->at[FILE_TERRITORIES].stream;
    return STATUS_OK;
}

static Status run(Measuring *made, Parsed *parsed, FileSet *files, Err *err)
{
    static const Work work = {"measuring", "the distances at this `spacing`", estimate, measure};
    TRY(prepare(made, parsed, files, err));
    TRY(work_make(&work, made, files->n_open ? files : NULL, parsed->common.talk, err));
    TRY(check_volume(made, err));
    warn_flat(made, parsed->common.talk);
    apply_law(made);
    return files->n_open ? work_write(files, put_files, made, parsed, err) : STATUS_OK;
}

static void release(Measuring *made)
{
    domain_release(&made->domain);
    tree_release(&made->tree);
    free(made->tubes);
    free(made->outlets);
    free(made->tube_node);
    free(made->outlet_node);
    free(made->labels);
}

Status coverage_make(void *options, Parsed *parsed, CoverageResult *result, Err *err)
{
    FileSet files = {0};
    *result = (CoverageResult){0};
    Measuring made = {.options = options, .result = result};
    Status status = run(&made, parsed, &files, err);
    release(&made);
    fileset_release(&files);
    return status;
}

void coverageresult_release(CoverageResult *result)
{
    coveragereport_release(&result->report);
}

const Command command_coverage = {
    .name = "coverage",
    .summary = "measure how far tissue is from the nearest vessel",
    .operands = "T.swc [-o D.nii.gz] [--territories L.nii.gz]",
    .examples = "  corcast coverage tree.swc\n"
                "  corcast coverage tree.swc --spacing 0.25 --beyond 0.1,0.2 --json coverage.json\n"
                "  corcast coverage tree.swc -o distance.nii.gz --territories supply.nii.gz\n"
                "  corcast coverage measured.swc --domain hull:2 --summary coverage.csv\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .size = sizeof(CoverageOptions),
    .tables = {{&table, 0}},
};
