/* What a view is made about, and what of it is framed: balls at the ends of vessels and their
 * shadows on the ground. Coordinates are the geometry's. */
#ifndef CORCAST_STAGE_SUBJECT_H
#define CORCAST_STAGE_SUBJECT_H

#include "geom/geom.h"
#include "scene/scene.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* The balls about the ends of all that is drawn, or of the tree's segments. Borrows both. */
typedef struct Subject {
    const Geometry *geometry;
    const Tree *tree; /* NULL: the geometry's own balls */
    Box box;          /* the smallest that holds them */
} Subject;

/* O(n) of n segments of the tree, where their box is not known. */
Subject subject_of(const ViewParams *params, const Geometry *geometry);

/* How many segments are numbered. */
size_t subject_segments(const Subject *subject);
/* The balls about the ends of segment `number`, in ends[2], and how many: 2, or 0 when it is not
 * drawn. */
int subject_ends(const Subject *subject, size_t number, Ball ends[2]);

enum { FRAMED_LIGHTS = 4 * VIEW_MAX_LIGHTS };

/* What is to be in the picture: the subject, or the corners of a box in its place, and their
 * shadows, as balls about them. Borrows the subject. */
typedef struct Framed {
    const Subject *subject;
    const Box *domain; /* NULL: the subject's balls; in the coordinates of the tree */
    Ground ground;
    Light lights[FRAMED_LIGHTS]; /* points, or parallel, whose shadows fall on the ground */
    size_t n_lights;
    Box box; /* the smallest that holds it all */
} Framed;

/* With the shadows of the view's lights on its ground. */
Framed framed_of(const Subject *subject, const ViewParams *params, const View *view);
/* As those of a subject; of a shadow that is too long to be framed there may be 1 ball. */
size_t framed_segments(const Framed *framed);
int framed_ends(const Framed *framed, size_t number, Ball ends[2]);

#endif
