/* Proves the topology of a print whose surfaces are joined by rings: finds the Euler number that
 * each part must have, and compares it with the mesh.
 *
 * A ring replaces a disc of each of the two surfaces that it joins. So a ring lowers the sum of the
 * Euler numbers by 2, and so does each handle of a surface. A part of the solid that is made of s
 * surfaces with h handles, joined by r rings, has the Euler number 2 (s - r - h). A part that is
 * connected in the graph must be connected in the mesh. */
#include "print/seams.h"

#include "mesh/mesh.h"
#include <stdlib.h>

#define NONE UINT32_MAX

void seams_release(SeamGraph *seams)
{
    free(seams->trees);
    free(seams->loops);
    free(seams->parent);
    free(seams->rings);
    free(seams->is_used);
    *seams = (SeamGraph){0};
}

static uint32_t surface_count(const SeamGraph *seams)
{
    return 2 * seams->n_trees + 1;
}

Status seams_make(const VesselTree *tree, SeamGraph *out, Err *err)
{
    SeamGraph seams = {0};
    size_t n_trees = 0;
    Status status;
    TRY_GOTO(meshcheck_trees(tree, &seams.trees, &n_trees, err));
    seams.n_trees = (uint32_t)n_trees;
    size_t n = surface_count(&seams);
    TRY_GOTO(meshcheck_loops(tree, seams.trees, n_trees, &seams.loops, err));
    TRY_GOTO(mem_calloc(&seams.parent, n, sizeof *seams.parent, "trees", err));
    TRY_GOTO(mem_calloc(&seams.rings, n, sizeof *seams.rings, "trees", err));
    TRY_GOTO(mem_calloc(&seams.is_used, n, sizeof *seams.is_used, "trees", err));
    sets_begin(seams.parent, n);
    *out = seams;
    return STATUS_OK;
done:
    seams_release(&seams);
    return status;
}

uint32_t seams_surface(const SeamGraph *seams, uint32_t label)
{
    if (label & MESH_FRAME)
        return 2 * seams->n_trees;
    return seams->trees[label & ~MESH_FLAGS] + (label & MESH_LUMEN ? seams->n_trees : 0);
}

void seams_add_surface(SeamGraph *seams, uint32_t label)
{
    seams->is_used[seams_surface(seams, label)] = true;
}

void seams_add_ring(SeamGraph *seams, uint32_t label, uint32_t other)
{
    uint32_t a = sets_find(seams->parent, seams_surface(seams, label));
    uint32_t b = sets_find(seams->parent, seams_surface(seams, other));
    uint32_t rings = seams->rings[a] + (a != b ? seams->rings[b] : 0);
    sets_join(seams->parent, a, b);
    seams->rings[sets_find(seams->parent, a)] = rings + 1;
    seams->n_rings++;
}

size_t seams_count_unjoined(const SeamGraph *seams, uint32_t kind)
{
    size_t n = 0;
    uint32_t first = kind == MESH_LUMEN ? seams->n_trees : 0;
    for (uint32_t i = first; i < first + seams->n_trees; i++)
        n += seams->is_used[i] && seams->parent[i] == i && seams->rings[i] == 0;
    return n;
}

/* Returns the Euler number of a surface. */
static long long surface_euler(const SeamGraph *seams, uint32_t surface)
{
    bool is_casing = surface == 2 * seams->n_trees;
    return is_casing ? 2 : 2 - 2 * (long long)seams->loops[surface % seams->n_trees];
}

/* Finds the Euler number that each part of the graph must have, at the surface that represents the
 * part. */
static void expect(const SeamGraph *seams, long long *euler, MeshReport *report)
{
    long long sum = 0;
    report->expected_components = 0;
    for (uint32_t i = 0; i < surface_count(seams); i++) {
        uint32_t root = sets_find(seams->parent, i);
        if (!seams->is_used[i])
            continue;
        euler[root] += surface_euler(seams, i);
        sum += surface_euler(seams, i);
        if (root == i) {
            report->expected_components++;
            euler[root] -= 2 * (long long)seams->rings[root];
            sum -= 2 * (long long)seams->rings[root];
        }
    }
    report->expected_genus = (size_t)((2 * (long long)report->expected_components - sum) / 2);
}

/* Compares the expected Euler numbers with the mesh: euler[] receives twice the difference, 0 for
 * each part that is as expected. Twice the Euler number of a closed mesh is 2 points - triangles,
 * because it has three edges per two triangles. Returns how often a point has triangles of two
 * parts, which must be 0. */
static size_t take_found(const SeamGraph *seams, const VesselMesh *mesh, uint32_t *part_of,
                         long long *euler)
{
    size_t mixed = 0;
    for (size_t i = 0; i < mesh->n_points; i++)
        part_of[i] = NONE;
    for (uint32_t i = 0; i < surface_count(seams); i++)
        euler[i] *= 2;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t part = sets_find(seams->parent, seams_surface(seams, mesh->labels[i]));
        euler[part]++;
        for (int k = 0; k < 3; k++) {
            uint32_t *of = &part_of[mesh->triangles[i][k]];
            mixed += *of != NONE && *of != part;
            euler[part] -= *of == NONE ? 2 : 0;
            *of = part;
        }
    }
    return mixed;
}

/* Checks each part. Call it after meshcheck_topology. */
static Status check_parts(const SeamGraph *seams, const VesselMesh *mesh, MeshReport *report,
                          Err *err)
{
    long long *euler = NULL;
    uint32_t *part_of = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&euler, surface_count(seams), sizeof *euler, "trees", err));
    TRY_GOTO(mem_calloc(&part_of, mesh->n_points, sizeof *part_of, "points", err));
    expect(seams, euler, report);
    report->bridges = take_found(seams, mesh, part_of, euler);
    for (uint32_t i = 0; i < surface_count(seams); i++)
        if (euler[i] != 0)
            TRY_GOTO(
                err_set(err, STATUS_DIFFERS,
                        "the solid is not valid: the Euler number of a component differs by %+lld "
                        "from that of the surfaces it was built from; no file was written",
                        -euler[i] / 2));
done:
    free(euler);
    free(part_of);
    return status;
}

Status seams_prove(const SeamGraph *seams, const VesselMesh *mesh, double grid_mm, int threads,
                   MeshReport *report, Err *err)
{
    TRY(meshcheck_topology(mesh, NULL, report, err));
    TRY(meshcheck_crossings(mesh, grid_mm, threads, NULL, &report->crossings, err));
    return check_parts(seams, mesh, report, err);
}
