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
     .otherwise = "the unit that the file states; if it states none, cm for .in, um for .vmv, "
                  "Amira and Secomb, mm for other formats",
     .help = "unit of coordinates, radii and --voxel-size"},
    {.name = "voxel-size",
     SETS(VECTOR, ReadOptions, voxel_size),
     GIVEN(ReadOptions, has_voxel_size),
     .group = GROUP_INPUT,
     .otherwise = "coordinates are not multiplied",
     .help = "for coordinates that are counted in voxels: edge lengths of a voxel in x, y and z, "
             "above 0, in the unit of --input-unit, such as 2,2,5; they multiply the coordinates, "
             "but the radii only with --voxel-radii"},
    {.name = "voxel-radii",
     SETS(FLAG, ReadOptions, voxel_radii),
     .group = GROUP_INPUT,
     .help = "with --voxel-size: also multiply each radius, by the geometric mean of the three "
             "edge lengths"},
    {.name = "merge-tolerance",
     SETS(NUMBER, ReadOptions, merge_tolerance_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "maximum distance at which two points of a tree file become one node, for formats "
             "that store vessels as lines of points (all except .swc and .pvd); 0 joins only "
             "points at the same position"},
    {.name = "break-loops",
     SETS(FLAG, ReadOptions, break_loops),
     .group = GROUP_INPUT,
     .help =
         "cut each loop of a network at its thinnest segment. Without this option loops are kept, "
         "and grow, refine, certify, pulse and study, which need a tree, refuse the network"},
    {.name = "radius",
     SETS(NUMBER, ReadOptions, radius_mm),
     FROM_TO(0, 1e3),
     .group = GROUP_INPUT,
     .unit = "mm",
     .help = "radius that vessels get whose radius is missing or 0 in the file; with "
             "--repair-radii, it is used only if no vessel of the file has a radius. 0 means no "
             "such radius: a radius of 0 is kept and a missing radius is an error, unless "
             "--repair-radii is set"},
    {.name = "repair-radii",
     SETS(FLAG, ReadOptions, repair_radii),
     .group = GROUP_INPUT,
     .help = "replace each radius that is missing, 0, negative, infinite or not a number: "
             "between two known radii of a branch by linear interpolation along its length, "
             "elsewhere in the branch by its nearest known radius; a branch without known radii "
             "gets the radius of a neighboring branch, or the median of the tree. If no vessel "
             "has a radius, use --radius"},
    {.name = "radius-array",
     SETS(TEXT, ReadOptions, radius_array),
     .group = GROUP_INPUT,
     .argument = "NAME",
     .otherwise = "recognized by its name",
     .help = "VTK, VTP, VTU, GXL, GraphML and Amira only: name of the data array or attribute that "
             "contains the radii, such as Radius"},
    {.name = "graphml-keys",
     SETS(TEXT, ReadOptions, graphml_keys),
     .group = GROUP_INPUT,
     .argument = "x=KEY,...",
     .otherwise = "recognized by their names",
     .help = "GraphML only: names (attr.name) of the keys that contain the coordinates and the "
             "radius, such as x=X,y=Y,z=Z,radius=R. If x is not given, the keys of all three "
             "coordinates are recognized by their names; if radius is not given, its key is"},
    {.name = "columns",
     SETS(TEXT, ReadOptions, columns),
     .group = GROUP_INPUT,
     .argument = "x=NAME,...",
     .otherwise = "recognized by their titles",
     .help = "tables (.csv, .tsv) only: meaning of columns, each MEANING=COLUMN, where COLUMN "
             "is the title of a column or its number (the first is 1), such as x=east,radius=7. "
             "Meanings: of nodes: id, parent (id of the parent), x, y, z, type (as in SWC), "
             "flow_share (flow out of a terminal, in any unit); of vessels: x0, y0, z0, x1, y1, z1 "
             "(their two ends); of both: same_as (id of another node at the same point, which "
             "closes a loop); of edges: from, to (ids of nodes); of all three: radius, diameter"},
    {.name = "edges",
     SETS(INPUT, ReadOptions, edges),
     .group = GROUP_INPUT,
     .argument = "E.csv",
     .help = "if the table of the tree (.csv, .tsv) lists only nodes: second table, of the "
             "edges between them, with the columns from and to (ids of nodes), and radius or "
             "diameter unless the nodes have one"},
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
        talk_note(talk, "%s: %zu radii were filled from their neighbours", path,
                  reading->repaired_radii);
    if (reading->given_radius > 0)
        talk_note(talk, "%s: %zu segment%s without a radius received --radius", path,
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
                  "%s: ends that miss another tree by at most %.2g mm: %zu; "
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
        "%s: the network has loops, and %s needs a tree; --break-loops cuts each loop at "
        "its thinnest line",
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
