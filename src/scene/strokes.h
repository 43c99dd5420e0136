/* A line drawing on paper: polylines, each of constant width. ink_strokes [render/ink/ink.h] makes
 * one. */
#ifndef CORCAST_SCENE_STROKES_H
#define CORCAST_SCENE_STROKES_H

#include <stddef.h>

/* A polyline through points[first .. first + n), n >= 2. Its ends and corners are round. */
typedef struct Stroke {
    size_t first, n;
    double width_mm;
} Stroke;

/* Strokes and their points. Coordinates are in millimetres from the upper left corner of the
 * paper, x to the right and y down. */
typedef struct Strokes {
    double (*points)[2];        /* owned */
    Stroke *strokes;            /* owned */
    size_t n_points, n;         /* numbers of points and of strokes */
    double width_mm, height_mm; /* size of the paper */
} Strokes;

/* Frees the arrays and zeroes *strokes. */
void strokes_release(Strokes *strokes);

#endif
