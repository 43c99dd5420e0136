/* What the writers of POV-Ray text share; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"
#include "tmpl/tmpl.h"

/* <x,y,z> */
void put_vector(Text *text, Vec3 v);
/* <r,g,b> */
void put_color(Text *text, Rgb color);
/* The last two arguments of the macros: id,color */
void put_paint(Text *text, const Scene *scene, uint32_t id, Rgb color);

/* x*k0+y*k1-z*k2+k3 without the zeros; nothing when all are 0. */
void put_linear(Text *text, const Linear *linear);

/* Loads povray/NAME. Release with tmpl_release. */
MUST_CHECK Status load_template(Tmpl *template, const PovrayParams *params, const char *name,
                                Err *err);

/* Appends a log form for each scale of a cell. */
MUST_CHECK Status put_scales(Text *text, const PovrayParams *params, const CellTree *cells,
                             Err *err);
/* Appends a function for each segment and part that a cell uses. */
MUST_CHECK Status put_terms(Text *text, const Scene *scene, const PovrayParams *params,
                            const CellTree *cells, Err *err);
/* Appends an isosurface for each cell. */
MUST_CHECK Status put_cells(Text *text, const Scene *scene, const PovrayParams *params,
                            const CellTree *cells, Err *err);
/* Appends the calls that make a blob, of which *n_cells is 0, or so many of them. STATUS_INFEASIBLE
 * when POV-Ray cannot hold them. */
MUST_CHECK Status put_blob(Text *text, const Scene *scene, size_t *n_cells, Err *err);
/* Appends what tells the segments of a blob apart: the functions that find the largest term, the
 * name of the one for all, and the segments' paints in groups, and how many groups. */
MUST_CHECK Status put_blob_paint(const Scene *scene, Text *functions, Text *top, Text *groups,
                                 Text *n_groups, Err *err);
/* The sides of joints' meshes, 0 where POV-Ray holds all of the scene's exactly. */
int joint_sides(const Scene *scene);
/* Appends the call that draws a joint. */
void put_joint(Text *text, const Scene *scene, const Primitive *joint);

#endif
