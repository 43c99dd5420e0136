/* The texts over the picture in the window of `view`: the legend of the field at the right, a
 * status line at the bottom, and on request the list of keys. They are drawn with the fonts and the
 * legend of `render`, once for each change. */
#ifndef CORCAST_CLI_COMMAND_VIEW_OVERLAY_H
#define CORCAST_CLI_COMMAND_VIEW_OVERLAY_H

#include "job/picture/picture.h"
#include "job/picture/sheet.h"
#include <stdint.h>

/* A line of the list of keys. Both strings are borrowed. */
typedef struct OverlayKey {
    const char *keys, *meaning;
} OverlayKey;

/* The content of an overlay. All pointers are borrowed. */
typedef struct OverlayContent {
    const Scene *scene; /* its legend is shown if its colors stand for values */
    const char *status; /* the status line, UTF-8 */
    const OverlayKey *keys;
    size_t n_keys; /* 0: no list of keys */
} OverlayContent;

typedef struct ViewOverlay {
    Sheet sheet;
    uint8_t *rgba; /* owned; per pixel: sRGB codes multiplied by the opacity, and the opacity in
                    * 0..255, rows from the top down; NULL before overlay_draw */
    int width, height;
} ViewOverlay;

/* Loads the fonts. `overlay` must be zeroed; the caller calls overlay_release even after an error.
 * Errors: as sheet_open. */
MUST_CHECK Status overlay_open(ViewOverlay *overlay, Err *err);
/* Draws the overlay of a window of this size in pixels, and sets rgba, width and height. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status overlay_draw(ViewOverlay *overlay, const OverlayContent *content, int width,
                               int height, Err *err);
void overlay_release(ViewOverlay *overlay);

#endif
