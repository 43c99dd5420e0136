/* Renders the images of an interactive window: first quick and coarse, then at full resolution,
 * then antialiased.
 *
 * While the view changes, call display_quick for each frame. When it stays the same, call
 * display_refine until *done is true, and handle events between the calls. */
#ifndef CORCAST_CLI_WINDOW_DISPLAY_H
#define CORCAST_CLI_WINDOW_DISPLAY_H

#include "render/render.h"
#include <stdint.h>

typedef struct Display Display;

/* Makes a renderer for a window. Borrows `geometry` until display_free. The last refinement has
 * `params->antialias` samples along each side of a pixel. Errors: STATUS_MEMORY. */
MUST_CHECK Status display_new(const Geometry *geometry, const RenderParams *params, Display **out,
                              Err *err);
void display_free(Display *display);

/* The image to show. It is valid until the next call for this Display. */
typedef struct DisplayPicture {
    const uint8_t *rgb; /* borrowed; 8 bits per channel, sRGB, rows from the top down */
    int width, height;
} DisplayPicture;

/* Renders the view in about 1/30 s, with as many pixels as that time allows; the number is
 * estimated from the images before. Errors: of render, STATUS_MEMORY. */
MUST_CHECK Status display_quick(Display *display, const View *view, const Appearance *appearance,
                                DisplayPicture *picture, Err *err);
/* Continues the image that display_quick began, for about 1/40 s: first renders every pixel, then
 * antialiases. View and appearance must be those of display_quick. Sets *done to true when the
 * image is complete. Errors: of render, STATUS_MEMORY. */
MUST_CHECK Status display_refine(Display *display, const View *view, const Appearance *appearance,
                                 DisplayPicture *picture, bool *done, Err *err);

/* Returns the side of a pixel of quick images, in pixels of the window. */
int display_coarseness(const Display *display);
/* Sets the coarseness of the next quick image, in pixels of the window. */
void display_set_coarseness(Display *display, int coarseness);

#endif
