/* Pictures for a window: quick and coarse, then whole, then smooth. */
#ifndef CORCAST_APP_DISPLAY_H
#define CORCAST_APP_DISPLAY_H

#include "render/render.h"
#include <stdint.h>

typedef struct Display Display;

/* Of a scene (borrowed); when nothing moves, pictures end with `params->antialias`. Camera, lights
 * and size of the scene may change between calls, its geometry may not. */
MUST_CHECK Status display_new(Scene *scene, const RenderParams *params, Display **out, Err *err);
void display_free(Display *display);

/* What is to be shown now. */
typedef struct DisplayPicture {
    const uint8_t *rgb; /* borrowed; 8 bits a channel, sRGB, rows from the top down */
    int width, height;
} DisplayPicture;

/* Draws the whole picture with as many pixels as a thirtieth of a second allows, judged by the
 * pictures before. */
MUST_CHECK Status display_quick(Display *display, DisplayPicture *picture, Err *err);
/* Draws on at what is shown, for about a fortieth of a second: at every pixel, then antialiased.
 * *done says that nothing is left. */
MUST_CHECK Status display_refine(Display *display, DisplayPicture *picture, bool *done, Err *err);

/* A pixel of quick pictures has so many of the window's along each side. */
int display_coarseness(const Display *display);
/* That quick pictures begin with. */
void display_set_coarseness(Display *display, int coarseness);

#endif
