/* What makes the geometry of each model: the macros that it takes and the members of the unions or
 * blobs that are called Tree and, of a forest, Tree_1, Tree_2, ...; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_MEMBERS_H
#define CORCAST_EMIT_POVRAY_MEMBERS_H

#include "emit/emit.h"

/* Some primitives or field segments of a geometry, by rising index. */
typedef struct PovrayItems {
    const uint32_t *index;
    size_t n;
} PovrayItems;

/* One geometry being written, as the objects that it declares: objects[0], Tree, is all of it; of a
 * forest objects[1] is its first tree, Tree_1, and so on. */
typedef struct PovrayGeometry {
    const EmitParams *params;
    const Scene *scene;
    EmitReport *report;
    Sight *sight; /* of params->part, or NULL; owned, as all that follows; povray_objects_release */
    PovrayItems *objects;
    size_t n_objects;
    uint32_t *indices;   /* of all objects */
    bool nothing;        /* no ray of the part can meet anything */
    PovrayItems painted; /* of a blob: the segments that may be seen; borrowed from the indices */
    CellTree *cells;     /* of each object of an isosurface; its terms have the scene's indices */
    Cell *met;           /* of the cells that are built, those that rays of the part can meet */
    size_t object;       /* that is being declared */
} PovrayGeometry;

/* Finds the objects, and the cells of each. */
MUST_CHECK Status povray_objects_find(PovrayGeometry *geometry, Err *err);
void povray_objects_release(PovrayGeometry *geometry);
/* Of how many pieces the whole is: primitives, cells, or segments of a blob or a mesh. */
size_t povray_pieces(const PovrayGeometry *geometry);
/* Finds the segments of the blobs that rays of the part can meet: all where there is no part, and
 * one, to paint something, where there is nothing. */
MUST_CHECK Status find_painted(PovrayGeometry *geometry, Err *err);

/* Each appends to *out what its name says; `geometry` is a PovrayGeometry, so that it may be a part
 * of a template. */
Status put_primitive_macros(Text *out, void *geometry, Err *err);
Status put_joint_macros(Text *out, void *geometry, Err *err);
/* The numbers and functions of an isosurface. */
Status put_cell_macros(Text *out, void *geometry, Err *err);
/* The numbers of a blob and what tells its segments apart. STATUS_INFEASIBLE when POV-Ray cannot
 * paint them. */
Status put_blob_macros(Text *out, void *geometry, Err *err);
Status put_mesh_macros(Text *out, void *geometry, Err *err);
/* Appends the part of the scale's range below the value x, as an expression of POV-Ray's functions
 * [colorscale_place]; of a scale that counts colours, x itself. */
void put_value_part(Text *text, const ColorScale *scale);
/* Appends the place on Value_Color_Map, 0 to 1, of a part x of the range, as such an expression. */
void put_value_map(Text *text, const ColorScale *scale);
/* Whether colours blend, and what blends them, if they do. */
bool povray_blends(const PovrayGeometry *geometry);
Status put_blend_macros(Text *out, void *geometry, Err *err);

/* Declares all objects, each by the function given, which is one of those that follow. */
Status put_objects(Text *out, PovrayGeometry *geometry,
                   Status (*put_object)(Text *out, PovrayGeometry *geometry, Err *err), Err *err);
/* Each declares geometry->object: a call for each primitive, an isosurface for each cell, the calls
 * that make a blob, the lists of a mesh2. STATUS_INFEASIBLE when POV-Ray cannot hold it. */
Status put_primitives(Text *out, PovrayGeometry *geometry, Err *err);
Status put_cells(Text *out, PovrayGeometry *geometry, Err *err);
Status put_blob(Text *out, PovrayGeometry *geometry, Err *err);
Status put_mesh(Text *out, PovrayGeometry *geometry, Err *err);

/* The declaration of geometry->object as a `kind`, "union" say, of what `put_members` appends. */
Status put_declaration(Text *out, PovrayGeometry *geometry, const char *kind,
                       Status (*put_members)(Text *out, void *geometry, Err *err), Err *err);

/* Appends the call that draws a joint. */
void put_joint(Text *text, const EmitParams *params, const Primitive *joint);

#endif
