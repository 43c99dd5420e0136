/* Decides from the facts about a mesh whether it is valid, and words the error if it is not. An
 * invalid mesh is not written: programs that read it rely on a closed surface, and a wrong surface
 * is harder to notice than an error. */
#include "mesh/meshreport.h"

#include "mesh/precision.h"
#include <stdlib.h>

void meshreport_release(MeshReport *report)
{
    free(report->missing);
    free(report->enclosed);
    free(report->slivers);
    free(report->round_ends);
    free(report->near);
    *report = (MeshReport){0};
}

bool meshreport_is_valid(const MeshReport *report)
{
    return report->open_edges == 0 && report->components == report->expected_components &&
           report->genus == report->expected_genus && report->crossings == 0 &&
           report->bridges == 0 && report->n_missing == 0;
}

Status meshreport_check(const MeshReport *report, const VesselTree *tree, Err *err)
{
    if (meshreport_is_valid(report))
        return STATUS_OK;
    if (report->n_missing)
        return err_set(
            err, STATUS_DIFFERS,
            "%zu segments have no triangles, for example segment %u; no file was written",
            report->n_missing, tree->ids[report->missing[0]]);
    if (report->crossings > 0 && precision_explains_crossings(tree))
        return precision_refuse(tree, precision_thinnest_segment(tree),
                                mesh_grid(mesh_max_coordinate(tree)), err);
    return err_set(
        err, STATUS_DIFFERS,
        "the mesh is not valid: %zu components for %zu trees, genus %zu for %zu loops, %zu open "
        "edges, %zu crossing pairs of triangles, %zu bridges between trees; no file was written "
        "(a smaller `tolerance` may help)",
        report->components, report->trees, report->genus, report->expected_genus,
        report->open_edges, report->crossings, report->bridges);
}
