/* `export --print`: vessels made fit for a printer, and what is to be known of the print. */
#ifndef CORCAST_JOB_EXPORT_PRINTING_H
#define CORCAST_JOB_EXPORT_PRINTING_H

#include "base/base.h"
#include "options/options.h"
#include "print/print.h"

typedef struct PrintSettings {
    double scale;           /* factor of all lengths, > 0 */
    double min_diameter_mm; /* of vessels, after scaling; 0: any */
    bool prunes;            /* thinner vessels are cut off, else thickened */
    double nozzle_mm;       /* 0: not known */
    double bed_mm[3];       /* sides of the space that the printer has; 0: not known */
    PrintParams params;
} PrintSettings;

/* Reads "KEY=VALUE,KEY,...", in any order, into *out. STATUS_USAGE naming `print`, the key and what
 * it takes. */
MUST_CHECK Status printing_parse(const char *text, PrintSettings *out, Err *err);

/* What was done to vessels before their surface is made. */
typedef struct PrintChanges {
    size_t thickened;   /* segments that were thinner than min_diameter_mm */
    size_t below_two;   /* segments that are still thinner than two widths of the nozzle */
    double trunk_mm;    /* diameter of the widest segment, scaled */
    double thinnest_mm; /* diameter of the thinnest one, scaled and thickened */
} PrintChanges;

/* Scales and thickens the vessels. STATUS_INPUT when the nozzle is wider than the trunk or the
 * wall. */
MUST_CHECK Status printing_prepare(const PrintSettings *settings, VesselTree *vessels,
                                   PrintChanges *changes, Err *err);

/* STATUS_INPUT, with the sizes of both, when the mesh does not fit the bed, as it stands or turned
 * by 90 degrees. */
MUST_CHECK Status printing_check_bed(const PrintSettings *settings, const VesselMesh *mesh,
                                     Err *err);

/* A print that was made; all borrowed. */
typedef struct Printing {
    const PrintSettings *settings;
    const PrintChanges *changes;
    size_t pruned; /* segments that were cut off before */
    const VesselTree *vessels;
    const PrintReport *report;
    const VesselMesh *mesh;
} Printing;

/* Says on standard error what was made. */
void printing_say(const Printing *print);

/* What the manifest says of the print. NULL when memory runs out. */
json_t *printing_json(const Printing *print);

/* The ids of `n` segments, listed by their indices. NULL when memory runs out. */
json_t *segment_ids(const VesselTree *vessels, const uint32_t *list, size_t n);

#endif
