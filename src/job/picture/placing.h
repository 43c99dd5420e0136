/* Places annotations where few vessels are, and gives them halos where vessels are behind them. A
 * halo is a rim in the color of the background. */
#ifndef CORCAST_JOB_PICTURE_PLACING_H
#define CORCAST_JOB_PICTURE_PLACING_H

#include "figure/figure.h"
#include "scene/scene.h"

/* The corner of a picture that an annotation is in. */
typedef enum Corner {
    CORNER_EMPTIEST, /* the corner with the fewest vessels; see placing_move */
    CORNER_BOTTOM_LEFT,
    CORNER_BOTTOM_RIGHT,
    CORNER_TOP_RIGHT,
    CORNER_TOP_LEFT,
    CORNER_CHOICES
} Corner;

/* The names of the corners for an option; NULL ends the list. */
extern const char *const corner_names[];

/* A picture on a page. All pointers are borrowed. */
typedef struct PlacedPicture {
    const Scene *scene;
    FigureBox where; /* the rectangle of the page that the picture covers */
} PlacedPicture;

/* Moves the items of the page from index `first` on, as one group, into a corner of the picture.
 * CORNER_EMPTIEST selects the corner in which the group covers the smallest area of vessels, and
 * avoids the other items of the page, except lines and items that contain the picture. Of equal
 * corners it selects the first in the order of Corner. The selection depends on the scene alone,
 * not on resolution, tiles or threads.
 *
 * gap_mm  distance of the group from the edges of the picture.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status placing_move(FigurePage *page, size_t first, const PlacedPicture *picture,
                               Corner corner, double gap_mm, Err *err);

/* Gives every item from index `first` on that lies on vessels a halo of the picture's background,
 * `width_mm` wide. Errors: STATUS_MEMORY. */
MUST_CHECK Status placing_add_halos(FigurePage *page, size_t first, const PlacedPicture *picture,
                                    double width_mm, Err *err);

#endif
