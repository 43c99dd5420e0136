/* Draws the texts over the picture in the window of `view`: the legend of the field at the right, a
 * status line at the bottom, and on request the list of keys. Fonts and legend are those of
 * `render`. Call overlay_open once, overlay_draw whenever content or window size change, and
 * overlay_release. */
#ifndef CORCAST_CLI_COMMAND_VIEW_OVERLAY_H
#define CORCAST_CLI_COMMAND_VIEW_OVERLAY_H

#include "job/picture/picture.h"
#include "job/picture/sheet.h"
#include <stdint.h>

/* One line of the list of keys: the keys, and what they do. Both strings are borrowed. */
typedef struct OverlayKey {
    const char *keys, *meaning;
} OverlayKey;

/* The content of an overlay. All pointers are borrowed. */
typedef struct OverlayContent {
    const Scene *scene; /* the drawn scene; its legend is shown if its colors represent values */
    const char *status; /* the status line, UTF-8 */
    const OverlayKey *keys;
    size_t n_keys; /* 0: no list of keys */
} OverlayContent;

typedef struct ViewOverlay {
    Sheet sheet;   /* the page with fonts on which the overlay is laid out [sheet.h] */
    uint8_t *rgba; /* per pixel: sRGB codes multiplied by the opacity (premultiplied alpha), and the
                    * opacity, 0 to 255; rows from top to bottom; owned; NULL before overlay_draw */
    int width, height;
} ViewOverlay;

/* Loads the fonts. `overlay` must be zeroed; the caller calls overlay_release even after an error.
 * Errors: those of sheet_open [job/picture/sheet.h]. */
MUST_CHECK Status overlay_open(ViewOverlay *overlay, Err *err);
/* Draws the overlay of a window of this size in pixels. Sets rgba, width and height, and frees the
 * previous `rgba`. Errors: STATUS_MEMORY. */
MUST_CHECK Status overlay_draw(ViewOverlay *overlay, const OverlayContent *content, int width,
                               int height, Err *err);
void overlay_release(ViewOverlay *overlay);

#endif
