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
/* Appends the call that draws a joint. */
void put_joint(Text *text, const Scene *scene, const Primitive *joint);

#endif
