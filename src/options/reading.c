/* Reads the trees that commands take as input, and sends notes about them. The options of all tree
 * formats are one table; treeio.c refuses an option that the format of the file does not use. */
#include "options/reading.h"

#include "treeio/treeio.h"

static const Option rows[] = {
    {.name = "input-format",
     SETS(TEXT, ReadOptions, format),
     .group = GROUP_INPUT,
     .argument = "NAME",
     .list = "formats",
     .otherwise = "from the extension and the first bytes",
     .help = "file format of the tree, such as vtp or graphml"},
    {.name = "input-unit",
     SETS(CHOICE, ReadOptions, unit),
     GIVEN(ReadOptions, has_unit),
     .choices = length_unit_names,
     .group = GROUP_INPUT,
     .otherwise = "the unit that the file states; if it states none: cm for .in files, um for "
                  ".vmv, Amira and Secomb files, mm for all others",
     .help = "unit of the coordinates, the radii and --voxel-size, instead of the unit that the "
             "file states"},
    {.name = "voxel-size",
     SETS(VECTOR, ReadOptions, voxel_size),
     GIVEN(ReadOptions, has_voxel_size),
     .group = GROUP_INPUT,
     .otherwise = "coordinates are not multiplied",
     .help = "edge lengths of a voxel in x, y and z, for files whose coordinates are counted in "
             "voxels: three numbers above 0, such as 2,2,5, in the unit of --input-unit. "
             "Coordinates are multiplied by the edge lengths; radii are multiplied only with "
             "--voxel-radii"},
    {.name = "voxel-radii",
     SETS(FLAG, ReadOptions, voxel_radii),
     .group = GROUP_INPUT,
     .help = "with --voxel-size, for files whose radii are counted in voxels, too: multiply each "
             "radius by the geometric mean of the three edge lengths"},
    {.name = "merge-tolerance",
     SETS(NUMBER, ReadOptions, merge_tolerance_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "maximum distance between points of the file that become one node; 0 joins only "
             "points at the same position. The option is for formats that store vessels as lines "
             "of points, which are all except .swc and .pvd"},
    {.name = "break-loops",
     SETS(FLAG, ReadOptions, break_loops),
     .group = GROUP_INPUT,
     .help = "remove the thinnest segment of each loop of a network, so that the network becomes "
             "a tree. Without this option loops are kept, and the commands that need a tree "
             "(grow, refine, certify, pulse and study) refuse the network"},
    {.name = "radius",
     SETS(NUMBER, ReadOptions, radius_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "radius for vessels whose radius in the file is missing or 0; with --repair-radii, "
             "used only if the file has no radius at all. --radius 0 is the same as no --radius. "
             "With neither option, missing radii are an error, and radii of 0 are kept"},
    {.name = "repair-radii",
     SETS(FLAG, ReadOptions, repair_radii),
     .group = GROUP_INPUT,
     .help = "replace each radius that is missing, 0, negative, infinite or not a number, by the "
             "known radii of the same branch (from one bifurcation to the next). A radius between "
             "two known ones is interpolated linearly along the length. One between an end of the "
             "branch and the first known radius becomes that radius. A branch without known radii "
             "gets the "
             "radius of its parent or of its thickest daughter, whichever is smaller. If both are "
             "unknown, it gets the median of all known radii. A file without any radius needs "
             "--radius as well"},
    {.name = "radius-array",
     SETS(TEXT, ReadOptions, radius_array),
     .group = GROUP_INPUT,
     .argument = "NAME",
     .otherwise = "an array with a usual name, such as radius or diameter",
     .help = "for VTK, VTP, VTU, GXL, GraphML and Amira files only: name of the data array or "
             "attribute that contains the radii, such as Radius"},
    {.name = "graphml-keys",
     SETS(TEXT, ReadOptions, graphml_keys),
     .group = GROUP_INPUT,
     .argument = "x=KEY,...",
     .otherwise = "recognized by their names",
     .help = "GraphML only: names (attr.name) of the keys that contain coordinates and radius, "
             "such as x=X,y=Y,z=Z,radius=R. Without x=, the keys of all three coordinates are "
             "recognized by their names. Without radius=, the key of the radius is recognized by "
             "its name"},
    {.name = "columns",
     SETS(TEXT, ReadOptions, columns),
     .group = GROUP_INPUT,
     .argument = "x=NAME,...",
     .otherwise = "each column is recognized by its title, such as x or radius",
     .help = "for tables (.csv, .tsv) only: what the columns contain, such as x=east,radius=7. "
             "NAME is the title of a column or its number, counted from 1. A table of nodes has "
             "id, parent (id of the parent), x, y, z, type (as in SWC), flow_share (flow out of "
             "a terminal, in any unit) and same_as (id of another node at the same point, which "
             "closes a loop). A table of vessels has x0, y0, z0, x1, y1, z1 (the two ends) and "
             "same_as. A table of edges has from and to (ids of nodes). All tables may have "
             "radius or diameter"},
    {.name = "edges",
     SETS(INPUT, ReadOptions, edges),
     .group = GROUP_INPUT,
     .argument = "E.csv",
     .help = "second table (.csv, .tsv), which connects the nodes if the tree file is a table of "
             "nodes without a column parent. Each row is a segment, with the columns from and to "
             "(ids of nodes) and, if the table of nodes has no radii, radius or diameter"},
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
        talk_note(talk, "%s: %zu radii were repaired from their neighbors", path,
                  reading->repaired_radii);
    if (reading->given_radius > 0)
        talk_note(talk, "%s: %zu segment%s without a radius got the radius of --radius", path,
                  reading->given_radius, reading->given_radius == 1 ? "" : "s");
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
                  "%s: ends of trees that are at most %.2g mm from another tree: %zu; "
                  "--merge-tolerance %.2g joins them",
                  path, reading->network.near_mm, reading->network.near_ends,
                  rounded_up(1.001 * reading->network.near_mm));
}

/* Sends notes if the file states no unit: that the radii suggest another unit, and that the
 * coordinates suggest voxels. */
static void say_unit(const Talk *talk, const char *path, const TreeReading *reading)
{
    const char *unit = length_unit_names[reading->unit];
    if (reading->unit_is_stated || reading->median_radius_mm == 0)
        return;
    if (reading->has_plausible_unit && reading->plausible_unit != reading->unit)
        talk_note(talk,
                  "%s: assuming %s, but a median radius of %.3g suggests %s; set the unit with "
                  "--input-unit",
                  path, unit, reading->median_radius_mm / length_unit_mm(reading->unit),
                  length_unit_names[reading->plausible_unit]);
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
    *reading = (TreeReading){.format = "memory", .unit = LENGTH_MM, .unit_is_stated = true};
    TRY(reading_measure(reading, parsed->given, err));
    return tree_prune_copy(parsed->given, 0, tree, err);
}

Status reading_refuse_loops(const Tree *tree, const char *path, const char *what, Err *err)
{
    if (!tree->link)
        return STATUS_OK;
    return err_set(
        err, STATUS_INPUT,
        "%s: the network has loops, and %s needs a tree; --break-loops cuts each loop at its "
        "thinnest segment",
        path, what);
}

/* Refuses a network that a command cannot use, and releases it. */
static Status check_kind(const Command *command, const char *path, Tree *tree, Err *err)
{
    if (!command->trees_only)
        return STATUS_OK;
    Status status = reading_refuse_loops(tree, path, command->name, err);
    if (status != STATUS_OK)
        tree_release(tree);
    return status;
}

Status reading_tree(const Parsed *parsed, const char *path, Tree *tree, TreeReading *reading,
                    Err *err)
{
    TreeReading own = {0};
    Status status = parsed->given && path == parsed->given_name
                        ? copy_given(parsed, tree, &own, err)
                        : read_file(parsed, path, tree, &own, err);
    if (status == STATUS_OK)
        status = check_kind(parsed->command, path, tree, err);
    if (status == STATUS_OK && reading)
        *reading = own;
    else
        reading_release(&own);
    return status;
}
