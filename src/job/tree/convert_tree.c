/* Converts a tree for `convert`: reads values from a file (--values), smooths and resamples the
 * centrelines, and derives fields (--fields), in this order. Values and fields become columns of
 * the tree, one number per segment. Then writes the tree. */
#include "job/tree/convert_tree.h"

#include "derive/derive.h"
#include "job/tree/makers.h"
#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const Option rows[] = {
    {.name = "values",
     SETS(TEXT, TreeConversion, values),
     .group = GROUP_FILES,
     .argument = "FILE[:COLUMN]",
     .when = WHEN(TREE),
     .help = "values per segment to add to the tree file as columns: a CSV file whose rows have "
             "the ids of segments (FILE:COLUMN adds only this column), or a folder of results of "
             "svOneDSolver"},
    {.name = "fields",
     SETS(TEXT, TreeConversion, fields),
     .group = GROUP_FILES,
     .argument = "all|NAME,...",
     .list = "fields",
     .when = WHEN(TREE),
     .help = "quantities per segment (fields), such as flow or wss, to compute and add to the "
             "tree file as columns: all, or names separated by commas"},
    {.name = "smooth",
     SETS(FLAG, TreeConversion, smooth),
     .group = GROUP_TREE,
     .when = WHEN(TREE),
     .help = "smooth measured centrelines by Taubin's filter, which removes the steps of voxels. "
             "Ends and bifurcations keep their positions; other nodes move by at most a quarter "
             "of their radius"},
    {.name = "step",
     SETS(NUMBER, TreeConversion, step_mm),
     FROM_TO(1e-6, 1e6),
     .group = GROUP_TREE,
     .unit = "mm",
     .otherwise = "as in the file",
     .when = WHEN(TREE),
     .help = "length of the equal segments that each branch is divided into, as closely as "
             "possible. A new segment gets the radius at which its flow resistance is that of "
             "the piece that it replaces"},
    {.name = "centreline-arrays",
     SETS(FLAG, TreeConversion, centreline_arrays),
     .group = GROUP_FILES,
     .when = WHEN(TREE),
     .help = "add columns named as the arrays of SimVascular's and VMTK's centrelines: "
             "MaximumInscribedSphereRadius, CenterlineSectionArea, BranchId, BifurcationId, Path, "
             "GlobalNodeId; .swc, .in and .vmv files cannot store them"},
};

const OptionTable treeconversion_table = OPTION_TABLE(rows);

/* ---- columns --------------------------------------------------------------------------------- */

/* Reads the values of --values into the tree. */
static Status join_values(const TreeConversion *conversion, Parsed *parsed, Tree *tree, Err *err)
{
    size_t length;
    const char *column;
    char *path = NULL;
    if (!conversion->values)
        return STATUS_OK;
    if (!values_parse(conversion->values, &length, &column))
        return err_set(err, STATUS_USAGE,
                       "--values: '%.60s' is not a FILE.csv, FILE.csv:COLUMN or FOLDER:flow",
                       conversion->values);
    TRY(mem_strdup(&path, conversion->values, err));
    path[length] = '\0';
    Status status = files_add_input(&parsed->files, "--values", path, err);
    if (status == STATUS_OK)
        status = tree_read_values(tree, path, column, NULL, err);
    free(path);
    return status;
}

/* Adds a field as a column; nothing if the tree has a column of its name. */
static Status add_field(Tree *tree, const TreeMeta *said, const char *name, Err *err)
{
    Field field;
    double *value;
    if (tree_column(tree, name))
        return STATUS_OK;
    TRY(derive_field(tree, said, name, &field, err));
    Status status = STATUS_OK;
    if (!tree_column(tree, field.name)) {
        status = tree_add_column(tree, field.name, field.unit, &value, err);
        if (status == STATUS_OK)
            memcpy(value, field.value, tree->n * sizeof *value);
    }
    field_release(&field);
    return status;
}

/* Appends the name of a field that lacks what it needs, and forgets the error. */
static Status skip_lacking(Status status, const char *name, Text *lacking)
{
    if (status != STATUS_INPUT)
        return status;
    text_printf(lacking, "%s%s", *text_chars(lacking) ? ", " : "", name);
    return STATUS_OK;
}

/* Adds all fields that can be derived, and notes which cannot. */
static Status add_all(Tree *tree, const TreeMeta *said, const Talk *talk, Err *err)
{
    static const char *const in_files[] = {"radius", "length", "type", NULL};
    Text lacking = TEXT_INIT;
    Status status = STATUS_OK;
    const char *name;
    for (size_t i = 0; (name = derive_field_name(i)); i++)
        if (!is_one_of(name, in_files)) /* files of trees store these anyway */
            TRY_GOTO(skip_lacking(add_field(tree, said, name, err), name, &lacking));
    TRY_GOTO(text_check(&lacking, err));
    if (*text_chars(&lacking))
        talk_note(talk,
                  "%s are left out: they need %svalues that are neither in the tree nor in options",
                  text_chars(&lacking), tree->link ? "a tree without loops, or " : "");
done:
    text_release(&lacking);
    return status;
}

static Status add_list(Tree *tree, const TreeMeta *said, const char *list, Err *err)
{
    char *copy = NULL;
    TRY(mem_strdup(&copy, list, err));
    Status status = STATUS_OK;
    char *rest = copy;
    for (char *name; status == STATUS_OK && (name = text_field(&rest));)
        status = add_field(tree, said, name, err);
    free(copy);
    return status;
}

/* Derives the fields of --fields into the tree. */
static Status join_fields(const TreeConversion *conversion, const Parsed *parsed, Tree *tree,
                          Err *err)
{
    if (!conversion->fields)
        return STATUS_OK;
    const TreeMeta said = blood_specified(&conversion->blood);
    TRY(blood_apply(&conversion->blood, parsed, tree, err));
    return strcmp(conversion->fields, "all") == 0 ? add_all(tree, &said, parsed->common.talk, err)
                                                  : add_list(tree, &said, conversion->fields, err);
}

/* Smooths and resamples the centrelines, and reports what this changed: length, volume and the sum
 * of l / r^4, which is in proportion to the resistance of all segments in series. */
static Status reshape(const TreeConversion *conversion, const Talk *talk, Tree *tree, Err *err)
{
    const CentrelineSums before = centreline_sums(tree);
    if (!conversion->smooth && conversion->step_mm == 0)
        return STATUS_OK;
    if (conversion->smooth) {
        SmoothMoves moves;
        TRY(tree_smooth(tree, &moves, err));
        talk_note(
            talk,
            "smoothed: nodes moved by up to %.3g mm (%.3g radii); the limit of %g radii shortened "
            "%zu moves",
            moves.most_mm, moves.most_radii, SMOOTH_MOST_RADII, moves.limited);
    }
    if (conversion->step_mm > 0) {
        Tree resampled;
        TRY(tree_resample_copy(tree, conversion->step_mm, &resampled, err));
        talk_note(talk, "resampled: %zu nodes became %zu", tree->n, resampled.n);
        tree_release(tree);
        *tree = resampled;
    }
    const CentrelineSums after = centreline_sums(tree);
    talk_note(talk, "length changed by %+.3g %%, volume by %+.3g %%, sum of l / r^4 by %+.3g %%",
              100 * (after.length_mm / before.length_mm - 1),
              100 * (after.volume_mm3 / before.volume_mm3 - 1),
              100 * (after.resistance / before.resistance - 1));
    return STATUS_OK;
}

/* The columns of --centreline-arrays. */
typedef enum CentrelineArray {
    SPHERE_RADIUS,
    SECTION_AREA,
    BRANCH_ID,
    BIFURCATION_ID,
    PATH,
    GLOBAL_NODE_ID,
    CENTRELINE_ARRAYS
} CentrelineArray;

/* Fills the columns. Branches count from 0; no point is inside a bifurcation, so BifurcationId is
 * -1; Path is the length from the start of the branch. */
static void fill_arrays(const Tree *tree, const Branches *branches, double *const value[])
{
    for (size_t i = 0; i < tree->n; i++) {
        value[SPHERE_RADIUS][i] = tree->radius_mm[i];
        value[SECTION_AREA][i] = PI * tree->radius_mm[i] * tree->radius_mm[i];
        value[BRANCH_ID][i] = value[PATH][i] = 0;
        value[BIFURCATION_ID][i] = -1;
        value[GLOBAL_NODE_ID][i] = (double)i;
    }
    for (size_t k = 0, at = 0; k < branches->n; k++) {
        double path = 0;
        for (; at < branches->end[k]; at++) {
            size_t node = (size_t)branches->node[at];
            path += tree_segment_length(tree, node);
            value[BRANCH_ID][node] = (double)k;
            value[PATH][node] = path;
        }
    }
}

/* Adds the columns of --centreline-arrays. Other programs need the exact names, so the columns
 * state no units: lengths are in mm, areas in mm^2. */
static Status add_arrays(Tree *tree, Err *err)
{
    static const char *const names[CENTRELINE_ARRAYS] = {"MaximumInscribedSphereRadius",
                                                         "CenterlineSectionArea",
                                                         "BranchId",
                                                         "BifurcationId",
                                                         "Path",
                                                         "GlobalNodeId"};
    double *value[CENTRELINE_ARRAYS];
    Branches branches;
    for (int k = 0; k < CENTRELINE_ARRAYS; k++)
        TRY(tree_set_column(tree, names[k], "", &value[k], err));
    TRY(branches_find(tree, &branches, err));
    fill_arrays(tree, &branches, value);
    branches_release(&branches);
    return STATUS_OK;
}

Status convert_tree_make(const TreeConversion *conversion, Parsed *parsed, Tree *tree, Err *err)
{
    *tree = (Tree){0};
    TRY(reading_tree(parsed, parsed->operands[0], tree, NULL, err));
    TRY(join_values(conversion, parsed, tree, err));
    TRY(reshape(conversion, parsed->common.talk, tree, err));
    TRY(join_fields(conversion, parsed, tree, err));
    if (conversion->centreline_arrays)
        TRY(add_arrays(tree, err));
    tree_renumber(tree);
    return STATUS_OK;
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Records the file of a moment as written. */
static Status note_moment(Parsed *parsed, const char *to, size_t moment, Err *err)
{
    char *path = NULL;
    TRY(tree_time_step_path(to, moment, &path, err));
    Status status = files_add_output(&parsed->files, to, path, err);
    free(path);
    return status;
}

/* Writes an index for ParaView and the files that it names, none of which is read here. */
static Status write_moments(const Tree *tree, Parsed *parsed, const char *to, Err *err)
{
    size_t n = 0;
    Status status = tree_count_time_steps(tree, &n, err);
    for (size_t k = 0; k < n && status == STATUS_OK; k++)
        status = note_moment(parsed, to, k, err);
    if (status == STATUS_OK)
        return tree_write_time_steps(tree, to, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", parsed->operands[0]);
    return status;
}

Status convert_tree_write(const Tree *tree, Parsed *parsed, const char *path, Err *err)
{
    return strcasecmp(file_extension(path), "pvd") == 0
               ? write_moments(tree, parsed, path, err)
               : tree_output(tree, path, parsed->common.talk, err);
}
