/* The operation `export`: writes the vessels of a tree as a mesh, curves, a volume or an HTML page.
 * export_run writes files; mesh_make makes a mesh in memory. */
#ifndef CORCAST_JOB_EXPORT_EXPORT_H
#define CORCAST_JOB_EXPORT_EXPORT_H

#include "job/export/extension.h"
#include "job/export/meshing.h"
#include "job/export/volumes.h"
#include "options/options.h"

typedef struct ExportOptions {
    const char *output; /* path of the output, whose extension selects the format; NULL: the mesh
                         * stays in memory */
    double prune_radius_mm; /* segments thinner than this are removed; 0: none */
    bool smooth;            /* vessels follow smooth curves through the nodes of the tree */
    bool parts;             /* a mesh with named parts, where it is not the extension's default */
    bool lattice;           /* beams, where they are not the extension's default */
    const char *print;      /* value of --print [printing_parse]; NULL: not for a 3D printer */
    PrintSettings settings; /* set from `print` or `wall_mm` by mesh_make and export_run */
    double wall_mm;         /* 0: none */
    MeshingOptions meshing;
    VolumeOptions volume;
    ExtensionOptions extension; /* flow extensions: vessels lengthened at their ends */
} ExportOptions;

/* Describes the operation. Its options set an ExportOptions. */
extern const Command command_export;

/* Makes the surface of a tree in memory, with the properties that the format of options->output
 * stores. Without an output, the result has colors and no named parts.
 *
 * options  parsed->options. The function sets members that follow from other options, such as
 *          options->settings.
 * mesh     set on success only. It borrows from `options` and `parsed`; release it with
 *          meshing_release.
 * Errors   STATUS_USAGE if an option has no effect on the format, or if the output has no known
 *          extension; the errors of meshing_make; STATUS_INPUT if the tree cannot be used;
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status mesh_make(ExportOptions *options, Parsed *parsed, MeshResult *mesh, Err *err);

/* Exports a tree to options->output and to additional files in the same folder. After an error no
 * file is changed.
 *
 * options  parsed->options, an ExportOptions with an output. It is changed as by mesh_make.
 * Errors   those of mesh_make, volumes_write and webpage_write; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status export_run(void *options, Parsed *parsed, Err *err);

#endif
