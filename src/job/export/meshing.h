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
    int body;                   /* a VesselBody; set by an option with a list of choices */
    double tolerance;           /* as MeshParams.tolerance */
    double lod;                 /* as MeshParams.lod */
    double tube_edge;           /* as MeshParams.tube_edge */
    bool part_overlaps;         /* a thin vessel that overlaps an unconnected vessel is made
                                 * thinner */
    const PrintSettings *print; /* makes a solid for a 3D printer; NULL: only the surface;
                                 * borrowed */
    LayerParams layers;         /* used if the emitter has layers */
    const char *look;           /* name of a look or path; used if the emitter has colors */
    Coloring coloring;          /* used if the emitter has colors */
} MeshingOptions;

/* Indices of segments in VesselTree.segments. */
typedef struct SegmentList {
    uint32_t *at; /* owned */
    size_t n;
} SegmentList;

/* A tree, and its surface. All members are owned, except `emitter`, `said` and `print`. */
typedef struct MeshResult {
    const Emitter *emitter; /* the format that the surface was made for */
    PictureTree of;         /* the tree */
    TreeMeta said;          /* values of the blood that options specify; owns nothing */
    VesselTree vessels;     /* the tree's segments, as they were triangulated */
    VesselMesh mesh;        /* the triangles; empty if the emitter writes lines */
    MeshReport report;      /* the facts about the mesh */
    SegmentList thinned;    /* segments that part_overlaps made thinner */
    SegmentList longer;     /* segments that were lengthened to make room for a flat cut of their
                             * ends */
    MeshEnds ends;          /* the named parts, if the emitter writes them */
    PrismLayers layers;     /* the layers of prisms, if the emitter writes them */
    Appearance appearance;  /* set if the emitter has colors, as are `orders` and `anatomy` */
    Field orders;           /* Strahler orders */
    Anatomy anatomy;
    const PrintSettings *print; /* NULL: the mesh is not for a 3D printer; borrowed from the
                                 * options */
    PrintChanges changes;       /* set if `print` is not NULL, as is `printed` */
    PrintReport printed;
} MeshResult;

/* Triangulates the vessels of a tree, unless the emitter writes lines, and validates the mesh.
 * Sends notes about the expected cost, about changes to vessels, and about the size of the mesh.
 *
 * of      is moved into the result and zeroed; it is released after an error.
 * out     set on success only; release it with meshing_release.
 * Errors  STATUS_DIFFERS if the mesh is invalid; STATUS_INPUT if the printer's nozzle is too wide
 *         or its bed too small; those of stage_vessels, coloring_appearance, work_make,
 *         vesselmesh_build, print_build, meshends_find and prismlayers_sweep. */
MUST_CHECK Status meshing_make(const Emitter *emitter, const MeshingOptions *options,
                               PictureTree *of, const Common *common, MeshResult *out, Err *err);
void meshing_release(MeshResult *mesh);

/* Writes the mesh or the lines, and the additional files of a mesh. The paths of `files` must have
 * been set by scene_files_name. Errors: those of scene_files_put, solver_ends, solver_centerline
 * and work_write. */
MUST_CHECK Status meshing_write(const MeshResult *mesh, FileSet *files, const Parsed *parsed,
                                Err *err);

/* Sends notes with the facts about a mesh for a 3D printer; mesh->print must not be NULL. */
void mesh_say_print(const MeshResult *mesh, const Talk *talk);
/* Returns the manifest of a mesh: a new reference, or NULL if memory runs out. */
json_t *mesh_manifest(const MeshResult *mesh);

#endif
