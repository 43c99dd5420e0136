/* The operation `export`: writes the vessels of a tree as a mesh, curves, a volume or a page. */
#ifndef CORCAST_JOB_EXPORT_EXPORT_H
#define CORCAST_JOB_EXPORT_EXPORT_H

#include "job/export/meshing.h"
#include "job/export/volumes.h"
#include "options/options.h"

typedef struct ExportOptions {
    const char *output; /* its extension selects the format */
    double prune_radius_mm;
    bool parts, lattice;    /* select another format of the extension */
    const char *print;      /* the text of --print; NULL: none */
    PrintSettings settings; /* made of `print` or wall_mm */
    double wall_mm;         /* 0: none */
    MeshingOptions meshing;
    VolumeOptions volume;
} ExportOptions;

/* Describes the operation. Its options set an ExportOptions. */
extern const Command command_export;
/* Runs the operation: checks the options, works and writes. Errors are in the sentences. */
MUST_CHECK Status run_export(void *options, Parsed *parsed, Err *err);

/* Checks the options, a pointer to an ExportOptions, makes what they ask for of the tree, and
 * writes it.
 */
MUST_CHECK Status export_run(void *options, Parsed *parsed, Err *err);

#endif
