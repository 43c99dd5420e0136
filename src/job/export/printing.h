/* Reads the settings of `export --print`, scales and thickens the vessels, and checks that the
 * printer can print them. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "print/print.h"

/* The settings for 3D printing, which `export --print` accepts as one text. */
typedef struct PrintSettings {
    double scale;           /* factor of all lengths, > 0 */
    double min_diameter_mm; /* minimum diameter of vessels, after scaling; 0: no minimum */
    bool prunes;            /* true: thinner vessels are removed; false: they are thickened */
    double nozzle_mm;       /* 0: unknown */
    double bed_mm[3];       /* sides of the printer's build volume; 0: unknown */
    PrintParams params;
} PrintSettings;

/* Reads "KEY=VALUE,KEY,...", in any order, into *out. Keys that are missing have their defaults;
 * "" sets all defaults. Errors: STATUS_USAGE, naming the option, the key and the accepted values;
 * STATUS_MEMORY. *out is then unchanged. */
MUST_CHECK Status printing_parse(const char *text, PrintSettings *out, Err *err);

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
