/* One table of options for all formats; which format takes which is treeio's matter. */
#include "options/reading.h"

#include "treeio/treeio.h"

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
                  "%s: assuming %s, but a median radius of %.3g suggests %s; set the unit with "
                  "--input-unit",
                  path, unit, reading->median_radius_mm / length_unit_mm(reading->unit),
                  length_unit_names[reading->believed]);
    if (reading->looks_like_voxels)
        talk_note(talk,
                  "%s: all coordinates are integers, which suggests voxels; set their size with "
                  "--voxel-size",
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

Status reading_tree_bytes(const Parsed *parsed, const MemoryFile *file, Tree *tree, Err *err)
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
    Status status = parsed->given && path == parsed->given_name
                        ? copy_given(parsed, tree, &own, err)
                        : read_file(parsed, path, tree, &own, err);
    if (status == STATUS_OK && reading)
        *reading = own;
    else
        reading_release(&own);
    return status;
}
