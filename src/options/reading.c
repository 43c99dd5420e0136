/* One table of options for all formats; which format takes which is treeio's matter. */
#include "options/reading.h"

#include "treeio/treeio.h"
#include <stdio.h>

static const Option rows[] = {
    {.name = "input-format",
     SETS(TEXT, ReadOptions, format),
     .group = GROUP_INPUT,
     .argument = "NAME",
     .list = "formats",
     .otherwise = "by extension and first bytes",
     .help = "the format that the tree is read as"},
    {.name = "input-unit",
     SETS(CHOICE, ReadOptions, unit),
     GIVEN(ReadOptions, has_unit),
     .choices = length_unit_names,
     .group = GROUP_INPUT,
     .otherwise = "the format's",
     .help = "of the tree's coordinates and radii"},
    {.name = "voxel-size",
     SETS(VECTOR, ReadOptions, voxel_size),
     GIVEN(ReadOptions, has_voxel_size),
     .group = GROUP_INPUT,
     .otherwise = "",
     .help = "what the tree's coordinates are multiplied by, in the input unit"},
    {.name = "voxel-radii",
     SETS(FLAG, ReadOptions, voxel_radii),
     .group = GROUP_INPUT,
     .help = "radii are voxels, too: of the geometric mean of --voxel-size"},
    {.name = "merge-tolerance",
     SETS(NUMBER, ReadOptions, merge_tolerance_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "points of a network this near are one; 0: those at the same place"},
    {.name = "break-loops",
     SETS(FLAG, ReadOptions, break_loops),
     .group = GROUP_INPUT,
     .help = "cut each loop of a network at its thinnest line"},
    {.name = "radius",
     SETS(NUMBER, ReadOptions, radius_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "radius of vessels that have none in the file, or 0; 0: the file must have radii"},
    {.name = "repair-radii",
     SETS(FLAG, ReadOptions, repair_radii),
     .group = GROUP_INPUT,
     .help = "replace radii that are negative or no numbers by those of the parents"},
    {.name = "radius-array",
     SETS(TEXT, ReadOptions, radius_array),
     .group = GROUP_INPUT,
     .argument = "NAME",
     .otherwise = "by its name",
     .help = "the array that holds the radii"},
    {.name = "graphml-keys",
     SETS(TEXT, ReadOptions, graphml_keys),
     .group = GROUP_INPUT,
     .argument = "x=KEY,...",
     .otherwise = "by their names",
     .help = "the keys of GraphML that hold x, y, z and radius"},
    {.name = "columns",
     SETS(TEXT, ReadOptions, columns),
     .group = GROUP_INPUT,
     .argument = "x=NAME,...",
     .otherwise = "by their names",
     .help = "the columns of a table that hold x, y, z, radius and others, by name or number"},
    {.name = "edges",
     SETS(INPUT, ReadOptions, edges),
     .group = GROUP_INPUT,
     .argument = "E.csv",
     .help = "the table of lines, beside one of points"},
};

const OptionTable reading_table = OPTION_TABLE(rows);

static Status check(const ReadOptions *options, Err *err)
{
    Vec3 voxel = options->voxel_size;
    if (options->has_voxel_size && !(voxel.x > 0 && voxel.y > 0 && voxel.z > 0))
        return err_set(err, STATUS_USAGE, "--voxel-size takes three numbers above 0, X,Y,Z");
    if (options->voxel_radii && !options->has_voxel_size)
        return err_set(err, STATUS_USAGE, "--voxel-radii needs --voxel-size");
    return STATUS_OK;
}

static void say_cuts(const Talk *talk, const TreeReading *reading)
{
    const ReadCut *cut = reading->network.cut;
    if (reading->network.n_cuts > 0)
        talk_note(talk, "%zu loop%s cut, the first at %g, %g, %g mm where the radius is %g mm",
                  reading->network.loops, reading->network.loops == 1 ? " is" : "s are",
                  cut->position.x, cut->position.y, cut->position.z, cut->radius_mm);
}

/* Reports radii that the options changed. */
static void say_radii(const Talk *talk, const char *path, const TreeReading *reading)
{
    if (reading->repaired_radii > 0)
        talk_note(talk, "%s: radii replaced by those of the parents: %zu", path,
                  reading->repaired_radii);
    if (reading->given_radius > 0)
        talk_note(talk, "%s: segments without a radius that got --radius: %zu", path,
                  reading->given_radius);
}

/* Rounds up to two digits, so that a tolerance is not below the gap. */
static double rounded_up(double gap)
{
    double unit = elementary_pow(10, floor(elementary_log10(gap)) - 1);
    return (floor(gap / unit) + 1) * unit;
}

static void say_near_ends(const Talk *talk, const char *path, const TreeReading *reading)
{
    if (reading->network.near_ends > 0)
        talk_note(talk,
                  "%s: ends that miss another tree by at most %.2g mm: %zu; "
                  "--merge-tolerance %.2g joins them",
                  path, reading->network.near_mm, reading->network.near_ends,
                  rounded_up(1.001 * reading->network.near_mm));
}

static void say_unit(const Talk *talk, const char *path, const TreeReading *reading)
{
    const char *unit = length_unit_names[reading->unit];
    if (reading->unit_said || reading->median_radius_mm == 0)
        return;
    if (reading->believes && reading->believed != reading->unit)
        talk_note(talk,
                  "%s: the unit is taken for %s, but the median radius, %.3g, looks like "
                  "%s; --input-unit tells",
                  path, unit, reading->median_radius_mm / length_unit_mm(reading->unit),
                  length_unit_names[reading->believed]);
    if (reading->looks_like_voxels)
        talk_note(talk,
                  "%s: all coordinates are whole numbers, which looks like voxels; "
                  "--voxel-size tells",
                  path);
}

static void say_found(const Talk *talk, const char *path, const TreeReading *reading)
{
    say_cuts(talk, reading);
    say_radii(talk, path, reading);
    say_near_ends(talk, path, reading);
    say_unit(talk, path, reading);
}

static Status read_file(const Parsed *parsed, const char *path, Tree *tree, TreeReading *reading,
                        Err *err)
{
    TRY(check(&parsed->reading, err));
    TRY(tree_read_as(tree, path, &parsed->reading, reading, err));
    say_found(parsed->common.talk, path, reading);
    return STATUS_OK;
}

Status reading_tree_bytes(const Parsed *parsed, const TreeBytes *file, Tree *tree, Err *err)
{
    TreeReading reading = {0};
    TRY(check(&parsed->reading, err));
    TRY(tree_read_bytes(tree, file, &parsed->reading, &reading, err));
    say_found(parsed->common.talk, file->name, &reading);
    reading_release(&reading);
    return STATUS_OK;
}

static Status copy_given(const Parsed *parsed, Tree *tree, TreeReading *reading, Err *err)
{
    *reading = (TreeReading){.format = "memory", .unit = LENGTH_MM, .unit_said = true};
    TRY(reading_measure(reading, parsed->given, err));
    return tree_pruned(parsed->given, 0, tree, err);
}

Status reading_tree(const Parsed *parsed, const char *path, Tree *tree, TreeReading *reading,
                    Err *err)
{
    TreeReading own = {0};
    Status status = parsed->given && path == parsed->operands[0]
                        ? copy_given(parsed, tree, &own, err)
                        : read_file(parsed, path, tree, &own, err);
    if (status == STATUS_OK && reading)
        *reading = own;
    else
        reading_release(&own);
    return status;
}

/* ---- info ------------------------------------------------------------------------------------ */

/* What of a network did not become part of the tree, as counts and what they are of. */
typedef struct LeftOut {
    size_t count;
    const char *key, *one, *more; /* what it is called in sentences */
} LeftOut;

enum { LEFT_OUT = 5 };

static void list_left_out(const TreeReading *reading, LeftOut list[LEFT_OUT])
{
    const LeftOut all[LEFT_OUT] = {
        {reading->network.merged, "merged_points", "point merged into another",
         "points merged into others"},
        {reading->network.unused, "unused_points", "point that no line uses",
         "points that no line uses"},
        {reading->network.without_length, "lines_without_length", "line without length",
         "lines without length"},
        {reading->network.repeated, "repeated_lines", "line given before", "lines given before"},
        {reading->network.loops, "loops", "line cut where a loop closed",
         "lines cut where loops closed"},
    };
    for (size_t i = 0; i < LEFT_OUT; i++)
        list[i] = all[i];
}

/* Of the word behind a count. */
static const char *ending(size_t count)
{
    return count == 1 ? "" : "s";
}

static void print_network(const TreeReading *reading)
{
    LeftOut left[LEFT_OUT];
    list_left_out(reading, left);
    printf("  read as       %s, %zu point%s and %zu line%s\n", reading->format,
           reading->network.points, ending(reading->network.points), reading->network.lines,
           ending(reading->network.lines));
    for (size_t i = 0, n = 0; i < LEFT_OUT; i++)
        if (left[i].count > 0)
            printf("  %s %zu %s\n", n++ ? "             " : "left out     ", left[i].count,
                   left[i].count == 1 ? left[i].one : left[i].more);
    for (size_t i = 0; i < reading->network.n_cuts && i < 3; i++)
        printf("  cut at        %g, %g, %g mm, radius %g mm\n", reading->network.cut[i].position.x,
               reading->network.cut[i].position.y, reading->network.cut[i].position.z,
               reading->network.cut[i].radius_mm);
    if (reading->network.n_cuts > 3)
        printf("                and %zu more place%s\n", reading->network.loops - 3,
               ending(reading->network.loops - 3));
    if (reading->network.against > 0)
        printf("  directions    %zu line%s given towards the root\n", reading->network.against,
               reading->network.against == 1 ? " is" : "s are");
}

static void print_roots(const TreeReading *reading)
{
    enum { SHOWN = 5 };
    printf("  components    %zu\n", reading->n_roots);
    for (size_t i = 0; i < reading->n_roots && i < SHOWN; i++)
        printf("  root          %d, %s; %zu node%s\n", reading->root[i].id,
               root_reason_texts[reading->root[i].reason], reading->root[i].nodes,
               ending(reading->root[i].nodes));
    if (reading->n_roots > SHOWN)
        printf("                and %zu more\n", reading->n_roots - SHOWN);
}

static void print_degrees(const TreeReading *reading)
{
    const char *before = "  degrees       ";
    for (int degree = 0; degree <= READ_MAX_DEGREE; degree++)
        if (reading->degree[degree] > 0) {
            printf("%s%d%s: %zu", before, degree, degree == READ_MAX_DEGREE ? "+" : "",
                   reading->degree[degree]);
            before = ", ";
        }
    printf("\n");
}

static void print_unit(const TreeReading *reading)
{
    if (reading->median_radius_mm > 0)
        printf("  median radius %.6g mm\n", reading->median_radius_mm);
    printf("  unit          %s, %s", length_unit_names[reading->unit],
           reading->unit_said ? "as is said" : "assumed");
    if (reading->median_radius_mm > 0)
        printf("; radii look like %s",
               reading->believes ? length_unit_names[reading->believed] : "no vessel's");
    printf("%s\n", reading->looks_like_voxels ? ", and coordinates like voxels" : "");
    if (reading->without_radius > 0)
        printf("  no radius     %zu segment%s\n", reading->without_radius,
               ending(reading->without_radius));
}

void reading_print(const TreeReading *reading)
{
    if (reading->is_network)
        print_network(reading);
    print_roots(reading);
    print_degrees(reading);
    print_unit(reading);
    for (size_t i = 0; i < reading->n_notes; i++)
        printf("  %s %s\n", i ? "             " : "assumed      ", reading->note[i]);
}

static json_t *roots_json(const TreeReading *reading)
{
    json_t *rows_json = json_array();
    for (size_t i = 0; i < reading->n_roots; i++)
        rows_json = json_with_item(rows_json,
                                   json_pack("{s:i, s:s, s:I}", "id", reading->root[i].id, "reason",
                                             root_reason_texts[reading->root[i].reason], "nodes",
                                             (json_int_t)reading->root[i].nodes));
    return rows_json;
}

static json_t *cuts_json(const TreeReading *reading)
{
    json_t *rows_json = json_array();
    for (size_t i = 0; i < reading->network.n_cuts; i++) {
        const ReadCut *cut = &reading->network.cut[i];
        rows_json = json_with_item(
            rows_json, json_pack("{s:I, s:[f,f,f], s:o}", "record", (json_int_t)cut->record,
                                 "position_mm", cut->position.x, cut->position.y, cut->position.z,
                                 "radius_mm", json_number(cut->radius_mm)));
    }
    return rows_json;
}

static json_t *degrees_json(const TreeReading *reading)
{
    json_t *list = json_array();
    for (int degree = 0; degree <= READ_MAX_DEGREE; degree++)
        list = json_with_item(list, json_count(reading->degree[degree]));
    return list;
}

static json_t *notes_json(const TreeReading *reading)
{
    json_t *list = json_array();
    for (size_t i = 0; i < reading->n_notes; i++)
        list = json_with_item(list, json_text(reading->note[i]));
    return list;
}

static json_t *network_json(const TreeReading *reading)
{
    LeftOut left[LEFT_OUT];
    list_left_out(reading, left);
    json_t *json = json_pack("{s:I, s:I, s:I}", "points", (json_int_t)reading->network.points,
                             "lines", (json_int_t)reading->network.lines, "lines_against",
                             (json_int_t)reading->network.against);
    for (size_t i = 0; i < LEFT_OUT; i++)
        json = json_with(json, left[i].key, json_count(left[i].count));
    return json_with(json, "cuts", cuts_json(reading));
}

json_t *reading_json(const TreeReading *reading)
{
    const JsonMember members[] = {
        {"format", json_text(reading->format)},
        {"network", reading->is_network ? network_json(reading) : json_null()},
        {"components", json_count(reading->n_roots)},
        {"roots", roots_json(reading)},
        {"degrees", degrees_json(reading)},
        {"median_radius_mm", json_number(reading->median_radius_mm)},
        {"segments_without_radius", json_count(reading->without_radius)},
        {"given_radii", json_count(reading->given_radius)},
        {"repaired_radii", json_count(reading->repaired_radii)},
        {"near_ends", json_count(reading->network.near_ends)},
        {"near_ends_mm", json_number(reading->network.near_mm)},
        {"unit", json_text(length_unit_names[reading->unit])},
        {"unit_said", json_boolean(reading->unit_said)},
        {"believed_unit",
         reading->believes ? json_text(length_unit_names[reading->believed]) : json_null()},
        {"looks_like_voxels", json_boolean(reading->looks_like_voxels)},
        {"assumed", notes_json(reading)},
    };
    return json_with_members(json_object(), members, sizeof members / sizeof *members);
}
