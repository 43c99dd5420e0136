/* Numbers, points and paints as POV-Ray reads them; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"

/* <x,y,z> */
void put_vector(Text *text, Vec3 v);
/* <r,g,b> */
void put_color(Text *text, Rgb color);
/* The last arguments of the macros, id,order,value,color of a segment, by its number; of a scene in
 * one colour the last two are 0. */
void put_paint(Text *text, const EmitParams *params, uint32_t segment);
/* x*k0+y*k1-z*k2+k3 without the zeros; nothing when all are 0. */
void put_linear(Text *text, const Linear *linear);

#endif
