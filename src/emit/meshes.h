/* Triangles in the formats of other programs. Exported by the room's door. */
#ifndef CORCAST_EMIT_MESHES_H
#define CORCAST_EMIT_MESHES_H

#include "base/base.h"
#include "scene/scene.h"
#include "surface/surface.h"

/* What is written. All is borrowed. */
typedef struct MeshFile {
    const VesselMesh *mesh;
    const VesselTree *vessels; /* whose segments the labels name */
    const char *generator;     /* program and version */
} MeshFile;

/* A format of meshes: one row of `mesh_formats`. */
typedef struct MeshFormat {
    const char *name;        /* "STL" */
    const char *extension;   /* "stl" */
    const char *description; /* what it holds */
    bool binary;
    /* Appends the file, as it is made. STATUS_INFEASIBLE when the format cannot hold the mesh. */
    Status (*write)(const MeshFile *file, Text *out, Err *err);
} MeshFormat;

/* A row without a name ends them. */
extern const MeshFormat mesh_formats[];
/* The format of files with this extension, or NULL. */
const MeshFormat *mesh_format_of_extension(const char *extension);

#endif
