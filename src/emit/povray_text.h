/* What the writers of POV-Ray text share; private to the room emit. */
#ifndef CORCAST_EMIT_POVRAY_TEXT_H
#define CORCAST_EMIT_POVRAY_TEXT_H

#include "emit/emit.h"

/* <x,y,z> */
void put_vector(Text *text, Vec3 v);
/* The last two arguments of the macros: id,color */
void put_paint(Text *text, const Scene *scene, uint32_t id, Rgb color);

/* Appends the call that draws a joint. */
void put_joint(Text *text, const Scene *scene, const Primitive *joint);

#endif
