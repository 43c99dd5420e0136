/* The objects that a camera frames, as balls: the ends of vessels, and their shadows on the ground.
 * Subject has the balls of the vessels; Framed also those of the shadows. Coordinates are those of
 * the geometry. Nothing is allocated. Private to the module stage. */
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

enum { FRAMED_LIGHTS = 4 * VIEW_MAX_LIGHTS };

/* The balls that the picture must show: those of the subject, or the corners of a box instead, and
 * balls around their shadows. Borrows the subject. */
typedef struct Framed {
    const Subject *subject;
    const Box *domain; /* in the coordinates of the tree; NULL: the subject's balls */
    Ground ground;
    Light lights[FRAMED_LIGHTS]; /* point and parallel lights whose shadows fall on the ground */
    size_t n_lights;
    Box box; /* the smallest box that holds all balls */
} Framed;

/* Makes the balls of a view, with the shadows of its lights on its ground. */
Framed framed_of(const Subject *subject, const ViewParams *params, const View *view);
/* The same for Framed: the number of segments, and the balls of segment `number`. A shadow that is
 * too long to be framed has no ball, so framed_ends may also return 1. */
size_t framed_segments(const Framed *framed);
int framed_ends(const Framed *framed, size_t number, Ball ends[2]);

#endif
