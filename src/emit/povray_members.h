/* The functions that write the kinds of geometry in POV-Ray's language. Private to the module emit.
 *
 * A scene for POV-Ray first defines macros, then declares objects whose members call the macros.
 * For each kind of geometry there is a function that writes the macros and one that writes the
 * members. The table in povray.c selects the functions by model. Every parameter `geometry` of type
 * const void * is a const PovrayGeometry *; the type lets the function be a part of a template
 * [values.h].
 *
 * Errors of all functions: STATUS_INPUT if a template is missing; STATUS_MEMORY. */
#ifndef CORCAST_EMIT_POVRAY_MEMBERS_H
#define CORCAST_EMIT_POVRAY_MEMBERS_H

#include "emit/povray_objects.h"

/* Append the macros that the members call. */
TmplPut put_primitive_macros;
TmplPut put_joint_macros;
TmplPut put_joined_macros; /* primitives and joints */
TmplPut put_mesh_macros;
/* Appends the numbers and functions of an isosurface. */
TmplPut put_cell_macros;
/* Appends the numbers of a blob and the functions that find the segment of a point. Errors: also
 * STATUS_INFEASIBLE if there are more segments than POV-Ray can paint. */
TmplPut put_blob_macros;

/* Finds the cells of each object of an isosurface: sets geometry->cells. */
Status find_cells(PovrayGeometry *geometry, Err *err);
/* Sets geometry->painted of a blob: the segments that rays of params->part can hit, or all segments
 * if there is no part. If no segment can be hit, the list has one segment all the same, because
 * POV-Ray needs one to color. */
Status find_visible_segments(PovrayGeometry *geometry, Err *err);

/* Append the declaration of geometry->object: a macro call for each primitive, an isosurface for
 * each cell, the calls that make a blob, the lists of a mesh2. Errors: also STATUS_INFEASIBLE if
 * POV-Ray cannot hold the object. */
PovrayPutObject put_primitives;
PovrayPutObject put_cells;
PovrayPutObject put_blob;
PovrayPutObject put_mesh;

/* Appends the call that draws a joint. */
void put_joint(Text *text, const EmitParams *params, const Primitive *joint);

/* ---- colors ---- */

/* Appends the fraction of the scale's range below the value x, as an expression of POV-Ray's
 * functions [colorscale_position]. For a scale that counts colors, the fraction is x itself. */
void put_value_fraction(Text *text, const ColorScale *scale);
/* Appends an expression for the position, 0 to 1, on Value_Color_Map of a fraction x of the range.
 */
void put_value_map(Text *text, const ColorScale *scale);
/* Returns true if segments differ in color or id. */
bool povray_paints(const PovrayGeometry *geometry);
/* Returns true if the colors of neighbouring segments blend where they meet. */
bool povray_blends(const PovrayGeometry *geometry);
/* Appends the macros that blend colors, if they do. */
TmplPut put_blend_macros;

#endif
