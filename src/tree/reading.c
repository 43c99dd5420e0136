/* Measures the report on a tree that was read: its unit, roots, loops and radii. Also repairs
 * missing radii.
 *
 * The report is measured on the finished tree, in the same way for all formats.
 *
 * A unit is plausible if the median radius, read in that unit, is a radius of vessels. The unit
 * with which the tree was read is tried first, then the other units, common ones before rare ones.
 */
#include "tree/reading.h"

#include "tree/tree.h"
#include <stdarg.h>
#include <stdlib.h>

const char *const length_unit_names[LENGTH_UNITS + 1] = {"mm", "um", "cm", "m", NULL};

const char *const root_reason_texts[ROOT_REASONS] = {
    [ROOT_STATED] = "from the file",
    [ROOT_DIRECTION] = "lines lead away from it alone",
    [ROOT_THICKEST] = "the thickest of the ends",
};

double length_unit_mm(LengthUnit unit)
{
    static const double mm[LENGTH_UNITS] = {
        [LENGTH_MM] = 1, [LENGTH_UM] = 1e-3, [LENGTH_CM] = 10, [LENGTH_M] = 1e3};
    return mm[unit];
}

double length_from_mm(double mm, LengthUnit unit)
{
    const double factor = length_unit_mm(unit);
    double best = mm / factor;
    const double others[] = {nextafter(best, -HUGE_VAL), nextafter(best, HUGE_VAL)};
    for (size_t i = 0; i < 2; i++)
        if (fabs(others[i] * factor - mm) < fabs(best * factor - mm))
            best = others[i];
    return best;
}

LengthScale length_scale(const ReadOptions *options, LengthUnit unit)
{
    LengthScale scale = {{1, 1, 1}, 1};
    if (options && options->has_voxel_size)
        scale.position = options->voxel_size;
    if (options && options->voxel_radii)
        scale.radius = elementary_cbrt(scale.position.x * scale.position.y * scale.position.z);
    double mm = length_unit_mm(options && options->has_unit ? options->unit : unit);
    return (LengthScale){vec3_scale(scale.position, mm), scale.radius * mm};
}

Vec3 length_scaled(const LengthScale *scale, Vec3 position)
{
    return (Vec3){position.x * scale->position.x, position.y * scale->position.y,
                  position.z * scale->position.z};
}

void reading_release(TreeReading *reading)
{
    for (size_t i = 0; i < reading->n_notes; i++)
        free(reading->note[i]);
    free(reading->note);
    free(reading->root);
    free(reading->repaired);
    free(reading->network.cut);
    *reading = (TreeReading){0};
}

Status reading_note(TreeReading *reading, Err *err, const char *format, ...)
{
    if (!reading)
        return STATUS_OK;
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    TRY(mem_reserve(&reading->note, &reading->notes_capacity, reading->n_notes + 1,
                    sizeof *reading->note, "notes", err));
    TRY(mem_strdup(&reading->note[reading->n_notes], text, err));
    reading->n_notes++;
    return STATUS_OK;
}

Status reading_refuse_radius(const char *what, const char *text, Err *err)
{
    return err_set(err, STATUS_INPUT,
                   "the %s is '%.40s'; it must be a finite number of 0 or more (`repair_radii` "
                   "replaces it, from its neighbors)",
                   what, text);
}

Status reading_radius(const ReadOptions *options, double *radius, Err *err)
{
    char number[NUMBER_TEXT_SIZE];
    if (isnan(*radius) || (*radius >= 0 && isfinite(*radius)))
        return STATUS_OK;
    if (!options || !options->repair_radii)
        return reading_refuse_radius("radius", number_text(*radius, number), err);
    *radius = (double)NAN;
    return STATUS_OK;
}

/* Sets the missing radius of a root to the radius of the thickest segment that leaves it. With
 * `zeros`, a radius of 0 counts as missing. */
static Status fill_roots(Tree *tree, bool zeros, Err *err)
{
    double *thickest = NULL;
    TRY(mem_calloc(&thickest, tree->n, sizeof *thickest, "radii", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            thickest[tree->parent[i]] = fmax(thickest[tree->parent[i]], tree->radius_mm[i]);
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i) &&
            (isnan(tree->radius_mm[i]) || (zeros && tree->radius_mm[i] == 0)))
            tree->radius_mm[i] = thickest[i];
    free(thickest);
    return STATUS_OK;
}

/* ---- repairing radii ------------------------------------------------------------------------- */

/* Returns true for a radius that is missing: 0 or NAN. */
static bool is_gap(double radius)
{
    return !(radius > 0);
}

/* Fills the missing radii of a branch by linear interpolation between known radii, over the path
 * length to the middles of the segments. Beyond the first and the last known radius, the radius is
 * constant. Returns false if no segment has a radius. `middle` has space for n numbers. */
static bool fill_within(Tree *tree, const int32_t *node, size_t n, double *middle)
{
    double length = 0, before = NAN;
    size_t known = n; /* the last segment with a radius of its own; n: none */
    for (size_t i = 0; i < n; i++) {
        double own = tree_segment_length(tree, (size_t)node[i]), radius = tree->radius_mm[node[i]];
        middle[i] = length + own / 2;
        length += own;
        if (is_gap(radius))
            continue;
        for (size_t k = known == n ? 0 : known + 1; k < i; k++) {
            double span = known == n ? 0 : middle[i] - middle[known];
            double part = span > 0 ? (middle[k] - middle[known]) / span : 1;
            tree->radius_mm[node[k]] = known == n ? radius : before + part * (radius - before);
        }
        known = i;
        before = radius;
    }
    for (size_t k = known == n ? n : known + 1; k < n; k++)
        tree->radius_mm[node[k]] = before;
    return known < n;
}

/* Returns the radius for a branch without radii: the smaller radius of its parent and its thickest
 * daughter, or `otherwise` if both are missing. `thickest` has, per node, the radius of the
 * thickest segment that leaves it. */
static double radius_beside(const Tree *tree, const int32_t *node, size_t n, const double *thickest,
                            double otherwise)
{
    int32_t start = tree->parent[node[0]];
    double up = tree_is_segment(tree, (size_t)start) ? tree->radius_mm[start] : 0;
    double down = thickest[tree_linked_node(tree, (size_t)node[n - 1])];
    if (is_gap(up) && is_gap(down))
        return otherwise;
    return is_gap(up) ? down : is_gap(down) ? up : fmin(up, down);
}

/* Returns the median of the known radii; NAN if there is none. `radius` has space for all nodes. */
static double median_radius(const Tree *tree, double *radius)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && !is_gap(tree->radius_mm[i]))
            radius[n++] = tree->radius_mm[i];
    return n > 0 ? select_number(radius, n, n / 2) : (double)NAN;
}

/* Lists the ids of the segments without a radius, for the report. */
static Status list_gaps(TreeReading *reading, const Tree *tree, Err *err)
{
    TRY(mem_calloc(&reading->repaired, tree->n, sizeof *reading->repaired, "ids", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && is_gap(tree->radius_mm[i]))
            reading->repaired[reading->repaired_radii++] = tree->id[i];
    return STATUS_OK;
}

/* Fills all missing radii. Branches are in the order of the tree, so the parent of a branch is
 * filled before the branch. */
static Status repair(TreeReading *reading, Tree *tree, Err *err)
{
    Branches branches = {0};
    double *thickest = NULL, *middle = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&thickest, tree->n, sizeof *thickest, "radii", err));
    TRY_GOTO(mem_calloc(&middle, tree->n, sizeof *middle, "radii", err));
    double otherwise = median_radius(tree, middle);
    TRY_GOTO(branches_find(tree, &branches, err));
    if (!isnan(otherwise))
        TRY_GOTO(list_gaps(reading, tree, err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && tree->radius_mm[i] > thickest[tree->parent[i]])
            thickest[tree->parent[i]] = tree->radius_mm[i];
    for (size_t k = 0, at = 0; k < branches.n; at = branches.end[k++]) {
        const int32_t *node = branches.node + at;
        size_t n = branches.end[k] - at;
        if (!fill_within(tree, node, n, middle))
            for (size_t i = 0; i < n; i++)
                tree->radius_mm[node[i]] = radius_beside(tree, node, n, thickest, otherwise);
    }
done:
    branches_release(&branches);
    free(thickest);
    free(middle);
    return status;
}

Status reading_fill_radii(TreeReading *reading, const ReadOptions *options, Tree *tree, Err *err)
{
    if (!options->repair_radii && options->radius_mm == 0)
        return STATUS_OK;
    TRY(fill_roots(tree, false, err));
    if (options->repair_radii)
        TRY(repair(reading, tree, err));
    for (size_t i = 0; i < tree->n; i++) {
        double *radius = &tree->radius_mm[i];
        if (!tree_is_segment(tree, i))
            continue;
        if (options->radius_mm > 0 && is_gap(*radius)) {
            *radius = options->radius_mm;
            reading->given_radius++;
        }
        if (isnan(*radius))
            return err_set(err, STATUS_INPUT,
                           "node %d has no radius, and no other node has one; set one with "
                           "`radius`",
                           tree->id[i]);
    }
    return fill_roots(tree, true, err);
}

/* Counts the nodes of each component. Roots that have no reason yet get ROOT_STATED. */
static Status measure_roots(TreeReading *reading, const Tree *tree, Err *err)
{
    bool has_roots = reading->n_roots > 0;
    uint32_t *root = NULL; /* per node: index of its component's root */
    size_t n = 0;
    Status status = STATUS_OK;
    TRY(mem_calloc(&root, tree->n, sizeof *root, "roots of nodes", err));
    for (size_t i = 0; i < tree->n; i++) {
        if (tree_is_segment(tree, i)) {
            root[i] = root[tree->parent[i]];
        } else {
            root[i] = (uint32_t)n++;
            if (!has_roots) {
                TRY_GOTO(mem_reserve(&reading->root, &reading->roots_capacity, n,
                                     sizeof *reading->root, "roots", err));
                reading->root[reading->n_roots++] = (ReadRoot){tree->id[i], ROOT_STATED, 0};
            }
        }
        reading->root[root[i]].nodes++;
    }
done:
    free(root);
    return status;
}

static Status measure_degrees(TreeReading *reading, const Tree *tree, Err *err)
{
    int32_t *children;
    TRY(tree_child_counts(tree, &children, err));
    for (size_t i = 0; i < tree->n; i++) {
        if (tree_has_link(tree, i))
            continue;
        size_t degree = (size_t)children[i] + tree_is_segment(tree, i);
        reading->degree[degree < READ_MAX_DEGREE ? degree : READ_MAX_DEGREE]++;
    }
    free(children);
    return STATUS_OK;
}

/* Finds a unit in which the median radius is plausible. Trees measured in tissue have median radii
 * from 1 um, of capillaries, to 2.5 mm, of large arteries. */
static void find_plausible_unit(TreeReading *reading)
{
    static const Range of_vessels = {0.001, 2.5}; /* mm */
    static const LengthUnit commoner[] = {LENGTH_MM, LENGTH_UM, LENGTH_M, LENGTH_CM};
    double median = reading->median_radius_mm / length_unit_mm(reading->unit);
    reading->plausible_unit = reading->unit;
    reading->has_plausible_unit = range_has(of_vessels, reading->median_radius_mm);
    for (size_t k = 0; k < LENGTH_UNITS && !reading->has_plausible_unit; k++) {
        reading->plausible_unit = commoner[k];
        reading->has_plausible_unit = range_has(of_vessels, median * length_unit_mm(commoner[k]));
    }
}

static void measure_radii(TreeReading *reading, const Tree *tree, double *radius)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        radius[n++] = tree->radius_mm[i];
        reading->without_radius += tree->radius_mm[i] == 0;
    }
    if (n > 0)
        reading->median_radius_mm = select_number(radius, n, n / 2);
}

bool reading_is_voxel(Vec3 at)
{
    return at.x == floor(at.x) && at.y == floor(at.y) && at.z == floor(at.z);
}

static bool looks_like_voxels(const Tree *tree)
{
    for (size_t i = 0; i < tree->n; i++)
        if (!reading_is_voxel(tree->position[i]))
            return false;
    return tree->n >= READ_MIN_POINTS;
}

Status reading_measure(TreeReading *reading, const Tree *tree, Err *err)
{
    double *radius = NULL;
    Status status = STATUS_OK;
    TRY(mem_calloc(&radius, tree->n, sizeof *radius, "radii", err));
    TRY_GOTO(measure_roots(reading, tree, err));
    TRY_GOTO(measure_degrees(reading, tree, err));
    measure_radii(reading, tree, radius);
    if (!reading->is_network && !reading->unit_is_stated && !reading->voxels)
        reading->looks_like_voxels = looks_like_voxels(tree);
    find_plausible_unit(reading);
done:
    free(radius);
    return status;
}
