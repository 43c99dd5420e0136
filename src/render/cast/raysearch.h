/* Searches geometry with rays. A RaySearch is a table of functions that build a search structure
 * (RayIndex) and search it. There are five constant ones: one each for primitives, meshes and
 * blobs, and two for isosurfaces. Engines use caster.h, which selects the RaySearch.
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

/* Minimum distance of a visible crossing from the ray's start, mm: POV-Ray's limit [docs/POVRAY.md
 * section 3]. */
#define NEAREST_VISIBLE_MM 1e-4
/* Minimum distance, mm, at which a crossing of a blob is visible or casts a shadow. */
#define BLOB_NEAREST_MM 1e-2

/* The interval of a ray that is searched: t_min <= t < t_max, unless a search states otherwise. */
typedef struct RayPart {
    Ray ray;
    double t_min, t_max; /* mm along the ray; t_max may be infinite */
} RayPart;

/* The first hit of a ray. */
typedef struct RayHit {
    double t;         /* distance along the ray, mm */
    Vec3 normal;      /* unit, outward; of cell_search: outward or inward, as POV-Ray computes it */
    uint32_t index;   /* index of the primitive; for implicit surfaces and meshes, index of the
                       * field segment */
    bool from_inside; /* triangles only: the ray comes from inside the vessel */
    uint32_t cell;    /* cells only: index of the cell */
} RayHit;

/* The search structures of one geometry. They do not change after they are built, and threads share
 * them. A search uses only its own structures, which are owned; the others stay empty. */
typedef struct RayIndex {
    const Geometry *geometry;     /* borrowed */
    BoxTree boxes;                /* boxes of primitives, triangles, cells, or segments of a blob */
    PrimitiveFrame *frames;       /* per primitive */
    struct TrianglePlane *planes; /* per triangle */
    CellTree cells;               /* POV-Ray's cells */
    FieldIndex *field;            /* search structure of the segments of the potential */
    /* For field_search and blob_search without a search structure: the indices of the `n` segments
     * that are searched one by one. Borrowed. */
    const uint32_t *list;
    size_t n;
} RayIndex;

/* One kind of search. A workspace belongs to one thread. Casting rays allocates nothing. */
typedef struct RaySearch {
    double nearest_mm;     /* crossings nearer than this to the ray's start are not visible, mm */
    double shadow_from_mm; /* blockers nearer than this to a shading point cast no shadow on it, mm;
                            * 0: the limit of caster_set_shadow_nearest applies */
    /* Builds the search structures of index->geometry.
     *
     * cells    parameters of POV-Ray's cells; NULL except for cell_search.
     * Errors   STATUS_MEMORY; cell_search: STATUS_INFEASIBLE if the surface cannot be cut into
     *          cells. The caller releases the index even after an error.
     * Cost     O(n log n). */
    Status (*build)(RayIndex *index, const CellParams *cells, Err *err);
    /* Allocates the workspace of one thread, for rays that may meet at most n field segments.
     * Memory that no ray needs is never touched. NULL: this search needs no workspace; pass NULL to
     * `first` and `any`. Errors: STATUS_MEMORY. */
    Status (*workspace_new)(const Geometry *geometry, size_t n, void **workspace, Err *err);
    void (*workspace_free)(void *workspace); /* accepts NULL */
    /* Finds the first crossing in the interval. Returns false if there is none; *hit is then
     * undefined. */
    bool (*first)(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit);
    /* Returns true if there is a crossing in the interval. The ray may start on the surface: t_min,
     * or for field_search the rule below, excludes the crossing at the start. */
    bool (*any)(const RayIndex *index, void *workspace, const RayPart *part);
} RaySearch;

/* primitive_search  primitives. Of equally near crossings, the primitive with the lowest index is
 *                   returned.
 *
 * triangle_search   the mesh. The normal is interpolated between the corners, except on caps. Of
 *                   equally near triangles, the triangle with the lowest index is returned.
 *
 * cell_search       an isosurface where POV-Ray 3.7 finds it [docs/POVRAY.md section 5]: repeats
 *                   POV-Ray's interval search operation by operation, so that pictures can be
 *                   compared to the last code. The normal is a forward difference. A cell has one
 *                   hit per ray, as in POV-Ray.
 *
 * field_search      an isosurface at its proven position, without sampling. If segments blend in
 *                   groups, the surface is that of the union of the groups' bodies. RayHit.index is
 *                   the segment with the largest term in the group that is hit; of equal terms, the
 *                   lowest index. Terms below RAY_TERM_CUTOFF are left out. The error of the
 *                   surface of a single vessel is therefore at most 1.9e-9 radii, and a ray that
 *                   grazes the surface by less may hit or miss. If the ray starts inside a vessel,
 *                   `first` returns the point where it leaves the vessel. For `any`, the start may
 *                   be up to 1e-3 radii off the surface: if the ray starts just inside and leaves
 *                   outwards, this crossing is ignored.
 *
 * blob_search       a blob: the field of field/blob.h, solved piece by piece. The hit is the first
 *                   t in (t_min, t_max), t_min >= 0, at which the field passes 1 in either
 *                   direction. RayHit.index is the segment with the largest term there. */
extern const RaySearch primitive_search, triangle_search, cell_search, field_search, blob_search;

/* Returns the search for a geometry. If `cells` is true, cell_search is returned for an
 * isosurface. */
const RaySearch *raysearch_for(const Geometry *geometry, bool cells);

/* Builds the bounding volume hierarchy index->boxes over n >= 1 items. `box_of` returns the box of
 * an item. Errors: STATUS_MEMORY. */
MUST_CHECK Status rayindex_build_boxes(RayIndex *index, size_t n,
                                       Box (*box_of)(const RayIndex *index, size_t item), Err *err);
/* Frees the search structures and zeroes *index. */
void rayindex_release(RayIndex *index);

#endif
