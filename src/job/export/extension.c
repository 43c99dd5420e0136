/* Lengthens the ends of vessels for flow simulations. A vessel end is a circle at a right angle to
 * a straight segment. An extension therefore only makes the segment longer: no transition to a
 * circle is needed, and the mesh has no kink. */
#include "job/export/extension.h"

#include "options/talk.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>

const char extension_column[] = "extension"; /* the column with the length of each extension, mm */

/* Lengths of extensions, radii of the end. Laminar flow at Reynolds number Re develops within
 * 0.12 Re radii [extension_entrance_length], so 100 radii suffice up to Re = 830. */
static const Range length_range = {0, 100};

static const Option rows[] = {
    {.name = "extend",
     SETS(NUMBER, ExtensionOptions, all),
     .group = GROUP_VESSELS,
     .range = &length_range,
     .argument = "N",
     .otherwise = "0",
     .when = WHEN(NAMED_PARTS) | WHEN(NO_VOLUME) | WHEN(NO_PAGE),
     .excludes = "smooth",
     .help = "length by which each vessel end is extended along its axis, in units of the end's "
             "radius, for flow solvers. For files with named parts only (VTP, gmsh, VTU, or STL "
             "with --parts)"},
    {.name = "extend-inlet",
     SETS(NUMBER, ExtensionOptions, inlet),
     GIVEN(ExtensionOptions, has_inlet),
     .group = GROUP_VESSELS,
     .range = &length_range,
     .argument = "N",
     .otherwise = "the value of --extend",
     .when = WHEN(NAMED_PARTS) | WHEN(NO_VOLUME) | WHEN(NO_PAGE),
     .excludes = "smooth",
     .help = "length by which inlets are extended, in units of the radius at the inlet; replaces "
             "--extend at inlets"},
    {.name = "extend-outlet",
     SETS(TEXT, ExtensionOptions, outlet),
     .group = GROUP_VESSELS,
     .argument = "N|FILE.csv",
     .otherwise = "the value of --extend",
     .when = WHEN(NAMED_PARTS) | WHEN(NO_VOLUME) | WHEN(NO_PAGE),
     .excludes = "smooth",
     .help = "length by which outlets are extended, in units of the radius at the outlet; "
             "replaces --extend at outlets. Or a CSV file with the columns id (of the outlet) and "
             "radii (this length)"},
};

const OptionTable extension_table = OPTION_TABLE(rows);

/* ---- lengths --------------------------------------------------------------------------------- */

/* Reads the lengths of outlets, in radii, from a file. Outlets without a row keep their length. */
static Status read_lengths(const char *path, Parsed *parsed, const Tree *tree,
                           const int32_t *children, double *radii, Err *err)
{
    Tree copy = {0};
    Status status;
    TRY_GOTO(files_add_input(&parsed->files, "--extend-outlet", path, err));
    TRY_GOTO(tree_prune_copy(tree, 0, &copy, err));
    TRY_GOTO(tree_read_values(&copy, path, "radii", NULL, err));
    const double *value = tree_column(&copy, "radii")->value;
    for (size_t i = 0; i < tree->n; i++) {
        if (isnan(value[i]))
            continue;
        if (children[i] > 0 || !tree_is_segment(tree, i))
            status =
                err_set(err, STATUS_INPUT, "%s: segment %d is not an outlet", path, tree->id[i]);
        else if (!range_has(length_range, value[i]))
            status = err_set(err, STATUS_INPUT,
                             "%s: the extension of outlet %d is %g radii; it must be 0 to 100",
                             path, tree->id[i], value[i]);
        if (status != STATUS_OK)
            goto done;
        radii[i] = value[i];
    }
done:
    tree_release(&copy);
    return status;
}

/* Sets radii[node] to the length of the extension at each end, in radii; 0 at all other nodes. */
static Status choose_lengths(const ExtensionOptions *options, Parsed *parsed, const Tree *tree,
                             const int32_t *children, double *radii, Err *err)
{
    double inlet = options->has_inlet ? options->inlet : options->all, outlet = options->all;
    bool is_number = options->outlet && number_parse(options->outlet, &outlet);
    if (is_number && !range_has(length_range, outlet))
        return err_set(err, STATUS_USAGE, "--extend-outlet: %g is not a number from 0 to 100",
                       outlet);
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            radii[i] = children[i] == 1 ? inlet : 0;
        else
            radii[i] = children[i] == 0 ? outlet : 0;
    return options->outlet && !is_number
               ? read_lengths(options->outlet, parsed, tree, children, radii, err)
               : STATUS_OK;
}

/* ---- collisions ------------------------------------------------------------------------------ */

/* An extension or a segment, as a cylinder with round ends. */
typedef struct Capsule {
    Vec3 from, along;
    double radius;
    size_t segment; /* index of the segment, or of the segment that the extension lengthens */
    size_t node;    /* of an extension: the node of the end */
} Capsule;

/* Returns the gap between two capsules, in mm; below 0 if they overlap. Of capsule `a` only the
 * fraction `part` of its length is used. The minimum is found by ternary search, because the
 * distance from the axis of `b` is a convex function of the position on the axis of `a`. 60 steps
 * leave (2/3)^60 = 3e-11 of the interval. */
static double gap(const Capsule *a, double part, const Capsule *b)
{
    double low = 0, high = part;
    for (int i = 0; i < 60; i++) {
        double third[2] = {low + (high - low) / 3, high - (high - low) / 3}, distance2[2];
        for (int k = 0; k < 2; k++) {
            Vec3 at = vec3_sub(vec3_add_scaled(a->from, a->along, third[k]), b->from);
            distance2[k] = vec3_distance2_along(at, b->along);
        }
        bool is_low = distance2[0] < distance2[1]; /* the minimum is not in the last third */
        *(is_low ? &high : &low) = third[is_low];
    }
    Vec3 at = vec3_sub(vec3_add_scaled(a->from, a->along, high), b->from);
    return sqrt(vec3_distance2_along(at, b->along)) - a->radius - b->radius;
}

/* Returns true if the first fraction `part` of the extension overlaps another vessel. A vessel that
 * already overlaps the end, such as the sister segment at a bifurcation, counts only if the
 * extension overlaps it more deeply. A billionth of the radius allows for rounding. */
static bool overlaps(const Capsule *extension, double part, const Capsule *other)
{
    double there = gap(extension, part, other);
    return there < 0 && there < gap(extension, 0, other) - 1e-9 * extension->radius;
}

static Box capsule_box(const Capsule *capsule)
{
    Box box = box_with_ball(box_empty(), capsule->from, capsule->radius);
    return box_with_ball(box, vec3_add(capsule->from, capsule->along), capsule->radius);
}

/* Sets the error that names both vessels and the longest extension without an overlap, rounded down
 * to a tenth of a radius. It is found by bisection; 40 steps leave 1e-12 of the length. Returns
 * STATUS_INPUT. */
static Status refuse(const Tree *tree, const Capsule *capsule, const Capsule *other, double radii,
                     Err *err)
{
    bool is_inlet = !tree_is_segment(tree, capsule->node);
    double low = 0, high = 1;
    for (int i = 0; i < 40; i++)
        *(overlaps(capsule, (low + high) / 2, other) ? &high : &low) = (low + high) / 2;
    return err_set(err, STATUS_INPUT,
                   "`extend`: the extension of %s %d by %g radii meets segment %d or its "
                   "extension; the longest that fits is %.1f radii",
                   is_inlet ? "the inlet at segment" : "outlet", tree->id[capsule->segment], radii,
                   tree->id[other->segment], floor(low * radii * 10) / 10);
}

/* Checks that no extension overlaps a segment or another extension. The first n - n_extensions
 * capsules are segments. */
static Status check_gaps(const Tree *tree, const Capsule *capsule, size_t n, size_t n_extensions,
                         const double *radii, Err *err)
{
    Box *boxes = NULL;
    BoxTree boxtree = {0};
    uint32_t other;
    Status status;
    TRY_GOTO(mem_alloc(&boxes, n, sizeof *boxes, "vessels", err));
    for (size_t i = 0; i < n; i++)
        boxes[i] = capsule_box(&capsule[i]);
    TRY_GOTO(boxtree_build(boxes, n, &boxtree, err));
    for (size_t i = n - n_extensions; i < n; i++)
        for (BoxWalk walk = boxwalk_box(&boxtree, boxes[i]); boxwalk_next(&walk, &other);)
            if (capsule[other].segment != capsule[i].segment &&
                overlaps(&capsule[i], 1, &capsule[other]))
                TRY_GOTO(refuse(tree, &capsule[i], &capsule[other], radii[capsule[i].node], err));
done:
    boxtree_release(&boxtree);
    free(boxes);
    return status;
}

/* Lists the segments, then the extensions. Returns the number of capsules. Sets *n_extensions to
 * the number of extensions. only_child[node] is the segment that begins at a root; the extension of
 * an inlet lengthens it backwards. */
static size_t list_capsules(const Tree *tree, const int32_t *only_child, const double *radii,
                            Capsule *capsule, size_t *n_extensions)
{
    size_t n = 0, segments;
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i)) {
            Vec3 from = tree->position[tree->parent[i]];
            capsule[n++] =
                (Capsule){from, vec3_sub(tree->position[i], from), tree->radius_mm[i], i, i};
        }
    segments = n;
    for (size_t i = 0; i < tree->n; i++) {
        size_t segment = tree_is_segment(tree, i) ? i : (size_t)only_child[i];
        double length = tree_segment_length(tree, segment);
        if (!(radii[i] > 0) || !(length > 0))
            continue;
        Vec3 start = tree->position[tree->parent[segment]], end = tree->position[segment];
        double factor = radii[i] * tree->radius_mm[segment] / length;
        Vec3 along = segment == i ? vec3_sub(end, start) : vec3_sub(start, end);
        capsule[n++] = (Capsule){tree->position[i], vec3_scale(along, factor),
                                 tree->radius_mm[segment], segment, i};
    }
    *n_extensions = n - segments;
    return n;
}

/* Moves the ends of the tree, and adds the column with the lengths in mm. */
static Status lengthen(Tree *tree, const Capsule *extension, size_t n, Err *err)
{
    double *column;
    TRY(tree_set_column(tree, extension_column, "mm", &column, err));
    for (size_t i = 0; i < tree->n; i++)
        column[i] = 0;
    for (size_t i = 0; i < n; i++) {
        Vec3 *end = &tree->position[extension[i].node];
        *end = vec3_add(*end, extension[i].along);
        column[extension[i].node] = vec3_length(extension[i].along);
    }
    return STATUS_OK;
}

/* ---- the flow in extensions ------------------------------------------------------------------ */

Status extension_field(const Tree *tree, const TreeMeta *said, const char *name, Field *field,
                       Err *err)
{
    *field = (Field){0};
    Status status = derive_computed_field(tree, said, name, field, err);
    return status == STATUS_INPUT ? STATUS_OK : status;
}

/* 0.06 diameters per unit of the Reynolds number: the usual estimate of the length in which laminar
 * flow in a tube develops. */
double extension_entrance_length(const Tree *tree, const Field *reynolds, size_t segment)
{
    return 0.06 * reynolds->value[segment] * 2 * tree->radius_mm[segment];
}

/* Sends a note about the end with an extension whose entrance length is the maximum. */
static void say_entrance(const Tree *tree, const Field *reynolds, bool of_inlets, const Talk *talk)
{
    const double *length = tree_column(tree, extension_column)->value;
    double most = 0;
    size_t at = 0;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i) || !(length[of_inlets ? (size_t)tree->parent[i] : i] > 0) ||
            !(extension_entrance_length(tree, reynolds, i) > most))
            continue;
        most = extension_entrance_length(tree, reynolds, i);
        at = i;
    }
    if (most > 0)
        talk_note(talk,
                  "laminar flow needs up to %.4g mm to develop at the %s (segment %d, Reynolds "
                  "number %.4g); the extension there has %.4g mm",
                  most, of_inlets ? "inlets" : "outlets", tree->id[at], reynolds->value[at],
                  length[of_inlets ? (size_t)tree->parent[at] : at]);
}

Status extension_report(const Tree *tree, const TreeMeta *said, const Talk *talk, Err *err)
{
    Field reynolds;
    if (!tree_column(tree, extension_column))
        return STATUS_OK;
    TRY(extension_field(tree, said, "reynolds", &reynolds, err));
    for (int of_inlets = 1; of_inlets >= 0 && reynolds.value; of_inlets--)
        say_entrance(tree, &reynolds, of_inlets, talk);
    field_release(&reynolds);
    return STATUS_OK;
}

Status extension_apply(const ExtensionOptions *options, Parsed *parsed, Tree *tree, Err *err)
{
    int32_t *children = NULL, *only_child = NULL;
    double *radii = NULL;
    Capsule *capsule = NULL;
    size_t n, n_extensions;
    Status status;
    if (options->all == 0 && options->inlet == 0 && !options->outlet)
        return STATUS_OK;
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(mem_calloc(&only_child, tree->n, sizeof *only_child, "nodes", err));
    TRY_GOTO(mem_calloc(&radii, tree->n, sizeof *radii, "radii", err));
    TRY_GOTO(mem_calloc(&capsule, 2 * tree->n, sizeof *capsule, "vessels", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            only_child[tree->parent[i]] = (int32_t)i;
    TRY_GOTO(choose_lengths(options, parsed, tree, children, radii, err));
    n = list_capsules(tree, only_child, radii, capsule, &n_extensions);
    TRY_GOTO(check_gaps(tree, capsule, n, n_extensions, radii, err));
    status = lengthen(tree, capsule + n - n_extensions, n_extensions, err);
done:
    free(children);
    free(only_child);
    free(radii);
    free(capsule);
    return status;
}
