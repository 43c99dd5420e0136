/* A window that shows a picture and hears mouse and keyboard; the only place that knows SDL. */
#ifndef CORCAST_CLI_WINDOW_WINDOW_H
#define CORCAST_CLI_WINDOW_WINDOW_H

#include "base/base.h"
#include <stdint.h>

typedef struct Window Window;

typedef enum WindowEventKind {
    WINDOW_NOTHING, /* nothing has happened */
    WINDOW_QUIT,
    WINDOW_KEY,   /* `key` */
    WINDOW_DRAG,  /* `x` and `y`, pixels right and down; with `button` */
    WINDOW_WHEEL, /* `y`, steps away from the user */
    WINDOW_SIZE,  /* `x` and `y`, pixels */
    WINDOW_EXPOSED
} WindowEventKind;

enum { WINDOW_KEY_ESCAPE = 27, WINDOW_LEFT = 1, WINDOW_MIDDLE = 2, WINDOW_RIGHT = 3 };

typedef struct WindowEvent {
    WindowEventKind kind;
    int key;    /* what it types, in lower case, or WINDOW_KEY_ESCAPE */
    int button; /* WINDOW_LEFT, ...; the left one with shift held is WINDOW_MIDDLE */
    double x, y;
} WindowEvent;

/* Opens a window whose inside has this size. STATUS_TOOL when there is no display, or no SDL 2. */
MUST_CHECK Status window_open(Window **out, const char *title, int width, int height, Err *err);
void window_close(Window *window);

/* The next event, if there is one; waits for it when `wait`. */
WindowEvent window_event(Window *window, bool wait);

/* Shows a picture of 8-bit red, green and blue, rows from the top down, stretched over the
 * window. */
MUST_CHECK Status window_show(Window *window, const uint8_t *rgb, int width, int height, Err *err);
void window_title(Window *window, const char *title);

/* Appends the version of SDL that a window would use, or why there is none. */
void window_put_library(Text *text);

#endif
