/* The operation `export`: writes the vessels of a tree as a mesh, curves, a volume or a page. */
#ifndef CORCAST_JOB_EXPORT_EXPORT_H
#define CORCAST_JOB_EXPORT_EXPORT_H

#include "job/export/extension.h"
#include "job/export/meshing.h"
#include "job/export/volumes.h"
#include "options/options.h"

typedef struct ExportOptions {
    const char *output; /* its extension selects the format */
    double prune_radius_mm;
    bool smooth;            /* as in PictureOptions */
    bool parts, lattice;    /* select a format that is not the default of the extension: named
                             * parts; beams */
    const char *print;      /* the text of --print; NULL: none */
    PrintSettings settings; /* set from `print` or wall_mm when the operation starts */
    double wall_mm;         /* 0: none */
    MeshingOptions meshing;
    VolumeOptions volume;
    ExtensionOptions extension;
} ExportOptions;

/* Describes the operation. Its options set an ExportOptions. */
extern const Command command_export;

/* Makes the surface of a tree in memory, with the properties that the format of options->output
 * stores. Without an output, the result has colors and no named parts.
 *
 * options  options->settings and other members are set from `print` or `wall_mm`.
 * mesh     set on success only. It borrows from `options` and `parsed`; release it with
 *          meshing_release.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; those of picture_read_tree and meshing_make. */
MUST_CHECK Status mesh_make(ExportOptions *options, Parsed *parsed, MeshResult *mesh, Err *err);

/* Exports a tree to options->output and to the files beside it.
 *
 * options  an ExportOptions, with an output; as for mesh_make.
 * Errors   those of mesh_make, meshing_write, volumes_write and webpage_write. If the operation
 *          fails, all files are as before. */
MUST_CHECK Status export_run(void *options, Parsed *parsed, Err *err);

#endif
