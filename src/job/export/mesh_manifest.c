/* Writes the facts about a mesh as notes for the user and as a manifest. Other programs read the
 * keys of the manifest, so the keys must not change when names in the code change. */
#include "job/export/meshing.h"
#include "options/output.h"
#include <math.h>

void mesh_report_print(const MeshResult *made, const Talk *talk)
{
    const PrintSettings *settings = made->print;
    const PrintChanges *changes = &made->changes;
    const PrintReport *report = &made->printed;
    const uint32_t *ids = made->vessels.ids;
    double size[3];
    printing_size(&made->mesh, size);
    if (changes->thickened)
        talk_note(talk, "%zu segment%s thickened to %g mm", changes->thickened,
                  changes->thickened == 1 ? " is" : "s are", settings->min_diameter_mm);
    if (made->of.pruned)
        talk_note(talk, "%zu thin segment%s pruned", made->of.pruned,
                  made->of.pruned == 1 ? " is" : "s are");
    if (changes->below_two_nozzles)
        talk_note(talk, "%zu segment%s thinner than twice the nozzle", changes->below_two_nozzles,
                  changes->below_two_nozzles == 1 ? " is" : "s are");
    if (report->has_closest)
        talk_note(
            talk,
            "the smallest gap between unconnected vessels is %.3g mm, between segments %u and "
            "%u",
            report->closest.gap_mm, ids[report->closest.segments[0]],
            ids[report->closest.segments[1]]);
    if (report->cavities)
        talk_note(talk, "%zu lumens have no opening, so resin or powder cannot drain",
                  report->cavities);
    if (report->n_lengthened)
        talk_note(talk, "%zu ends are lengthened to make room for a flat cut",
                  report->n_lengthened);
    if (settings->params.base.is_wanted)
        talk_note(
            talk,
            "%zu support pins stand on the base; %zu overhangs could not be supported, because "
            "vessels or open ends are in the way",
            report->pins, report->unsupported);
    if (settings->params.block.is_wanted)
        talk_note(talk, "the block has %zu ports; %zu vessel ends have none", report->openings,
                  report->n_closed);
    if (print_has_wall(&settings->params))
        talk_note(talk, "the wall has %zu openings; %zu vessel ends are closed", report->openings,
                  report->n_closed);
    talk_note(talk, "the print measures %.4g x %.4g x %.4g mm", size[0], size[1], size[2]);
}

/* Makes a list of the ids of segments from their indices. */
static json_t *segment_ids(const VesselTree *vessels, const uint32_t *list, size_t n)
{
    json_t *ids = json_array();
    for (size_t i = 0; i < n; i++)
        ids = json_with_item(ids, json_integer(vessels->ids[list[i]]));
    return ids;
}

/* Returns the size of the smallest feature, in mm: the minimum of the vessel diameters, wall
 * thicknesses and gaps between vessels. */
static double smallest_of(const MeshResult *made)
{
    double least = made->changes.thinnest_mm;
    if (print_has_wall(&made->print->params))
        least = fmin(least, printing_thinnest_wall(made->print, &made->changes));
    return made->printed.has_closest ? fmin(least, made->printed.closest.gap_mm) : least;
}

static json_t *print_json(const MeshResult *made)
{
    const PrintSettings *settings = made->print;
    const PrintChanges *changes = &made->changes;
    const VesselTree *vessels = &made->vessels;
    const PrintReport *report = &made->printed;
    double size[3];
    printing_size(&made->mesh, size);
    json_t *all = JSON_OBJECT(
        {"scale", json_number(settings->scale)},
        {"min_diameter_mm", json_number(settings->min_diameter_mm)},
        {"segments_thickened", json_count(changes->thickened)},
        {"segments_pruned", json_count(made->of.pruned)},
        {"nozzle_mm", json_number(settings->nozzle_mm)},
        {"segments_below_two_nozzles", json_count(changes->below_two_nozzles)},
        {"thinnest_diameter_mm", json_number(changes->thinnest_mm)},
        {"segments_lengthened", segment_ids(vessels, report->lengthened, report->n_lengthened)},
        {"openings", json_count(report->openings)},
        {"closed_ends", segment_ids(vessels, report->closed, report->n_closed)},
        {"lumen_mm3", json_number(report->lumen_mm3)}, {"pins", json_count(report->pins)},
        {"hanging", json_count(report->unsupported)},
        {"closed_cavities", json_count(report->cavities)}, {"rings", json_count(report->rings)},
        {"least_gap_mm", report->has_closest ? json_number(report->closest.gap_mm) : json_null()},
        {"least_gap_between",
         segment_ids(vessels, report->closest.segments, 2 * report->has_closest)},
        {"smallest_feature_mm", json_number(smallest_of(made))}, {"size_mm", json_numbers(size, 3)},
        {"bed_mm", settings->bed_mm[2] > 0 ? json_numbers(settings->bed_mm, 3) : json_null()});
    return print_has_wall(&settings->params)
               ? JSON_WITH(all, {"wall_mm", json_number(settings->params.wall_mm)},
                           {"wall_over_radius", json_number(settings->params.wall_ratio)},
                           {"outer_mm3", json_number(report->outer_mm3)})
               : all;
}

static json_t *layers_json(const PrismLayers *layers)
{
    /* A file with inverted prisms is not written. */
    return JSON_OBJECT({"layers", json_count(layers->n_layers)},
                       {"prisms", json_count(layers->n_prisms)}, {"inverted", json_count(0)},
                       {"points_thinner", json_count(layers->n_thinner)},
                       {"mean_thickness", json_number(layers->mean_ratio)},
                       {"least_thickness", json_number(layers->min_ratio)},
                       {"volume_mm3", json_number(layers->volume_mm3)},
                       {"core_volume_mm3", json_number(layers->core_volume_mm3)});
}

static json_t *pair_list(const VesselTree *vessels, const MeshReport *report)
{
    json_t *pairs = json_array();
    for (size_t i = 0; i < report->n_near; i++) {
        const NearPair *pair = &report->near[i];
        pairs = json_with_item(
            pairs, JSON_OBJECT({"segments", json_pack("[i,i]", (int)vessels->ids[pair->segments[0]],
                                                      (int)vessels->ids[pair->segments[1]])},
                               {"gap_mm", json_number(pair->gap_mm)}));
    }
    return pairs;
}

json_t *mesh_manifest(const MeshResult *made)
{
    const VesselTree *vessels = &made->vessels;
    const VesselMesh *mesh = &made->mesh;
    const MeshReport *report = &made->report;
    json_t *all = JSON_OBJECT(
        {"generator", json_text(GENERATOR)}, {"model", json_text(vessel_body_names[vessels->body])},
        {"unit", json_text("mm")}, {"trees", json_count(report->trees)},
        {"components", json_count(report->components)}, {"genus", json_count(report->genus)},
        {"euler", json_integer(report->euler)},
        {"watertight", json_boolean(report->open_edges == 0)},
        {"self_intersections", json_count(report->crossings)},
        {"bridges", json_count(report->bridges)}, {"segments", json_count(vessels->n_segments)},
        {"segments_present", json_count(vessels->n_segments - report->n_missing -
                                        report->n_enclosed - report->n_slivers)},
        {"segments_missing", segment_ids(vessels, report->missing, report->n_missing)},
        {"segments_swallowed", segment_ids(vessels, report->enclosed, report->n_enclosed)},
        {"segments_slivers", segment_ids(vessels, report->slivers, report->n_slivers)},
        {"segments_thinned", segment_ids(vessels, made->thinned.at, made->thinned.n)},
        {"segments_lengthened", segment_ids(vessels, made->longer.at, made->longer.n)},
        {"round_ends", segment_ids(vessels, report->round_ends, report->n_round_ends)},
        {"near_pairs", pair_list(vessels, report)}, {"triangles", json_count(mesh->n_triangles)},
        {"points", json_count(mesh->n_points)}, {"volume_mm3", json_number(report->volume_mm3)},
        {"tolerance", json_number(report->tolerance)},
        {"max_distance_mm", json_number(report->deviation.mm)},
        {"max_distance_over_radius", json_number(report->deviation.ratio)});
    if (made->emitter->has_layers)
        all = json_with(all, "layers", layers_json(&made->layers));
    return made->print ? json_with(all, "print", print_json(made)) : all;
}
