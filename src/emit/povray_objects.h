/* A geometry as the POV-Ray objects that it declares: Tree, which is all of it, and Tree_1, Tree_2,
 * ... for the trees of a forest. Private to the module emit. */
#ifndef CORCAST_EMIT_POVRAY_OBJECTS_H
#define CORCAST_EMIT_POVRAY_OBJECTS_H

#include "emit/emit.h"
#include "emit/values.h"

/* Some primitives or field segments of a geometry, by rising index. Borrowed. */
typedef struct PovrayItems {
    const uint32_t *index;
    size_t n;
} PovrayItems;

/* A geometry that is being written. Everything from `volume` on is owned; release it with
 * povray_objects_release. */
typedef struct PovrayGeometry {
    const EmitParams *params;
    const Scene *scene;
    EmitReport *report;
    RayVolume *volume;    /* of params->part, or NULL */
    PovrayItems *objects; /* [0]: Tree; of a forest, [k]: Tree_k */
    size_t n_objects;
    uint32_t *indices;   /* the items of all objects */
    IndexLists trees;    /* of a forest: the items of each tree */
    bool is_empty;       /* no ray of the part can hit anything */
    PovrayItems painted; /* blob: the segments that may be visible; borrowed from `indices` */
    CellTree *cells;     /* isosurface: per object; terms have the indices of the scene */
    Cell *hit_cells;     /* isosurface with a part: the cells of params->built that its rays hit */
    size_t object;       /* index of the object that is being declared */
} PovrayGeometry;

/* Finds the objects and their items. The caller sets params, scene and report, zeroes the rest, and
 * releases *geometry also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status povray_objects_find(PovrayGeometry *geometry, Err *err);
void povray_objects_release(PovrayGeometry *geometry);

/* Appends the declaration of geometry->object as a `kind`, such as "union". `members` has the part
 * `members`, and is released, also after an error. Errors: as values_expand. */
MUST_CHECK Status put_declaration(Text *out, const PovrayGeometry *geometry, const char *kind,
                                  Values *members, Err *err);

/* Appends the declarations of all objects. `put_object` appends the declaration of
 * geometry->object. Errors: those of `put_object` and of put_declaration. */
MUST_CHECK Status put_objects(Text *out, PovrayGeometry *geometry,
                              Status (*put_object)(Text *out, PovrayGeometry *geometry, Err *err),
                              Err *err);

#endif
