/* Draws the pictures of a window progressively. While the camera moves, pictures are drawn at 1 / k
 * of the resolution; k is the coarseness. k grows when a picture took longer than frame_s, and
 * shrinks by 1 when it did not. k does not return to a value that was too slow within the last
 * REMEMBERED pictures (hysteresis). When the camera rests, rows at full resolution replace the
 * coarse picture from the top down, and antialiased rows then replace these. Each call draws only a
 * few rows, so that the window reacts to the mouse at once. */
#include "cli/window/display.h"

#include "image/image.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Times for drawing a quick picture and for one refinement, s. The window needs the rest of 1/30 s.
 * Larger: finer pictures, fewer per second. */
static const double frame_s = 1.0 / 40, refine_s = 1.0 / 40;
/* MAX_COARSENESS: larger values draw slow scenes faster, with larger pixels. REMEMBERED: a
 * coarseness that was too slow is tried again after 60 pictures, about 2 s; larger values let the
 * resolution change less often. Reasons of the numbers not recorded. */
enum { MAX_COARSENESS = 16, REMEMBERED = 60 /* pictures */ };

struct Display {
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

Status display_new(const Geometry *geometry, const RenderParams *params, Display **out, Err *err)
{
    Display *display;
    TRY(mem_calloc(&display, 1, sizeof *display, "displays", err));
    *display = (Display){.antialias = params->antialias, .coarseness = 2, .rows = RENDER_BAND_STEP};
    Status status = renderer_new(geometry, params, &display->renderer, err);
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

/* The view that is drawn, and the appearance of its vessels. */
typedef struct Subject {
    const View *view;
    const Appearance *appearance;
} Subject;

/* Draws the rows from `first` to first + rows - 1 into the picture of the display. */
static Status draw_rows(Display *display, Subject subject, int first, int rows, int antialias,
                        Err *err)
{
    Frame band;
    size_t row = 3 * (size_t)display->width;
    renderer_antialias(display->renderer, antialias);
    TRY(renderer_rows(display->renderer, subject.view, subject.appearance, first, rows, &band,
                      err));
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

/* Chooses the coarseness of the next picture from the time of this one. The time of a coarser
 * picture is about proportional to its pixels. The time of a finer picture is only known after a
 * try. */
static void steer(Display *display, double seconds)
{
    int k = display->coarseness;
    if (++display->since > REMEMBERED)
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

Status display_quick(Display *display, const View *view, const Appearance *appearance,
                     DisplayPicture *picture, Err *err)
{
    View coarse = *view;
    Camera *camera = &coarse.camera;
    int k = display->coarseness;
    double start_s = clock_seconds();
    camera->width = (camera->width + k - 1) / k;
    camera->height = (camera->height + k - 1) / k;
    Status status = set_size(display, camera->width, camera->height, err);
    if (status == STATUS_OK)
        status = draw_rows(display, (Subject){&coarse, appearance}, 0, camera->height, 1, err);
    display->pass = k > 1 ? 0 : 1;
    display->next = k > 1 ? 0 : camera->height;
    steer(display, clock_seconds() - start_s);
    *picture = picture_of(display);
    return status;
}

/* Enlarges the coarse picture to the pixels of the window. */
static Status enlarge(Display *display, const Camera *camera, Err *err)
{
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

/* The number of rows at a time doubles as long as they take less than a quarter of refine_s, so
 * that a call ends in about this time. */
Status display_refine(Display *display, const View *view, const Appearance *appearance,
                      DisplayPicture *picture, bool *done, Err *err)
{
    int height = view->camera.height, passes = display->antialias > 1 ? 2 : 1;
    if (display->pass == 0)
        TRY(enlarge(display, &view->camera, err));
    if (display->pass == 0 || (display->next == height && display->pass < passes)) {
        display->pass++;
        display->next = 0;
        display->rows = RENDER_BAND_STEP;
    }
    double end_s = clock_seconds() + refine_s;
    while (display->next < height && clock_seconds() < end_s) {
        int left = height - display->next, rows = display->rows < left ? display->rows : left;
        double start_s = clock_seconds();
        TRY(draw_rows(display, (Subject){view, appearance}, display->next, rows,
                      display->pass == 1 ? 1 : display->antialias, err));
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
