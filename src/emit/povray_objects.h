/* Finds the objects that a POV-Ray scene declares, and writes their declarations. The object Tree
 * contains the whole geometry. A forest also has an object for each tree: Tree_1, Tree_2, ... Call
 * povray_objects_find first, then put_objects, whose callback calls put_declaration. Private to the
 * module emit. */
#ifndef CORCAST_EMIT_POVRAY_OBJECTS_H
#define CORCAST_EMIT_POVRAY_OBJECTS_H

#include "emit/emit.h"
#include "emit/values.h"

/* The indices of primitives or of field segments of a geometry, ascending. Borrowed. */
typedef struct PovrayItems {
    const uint32_t *index;
    size_t n;
} PovrayItems;

/* A geometry that is being written. The caller sets the first three members, which are borrowed.
 * povray_objects_find sets the other members except `object`. It allocates the members that are not
 * marked borrowed; povray_objects_release frees them. */
typedef struct PovrayGeometry {
    const EmitParams *params;
    const Scene *scene;
    EmitReport *report;   /* NULL: nothing is written; only POV-Ray's memory and time are estimated
                           * [povray_load] */
    RayVolume *volume;    /* the rays through params->part, the part of the picture that is drawn;
                           * NULL: all rays */
    PovrayItems *objects; /* [0]: Tree; of a forest, [k]: Tree_k */
    size_t n_objects;
    uint32_t *indices;            /* the items of all objects */
    IndexLists trees;             /* of a forest: the items of each tree */
    bool is_empty;                /* true: no ray through the part can hit anything */
    PovrayItems visible_segments; /* for a blob: the segments that may be visible; borrowed from
                                   * `indices` */
    CellTree *cells; /* for an isosurface: one tree of cells per object. Its cells refer to terms by
                      * their index in the whole scene */
    Cell *hit_cells; /* for an isosurface, if only a part of the picture is drawn: the cells of
                      * the scene (params->built) that rays through the part hit */
    size_t object;   /* index of the object that is being declared; put_objects sets it */
} PovrayGeometry;

/* Finds the objects and their items. The caller sets params, scene and report, zeroes the rest, and
 * releases *geometry also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status povray_objects_find(PovrayGeometry *geometry, Err *err);
void povray_objects_release(PovrayGeometry *geometry);

/* Appends the whole declaration of the object with the index geometry->object: its name, its kind
 * and its members.
 *
 * kind         the kind of POV-Ray object, such as "union".
 * put_members  appends the members of the object; its `context` is `geometry`.
 * Errors       those of values_expand and of put_members. */
MUST_CHECK Status put_declaration(Text *out, const PovrayGeometry *geometry, const char *kind,
                                  TmplPut *put_members, Err *err);

/* A callback of put_objects: appends the declaration of geometry->object by put_declaration. */
typedef Status PovrayPutObject(Text *out, const PovrayGeometry *geometry, Err *err);

/* Appends the declarations of all objects. Calls `put_object` for each object that has items, with
 * a copy of the geometry in which `object` is the object's index. For an object without
 * items, appends the declaration of an empty object. Errors: those of `put_object` and of
 * put_declaration. */
MUST_CHECK Status put_objects(Text *out, const PovrayGeometry *geometry,
                              PovrayPutObject *put_object, Err *err);

#endif
