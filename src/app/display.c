/* While the camera moves, a pixel stands for k x k of the window, k steered by the clock: what
 * takes longer than the time of a frame makes k larger, what takes less makes it smaller by 1,
 * unless that took too long a short while ago. When it rests, the coarse picture is replaced from
 * the top down by the whole one and that by the antialiased one, some rows at a time, so that a
 * hand on the mouse never waits for more than a few rows. */
#include "app/display.h"

#include "image/image.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* For drawing; the rest of a thirtieth of a second goes into the window. */
static const double frame_s = 1.0 / 40, refine_s = 1.0 / 40;
enum { MAX_COARSENESS = 16, WHILE = 60 /* pictures */ };

struct Display {
    Scene *scene;
    Renderer *renderer;
    int antialias;
    int coarseness;
    int too_slow, since; /* a coarseness that took too long, or 0, and how many pictures ago */
    uint8_t *rgb;        /* owned */
    size_t capacity;
    int width, height; /* of rgb */
    int pass;          /* 0: coarse; 1: every pixel; 2: antialiased */
    int next;          /* row of this pass */
    int rows;          /* at a time */
};

Status display_new(Scene *scene, const RenderParams *params, Display **out, Err *err)
{
    Display *display;
    TRY(mem_calloc(&display, 1, sizeof *display, "displays", err));
    *display = (Display){
        .scene = scene, .antialias = params->antialias, .coarseness = 2, .rows = RENDER_BAND_STEP};
    Status status = renderer_new(scene, params, &display->renderer, err);
    if (status != STATUS_OK) {
        display_free(display);
        return status;
    }
    *out = display;
    return STATUS_OK;
}

void display_free(Display *display)
{
    if (!display)
        return;
    renderer_free(display->renderer);
    free(display->rgb);
    free(display);
}

int display_coarseness(const Display *display)
{
    return display->coarseness;
}

void display_set_coarseness(Display *display, int coarseness)
{
    display->coarseness = coarseness;
}

static Status set_size(Display *display, int width, int height, Err *err)
{
    TRY(mem_reserve(&display->rgb, &display->capacity, (size_t)width * (size_t)height * 3, 1,
                    "bytes of a picture", err));
    display->width = width;
    display->height = height;
    return STATUS_OK;
}

/* Rows first .. first + rows of the scene's picture go to the display's. */
static Status draw_rows(Display *display, int first, int rows, int antialias, Err *err)
{
    Frame band;
    size_t row = 3 * (size_t)display->width;
    renderer_antialias(display->renderer, antialias);
    TRY(renderer_rows(display->renderer, first, rows, &band, err));
    Status status = STATUS_OK;
    if (!band.codes.codes8)
        status = picture_from_plane(&band.codes, &band.color, ENCODING_SRGB, 8, err);
    if (status == STATUS_OK)
        memcpy(display->rgb + (size_t)first * row, band.codes.codes8, (size_t)rows * row);
    frame_release(&band);
    return status;
}

static DisplayPicture picture_of(const Display *display)
{
    return (DisplayPicture){display->rgb, display->width, display->height};
}

/* A coarser picture takes time in proportion to its pixels, more or less; of a finer one nothing is
 * known but what was tried. */
static void steer(Display *display, double seconds)
{
    int k = display->coarseness;
    if (++display->since > WHILE)
        display->too_slow = 0;
    if (seconds > frame_s) {
        display->too_slow = k;
        display->since = 0;
        k = (int)ceil(k * sqrt(seconds / frame_s));
    } else if (k - 1 > display->too_slow) {
        k--;
    }
    display->coarseness = k < MAX_COARSENESS ? k : MAX_COARSENESS;
}

Status display_quick(Display *display, DisplayPicture *picture, Err *err)
{
    Camera *camera = &display->scene->camera;
    int width = camera->width, height = camera->height, k = display->coarseness;
    double start_s = clock_seconds();
    camera->width = (width + k - 1) / k;
    camera->height = (height + k - 1) / k;
    Status status = set_size(display, camera->width, camera->height, err);
    if (status == STATUS_OK)
        status = draw_rows(display, 0, camera->height, 1, err);
    camera->width = width;
    camera->height = height;
    display->pass = k > 1 ? 0 : 1;
    display->next = k > 1 ? 0 : height;
    steer(display, clock_seconds() - start_s);
    *picture = picture_of(display);
    return status;
}

/* The coarse picture with the pixels of the window. */
static Status enlarge(Display *display, Err *err)
{
    const Camera *camera = &display->scene->camera;
    int width = display->width, height = display->height;
    uint8_t *coarse = display->rgb;
    display->rgb = NULL;
    display->capacity = 0;
    Status status = set_size(display, camera->width, camera->height, err);
    for (int y = 0; y < camera->height && status == STATUS_OK; y++)
        for (int x = 0; x < camera->width; x++) {
            size_t from = (size_t)(y * (long long)height / camera->height) * (size_t)width +
                          (size_t)(x * (long long)width / camera->width);
            size_t to = (size_t)y * (size_t)camera->width + (size_t)x;
            memcpy(display->rgb + 3 * to, coarse + 3 * from, 3);
        }
    free(coarse);
    return status;
}

Status display_refine(Display *display, DisplayPicture *picture, bool *done, Err *err)
{
    int height = display->scene->camera.height, passes = display->antialias > 1 ? 2 : 1;
    if (display->pass == 0)
        TRY(enlarge(display, err));
    if (display->pass == 0 || (display->next == height && display->pass < passes)) {
        display->pass++;
        display->next = 0;
        display->rows = RENDER_BAND_STEP;
    }
    double end_s = clock_seconds() + refine_s;
    while (display->next < height && clock_seconds() < end_s) {
        int left = height - display->next, rows = display->rows < left ? display->rows : left;
        double start_s = clock_seconds();
        TRY(draw_rows(display, display->next, rows, display->pass == 1 ? 1 : display->antialias,
                      err));
        display->next += rows;
        if (clock_seconds() - start_s < refine_s / 4)
            display->rows *= 2;
        else if (display->rows > RENDER_BAND_STEP && clock_seconds() - start_s > refine_s)
            display->rows /= 2;
    }
    *done = display->next == height && display->pass >= passes;
    *picture = picture_of(display);
    return STATUS_OK;
}
