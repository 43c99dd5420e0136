/* The objects that a camera frames, as balls: the ends of vessels, or the corners of a domain.
 * Coordinates are those of the geometry. Nothing is allocated. Private to the module stage. */
#ifndef CORCAST_STAGE_SUBJECT_H
#define CORCAST_STAGE_SUBJECT_H

#include "geom/geom.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* The balls around the ends of the geometry, or of the tree's segments. Borrows both. */
typedef struct Subject {
    const Geometry *geometry;
    const Tree *tree; /* NULL: the balls of the geometry */
    Box box;          /* the smallest box that holds the balls */
} Subject;

/* Makes the subject of a view. O(n) for n segments of the tree if params->box is not known. */
Subject subject_of(const ViewParams *params, const Geometry *geometry);

/* Returns the number of segments. */
size_t subject_segments(const Subject *subject);
/* Computes the balls around the ends of segment `number`. Returns their number: 2, or 0 if the
 * segment is not drawn. */
int subject_ends(const Subject *subject, size_t number, Ball ends[2]);

/* The balls that the picture must show: those of the subject, or the corners of a box instead.
 * Shadows on the ground are not framed, so that they change no camera. Borrows the subject. */
typedef struct Framed {
    const Subject *subject;
    const Box *domain; /* in the coordinates of the tree; NULL: the subject's balls */
    Box box;           /* the smallest box that holds all balls */
} Framed;

/* Makes the balls of a subject or, unless NULL, of a domain. */
Framed framed_of(const Subject *subject, const Box *domain);
/* The same for Framed: the number of segments, and the balls of segment `number`. */
size_t framed_segments(const Framed *framed);
int framed_ends(const Framed *framed, size_t number, Ball ends[2]);

#endif
