/* Each edge is listed at its point of lower index, with its other point and its direction. An edge
 * is closed if its list has the other point exactly twice, once in each direction. In a closed
 * component the number of triangles is two thirds of the number of edges, and the genus is (2 -
 * points + edges - triangles) / 2. */
#include "mesh/proof/meshcheck.h"

#include <stdlib.h>

#define NO_TREE UINT32_MAX

/* Edges are listed for this many points at a time, so that the lists take less memory than the
 * mesh. */
enum { POINTS_AT_A_TIME = 1 << 22 };

/* Lists the edges from points [from, to) to points of a higher index: twice the other point, plus 1
 * if the triangle goes from it. */
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
        for (int k = 0; k < 3; k++) {
            const float *x = mesh->points[mesh->triangles[i][k]], *o = mesh->points[0];
            at[k] = vec3((double)x[0] - (double)o[0], (double)x[1] - (double)o[1],
                         (double)x[2] - (double)o[2]);
        }
        six += vec3_dot(at[0], vec3_cross(at[1], at[2]));
    }
    return six / 6;
}

Status meshcheck_trees(const VesselTree *tree, uint32_t **trees, size_t *n_trees, Err *err)
{
    uint32_t *root = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&root, tree->n_nodes, sizeof *root, "nodes", err));
    TRY_GOTO(mem_calloc(trees, tree->n_segments, sizeof **trees, "segments", err));
    sets_begin(root, tree->n_nodes);
    for (size_t i = 0; i < tree->n_segments; i++)
        sets_join(root, tree->nodes[i][0], tree->nodes[i][1]);
    for (size_t i = 0; i < tree->n_segments; i++)
        (*trees)[i] = sets_find(root, tree->nodes[i][0]);
    *n_trees = 0;
    for (size_t i = 0; i < tree->n_segments; i++) {
        uint32_t *lowest = &root[(*trees)[i]];
        *n_trees += *lowest != NO_TREE;
        *lowest = NO_TREE; /* counted */
    }
done:
    free(root);
    return status;
}

Status meshcheck_loops(const VesselTree *tree, const uint32_t *trees, uint32_t **loops, Err *err)
{
    bool *is_counted;
    TRY(mem_calloc(&is_counted, tree->n_nodes, sizeof *is_counted, "nodes", err));
    Status status = mem_calloc(loops, tree->n_nodes, sizeof **loops, "nodes", err);
    for (size_t i = 0; i < tree->n_segments && status == STATUS_OK; i++) {
        uint32_t *own = &(*loops)[trees[i]];
        *own += 1;
        for (int end = 0; end < 2; end++) {
            bool *counted = &is_counted[tree->nodes[i][end]];
            *own -= !*counted && tree->nodes[i][end] != trees[i];
            *counted = true;
        }
    }
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
    report->bridges = count_bridges(mesh, root, tree, trees);
    report->euler = (long long)mesh->n_points - (long long)(mesh->n_triangles / 2);
    report->genus = (size_t)llabs((2 * (long long)report->components - report->euler) / 2);
    report->volume_mm3 = vesselmesh_volume(mesh);
done:
    free(tree);
    free(root);
    return status;
}
