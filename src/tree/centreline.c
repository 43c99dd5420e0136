/* Smooths centrelines, and divides branches into segments of equal length.
 *
 * Centrelines that were traced in voxels have steps. A spline through all nodes would keep the
 * steps and make the path longer, so a low-pass filter removes them [docs/METHODS.md section 10].
 * Resampling walks along each branch once and sums what each new segment replaces. */
#include "tree/tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

CentrelineSums centreline_sums(const Tree *tree)
{
    CentrelineSums sums = {0};
    for (size_t i = 0; i < tree->n; i++) {
        double length = tree_segment_length(tree, i), r2 = tree->radius_mm[i] * tree->radius_mm[i];
        sums.length_mm += length;
        sums.volume_mm3 += PI * r2 * length;
        sums.resistance += r2 > 0 ? length / (r2 * r2) : 0;
    }
    return sums;
}

/* ---- smoothing ------------------------------------------------------------------------------- */

/* Moves each node inside a branch towards the midpoint of its two neighbours, by `factor` times its
 * distance from the midpoint. `before` is scratch space for the old positions of all nodes. */
static void filter(Tree *tree, const Branches *branches, double factor, Vec3 *before)
{
    memcpy(before, tree->position, tree->n * sizeof *before);
    for (size_t k = 0, at = 0; k < branches->n; k++, at++)
        for (; at + 1 < branches->end[k]; at++) {
            int32_t node = branches->node[at], next = branches->node[at + 1];
            Vec3 middle = vec3_scale(vec3_add(before[tree->parent[node]], before[next]), 0.5);
            Vec3 way = vec3_sub(middle, before[node]);
            tree->position[node] = vec3_add_scaled(before[node], way, factor);
        }
}

/* Limits the move of each node from its position in `from` to SMOOTH_MOST_RADII radii. */
static void limit_moves(Tree *tree, const Branches *branches, const Vec3 *from, SmoothMoves *moves)
{
    for (size_t k = 0, at = 0; k < branches->n; k++, at++)
        for (; at + 1 < branches->end[k]; at++) {
            int32_t node = branches->node[at], next = branches->node[at + 1];
            double radius = fmin(tree->radius_mm[node], tree->radius_mm[next]);
            double most = SMOOTH_MOST_RADII * radius;
            Vec3 way = vec3_sub(tree->position[node], from[node]);
            double length = vec3_length(way);
            if (length > most) {
                tree->position[node] = vec3_add_scaled(from[node], way, most / length);
                moves->limited++;
                length = most;
            }
            moves->most_mm = fmax(moves->most_mm, length);
            moves->most_radii = fmax(moves->most_radii, radius > 0 ? length / radius : 0);
        }
}

Status tree_smooth(Tree *tree, SmoothMoves *moves, Err *err)
{
    /* Taubin's factors [SIGGRAPH 1995]: each round shrinks the curve by 0.5 and then inflates it by
     * 0.53. Waves of 13 segments or more pass unchanged, within 1 %. After ten rounds, waves of 6
     * segments have 0.6 and waves of 4 segments have 0.07 times their first amplitude. More rounds
     * damp longer waves, too. */
    enum { ROUNDS = 10 };
    Branches branches = {0};
    Vec3 *from = NULL, *before = NULL;
    Status status;
    *moves = (SmoothMoves){0};
    TRY_GOTO(branches_find(tree, &branches, err));
    TRY_GOTO(mem_alloc(&from, tree->n, sizeof *from, "positions", err));
    TRY_GOTO(mem_alloc(&before, tree->n, sizeof *before, "positions", err));
    memcpy(from, tree->position, tree->n * sizeof *from);
    for (int round = 0; round < ROUNDS; round++) {
        filter(tree, &branches, 0.5, before);
        filter(tree, &branches, -0.53, before);
    }
    limit_moves(tree, &branches, from, moves);
done:
    branches_release(&branches);
    free(from);
    free(before);
    return status;
}

/* ---- resampling ------------------------------------------------------------------------------ */

/* A branch that is being resampled. */
typedef struct BranchResampling {
    const Tree *tree;
    Tree *out;
    const int32_t *segment; /* the segments of the branch */
    size_t n;
    double length_mm;
    int32_t pieces;
} BranchResampling;

/* Returns the number of new segments of a branch of `n` segments. A branch that ends with a link
 * may begin where it ends, or lie beside another branch, and keeps up to 3 segments. */
static int32_t count_pieces(const Tree *tree, const int32_t *segment, size_t n, double length,
                            double step)
{
    int32_t least = !tree_has_link(tree, (size_t)segment[n - 1]) ? 1 : n < 3 ? (int32_t)n : 3;
    double pieces = fmin(floor(length / step + 0.5), TREE_MAX_ID);
    return pieces > least ? (int32_t)pieces : least;
}

/* Sums over the part of a branch that a new segment replaces. */
typedef struct PieceSums {
    double length, inverse_r4; /* sum of l, and of l / r^4 */
} PieceSums;

/* Adds `length` mm of an old segment to the sums. */
static void add_part(const BranchResampling *branch, int32_t segment, double length,
                     PieceSums *sums)
{
    double r2 = branch->tree->radius_mm[segment] * branch->tree->radius_mm[segment];
    sums->length += length;
    sums->inverse_r4 += length > 0 ? length / (r2 * r2) : 0;
}

/* Completes new segment `to`: radius, type and values. `segment` is the old segment at its end. */
static void end_piece(const BranchResampling *branch, int32_t segment, size_t to,
                      const PieceSums *sums)
{
    Tree *out = branch->out;
    double r4 = sums->length / sums->inverse_r4;
    out->radius_mm[to] = sums->length > 0 ? sqrt(sqrt(r4)) : branch->tree->radius_mm[segment];
    out->type[to] = branch->tree->type[segment];
    for (size_t k = 0; k < out->n_columns; k++)
        out->column[k].value[to] = branch->tree->column[k].value[segment];
}

/* Writes the new segments of a branch to the nodes from `first` on. */
static void resample(const BranchResampling *branch, size_t first)
{
    const Tree *tree = branch->tree;
    double done = 0; /* length of the old segments before the current one */
    int32_t piece = 0;
    PieceSums sums = {0};
    for (size_t i = 0; i < branch->n; i++) {
        int32_t segment = branch->segment[i];
        double length = tree_segment_length(tree, (size_t)segment), from = 0, end;
        Vec3 a = tree->position[tree->parent[segment]];
        Vec3 along = vec3_sub(tree->position[segment], a);
        for (; piece + 1 < branch->pieces; piece++, from = end) {
            end = branch->length_mm * (piece + 1) / branch->pieces - done;
            if (end > length)
                break;
            size_t to = first + (size_t)piece;
            add_part(branch, segment, end - from, &sums);
            branch->out->position[to] = vec3_add_scaled(a, along, end / length);
            end_piece(branch, segment, to, &sums);
            sums = (PieceSums){0};
        }
        add_part(branch, segment, length - from, &sums);
        if (tree->flow_share)
            branch->out->flow_share[first + (size_t)piece] += tree->flow_share[segment];
        done += length;
    }
    int32_t last = branch->segment[branch->n - 1];
    branch->out->position[first + (size_t)piece] = tree->position[last];
    end_piece(branch, last, first + (size_t)piece, &sums);
}

static double branch_length(const Tree *tree, const int32_t *segment, size_t n)
{
    double length = 0;
    for (size_t i = 0; i < n; i++)
        length += tree_segment_length(tree, (size_t)segment[i]);
    return length;
}

/* Counts the nodes of the new tree. */
static double count_nodes(const Tree *tree, const Branches *branches, double step)
{
    double n = 0;
    for (size_t i = 0; i < tree->n; i++)
        n += !tree_is_segment(tree, i);
    for (size_t k = 0, at = 0; k < branches->n; at = branches->end[k++])
        n += count_pieces(tree, branches->node + at, branches->end[k] - at,
                          branch_length(tree, branches->node + at, branches->end[k] - at), step);
    return n;
}

/* Makes a tree of n nodes with the metadata and the columns of `tree`. */
static Status start_tree(const Tree *tree, double n, Tree *out, Err *err)
{
    double *value;
    if (n > TREE_MAX_ID)
        return err_set(err, STATUS_INFEASIBLE, "`step` makes %.3g nodes; a tree has at most %d", n,
                       TREE_MAX_ID);
    TRY(tree_init(out, (size_t)n, err));
    TRY(meta_copy(&out->meta, &tree->meta, err));
    if (tree->flow_share)
        TRY(tree_add_flow_shares(out, err));
    if (tree->link)
        TRY(tree_add_links(out, err));
    for (size_t k = 0; k < tree->n_columns; k++)
        TRY(tree_add_column(out, tree->column[k].name, tree->column[k].unit, &value, err));
    return STATUS_OK;
}

/* Writes node `to`, a root, as a copy of node `from`. */
static void copy_root(const Tree *tree, size_t from, Tree *out, size_t to)
{
    out->parent[to] = TREE_NO_PARENT;
    out->position[to] = tree->position[from];
    out->radius_mm[to] = tree->radius_mm[from];
    out->type[to] = tree->type[from];
    if (tree->flow_share)
        out->flow_share[to] = tree->flow_share[from];
    for (size_t k = 0; k < tree->n_columns; k++)
        out->column[k].value[to] = tree->column[k].value[from];
}

/* Writes all nodes: copies of the roots, then the new segments of each branch. place[i] receives
 * the new index of old node i if it is a root or the end of a branch. */
static void fill(const Tree *tree, const Branches *branches, double step, int32_t *place, Tree *out)
{
    size_t n = 0;
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i)) {
            place[i] = (int32_t)n;
            copy_root(tree, i, out, n++);
        }
    for (size_t k = 0, at = 0; k < branches->n; at = branches->end[k++]) {
        const int32_t *segment = branches->node + at;
        size_t count = branches->end[k] - at;
        double length = branch_length(tree, segment, count);
        const BranchResampling branch = {
            tree, out, segment, count, length, count_pieces(tree, segment, count, length, step)};
        for (int32_t piece = 0; piece < branch.pieces; piece++)
            out->parent[n + (size_t)piece] =
                piece ? (int32_t)n + piece - 1 : place[tree->parent[segment[0]]];
        resample(&branch, n);
        n += (size_t)branch.pieces;
        place[segment[count - 1]] = (int32_t)n - 1;
    }
    for (size_t i = 0; i < tree->n && tree->link; i++)
        if (tree_has_link(tree, i))
            out->link[place[i]] = place[tree->link[i]];
    tree_renumber(out);
}

Status tree_resample_copy(const Tree *tree, double step_mm, Tree *out, Err *err)
{
    Branches branches = {0};
    int32_t *place = NULL; /* per node: its index in the new tree */
    Tree made = {0};
    Status status;
    TRY_GOTO(branches_find(tree, &branches, err));
    TRY_GOTO(mem_alloc(&place, tree->n, sizeof *place, "nodes", err));
    TRY_GOTO(start_tree(tree, count_nodes(tree, &branches, step_mm), &made, err));
    fill(tree, &branches, step_mm, place, &made);
    *out = made;
    made = (Tree){0};
done:
    tree_release(&made);
    branches_release(&branches);
    free(place);
    return status;
}
