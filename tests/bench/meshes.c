/* Times the triangulation of trees and measures its distance from the surface. Prints a row for
 * each tree file on the command line. The guaranteed search for rays finds the distances
 * [unit/mesh_distance.h]. */
#include "stage/stage.h"
#include "treeio/treeio.h"

#include "../unit/mesh_distance.h"
#include <stdio.h>
#include <sys/resource.h>
#include <time.h>

enum { SAMPLES = 20000 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void print_distances(const char *way, Distances found)
{
    printf("  %s: mean %.3f %%, %.3f %% beyond 2 %%, worst %.2f %% of the radius\n", way,
           100 * found.mean, 100 * (double)found.beyond / (double)found.n, 100 * found.worst);
}

static Status measure(const char *path, Err *err)
{
    Tree tree;
    VesselTree vessels;
    VesselMesh mesh;
    MeshReport report;
    Ruler ruler;
    Random random;
    struct rusage used;
    const MeshParams params = {.tolerance = 0.02};
    TRY(tree_read(&tree, path, err));
    TRY(stage_vessels(&tree, NULL, &vessels, NULL, err));
    double start = seconds();
    TRY(vesselmesh_build(&vessels, &params, &mesh, &report, err));
    double end = seconds();
    getrusage(RUSAGE_SELF, &used);
    printf("%s: %zu segments, %zu triangles, %.2f s, %ld MB, %zu zones (%zu repeated), %s\n", path,
           vessels.n_segments, mesh.n_triangles, end - start, used.ru_maxrss / 1024,
           report.junctions, report.refined, meshreport_is_valid(&report) ? "sound" : "NOT SOUND");
    TRY(ruler_make(&ruler, &vessels, &mesh, &report));
    random_seed(&random, 1);
    print_distances("mesh to surface", mesh_to_surface(&ruler, &random, SAMPLES));
    print_distances("surface to mesh", surface_to_mesh(&ruler, &random, SAMPLES));
    ruler_release(&ruler);
    vesselmesh_release(&mesh);
    meshreport_release(&report);
    vesseltree_release(&vessels);
    tree_release(&tree);
    return STATUS_OK;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        Err err;
        Status status = measure(argv[i], &err);
        if (status != STATUS_OK) {
            fprintf(stderr, "%s\n", err.text);
            return status_exit(status);
        }
    }
    return 0;
}
