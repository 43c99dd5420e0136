/* Numbers, points and paints as POV-Ray reads them; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"

/* <x,y,z> */
void put_vector(Text *text, Vec3 v);
/* <r,g,b> */
void put_color(Text *text, Rgb color);
/* The last arguments of the macros, id,order,value,color of a segment, by its number; of a scene in
 * one colour the last two are 0, where colours change with time they are looked up. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* What the values and colours of all segments are in a frame [appearance_frame], as the arrays that
 * put_paint looks up in. */
void put_frame(Text *text, const Appearance *frame);
/* x*k0+y*k1-z*k2+k3 without the zeros; nothing when all are 0. */
void put_linear(Text *text, const Linear *linear);

#endif
