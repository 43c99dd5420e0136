/* Integrates the color of a scene over a part of the picture, with proven bounds: region_integrate
 * over any convex polygon, arealeaf_measure over a leaf, which is a part of a pixel. Private to the
 * module answer.
 *
 * The polygon is in the rectangle of a beam. It is cut along the edges of the faces that the beam
 * may hit, until each piece shows one face, or until the limit of cuts is reached. Each cut leaves
 * a narrow strip in which the sign of the edge is not decided. In a strip, the integral includes
 * all colors that are possible there. See docs/ANSWERS.md, section 5. */
#ifndef CORCAST_ANSWER_REGION_H
#define CORCAST_ANSWER_REGION_H

#include "answer/workspace.h"

/* Capacity for the corners of a polygon. A rectangle clipped to a square has up to 8, and each cut
 * adds at most one; a piece is cut up to 10 times for visibility and up to 10 times for shadows, a
 * limit that bounds the time. */
enum { POLYGON_MAX = 28 };

/* A convex polygon in the coordinates ex and ey of a beam's rectangle, which are in [-1, 1]. */
typedef struct LeafPolygon {
    int n; /* number of corners; 0: empty */
    double x[POLYGON_MAX], y[POLYGON_MAX];
} LeafPolygon;

/* Returns the part of the polygon in which f.c + f.x ex + f.y ey >= `from`. Ignores f.e. The result
 * is empty if it would have fewer than 3 corners, or more than POLYGON_MAX - 2, because the last
 * step of a cut needs space for two. Callers count the area that is lost in this way as undecided.
 */
LeafPolygon polygon_cut(const LeafPolygon *polygon, Form f, double from);

/* The integral of the color over a region. Areas are in units of ex and ey, so the area of the
 * whole rectangle is 4. */
typedef struct RegionSum {
    double low[3], high[3]; /* per channel: bounds of the integral */
    double strips;  /* part of high - low, summed over the channels, that comes from areas whose
                     * color is not decided */
    uint32_t walls; /* if a single face is visible, and it is a wall: 1 + its index in work->hits;
                     * else 0 */
    bool is_mixed;  /* several faces are visible, or a face that is no wall */
} RegionSum;

/* Integrates the color over a polygon in the beam's rectangle. Only faces in `list` may be visible
 * there; any face of the scene may cast shadows. Overwrites work->hits. */
RegionSum region_integrate(AnswerWorkspace *work, const Beam *beam, const FaceList *list,
                           const LeafPolygon *polygon);

/* A leaf: a part of a pixel. It is a rectangle with any orientation. A turned rectangle is clipped
 * to a square with horizontal and vertical sides. All positions are in pixels from the center of
 * the pixel. */
typedef struct AreaLeaf {
    /* Center of the rectangle, and its half sides. In the forms of the leaf's beam, ex grows along
     * `along`, and ey along `across`. */
    double x, y, across[2], along[2];
    bool turned;    /* true: `along` is parallel to a vessel in the picture */
    double clip[4]; /* the square: left, right, top, bottom; unused unless `turned` */
    /* Results of arealeaf_measure: */
    double low[3], high[3]; /* per channel: bounds of the integral of the color over the leaf, in
                             * color times square pixels */
    /* Unit vector across the vessel, in the picture, if the leaf is a square that shows only the
     * wall of one vessel. The leaf is later replaced by a turned leaf, because color varies mainly
     * across a vessel. (0, 0): the leaf is not replaced. */
    double turn[2];
    /* The reason why the interval of the leaf is wide. false: shading varies over one wall. true:
     * the leaf shows several faces or a face that is not a wall, or strips cause more than half of
     * the width. */
    bool is_mixed;
} AreaLeaf;

/* Returns the leaf as a polygon in the coordinates of its rectangle; empty if nothing is left. */
LeafPolygon arealeaf_polygon(const AreaLeaf *leaf);
/* Integrates the color over a leaf of the pixel in column i and row j. Sets low, high,
 * turn and is_mixed of the leaf. Only the faces of work->pixel may be visible. Overwrites
 * work->hits, and adds 1 to work->beams. */
void arealeaf_measure(AnswerWorkspace *work, int i, int j, AreaLeaf *leaf);

#endif
