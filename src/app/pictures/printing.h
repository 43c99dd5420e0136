/* `export --print`: vessels made fit for a printer, and what is to be known of the print. */
#ifndef CORCAST_APP_PRINTING_H
#define CORCAST_APP_PRINTING_H

#include "app/run/options.h"
#include "base/base.h"
#include "surface/surface.h"

typedef struct PrintSettings {
    double scale;           /* of the whole model */
    double min_diameter_mm; /* of vessels, after scaling; 0: any */
    bool prunes;            /* thinner vessels are cut off, else thickened */
    double nozzle_mm;       /* 0: not known */
    double bed_mm[3];       /* room of the printer; 0: not known */
    PrintParams params;
} PrintSettings;

/* Reads "KEY=VALUE,KEY,...", in any order, into *out. STATUS_USAGE naming `print`, the key and what
 * it takes. */
MUST_CHECK Status printing_parse(const char *text, PrintSettings *out, Err *err);

/* What was done to vessels before their surface is made. */
typedef struct PrintChanges {
    size_t thickened; /* segments that were thinner than they may be */
    size_t below_two; /* thinner than two widths of the nozzle, in the end */
    double trunk_mm;  /* diameter of the widest */
    double thinnest_mm;
} PrintChanges;

/* Scales and thickens the vessels. STATUS_INPUT when the nozzle is wider than the trunk or the
 * wall. */
MUST_CHECK Status printing_prepare(const PrintSettings *settings, VesselTree *vessels,
                                   PrintChanges *changes, Err *err);

/* STATUS_INPUT, with the sizes of both, when the mesh does not fit the bed, in either of the two
 * ways that it can stand along its sides. */
MUST_CHECK Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh,
                                     Err *err);

/* Says on standard error what was made. */
void printing_say(const PrintSettings *settings, const PrintChanges *changes, size_t pruned,
                  const VesselTree *vessels, const PrintReport *report, const VesselMesh *mesh);

/* The same and more for the manifest. NULL when memory runs out. */
json_t *printing_json(const PrintSettings *settings, const PrintChanges *changes, size_t pruned,
                      const VesselTree *vessels, const PrintReport *report, const VesselMesh *mesh);

#endif
