/* The vessels of `export --print`: they are made fit for a printer, and the print is described. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "job/export/print_settings.h"
#include "options/talk.h"

/* What was done to vessels before their surface is made. */
typedef struct PrintChanges {
    size_t thickened;   /* segments that were thinner than min_diameter_mm */
    size_t below_two;   /* segments that are still thinner than two widths of the nozzle */
    double trunk_mm;    /* diameter of the widest segment, scaled */
    double thinnest_mm; /* diameter of the thinnest segment, scaled and thickened */
} PrintChanges;

/* Scales and thickens the vessels. Errors: STATUS_INPUT if the nozzle is wider than the trunk or
 * the wall. */
MUST_CHECK Status printing_prepare(const PrintSettings *settings, VesselTree *vessels,
                                   PrintChanges *changes, Err *err);

/* Checks that a mesh fits the bed, as it is or rotated by 90 degrees. Errors: STATUS_INPUT with the
 * sizes of both. */
MUST_CHECK Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh,
                                     Err *err);

/* A finished print. All members are borrowed. */
typedef struct Printing {
    const PrintSettings *settings;
    const PrintChanges *changes;
    size_t pruned; /* number of segments that were removed because they are thin */
    const VesselTree *vessels;
    const PrintReport *report;
    const VesselMesh *mesh;
} Printing;

/* Reports the facts about a print as notes. */
void printing_say(const Printing *print, const Talk *talk);

/* Makes the part of a manifest that describes a print. Returns NULL if memory runs out. */
json_t *printing_json(const Printing *print);

/* Makes a list of the ids of `n` segments, which `list` has by their indices. Returns NULL if
 * memory runs out. */
json_t *segment_ids(const VesselTree *vessels, const uint32_t *list, size_t n);

#endif
