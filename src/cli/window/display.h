/* Pictures for a window: quick and coarse, then whole, then smooth. */
#ifndef CORCAST_CLI_WINDOW_DISPLAY_H
#define CORCAST_CLI_WINDOW_DISPLAY_H

#include "render/render.h"
#include <stdint.h>

typedef struct Display Display;

/* Of a geometry (borrowed); when nothing moves, pictures end with `params->antialias`. */
MUST_CHECK Status display_new(const Geometry *geometry, const RenderParams *params, Display **out,
                              Err *err);
void display_free(Display *display);

/* What is to be shown now. */
typedef struct DisplayPicture {
    const uint8_t *rgb; /* borrowed; 8 bits a channel, sRGB, rows from the top down */
    int width, height;
} DisplayPicture;

/* Draws the whole picture of a view with as many pixels as a thirtieth of a second allows, judged
 * by the pictures before. */
MUST_CHECK Status display_quick(Display *display, const View *view, const Appearance *appearance,
                                DisplayPicture *picture, Err *err);
/* Draws on at what display_quick has begun, with the same view and appearance, for about a fortieth
 * of a second: at every pixel, then antialiased. *done says that nothing is left. */
MUST_CHECK Status display_refine(Display *display, const View *view, const Appearance *appearance,
                                 DisplayPicture *picture, bool *done, Err *err);

/* A pixel of quick pictures has so many of the window's along each side. */
int display_coarseness(const Display *display);
/* That quick pictures begin with. */
void display_set_coarseness(Display *display, int coarseness);

#endif
