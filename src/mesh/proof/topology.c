/* The edges of a mesh are sorted into lists, one a point, that hold for its edges to points of a
 * higher number that other point and the way the triangle goes along it; an edge is closed when its
 * list has the other point once each way. What is a component is found by union-find; in a closed
 * one triangles make two thirds as many as edges, and genus is (2 - points + edges - triangles)
 * / 2. */
#include "mesh/proof/meshcheck.h"

#include <stdlib.h>

static const uint32_t no_tree = UINT32_MAX;

/* Points whose edges are listed at a time, so that the lists take less memory than the mesh. */
enum { POINTS_AT_A_TIME = 1 << 22 };

/* The edges from points [from, to) to points of a higher number. */
typedef struct EdgeLists {
    uint32_t from, to;
    uint32_t *first; /* one a point, and two more */
    uint32_t *ends;  /* twice the other point, and 1 when the triangle goes from it */
    size_t capacity;
} EdgeLists;

static Status list_edges(const VesselMesh *mesh, EdgeLists *lists, Err *err)
{
    uint32_t n = lists->to - lists->from;
    for (uint32_t i = 0; i < n + 2; i++)
        lists->first[i] = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < 3 * mesh->n_triangles; i++) {
            uint32_t a = mesh->triangles[i / 3][i % 3], b = mesh->triangles[i / 3][(i + 1) % 3];
            uint32_t low = a < b ? a : b, high = a < b ? b : a;
            if (low < lists->from || low >= lists->to)
                continue;
            if (pass == 0)
                lists->first[low - lists->from + 2]++;
            else
                lists->ends[lists->first[low - lists->from + 1]++] = 2 * high + (a > b);
        }
        for (uint32_t i = 2; i < n + 2 && pass == 0; i++)
            lists->first[i] += lists->first[i - 1];
        TRY(mem_reserve(&lists->ends, &lists->capacity, lists->first[n + 1], sizeof *lists->ends,
                        "edges", err));
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

/* Edges in the lists that do not have two triangles, one each way. */
static size_t count_listed(const EdgeLists *lists)
{
    size_t open = 0;
    for (uint32_t i = 0; i < lists->to - lists->from; i++) {
        uint32_t *ends = &lists->ends[lists->first[i]];
        size_t n = lists->first[i + 1] - lists->first[i];
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

/* Edges that do not have two triangles, one each way. */
static Status count_open(const VesselMesh *mesh, size_t *open, Err *err)
{
    EdgeLists lists = {0};
    size_t most = mesh->n_points < POINTS_AT_A_TIME ? mesh->n_points : POINTS_AT_A_TIME;
    Status status = mem_calloc(&lists.first, most + 2, sizeof *lists.first, "edges", err);
    *open = 0;
    while (lists.to < mesh->n_points && status == STATUS_OK) {
        size_t rest = mesh->n_points - lists.to;
        lists.from = lists.to;
        lists.to += (uint32_t)(rest < most ? rest : most);
        status = list_edges(mesh, &lists, err);
        if (status == STATUS_OK)
            *open += count_listed(&lists);
    }
    free(lists.first);
    free(lists.ends);
    return status;
}

static uint32_t root_of(uint32_t *root, uint32_t point)
{
    while (root[point] != point)
        point = root[point] = root[root[point]];
    return point;
}

/* The lowest point of a component is its root. */
static void join_points(const VesselMesh *mesh, uint32_t *root)
{
    for (uint32_t i = 0; i < mesh->n_points; i++)
        root[i] = i;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        for (int k = 1; k < 3; k++) {
            uint32_t a = root_of(root, mesh->triangles[i][0]);
            uint32_t b = root_of(root, mesh->triangles[i][k]);
            root[a > b ? a : b] = a < b ? a : b;
        }
}

static size_t count_bridges(const VesselMesh *mesh, uint32_t *root, uint32_t *tree,
                            const uint32_t *trees)
{
    size_t bridges = 0;
    for (size_t i = 0; i < mesh->n_points; i++)
        tree[i] = no_tree;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t component = root_of(root, mesh->triangles[i][0]);
        uint32_t own = trees[mesh_segment(mesh, i)];
        if (tree[component] == no_tree)
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
    uint32_t *root, *of_segment;
    TRY(mem_calloc(&root, tree->n_nodes, sizeof *root, "nodes", err));
    Status status = mem_calloc(&of_segment, tree->n_segments, sizeof *of_segment, "segments", err);
    if (status != STATUS_OK) {
        free(root);
        return status;
    }
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        root[i] = i;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < tree->n_segments; i++) {
            uint32_t ends[2];
            for (int end = 0; end < 2; end++) {
                uint32_t node = tree->nodes[i][end];
                while (root[node] != node)
                    node = root[node] = root[root[node]];
                ends[end] = node;
            }
            root[ends[0] > ends[1] ? ends[0] : ends[1]] = ends[0] < ends[1] ? ends[0] : ends[1];
            of_segment[i] = ends[0] < ends[1] ? ends[0] : ends[1];
        }
    uint8_t *used = (uint8_t *)root; /* one node is as many bytes as needed, and more */
    size_t n = 0;
    for (size_t i = 0; i < tree->n_nodes; i++)
        used[i] = 0;
    for (size_t i = 0; i < tree->n_segments; i++) {
        n += !used[of_segment[i]];
        used[of_segment[i]] = 1;
    }
    free(root);
    *trees = of_segment;
    *n_trees = n;
    return STATUS_OK;
}

Status meshcheck_topology(const VesselMesh *mesh, const uint32_t *trees, MeshReport *report,
                          Err *err)
{
    uint32_t *root = NULL, *tree = NULL;
    Status status;
    TRY(count_open(mesh, &report->open_edges, err));
    TRY_GOTO(mem_calloc(&root, mesh->n_points, sizeof *root, "points", err));
    TRY_GOTO(mem_calloc(&tree, mesh->n_points, sizeof *tree, "points", err));
    join_points(mesh, root);
    report->components = 0;
    for (uint32_t i = 0; i < mesh->n_points; i++)
        report->components += root_of(root, i) == i;
    report->bridges = count_bridges(mesh, root, tree, trees);
    report->euler = (long long)mesh->n_points - (long long)(mesh->n_triangles / 2);
    report->genus = (size_t)llabs((2 * (long long)report->components - report->euler) / 2);
    report->volume_mm3 = vesselmesh_volume(mesh);
done:
    free(tree);
    free(root);
    return status;
}
