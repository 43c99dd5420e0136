/* Prepares vessels for 3D printing: reads the settings of `export --print`, scales and thickens the
 * vessels, and checks that the printer can print them. Call printing_parse and printing_prepare.
 * After the mesh is made, call printing_check_bed. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "print/print.h"

/* The settings for 3D printing, which `export --print` accepts as one text. */
typedef struct PrintSettings {
    double scale;           /* factor of all lengths, > 0 */
    double min_diameter_mm; /* minimum diameter of vessels, after scaling; 0: no minimum */
    bool prunes;            /* thinner vessels are removed (true) or thickened (false) */
    double nozzle_mm;       /* 0: unknown */
    double bed_mm[3];       /* sides of the printer's build volume, x, y, z; 0: unknown */
    PrintParams params;
} PrintSettings;

/* Reads "KEY=VALUE,KEY,...", in any order, into *out. Keys that are missing have their defaults; ""
 * sets all defaults. Errors: STATUS_USAGE, naming the option, the key and the accepted values;
 * STATUS_MEMORY. After an error *out is unchanged. */
MUST_CHECK Status printing_parse(const char *text, PrintSettings *out, Err *err);

/* The changes that printing_prepare made to the vessels. Lengths are after scaling. */
typedef struct PrintChanges {
    size_t thickened;         /* segments that were thinner than min_diameter_mm */
    size_t below_two_nozzles; /* segments that are still thinner than two nozzle widths; 0 if the
                               * nozzle is unknown */
    double widest_mm;         /* diameter of the widest segment, scaled */
    double thinnest_mm;       /* diameter of the thinnest segment, scaled and thickened */
} PrintChanges;

/* Scales the vessels, thickens those that are thinner than settings->min_diameter_mm, and sets
 * *changes. Ignores `prunes`: the caller has already removed thin vessels. Errors: STATUS_INPUT if
 * the nozzle is wider than the widest vessel or the wall. After an error the vessels are changed,
 * and *changes is not. */
MUST_CHECK Status printing_prepare(const PrintSettings *settings, VesselTree *vessels,
                                   PrintChanges *changes, Err *err);

/* Checks that a mesh fits the printer's build volume, as it is or rotated by 90 degrees about the
 * vertical axis. Accepts every mesh if the build volume is unknown. Errors: STATUS_INPUT, with the
 * sizes of the mesh and of the build volume. */
MUST_CHECK Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh,
                                     Err *err);

/* Returns the thickness of the wall around the thinnest vessel, in mm; 0 without a wall. */
double printing_thinnest_wall(const PrintSettings *settings, const PrintChanges *changes);
/* Computes the sides of the bounding box of a mesh, in mm. */
void printing_size(const VesselMesh *mesh, double size[3]);

#endif
