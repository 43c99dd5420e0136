/* Places annotations where they cover few vessels, and gives them halos where vessels are behind
 * them. A halo is an outline in the color of the background. */
#ifndef CORCAST_JOB_PICTURE_PLACING_H
#define CORCAST_JOB_PICTURE_PLACING_H

#include "figure/figure.h"
#include "scene/scene.h"

/* The corner of a picture in which an annotation is placed. */
typedef enum Corner {
    CORNER_EMPTIEST, /* the corner in which the annotation covers the smallest area of vessels
                      * [placing_move] */
    CORNER_BOTTOM_LEFT,
    CORNER_BOTTOM_RIGHT,
    CORNER_TOP_RIGHT,
    CORNER_TOP_LEFT,
    CORNER_CHOICES
} Corner;

/* The names of the corners for an option, with a Corner as index. The last element is NULL. */
extern const char *const corner_names[];

/* A picture on a page. All pointers are borrowed. */
typedef struct PlacedPicture {
    const Scene *scene;
    FigureBox where; /* the rectangle of the page that the picture covers, mm */
} PlacedPicture;

/* Moves the items of the page from index `first` on, as one group, into a corner of the picture.
 *
 * CORNER_EMPTIEST selects the corner in which the group covers the smallest area of vessels.
 * Corners that contain other items of the page are chosen only if all corners do; lines, and items
 * that contain the whole picture, do not count. On a tie, the corner that is first in the order of
 * Corner is selected. The selection depends only on the scene and the page, not on resolution,
 * tiles or threads.
 *
 * gap_mm  distance of the group from the edges of the picture.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status placing_move(FigurePage *page, size_t first, const PlacedPicture *picture,
                               Corner corner, double gap_mm, Err *err);

/* Gives each item from index `first` on that is in front of vessels a halo of the picture's
 * background color, `width_mm` wide. Errors: STATUS_MEMORY. */
MUST_CHECK Status placing_add_halos(FigurePage *page, size_t first, const PlacedPicture *picture,
                                    double width_mm, Err *err);

#endif
