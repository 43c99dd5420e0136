/* The surface of a tree's vessels as triangles, in memory and as files. */
#ifndef CORCAST_JOB_EXPORT_MESHING_H
#define CORCAST_JOB_EXPORT_MESHING_H

#include "emit/emit.h"
#include "job/export/printing.h"
#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "job/work.h"

/* The names of vessel bodies, by VesselBody. NULL ends the list. */
extern const char *const vessel_body_names[];

typedef struct MeshingOptions {
    int body;                   /* choice: VesselBody */
    double tolerance;           /* as MeshParams.tolerance */
    double lod;                 /* as MeshParams.lod */
    double tube_edge;           /* as MeshParams.tube_edge */
    bool part_overlaps;         /* makes thin vessels thinner that overlap vessels to which they are
                                 * not connected */
    const PrintSettings *print; /* makes a solid for a printer; NULL: the surface alone; borrowed */
    LayerParams layers;         /* used if the emitter has layers */
    const char *look;           /* name or path; read if the emitter has colors */
    Coloring coloring;          /* used if the emitter has colors */
} MeshingOptions;

/* Indices of segments in VesselTree.segments. */
typedef struct SegmentList {
    uint32_t *at; /* owned */
    size_t n;
} SegmentList;

/* A tree, and its surface. Everything but `emitter` is owned. */
typedef struct MeshResult {
    const Emitter *emitter; /* the format that the surface was made for */
    PictureTree of;         /* the tree */
    TreeMeta said;          /* values of the blood that options give; owns nothing */
    VesselTree vessels;     /* the tree's segments, as they were triangulated */
    VesselMesh mesh;        /* the triangles; empty if the emitter writes lines */
    MeshReport report;      /* the facts about the mesh */
    SegmentList thinned;    /* segments that part_overlaps made thinner */
    SegmentList longer;     /* segments that were lengthened, so that their ends are flat */
    MeshEnds ends;          /* the named parts, if the emitter writes them */
    PrismLayers layers;     /* the layers, if the emitter writes them */
    Appearance appearance;  /* this and the next two are set if the emitter has colors */
    Field orders;           /* Strahler orders */
    Anatomy anatomy;
    const PrintSettings *print; /* NULL: the mesh is no print; borrowed from the options */
    PrintChanges changes;       /* set if `print` is not NULL, like `printed` */
    PrintReport printed;
} MeshResult;

/* Triangulates the vessels of a tree, unless the emitter writes lines. Proves that the mesh is
 * sound. Reports the expected cost, what was changed, and the size of the mesh.
 *
 * of      is moved into the result; it is zeroed, and released after an error.
 * out     is released with meshing_release.
 * Errors  STATUS_DIFFERS if the mesh is not sound; STATUS_INPUT if the printer's nozzle or bed is
 *         too large or too small; those of stage_vessels, coloring_appearance, work_make,
 *         vesselmesh_build, print_build, meshends_find and prismlayers_sweep. */
MUST_CHECK Status meshing_make(const Emitter *emitter, const MeshingOptions *options,
                               PictureTree *of, const Common *common, MeshResult *out, Err *err);
void meshing_release(MeshResult *mesh);

/* Writes the mesh or the lines, and what is written beside a mesh. scene_files_name has named
 * `files`. Errors: those of scene_files_put, solver_ends, solver_centerline and
 * work_write. */
MUST_CHECK Status meshing_write(const MeshResult *mesh, FileSet *files, const Parsed *parsed,
                                Err *err);

/* Reports the facts about a mesh that is a print, as notes. */
void mesh_say_print(const MeshResult *mesh, const Talk *talk);
/* Makes the manifest of a mesh. Returns NULL if memory runs out. */
json_t *mesh_manifest(const MeshResult *mesh);

#endif
