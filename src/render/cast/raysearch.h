/* Searches the five kinds of geometry with rays. Each kind is one constant RaySearch: a table of
 * functions that build a search structure (RayIndex) and search it. caster.h hides the choice and
 * is what engines use.
 *
 *     const RaySearch *search = raysearch_for(geometry, false);
 *     RayIndex index = {.geometry = geometry};
 *     TRY(search->build(&index, NULL, err));
 *     bool hit = search->first(&index, workspace, &(RayPart){ray, 1e-4, INFINITY}, &result);
 *     rayindex_release(&index); */
#ifndef CORCAST_RENDER_CAST_RAYSEARCH_H
#define CORCAST_RENDER_CAST_RAYSEARCH_H

#include "base/base.h"
#include "field/field.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* POV-Ray's limit [docs/POVRAY.md section 3]: crossings nearer than this are not visible. */
#define NEAREST_VISIBLE_MM 1e-4
/* Crossings of a blob nearer than this are not visible and cast no shadow. */
#define BLOB_NEAREST_MM 1e-2

/* The part of a ray that is searched: t_min <= t < t_max, unless a search states otherwise. */
typedef struct RayPart {
    Ray ray;
    double t_min, t_max; /* mm along the ray; t_max may be infinite */
} RayPart;

/* The first hit of a ray. */
typedef struct RayHit {
    double t;         /* mm along the ray */
    Vec3 normal;      /* unit, outward; cells: to either side */
    uint32_t index;   /* index of the primitive; other geometry: index of the field segment */
    bool from_inside; /* triangles only: the ray comes from inside the vessel */
    uint32_t cell;    /* cells only: index of the cell */
} RayHit;

/* The search structures of one geometry. Immutable once built, and shared by threads. A search uses
 * only its own structures, which are owned; the others stay empty. */
typedef struct RayIndex {
    const Geometry *geometry;     /* borrowed */
    BoxTree boxes;                /* boxes of primitives, triangles, cells, or segments of a blob */
    PrimitiveFrame *frames;       /* per primitive */
    struct TrianglePlane *planes; /* per triangle */
    CellTree cells;               /* POV-Ray's cells */
    FieldIndex *field;            /* tubes of the potential */
    /* For field_search and blob_search without a search structure: the indices of `n` segments that
     * are searched one by one. Borrowed. */
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
    /* Allocates the workspace of one thread, for rays among `n` field segments of the geometry.
     * Memory that no ray needs is never touched. NULL: this search needs no workspace; pass NULL to
     * `first` and `any`. Errors: STATUS_MEMORY. */
    Status (*workspace_new)(const Geometry *geometry, size_t n, void **workspace, Err *err);
    void (*workspace_free)(void *workspace); /* accepts NULL */
    /* Finds the first crossing in the part of the ray. Returns false, *hit undefined, if there is
     * none. */
    bool (*first)(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit);
    /* Returns true if there is a crossing in the part of the ray. The ray may start on the
     * surface. */
    bool (*any)(const RayIndex *index, void *workspace, const RayPart *part);
} RaySearch;

/* primitive_search  primitives. Among equally near crossings, the primitive with the lowest index
 *                   wins.
 * triangle_search   the mesh. The normal is interpolated between the corners, except on caps. Among
 *                   equally near triangles, the triangle with the lowest index wins.
 * cell_search       an isosurface where POV-Ray 3.7 finds it [docs/POVRAY.md section 5]: repeats
 *                   POV-Ray's interval search operation by operation, so that pictures can be
 *                   compared to the last code. The normal is a forward difference. A cell has one
 *                   hit per ray, as in POV-Ray.
 * field_search      an isosurface at its proven position, without sampling. If segments blend in
 *                   groups, the surface is that of the union of the groups' bodies. RayHit.index is
 *                   the segment with the largest term in the group that is hit, or the lowest index
 *                   among equal terms. Terms below RAY_TERM_CUTOFF are left out: the surface of a
 *                   single vessel is off by at most 1.9e-9 radii, and a ray that grazes the level
 *                   by less may hit or miss. `first` with a ray that starts inside a vessel returns
 *                   the point where the ray leaves the vessel. `any` accepts a start up to 1e-3
 *                   radii off the surface: if the ray starts just inside and leaves outwards, that
 *                   crossing does not count.
 * blob_search       a blob: the field of field/blob.h, solved piece by piece. The hit is the first
 *                   t in (t_min, t_max), t_min >= 0, at which the field passes 1 in either
 *                   direction. RayHit.index is the segment with the largest term there. */
extern const RaySearch primitive_search, triangle_search, cell_search, field_search, blob_search;

/* Returns the search for a geometry. `cells` selects cell_search for an isosurface. */
const RaySearch *raysearch_for(const Geometry *geometry, bool cells);

/* Builds the bounding volume hierarchy index->boxes over n >= 1 items. `box_of` returns the box of
 * an item. Errors: STATUS_MEMORY. */
MUST_CHECK Status rayindex_build_boxes(RayIndex *index, size_t n,
                                       Box (*box_of)(const RayIndex *index, size_t item), Err *err);
/* Frees the search structures and zeroes *index. */
void rayindex_release(RayIndex *index);

#endif
