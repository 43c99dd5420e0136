/* Writes each kind of geometry (primitives, joints, meshes, isosurfaces, blobs) in POV-Ray's
 * language. Private to the module emit.
 *
 * A scene for POV-Ray first defines macros, then declares objects. An object is a union, whose
 * members are calls of the macros. For each kind of geometry, one function writes the macros and
 * one function writes the members; the table in povray.c selects them by model. TmplPut
 * [tmpl/tmpl.h] is a function type, so a line such as `TmplPut put_mesh_macros;` declares a
 * function. It receives its data as a const void *; here the data is always a const PovrayGeometry
 * *.
 *
 * Errors of the functions that return a Status: STATUS_INPUT if a template is missing;
 * STATUS_MEMORY. If memory runs out, functions without a Status mark `text` as failed
 * [base/text.h]. */
#ifndef CORCAST_EMIT_POVRAY_MEMBERS_H
#define CORCAST_EMIT_POVRAY_MEMBERS_H

#include "emit/povray_objects.h"

/* Append the macros that the members call: of primitives, of joints, of both, and of meshes. */
TmplPut put_primitive_macros;
TmplPut put_joint_macros;
TmplPut put_primitive_and_joint_macros;
TmplPut put_mesh_macros;
/* Appends the constants and functions of an isosurface. */
TmplPut put_cell_macros;
/* Appends the constants of a blob, and the functions that find the segment to which a point of the
 * blob belongs. Errors: also STATUS_INFEASIBLE if the colors need more segments than POV-Ray can
 * distinguish. */
TmplPut put_blob_macros;

/* Sets geometry->cells: for each object of an isosurface, the cells (boxes with the terms that are
 * significant in them) that together contain the surface. povray_objects_release frees them. */
MUST_CHECK Status find_cells(PovrayGeometry *geometry, Err *err);
/* Sets geometry->visible_segments of a blob: the segments that rays through params->part can hit,
 * or all segments if params->part is NULL. The list has at least one segment, because POV-Ray
 * rejects an empty list. It borrows from geometry->indices. */
MUST_CHECK Status find_visible_segments(PovrayGeometry *geometry, Err *err);

/* Append the declaration of geometry->object: for primitives a macro call each, for an isosurface
 * an object per cell, for a blob the calls that make it, for a mesh the lists of a mesh2. Errors:
 * also STATUS_INFEASIBLE if POV-Ray cannot hold the object. */
PovrayPutObject put_primitives;
PovrayPutObject put_cells;
PovrayPutObject put_blob;
PovrayPutObject put_mesh;

/* Appends the call that draws a joint. */
void put_joint(Text *text, const EmitParams *params, const Primitive *joint);

/* ---- colors ---- */

/* Appends an expression in POV-Ray's language that maps the value x to its position on the scale
 * [colorscale_position]. If the scale maps integers to colors [colorscale_selects_by_integer], the
 * expression is x itself. */
void put_scale_position(Text *text, const ColorScale *scale);
/* Appends an expression that maps a position x on the scale to a position on Value_Color_Map, 0 to
 * 1. */
void put_value_map(Text *text, const ColorScale *scale);
/* Returns true if not all segments have the same color and id. */
bool povray_has_several_paints(const PovrayGeometry *geometry);
/* Returns true if the colors of neighbouring segments are interpolated where the segments meet. */
bool povray_blends(const PovrayGeometry *geometry);
/* Appends the macros that interpolate colors. Appends nothing if povray_blends is false. */
TmplPut put_blend_macros;

#endif
