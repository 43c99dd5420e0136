/* A band of a picture while it is drawn tile by tile, whatever engine finds what the tiles see: how
 * tiles are shaded, encoded and stored, in how many passes, and by which threads. */
#ifndef CORCAST_RENDER_CANVAS_H
#define CORCAST_RENDER_CANVAS_H

#include "render/light/resample.h"
#include "render/planes.h"
#include "render/tile/thincells.h"
#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* A finish, and the lights of a view in the frame of a viewpoint. */
TileLook tilelook_of(const View *view, const Finish *finish, const Viewpoint *eye);

/* What one thread works with. */
typedef struct CanvasWorker {
    TileSurface surface, ground; /* of vessels and of the ground */
    float open[TILE_SAMPLES];    /* of both, what samples share: */
    float parts[VIEW_MAX_LIGHTS][TILE_SAMPLES];
    float color[3][TILE_SAMPLES]; /* of the tile at hand */
    int row, column;              /* the first tile that is not drawn yet, in pixels */
} CanvasWorker;

/* Constant while rows are drawn, but for the workers, each its thread's own. */
typedef struct Canvas {
    const Drawing *drawing; /* borrowed */
    Frame *frame;           /* borrowed */
    Viewpoint eye;
    const TileKernels *kernels;
    bool needs_places; /* light, sight or colours differ from place to place: shading asks for
                        * TileHits.z */
    bool wants_color, wants_geometry;
    bool wholly_colored; /* the engine sets colours where nothing is seen, too; at first false */
    TileLook look, ground_look;
    Resampling more;   /* owned, as all that follows */
    SrgbCodes codes;   /* if the frame has codes */
    float *background; /* a row of the picture */
    float *blank;      /* what pixels of tiles that are not drawn become: a row of the picture */
    uint8_t *background_codes;
    CanvasWorker *each;
    int workers;
} Canvas;

/* Sets up the canvas (owned by the caller even when this fails) for the drawing's band, whose
 * planes the frame has. STATUS_MEMORY. */
MUST_CHECK Status canvas_init(const Drawing *drawing, Frame *frame, const Viewpoint *eye,
                              Canvas *canvas, Err *err);
void canvas_release(Canvas *canvas);

/* From now on pixels of tiles that are not drawn have the mean of their background's samples,
 * which need not be the background in the last digit. */
void canvas_blank_is_mean(Canvas *canvas);

/* Draws so many rows of tiles of the picture, `first` counted from its top. */
typedef Status CanvasRows(void *context, int first, int rows, int worker, Err *err);

/* Calls `draw` for all rows of tiles of the band, so many at once, one worker each, and says how
 * far it is; the first failure is returned. In the pass of the centre samples (`further` false)
 * tiles that canvas_draw has not been given are blank. */
MUST_CHECK Status canvas_pass(Canvas *canvas, bool further, int at_once, CanvasRows *draw,
                              void *context, Err *err);

/* Which pixels get further samples, by the colours of the centre samples. STATUS_MEMORY. */
MUST_CHECK Status canvas_choose(Canvas *canvas, Err *err);

/* Index of a pixel of the picture in the frame's planes. */
static inline size_t canvas_pixel(const Canvas *canvas, int column, int row)
{
    return (size_t)(row - canvas->drawing->band.first) *
               (size_t)canvas->drawing->view->camera.width +
           (size_t)column;
}

/* Sets what samples see of the view's ground, where no vessel is before it, in *hits, which has
 * what they see of vessels if seen->hits is not NULL, and in *seen. */
void canvas_see_ground(const Canvas *canvas, SeenTile *seen, TileHits *hits);

/* The colours of a tile's samples, the background's where nothing is seen; the latter is left out
 * if the frame has codes. `seen` has hits. shadowed[light][sample]: whether the sample gets none of
 * the light; NULL: none is. The colours are the worker's until the next call. */
float (*canvas_shade(const Canvas *canvas, int worker, const SeenTile *seen,
                     const uint8_t (*shadowed)[TILE_SAMPLES]))[TILE_SAMPLES];

/* Draws thin vessels over the colours of a tile's samples, whose hits have depths. Sample (i, j) of
 * the tile has cell (i * step + x, j * step + y) of `cells`, step being the number of cells per
 * sample. `color` is the worker's, from canvas_shade; NULL: the background's. Returns the worker's
 * colours, or `color` if no thin vessel touches the tile. */
float (*canvas_cover(const Canvas *canvas, int worker, const SeenTile *seen, ThinCells *cells,
                     int x, int y, float (*color)[TILE_SAMPLES]))[TILE_SAMPLES];

/* Stores a tile of the centre samples in the planes of the frame; tiles go row by row, and
 * from left to right. `color` NULL: the background's. */
void canvas_draw(const Canvas *canvas, int worker, const SeenTile *seen,
                 float color[3][TILE_SAMPLES]);

/* Stores the first columns and rows of a tile's colours in rows of pixels, `stride` floats from one
 * to the next; color NULL: the background's. */
void canvas_store(const Canvas *canvas, int columns, int rows, float color[3][TILE_SAMPLES],
                  float *pixels, size_t stride);

#endif
