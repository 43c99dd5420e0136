/* The settings for 3D printing, which `export --print` accepts as one text. */
#ifndef CORCAST_JOB_EXPORT_PRINT_SETTINGS_H
#define CORCAST_JOB_EXPORT_PRINT_SETTINGS_H

#include "print/print.h"

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

#endif
