/* The keys of a manifest are public [docs/FORMATS.md]; they stay when names in the code change. */
#include "job/export/meshing.h"
#include "options/output.h"

static json_t *pair_list(const VesselTree *vessels, const MeshReport *report)
{
    json_t *pairs = json_array();
    for (size_t i = 0; i < report->n_near; i++) {
        const NearPair *pair = &report->near[i];
        const JsonMember members[] = {
            {"segments", json_pack("[i,i]", (int)vessels->ids[pair->segments[0]],
                                   (int)vessels->ids[pair->segments[1]])},
            {"gap_mm", json_number(pair->gap_mm)},
        };
        pairs = json_with_item(pairs, json_with_members(json_object(), members, 2));
    }
    return pairs;
}

json_t *mesh_manifest(const MeshResult *made)
{
    const VesselTree *vessels = &made->vessels;
    const VesselMesh *mesh = &made->mesh;
    const MeshReport *report = &made->report;
    const JsonMember members[] = {
        {"generator", json_text(GENERATOR)},
        {"model", json_text(vessel_body_names[vessels->body])},
        {"unit", json_text("mm")},
        {"trees", json_count(report->trees)},
        {"components", json_count(report->components)},
        {"genus", json_count(report->genus)},
        {"euler", json_integer(report->euler)},
        {"watertight", json_boolean(report->open_edges == 0)},
        {"self_intersections", json_count(report->crossings)},
        {"bridges", json_count(report->bridges)},
        {"segments", json_count(vessels->n_segments)},
        {"segments_present", json_count(vessels->n_segments - report->n_missing -
                                        report->n_enclosed - report->n_slivers)},
        {"segments_missing", segment_ids(vessels, report->missing, report->n_missing)},
        {"segments_swallowed", segment_ids(vessels, report->enclosed, report->n_enclosed)},
        {"segments_slivers", segment_ids(vessels, report->slivers, report->n_slivers)},
        {"segments_thinned", segment_ids(vessels, made->thinned.at, made->thinned.n)},
        {"segments_lengthened", segment_ids(vessels, made->longer.at, made->longer.n)},
        {"round_ends", segment_ids(vessels, report->round, report->n_round)},
        {"near_pairs", pair_list(vessels, report)},
        {"triangles", json_count(mesh->n_triangles)},
        {"points", json_count(mesh->n_points)},
        {"volume_mm3", json_number(report->volume_mm3)},
        {"tolerance", json_number(report->tolerance)},
        {"max_distance_mm", json_number(report->off.mm)},
        {"max_distance_over_radius", json_number(report->off.ratio)},
    };
    json_t *all = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (!made->print)
        return all;
    const Printing print = printing_of(made);
    return json_with(all, "print", printing_json(&print));
}
