/* The integral of a scene's color over a part of the picture, with proven bounds.
 *
 * The part is a convex polygon in the rectangle of a beam. It is cut along the edges of what the
 * beam may hit, until each piece shows one face, or until the limit of cuts is reached. Strips
 * along the cuts, in which an edge is not decided, take the range of all colors that are possible
 * there. docs/ANSWERS.md, section 5. */
#ifndef CORCAST_ANSWER_REGION_H
#define CORCAST_ANSWER_REGION_H

#include "answer/answertile.h"

/* A square has 4 corners, a rectangle in it up to 8, and each cut adds one. */
enum { POLYGON_MAX = 28 };

/* A convex polygon in the coordinates of a beam's rectangle, [-1, 1] in both. */
typedef struct LeafPolygon {
    int n;
    double x[POLYGON_MAX], y[POLYGON_MAX];
} LeafPolygon;

/* Cuts the polygon to the side where f >= `from`, in value without e. */
LeafPolygon polygon_cut(const LeafPolygon *polygon, Form f, double from);
double polygon_area(const LeafPolygon *polygon);

/* Bounds of the integral of each channel over a region, in units of area of the beam's rectangle,
 * whose own area is 4. */
typedef struct RegionSum {
    double low[3], high[3];
    double strips;  /* the part of high - low that strips along cuts make up, of all channels */
    uint32_t walls; /* index in work->hits of the wall, plus 1, if no other face is seen; else 0 */
    bool is_mixed;  /* another face than one wall is seen */
} RegionSum;

/* Integrates the color over a polygon of the beam among the faces of `list`. */
RegionSum region_integrate(AnswerWork *work, const Beam *beam, const FaceList *list,
                           const LeafPolygon *polygon);

/* Returns the leaf's points as a polygon of its rectangle. */
LeafPolygon arealeaf_polygon(const AreaLeaf *leaf);
/* Integrates over a leaf of the pixel (i, j), among the faces of work->pixel, and sets its bounds
 * and how it is divided next. */
void arealeaf_measure(AnswerWork *work, int i, int j, AreaLeaf *leaf);

#endif
