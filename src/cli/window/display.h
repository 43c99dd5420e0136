/* Renders the images of an interactive window: first quickly with large pixels, then at full
 * resolution, then antialiased.
 *
 * While the view changes, call display_quick for each frame. When the view stays the same, call
 * display_refine until *done is true, and handle events between the calls. */
#ifndef CORCAST_CLI_WINDOW_DISPLAY_H
#define CORCAST_CLI_WINDOW_DISPLAY_H

#include "render/render.h"
#include <stdint.h>

typedef struct Display Display;

/* Makes a renderer for a window.
 *
 * geometry  borrowed until display_free.
 * params    copied. The last refinement has params->antialias samples along each side of a pixel.
 * out       set on success; release it with display_free.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status display_new(const Geometry *geometry, const RenderParams *params, Display **out,
                              Err *err);
void display_free(Display *display);

/* The image to show. It is valid until the next call for this Display, and may have fewer pixels
 * than the window. */
typedef struct DisplayPicture {
    const uint8_t *rgb; /* borrowed; 8 bits per channel, sRGB, rows from top to bottom */
    int width, height;
} DisplayPicture;

/* Renders the view in about 1/30 s. Chooses the number of pixels for that time from the durations
 * of previous images. The size of the window is view->camera's size. Errors: those of
 * renderer_render; STATUS_MEMORY. */
MUST_CHECK Status display_quick(Display *display, const View *view, const Appearance *appearance,
                                DisplayPicture *picture, Err *err);
/* Continues the image that display_quick began, for about 1/40 s: first renders every pixel of the
 * window, then antialiases. View and appearance must be those of display_quick. Sets *done to true
 * when the image is complete. Errors: those of renderer_render; STATUS_MEMORY. */
MUST_CHECK Status display_refine(Display *display, const View *view, const Appearance *appearance,
                                 DisplayPicture *picture, bool *done, Err *err);

/* Returns the coarseness: the side of a pixel of quick images, in pixels of the window. */
int display_coarseness(const Display *display);
/* Sets the coarseness of the next quick image, 1 or more. */
void display_set_coarseness(Display *display, int coarseness);

#endif
