/* Makes the surface of a tree's vessels as triangles, and writes it to files. Call meshing_make,
 * then meshing_write or read MeshResult.mesh, then meshing_release. An Emitter [emit/emit.h]
 * describes the output format, and thereby what the result has to contain. */
#ifndef CORCAST_JOB_EXPORT_MESHING_H
#define CORCAST_JOB_EXPORT_MESHING_H

#include "emit/emit.h"
#include "job/export/printing.h"
#include "job/picture/coloring.h"
#include "job/picture/picture.h"
#include "job/work.h"

/* The names of vessel bodies, with a VesselBody as index. The last element is NULL. */
extern const char *const vessel_body_names[];

typedef struct MeshingOptions {
    int body;           /* shape of the vessels, a VesselBody [scene/scene.h] */
    double tolerance;   /* MeshParams.tolerance: maximum distance of the triangles from the surface,
                         * as a fraction of the local radius */
    double lod;         /* MeshParams.lod [mesh/mesh.h] */
    double tube_edge;   /* MeshParams.tube_edge [mesh/mesh.h] */
    bool part_overlaps; /* vessels are made thinner where they overlap vessels to which they are not
                         * connected */
    const PrintSettings *print; /* makes a solid for a 3D printer; NULL: only the surface;
                                 * borrowed */
    LayerParams layers;         /* layers of prisms at the wall; used if the emitter has layers */
    const char *look;           /* name of a look or path; used if the emitter has colors */
    Coloring coloring;          /* used if the emitter has colors */
} MeshingOptions;

/* Indices of segments in VesselTree.segments. */
typedef struct SegmentList {
    uint32_t *at; /* owned */
    size_t n;
} SegmentList;

/* A tree and its surface. All members are owned, except `emitter`, `said` and `print`. */
typedef struct MeshResult {
    const Emitter *emitter; /* the format that the surface was made for */
    PictureTree of;         /* the tree [picture.h] */
    TreeMeta said;          /* values of the blood that options specify; owns nothing */
    VesselTree vessels;  /* the segments that were triangulated, after thickening and lengthening */
    VesselMesh mesh;     /* the triangles; empty if the emitter writes lines */
    MeshReport report;   /* the facts about the mesh */
    SegmentList thinned; /* segments that part_overlaps made thinner */
    SegmentList longer;  /* segments that were lengthened, so that their ends can be cut flat */
    MeshEnds ends;       /* the named parts, if the emitter writes them */
    PrismLayers layers;  /* the layers of prisms, if the emitter writes them */
    Appearance appearance;      /* set if the emitter has colors */
    Anatomy anatomy;            /* connections of the vessels; set if the emitter has colors */
    const PrintSettings *print; /* NULL: the mesh is not for a 3D printer; borrowed from the
                                 * options */
    PrintChanges changes;       /* set if `print` is not NULL */
    PrintReport printed;        /* set if `print` is not NULL */
} MeshResult;

/* Triangulates the vessels of a tree, unless the emitter writes lines, and validates the mesh.
 * Sends notes about the expected cost, about changes to vessels, and about the size of the mesh.
 * of      the tree. The function moves *of into the result and zeroes it; after an error it
 *         releases *of.
 * common  number of threads, and receiver of messages and progress.
 * out     set on success only; release it with meshing_release.
 * Errors  STATUS_DIFFERS if the mesh is invalid; STATUS_INPUT if the printer's nozzle is too wide
 *         or its bed too small, or if the vessels cannot be meshed; STATUS_USAGE for a wrong look
 *         or color map; STATUS_CANCELLED; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status meshing_make(const Emitter *emitter, const MeshingOptions *options,
                               PictureTree *of, const Common *common, MeshResult *out, Err *err);
void meshing_release(MeshResult *mesh);

/* Writes the mesh or the lines, and the additional files of a mesh.
 * files   scene_files_name [scenefiles.h] must have set the paths.
 * parsed  the command line, which the files contain as their provenance.
 * Errors  STATUS_INPUT if the format cannot store the mesh; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status meshing_write(const MeshResult *mesh, FileSet *files, const Parsed *parsed,
                                Err *err);

/* Sends notes with the facts about a mesh for a 3D printer. mesh->print must not be NULL. */
void mesh_report_print(const MeshResult *mesh, const Talk *talk);
/* Returns the manifest of a mesh, a JSON object with the facts about the mesh: a new reference, or
 * NULL if memory runs out. */
json_t *mesh_manifest(const MeshResult *mesh);

#endif
