/* Computes the terms of a vessel segment along a single ray, as functions of the ray parameter z,
 * for levelray.h. In the potential [field/field.h], a segment is one term: potential_terms. In a
 * blob [field/blob.h], each component of the segment is a term: blob_terms. Both find their axes by
 * levelterm_place. All forms here are constants with a proven error [affine.h]; z is the distance
 * from the ray's origin, mm. Private to the module answer. */
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

/* Returns the axis of a face's segment, with `unit` as LevelAxis.unit. */
static inline LevelAxis levelaxis_of(const Face *face, Form unit)
{
    return (LevelAxis){form3_exact(face->at), face->axis, face->length, unit};
}

/* Sets the members of a term that depend only on the axis and the ray: from, to, distance, least,
 * unit, axis, along, before, across and across_rate. `reach` is the distance from the axis, in the
 * term's unit, beyond which the term is 0 or left out. Returns false if the whole ray is certainly
 * farther than `reach` from the axis; *term is then undefined. */
bool levelterm_place(const LevelAxis *axis, double reach, const Beam *ray, LevelTerm *term);
/* Sets [*from, *to], mm, to an interval that contains every z at which the ray is at most
 * sqrt(d^2 + w^2) from the axis line, and at most x beyond either end of the axis. d is the minimum
 * distance between the ray and the axis line. Lengths w, x and d are in the term's unit. Reads
 * term->distance, along and before. The bounds are infinite if the ray is about parallel to the
 * axis. */
void levelterm_interval(const LevelTerm *term, double w, double x, double *from, double *to);

/* Maximum number of terms of a segment: a blob has BLOB_COMPONENTS, the potential one. */
enum { LEVEL_SEGMENT_TERMS = BLOB_COMPONENTS };
/* Set terms[0], terms[1], ... to the terms of a segment that the ray reaches, and return their
 * number. `terms` has space for LEVEL_SEGMENT_TERMS terms. `face` must be a FACE_SEGMENT; `index`
 * is its index in AnswerPlan.faces. */
size_t potential_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms);
size_t blob_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms);

#endif
