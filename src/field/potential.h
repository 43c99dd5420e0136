/* What the files of the room surface share. */
#ifndef CORCAST_FIELD_POTENTIAL_H
#define CORCAST_FIELD_POTENTIAL_H

#include "field/field.h"

/* The squared distance between the segment's axis and the box, mm^2. */
double segment_box_distance2(const FieldSegment *segment, const Box *box);

#endif
