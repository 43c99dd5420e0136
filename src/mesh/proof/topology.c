/* Computes the topology of a mesh: open edges, components, genus, and triangles that bridge two
 * trees.
 *
 * Each edge is listed at its end of lower index, with its other end and its direction. An edge is
 * closed if the list has the other end exactly twice, once in each direction. In a closed mesh the
 * number of triangles is two thirds of the number of edges, and the sum of the genera is components
 * - (points - edges + triangles) / 2. O(triangles). */
#include "mesh/proof/meshcheck.h"

#include <stdlib.h>

#define NO_TREE UINT32_MAX

/* Edges are listed for this many points at a time: 4 million, whose lists take about 120 MB. A mesh
 * of 4 million points takes twice as much. */
enum { POINTS_AT_A_TIME = 1 << 22 };

/* Lists, per point in [from, to), its edges to points of a higher index. An item is twice the index
 * of the other end, plus 1 if the triangle's edge leads from the other end to the point. */
static Status list_edges(const VesselMesh *mesh, size_t from, size_t to, IndexLists *lists,
                         Err *err)
{
    TRY(indexlists_begin(lists, to - from, "edges", err));
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < 3 * mesh->n_triangles; i++) {
            uint32_t a = mesh->triangles[i / 3][i % 3], b = mesh->triangles[i / 3][(i + 1) % 3];
            uint32_t low = a < b ? a : b, high = a < b ? b : a;
            if (low < from || low >= to)
                continue;
            if (pass == 0)
                indexlists_count(lists, low - from);
            else
                indexlists_put(lists, low - from, 2 * high + (a > b));
        }
        if (pass == 0)
            TRY(indexlists_allot(lists, "edges", err));
    }
    return STATUS_OK;
}

/* Sorts by insertion, because a point has few edges. */
static void sort_few(uint32_t *numbers, size_t n)
{
    for (size_t i = 1; i < n; i++) {
        uint32_t own = numbers[i];
        size_t at = i;
        for (; at > 0 && numbers[at - 1] > own; at--)
            numbers[at] = numbers[at - 1];
        numbers[at] = own;
    }
}

/* Counts the listed edges that do not have two triangles, one in each direction. */
static size_t count_listed(const IndexLists *lists)
{
    size_t open = 0;
    for (size_t i = 0; i < lists->n; i++) {
        uint32_t *ends = &lists->items[lists->first[i]];
        size_t n = indexlists_length(lists, i);
        sort_few(ends, n);
        for (size_t k = 0; k < n;) {
            size_t same = k;
            while (same < n && ends[same] / 2 == ends[k] / 2)
                same++;
            open += !(same == k + 2 && ends[k] % 2 == 0 && ends[k + 1] % 2 == 1);
            k = same;
        }
    }
    return open;
}

/* Counts the edges that do not have two triangles, one in each direction. */
static Status count_open(const VesselMesh *mesh, size_t *open, Err *err)
{
    IndexLists lists = {0};
    Status status = STATUS_OK;
    *open = 0;
    for (size_t from = 0; from < mesh->n_points; from += POINTS_AT_A_TIME) {
        size_t rest = mesh->n_points - from, n = rest < POINTS_AT_A_TIME ? rest : POINTS_AT_A_TIME;
        TRY_GOTO(list_edges(mesh, from, from + n, &lists, err));
        *open += count_listed(&lists);
    }
done:
    indexlists_release(&lists);
    return status;
}

/* Counts the triangles of segments that are not of the same tree as the first triangle of their
 * component. `tree` is scratch, per point. */
static size_t count_bridges(const VesselMesh *mesh, uint32_t *root, uint32_t *tree,
                            const uint32_t *trees)
{
    size_t bridges = 0;
    for (size_t i = 0; i < mesh->n_points; i++)
        tree[i] = NO_TREE;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t component = sets_find(root, mesh->triangles[i][0]);
        uint32_t own = trees[mesh_segment(mesh, i)];
        if (tree[component] == NO_TREE)
            tree[component] = own;
        bridges += tree[component] != own;
    }
    return bridges;
}

double vesselmesh_volume(const VesselMesh *mesh)
{
    double six = 0;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        Vec3 at[3];
        for (int k = 0; k < 3; k++)
            at[k] = vec3_sub(mesh_point(mesh, mesh->triangles[i][k]), mesh_point(mesh, 0));
        six += vec3_dot(at[0], vec3_cross(at[1], at[2]));
    }
    return six / 6;
}

Status meshcheck_trees(const VesselTree *tree, uint32_t **trees, size_t *n_trees, Err *err)
{
    uint32_t *root = NULL, *number = NULL; /* number: per root, the index of its tree plus 1 */
    Status status;
    TRY_GOTO(mem_calloc(&root, tree->n_nodes, sizeof *root, "nodes", err));
    TRY_GOTO(mem_calloc(&number, tree->n_nodes, sizeof *number, "nodes", err));
    TRY_GOTO(mem_calloc(trees, tree->n_segments, sizeof **trees, "segments", err));
    sets_begin(root, tree->n_nodes);
    for (size_t i = 0; i < tree->n_segments; i++)
        sets_join(root, tree->nodes[i][0], tree->nodes[i][1]);
    *n_trees = 0;
    for (size_t i = 0; i < tree->n_segments; i++) {
        uint32_t *own = &number[sets_find(root, tree->nodes[i][0])];
        *own = *own ? *own : (uint32_t)(*n_trees += 1);
        (*trees)[i] = *own - 1;
    }
done:
    free(root);
    free(number);
    return status;
}

Status meshcheck_loops(const VesselTree *tree, const uint32_t *trees, size_t n_trees,
                       uint32_t **loops, Err *err)
{
    bool *is_counted = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&is_counted, tree->n_nodes, sizeof *is_counted, "nodes", err));
    TRY_GOTO(mem_calloc(loops, n_trees, sizeof **loops, "trees", err));
    for (size_t i = 0; i < n_trees; i++)
        (*loops)[i] = 1;
    for (size_t i = 0; i < tree->n_segments; i++) {
        (*loops)[trees[i]]++;
        for (int end = 0; end < 2; end++) {
            bool *counted = &is_counted[tree->nodes[i][end]];
            (*loops)[trees[i]] -= !*counted;
            *counted = true;
        }
    }
done:
    free(is_counted);
    return status;
}

Status meshcheck_topology(const VesselMesh *mesh, const uint32_t *trees, MeshReport *report,
                          Err *err)
{
    uint32_t *root = NULL, *tree = NULL;
    Status status;
    TRY_GOTO(count_open(mesh, &report->open_edges, err));
    TRY_GOTO(mem_calloc(&root, mesh->n_points, sizeof *root, "points", err));
    TRY_GOTO(mem_calloc(&tree, mesh->n_points, sizeof *tree, "points", err));
    sets_begin(root, mesh->n_points);
    report->components = mesh->n_points;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int k = 1; k < 3; k++)
            report->components -= sets_join(root, mesh->triangles[i][0], mesh->triangles[i][k]);
    report->bridges = trees ? count_bridges(mesh, root, tree, trees) : 0;
    report->euler = (long long)mesh->n_points - (long long)(mesh->n_triangles / 2);
    report->genus = (size_t)llabs((2 * (long long)report->components - report->euler) / 2);
    report->volume_mm3 = vesselmesh_volume(mesh);
done:
    free(tree);
    free(root);
    return status;
}
