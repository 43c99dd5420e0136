/* A print is described twice: in notes for its user, and in the manifest. */
#include "job/export/printing.h"

#include <math.h>

static double thinnest_wall(const PrintSettings *settings, const PrintChanges *changes)
{
    const PrintParams *params = &settings->params;
    return params->wall_mm + params->wall_ratio * changes->thinnest_mm / 2;
}

static Status check_nozzle(const PrintSettings *settings, const PrintChanges *changes, Err *err)
{
    double nozzle = settings->nozzle_mm, wall = thinnest_wall(settings, changes);
    if (changes->trunk_mm < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle of %g mm is wider than the trunk, %.3g mm when printed; no "
                       "vessel can be made with it (`print` takes a scale)",
                       nozzle, changes->trunk_mm);
    if (print_has_wall(&settings->params) && wall < nozzle)
        return err_set(err, STATUS_INPUT,
                       "the nozzle of %g mm is wider than the wall, %.3g mm at its thinnest",
                       nozzle, wall);
    return STATUS_OK;
}

Status printing_prepare(const PrintSettings *settings, VesselTree *vessels, PrintChanges *changes,
                        Err *err)
{
    PrintChanges made = {.thinnest_mm = HUGE_VAL};
    for (size_t i = 0; i < vessels->n_segments; i++)
        made.trunk_mm = fmax(made.trunk_mm, 2 * settings->scale * vessels->segments[i].radius_mm);
    for (size_t i = 0; i < vessels->n_segments; i++) {
        FieldSegment *segment = &vessels->segments[i];
        segment->a = vec3_scale(segment->a, settings->scale);
        segment->b = vec3_scale(segment->b, settings->scale);
        segment->radius_mm *= settings->scale;
        if (2 * segment->radius_mm < settings->min_diameter_mm) {
            segment->radius_mm = settings->min_diameter_mm / 2;
            made.thickened++;
        }
        made.thinnest_mm = fmin(made.thinnest_mm, 2 * segment->radius_mm);
        made.below_two += segment->radius_mm < settings->nozzle_mm;
    }
    TRY(check_nozzle(settings, &made, err));
    *changes = made;
    return STATUS_OK;
}

static void size_of(const VesselMesh *mesh, double size[3])
{
    Box box = box_empty();
    for (size_t i = 0; i < mesh->n_points; i++)
        box = box_with_ball(box, mesh_point(mesh, (uint32_t)i), 0);
    for (int axis = 0; axis < 3; axis++)
        size[axis] = vec3_component(box.high, axis) - vec3_component(box.low, axis);
}

Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh, Err *err)
{
    const double *bed = settings->bed_mm;
    double size[3];
    size_of(mesh, size);
    bool fits =
        (size[0] <= bed[0] && size[1] <= bed[1]) || (size[1] <= bed[0] && size[0] <= bed[1]);
    if (bed[2] == 0 || (fits && size[2] <= bed[2]))
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the print of %.4g x %.4g x %.4g mm does not fit the bed of %g x %g x %g mm",
                   size[0], size[1], size[2], bed[0], bed[1], bed[2]);
}

void printing_say(const Printing *print, const Talk *talk)
{
    const PrintSettings *settings = print->settings;
    const PrintChanges *changes = print->changes;
    const PrintReport *report = print->report;
    const uint32_t *ids = print->vessels->ids;
    double size[3];
    size_of(print->mesh, size);
    if (changes->thickened)
        talk_note(talk, "%zu segment%s thickened to %g mm", changes->thickened,
                  changes->thickened == 1 ? " is" : "s are", settings->min_diameter_mm);
    if (print->pruned)
        talk_note(talk, "%zu thin segment%s pruned", print->pruned,
                  print->pruned == 1 ? " is" : "s are");
    if (changes->below_two)
        talk_note(talk, "%zu segment%s thinner than two widths of the nozzle", changes->below_two,
                  changes->below_two == 1 ? " is" : "s are");
    if (report->has_closest)
        talk_note(talk,
                  "vessels that do not belong together are %.3g mm apart at the least, "
                  "segments %u and %u",
                  report->closest.gap_mm, ids[report->closest.segments[0]],
                  ids[report->closest.segments[1]]);
    if (report->cavities)
        talk_note(talk, "%zu trees are closed cavities, which cannot drain", report->cavities);
    if (report->n_longer)
        talk_note(talk, "%zu ends are lengthened, so that they can be cut off flat",
                  report->n_longer);
    if (settings->params.base.is_there)
        talk_note(talk,
                  "%zu pins hold it on the base; %zu places hang free, as vessels or open "
                  "ends are in the way",
                  report->pins, report->hanging);
    if (settings->params.block.is_there)
        talk_note(talk, "the block has %zu ports; %zu ends are closed in it", report->openings,
                  report->n_closed);
    if (print_has_wall(&settings->params))
        talk_note(talk, "the wall has %zu openings; %zu ends are closed", report->openings,
                  report->n_closed);
    talk_note(talk, "the print measures %.4g x %.4g x %.4g mm", size[0], size[1], size[2]);
}

json_t *segment_ids(const VesselTree *vessels, const uint32_t *list, size_t n)
{
    json_t *ids = json_array();
    for (size_t i = 0; i < n; i++)
        ids = json_with_item(ids, json_integer(vessels->ids[list[i]]));
    return ids;
}

/* Adds the members of a wall. */
static json_t *with_wall(json_t *object, const Printing *print)
{
    const PrintParams *params = &print->settings->params;
    const JsonMember members[] = {
        {"wall_mm", json_number(params->wall_mm)},
        {"wall_over_radius", json_number(params->wall_ratio)},
        {"outer_mm3", json_number(print->report->outer_mm3)},
    };
    return json_with_members(object, members, sizeof members / sizeof *members);
}

/* The smallest of the vessels' diameters, the walls' thicknesses and the gaps between vessels, mm.
 */
static double smallest_of(const Printing *print)
{
    double least = print->changes->thinnest_mm;
    if (print_has_wall(&print->settings->params))
        least = fmin(least, thinnest_wall(print->settings, print->changes));
    return print->report->has_closest ? fmin(least, print->report->closest.gap_mm) : least;
}

json_t *printing_json(const Printing *print)
{
    const PrintSettings *settings = print->settings;
    const PrintChanges *changes = print->changes;
    const VesselTree *vessels = print->vessels;
    const PrintReport *report = print->report;
    double size[3];
    size_of(print->mesh, size);
    const JsonMember members[] = {
        {"scale", json_number(settings->scale)},
        {"min_diameter_mm", json_number(settings->min_diameter_mm)},
        {"segments_thickened", json_count(changes->thickened)},
        {"segments_pruned", json_count(print->pruned)},
        {"nozzle_mm", json_number(settings->nozzle_mm)},
        {"segments_below_two_nozzles", json_count(changes->below_two)},
        {"thinnest_diameter_mm", json_number(changes->thinnest_mm)},
        {"segments_lengthened", segment_ids(vessels, report->longer, report->n_longer)},
        {"openings", json_count(report->openings)},
        {"closed_ends", segment_ids(vessels, report->closed, report->n_closed)},
        {"lumen_mm3", json_number(report->lumen_mm3)},
        {"pins", json_count(report->pins)},
        {"hanging", json_count(report->hanging)},
        {"closed_cavities", json_count(report->cavities)},
        {"rings", json_count(report->rings)},
        {"least_gap_mm", report->has_closest ? json_number(report->closest.gap_mm) : json_null()},
        {"least_gap_between",
         segment_ids(vessels, report->closest.segments, 2 * report->has_closest)},
        {"smallest_feature_mm", json_number(smallest_of(print))},
        {"size_mm", json_numbers(size, 3)},
        {"bed_mm", settings->bed_mm[2] > 0 ? json_numbers(settings->bed_mm, 3) : json_null()},
    };
    json_t *all = json_with_members(json_object(), members, sizeof members / sizeof *members);
    return print_has_wall(&settings->params) ? with_wall(all, print) : all;
}
