/* How rays search the five kinds of geometry: one row for each. */
#ifndef CORCAST_RENDER_RAYSEARCH_H
#define CORCAST_RENDER_RAYSEARCH_H

#include "base/base.h"
#include "field/field.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* POV-Ray's limit [docs/POVRAY.md section 3]: crossings nearer than this are not visible. */
#define NEAREST_VISIBLE_MM 1e-4
/* Crossings of a blob nearer than this are not visible and cast no shadow. */
#define BLOB_NEAREST_MM 1e-2

/* The part of a ray that is searched. */
typedef struct RayPart {
    Ray ray;
    double t_min, t_max; /* mm along the ray; t_max may be infinite */
} RayPart;

/* Where a ray first meets a surface. */
typedef struct RayHit {
    double t;         /* mm along the ray */
    Vec3 normal;      /* unit, outward; of cells on either side */
    uint32_t index;   /* index of the primitive; for other geometry, of the field segment */
    bool from_inside; /* triangles only: the ray comes from inside the vessel */
    uint32_t cell;    /* cells only: index of the cell */
} RayHit;

/* What rays search. Immutable once built, and shared by threads. A search uses only its own search
 * structures, which are owned; the others stay empty. */
typedef struct RayIndex {
    const Geometry *geometry;     /* borrowed */
    BoxTree boxes;                /* of primitives, triangles, cells, or segments of a blob */
    PrimitiveFrame *frames;       /* per primitive */
    struct TrianglePlane *planes; /* per triangle */
    CellTree cells;               /* of POV-Ray */
    FieldIndex *field;            /* of the potential */
    /* field_search and blob_search without a search structure: indices of the `n` segments that are
     * searched one by one. Borrowed. */
    const uint32_t *list;
    size_t n;
} RayIndex;

/* One kind of search. A workspace belongs to one thread. Nothing is allocated while rays are cast.
 */
typedef struct RaySearch {
    double nearest_mm;     /* crossings nearer than this to the ray's start are not visible */
    double shadow_from_mm; /* blockers nearer than this to a lit point cast no shadow on it; 0: the
                            * limit of the caster */
    /* Builds the search structures of index->geometry.
     *
     * cells    parameters of POV-Ray's cells; NULL except for cell_search.
     * Errors   STATUS_MEMORY; cell_search: STATUS_INFEASIBLE if the surface cannot be cut into
     *          cells. The caller releases the index even after an error.
     * Cost     O(n log n). */
    Status (*build)(RayIndex *index, const CellParams *cells, Err *err);
    /* Allocates the workspace for rays among `n` field segments of the geometry. Memory that no ray
     * needs is never touched. NULL: this search needs no workspace, and is given NULL.
     * Errors   STATUS_MEMORY. */
    Status (*workspace_new)(const Geometry *geometry, size_t n, void **workspace, Err *err);
    void (*workspace_free)(void *workspace); /* accepts NULL */
    /* Finds the first crossing with t between t_min and t_max. Returns false, *hit undefined, if
     * there is none. */
    bool (*first)(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit);
    /* Returns true if there is a crossing with t between t_min and t_max. The ray may start on the
     * surface. */
    bool (*any)(const RayIndex *index, void *workspace, const RayPart *part);
} RaySearch;

/* primitive_search  primitives. Of equally near crossings, the primitive with the lowest index.
 * triangle_search   the mesh. The normal is interpolated between the corners, except on caps. Of
 *                   equally near triangles, the first.
 * cell_search       an isosurface where POV-Ray 3.7 finds it [docs/POVRAY.md section 5]: its own
 *                   interval isosurface, repeated operation by operation, so that its pictures can
 *                   be compared to the last code. The normal is a forward difference. A cell has
 *                   one hit per ray, as in POV-Ray.
 * field_search      an isosurface by proof and not by sampling.
 *                   Where segments blend in groups, the union of the groups' bodies is met. Of the
 *                   group that is met, the segment with the largest term there, the lowest of equal
 *                   ones. Terms below RAY_TERM_CUTOFF are left out: the surface of a single vessel
 *                   is off by at most 1.9e-9 radii, and a ray that grazes the level by less may go
 *                   either way. `first` with a ray that starts inside a vessel returns the wall
 *                   that it leaves through. `any` accepts a start up to 1e-3 radii off the surface:
 *                   the wall that a ray leaves outwards, but starts just within, does not count.
 * blob_search       a blob: the field of field/blob.h, solved piece by piece. The first t in
 *                   (t_min, t_max), t_min >= 0, at which the field passes 1, in either direction;
 *                   of the segments, the one with the largest term there. */
extern const RaySearch primitive_search, triangle_search, cell_search, field_search, blob_search;

/* Returns the search for a geometry. `cells` selects cell_search for an isosurface. */
const RaySearch *raysearch_for(const Geometry *geometry, bool cells);

/* Builds the hierarchy index->boxes over n >= 1 items, whose boxes `box_of` returns.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status rayindex_build_boxes(RayIndex *index, size_t n,
                                       Box (*box_of)(const RayIndex *index, size_t item), Err *err);
void rayindex_release(RayIndex *index);

#endif
