/* What a camera frames. A Subject is the balls around the ends of vessels. A Framed is the subject,
 * or the corners of a box in its place. Balls are computed when they are used; nothing is
 * allocated. Coordinates are those of the geometry, unless stated. Private to the module stage. */
#ifndef CORCAST_STAGE_SUBJECT_H
#define CORCAST_STAGE_SUBJECT_H

#include "geom/geom.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* The balls around the ends of the segments of a geometry, or of a tree. Borrows both. */
typedef struct Subject {
    const Geometry *geometry;
    const Tree *tree; /* the tree whose segments are used; NULL: the geometry is used */
    Box box;          /* the smallest box that contains the balls */
} Subject;

/* Makes the subject of a view: the segments of params->tree, or of the geometry if it is NULL. The
 * box is *params->box; if that is NULL, the geometry's box, or, with a tree, computed in O(n) for n
 * segments. */
Subject subject_of(const ViewParams *params, const Geometry *geometry);

/* Returns the number of segments, including those that are not drawn. */
size_t subject_segments(const Subject *subject);
/* Computes the balls around the ends of segment `number`. Returns their number: 2, or 0 if the
 * segment is not drawn. */
int subject_ends(const Subject *subject, size_t number, Ball ends[2]);

/* The balls that the picture must show: those of a subject, or the corners of a domain's box.
 * Borrows both. Shadows on the ground are not framed, so that they do not change the camera. */
typedef struct Framed {
    const Subject *subject;
    const Box *domain; /* box in the coordinates of the tree, which framed_of moves to those of the
                        * geometry; NULL: the subject's balls are framed */
    Box box;           /* the smallest box that contains all balls */
} Framed;

/* Makes a Framed of the domain or, if `domain` is NULL, of the subject. */
Framed framed_of(const Subject *subject, const Box *domain);
/* framed_segments returns the number of segments of a Framed. framed_ends computes the two balls of
 * segment `number`, and returns their number: 2, or 0 if the segment is not drawn. The four edges
 * of a domain along x count as segments, with balls of radius 0 at the corners. */
size_t framed_segments(const Framed *framed);
int framed_ends(const Framed *framed, size_t number, Ball ends[2]);

#endif
