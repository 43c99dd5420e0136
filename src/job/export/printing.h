/* Scales and thickens the vessels for `export --print`, and checks that the printer can print
 * them. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "job/export/print_settings.h"

/* The changes to the vessels before their surface is made. Lengths are after scaling. */
typedef struct PrintChanges {
    size_t thickened;   /* segments that were thinner than min_diameter_mm */
    size_t below_two;   /* segments that are still thinner than two nozzle widths */
    double trunk_mm;    /* diameter of the widest segment, scaled */
    double thinnest_mm; /* diameter of the thinnest segment, scaled and thickened */
} PrintChanges;

/* Scales and thickens the vessels, and reports this in *changes. Errors: STATUS_INPUT if the nozzle
 * is wider than the trunk or the wall; the vessels are then changed, and *changes is not. */
MUST_CHECK Status printing_prepare(const PrintSettings *settings, VesselTree *vessels,
                                   PrintChanges *changes, Err *err);

/* Checks that a mesh fits the bed, as it is or rotated by 90 degrees about the vertical axis.
 * Accepts every mesh if the bed is unknown. Errors: STATUS_INPUT with the sizes of the mesh and the
 * bed. */
MUST_CHECK Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh,
                                     Err *err);

/* Returns the thickness of the wall around the thinnest vessel, in mm; 0 without a wall. */
double printing_thinnest_wall(const PrintSettings *settings, const PrintChanges *changes);
/* Computes the sides of the bounding box of a mesh, in mm. */
void printing_size(const VesselMesh *mesh, double size[3]);

#endif
