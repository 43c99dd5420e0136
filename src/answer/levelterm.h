/* Makes the terms of fields along single rays, for levelray.h. The field of a vessel segment is one
 * term of the potential [field/field.h], or the components of a blob [field/blob.h], each of which
 * is a term. Private to the module answer. */
#ifndef CORCAST_ANSWER_LEVELTERM_H
#define CORCAST_ANSWER_LEVELTERM_H

#include "answer/faces.h"
#include "answer/levelray.h"
#include "field/field.h"

/* The axis of a term: a straight line between two ends, or a point. */
typedef struct LevelAxis {
    Form3 start; /* first end, mm */
    Form3 axis;  /* unit vector towards the second end; 0 for a point */
    Form length; /* distance between the ends, mm; 0 for a point */
    Form unit;   /* 1 / the term's unit of length, 1/mm */
} LevelAxis;

/* Returns an axis along the segment of a face, with this unit. */
static inline LevelAxis levelaxis_of(const Face *face, Form unit)
{
    return (LevelAxis){form3_exact(face->at), face->axis, face->length, unit};
}

/* Sets the members of a term that follow from its axis: from `from` to `across_rate`, except the
 * windows. `reach` is the distance from the axis, in the term's unit, beyond which the term is 0 or
 * left out. Returns false if the ray surely passes beyond it. */
bool levelterm_place(const LevelAxis *axis, double reach, const Beam *ray, LevelTerm *term);
/* Returns an interval that has every z at which the ray is at most sqrt(d^2 + w^2) from the axis
 * line, where d is the ray's least distance from it, and at most x beyond an end of the axis.
 * Lengths w, x and d are in the term's unit. */
void levelterm_interval(const LevelTerm *term, double w, double x, double *from, double *to);

/* Makes the terms of a segment along a ray, and returns their number, at most
 * LEVEL_SEGMENT_TERMS. Terms that the ray does not reach are left out. `face` must be a
 * FACE_SEGMENT, and `index` is its index. */
enum { LEVEL_SEGMENT_TERMS = BLOB_COMPONENTS };
size_t potential_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms);
size_t blob_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms);

#endif
