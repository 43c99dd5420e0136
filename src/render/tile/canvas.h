/* Converts traced tiles to pixels: shades their samples, encodes the colors, and stores them in the
 * planes of a band of an image. A band is drawn in a first pass, with one sample at the centre of
 * each pixel, and, for antialiasing, a second pass with the further samples of pixels. The
 * functions below draw the first pass; canvas_shade, canvas_draw_thin and canvas_copy also serve
 * the second.
 *
 *     TRY_GOTO(canvas_init(&drawing, frame, &eye, &canvas, err));
 *     // per worker, for some rows of tiles:
 *     canvas_begin_rows(&canvas, worker, first);
 *     // per tile:
 *     color = canvas_shade(&canvas, worker, &traced, NULL);
 *     canvas_store(&canvas, worker, &traced, color);
 *     // per worker, after its rows:
 *     canvas_end_rows(&canvas, worker, end);
 *     canvas_release(&canvas);
 *
 * Nothing is allocated after canvas_init. Workers draw different rows at the same time. */
#ifndef CORCAST_RENDER_TILE_CANVAS_H
#define CORCAST_RENDER_TILE_CANVAS_H

#include "render/light/resample.h"
#include "render/planes.h"
#include "render/tile/thincells.h"
#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* Returns the shading properties of a surface: the finish, and the lights and the background color
 * of the view, in the frame of a viewpoint. */
TileShading tileshading_make(const View *view, const Finish *finish, const Viewpoint *eye);

/* The workspace of one thread. */
typedef struct CanvasWorker {
    TileSurface surface, ground; /* hits of vessels, and hits of the ground */
    float ambient[TILE_SAMPLES]; /* ambient visibility of the samples, of vessels and ground */
    float fade[TILE_SAMPLES]; /* per sample that hits a vessel: fraction of the background's color
                               * that is mixed in, 0 to 1 */
    float light_visibility[VIEW_MAX_LIGHTS][TILE_SAMPLES];
    float color[3][TILE_SAMPLES]; /* colors of the current tile */
    int row, column;              /* position of the upper left pixel of the first tile that is not
                                   * stored yet */
} CanvasWorker;

/* The state of one band. While rows are drawn, only the workspaces `each` change, one per
 * thread. */
typedef struct Canvas {
    const Drawing *drawing; /* borrowed */
    Frame *frame;           /* borrowed */
    Viewpoint eye;
    const TileKernels *kernels;
    bool needs_points;   /* true: shading reads TileHits.z, because lights, visibility or colors
                          * depend on the position of the hit */
    bool wants_color;    /* the frame has colors or codes */
    bool wants_geometry; /* the frame has depths, normals or ids */
    bool engine_colors_background; /* true: the caller also passes colors for samples without a hit;
                                    * false after canvas_init, set by tilerender.c */
    TileShading look, ground_look;
    Resampling more;   /* the further samples of antialiasing; owned, as are all pointers below */
    SrgbCodes codes;   /* set if the frame stores codes */
    float *background; /* colors of one row of the background */
    float *blank;      /* colors of one row of the image for the pixels of tiles that are not
                        * drawn */
    uint8_t *background_codes;
    CanvasWorker *each; /* per worker */
    int workers;
} Canvas;

/* Sets up a canvas for the drawing's band; `frame` must have the planes of the band. Release the
 * canvas with canvas_release, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status canvas_init(const Drawing *drawing, Frame *frame, const Viewpoint *eye,
                              Canvas *canvas, Err *err);
void canvas_release(Canvas *canvas);

/* Sets the color of pixels in tiles that are not drawn to the mean of all their samples, each of
 * the background's color. By rounding, the mean may differ from the background in the last digit,
 * as it does for pixels without a hit in tiles that are drawn. */
void canvas_average_undrawn(Canvas *canvas);

/* Begin and end the drawing of the rows of tiles [first, end) by a worker, in the pass of the
 * centre samples. Rows are counted from the top of the picture. canvas_end_rows fills the tiles
 * that were not passed to canvas_store with the background. */
void canvas_begin_rows(const Canvas *canvas, int worker, int first);
void canvas_end_rows(const Canvas *canvas, int worker, int end);

/* Returns the index in the frame's planes of the picture's pixel at (column, row). */
static inline size_t canvas_pixel(const Canvas *canvas, int column, int row)
{
    return (size_t)(row - canvas->drawing->band.first) *
               (size_t)canvas->drawing->view->camera.width +
           (size_t)column;
}

/* Adds the view's ground plane to a tile: adds hits of the ground to *hits where no vessel is
 * nearer, and sets traced->ground, the mask of their samples, and, if there are any, traced->hits
 * to `hits`. If traced->hits is not NULL, *hits must already contain the hits of vessels. */
void canvas_trace_ground(const Canvas *canvas, TracedTile *traced, TileHits *hits);

/* Shades the samples of a tile, which must have hits. Samples without a hit get the background, but
 * only if the frame stores float colors, not codes.
 *
 * shadowed  shadowed[light][sample] is 1 if the sample is in the shadow of the light; NULL: no
 *           sample is in shadow.
 * Returns   the colors, in the workspace of the worker; valid until the worker's next call. */
float (*canvas_shade(const Canvas *canvas, int worker, const TracedTile *traced,
                     const uint8_t (*shadowed)[TILE_SAMPLES]))[TILE_SAMPLES];

/* Draws thin vessels over the colors of a tile, whose hits must have depths.
 *
 * cells    the thin vessels [thincells.h]. With N x N cells per pixel, sample (i, j) of the tile
 *          has the cell (i * N + x, j * N + y).
 * x, y     cell of sample (0, 0): the position of the pass's sample in its pixel, 0 to N - 1.
 * color    the result of canvas_shade; NULL: all samples have the background's color.
 * Returns  the colors in the workspace of the worker; or `color`, if no thin vessel touches the
 *          tile. */
float (*canvas_draw_thin(const Canvas *canvas, int worker, const TracedTile *traced,
                         ThinCells *cells, int x, int y,
                         float (*color)[TILE_SAMPLES]))[TILE_SAMPLES];

/* Stores a tile of centre samples in the planes of the frame. A worker must store its tiles row by
 * row, from left to right. `color` NULL: all samples have the background's color. */
void canvas_store(const Canvas *canvas, int worker, const TracedTile *traced,
                  float color[3][TILE_SAMPLES]);

/* Copies the first `columns` and `rows` of a tile's colors to rows of pixels; `stride` is the
 * number of floats from one row to the next. `color` NULL: all samples have the background's
 * color. */
void canvas_copy(const Canvas *canvas, int columns, int rows, float color[3][TILE_SAMPLES],
                 float *pixels, size_t stride);

#endif
