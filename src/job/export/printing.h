/* Makes the vessels of `export --print` fit for a printer. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "job/export/print_settings.h"

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

/* Computes the thickness of the wall around the thinnest vessel, mm. */
double printing_thinnest_wall(const PrintSettings *settings, const PrintChanges *changes);
/* Computes the sides of the mesh's box, mm. */
void printing_size(const VesselMesh *mesh, double size[3]);

#endif
