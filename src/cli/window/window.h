/* A window that shows an image and receives mouse and keyboard events. No other module uses SDL.
 * All functions must be called from the thread that opened the window. */
#ifndef CORCAST_CLI_WINDOW_WINDOW_H
#define CORCAST_CLI_WINDOW_WINDOW_H

#include "base/base.h"
#include <stdint.h>

typedef struct Window Window;

typedef enum WindowEventKind {
    WINDOW_NOTHING, /* nothing has happened */
    WINDOW_QUIT,
    WINDOW_KEY,    /* sets `key` */
    WINDOW_DRAG,   /* sets `button`, and `x` and `y`: movement right and down, pixels */
    WINDOW_WHEEL,  /* sets `y`: steps of the wheel, positive away from the user */
    WINDOW_SIZE,   /* sets `x` and `y`: new width and height, pixels */
    WINDOW_EXPOSED /* the window must be redrawn with window_show */
} WindowEventKind;

enum { WINDOW_KEY_ESCAPE = 27, WINDOW_LEFT = 1, WINDOW_MIDDLE = 2, WINDOW_RIGHT = 3 };

typedef struct WindowEvent {
    WindowEventKind kind;
    int key;    /* lower-case character of the key, or WINDOW_KEY_ESCAPE */
    int button; /* WINDOW_LEFT, ...; the left one with shift held is WINDOW_MIDDLE */
    double x, y;
} WindowEvent;

/* Opens a window. `width` and `height` are the size of its content in pixels. Close *out with
 * window_close. Errors: STATUS_TOOL if there is no display, or the library SDL 2 is missing;
 * STATUS_MEMORY. */
MUST_CHECK Status window_open(Window **out, const char *title, int width, int height, Err *err);
void window_close(Window *window);

/* Returns the next event. If there is none, waits for one if `wait` is true, else returns
 * WINDOW_NOTHING. */
WindowEvent window_event(Window *window, bool wait);

/* Shows an image, scaled to the size of the window. `rgb` has 8 bits per channel, sRGB, rows from
 * top to bottom; it is copied. Errors: STATUS_TOOL. */
MUST_CHECK Status window_show(Window *window, const uint8_t *rgb, int width, int height, Err *err);
/* Sets an image that later calls of window_show draw over theirs, without scaling. It is not drawn
 * while the window has another size.
 *
 * rgba  borrowed until the next call; per pixel: sRGB codes multiplied by the opacity
 *       (premultiplied alpha), and the opacity, 0 to 255; rows from top to bottom. NULL: no image.
 */
void window_overlay(Window *window, const uint8_t *rgba, int width, int height);
void window_title(Window *window, const char *title);

/* Appends the version of SDL that window_open would use, or the reason why SDL cannot be used. */
void window_put_library(Text *text);

#endif
