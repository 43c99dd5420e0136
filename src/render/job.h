/* The types that the engines of the module render share: the parameters of a renderer
 * (RenderParams), its statistics (RenderStats), and the input of an engine (Drawing).
 *
 * A sample is one ray through the image. A pixel has one centre sample, and N x N further samples
 * if it is antialiased. A band is a range of rows that is drawn in one call. The planes of a frame
 * are color and, per pixel, depth, normal and id. */
#ifndef CORCAST_RENDER_JOB_H
#define CORCAST_RENDER_JOB_H

#include "base/base.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

/* How primitives and blobs are drawn. */
typedef enum RenderMethod {
    RENDER_TRACE,   /* ray by ray in double precision, as POV-Ray does */
    RENDER_RASTER,  /* tile by tile in single precision: the same picture except for rounding */
    RENDER_ZBUFFER, /* points on the surfaces of primitives and a depth buffer [N in
                     * docs/METHODS.md] */
    RENDER_FASTEST  /* RENDER_RASTER if it supports the scene, else RENDER_TRACE. The difference
                     * from RENDER_TRACE is that of single precision, within tier B of `corcast
                     * compare`, except for the visibility that the samples of a pixel share */
} RenderMethod;

/* The instruction set that draws several samples of a tile at once. Pictures differ between
 * instruction sets in the last digits of single precision. Pictures of primitives and blobs by
 * RENDER_TRACE do not differ. */
typedef enum RenderKernels {
    KERNELS_FASTEST,  /* the fastest that this processor has */
    KERNELS_PORTABLE, /* any processor */
    KERNELS_AVX2,     /* AVX2 with FMA */
    KERNELS_AVX512
} RenderKernels;

/* The names of RenderKernels, in the order of the enum; NULL ends the list. */
extern const char *const render_kernel_names[];

/* Maximum of RenderParams.antialias: the maximum of POV-Ray's Antialias_Depth. */
enum { RENDER_MAX_ANTIALIAS = 9 };

/* Parameters of a renderer. */
typedef struct RenderParams {
    /* The method for primitives and blobs; an isosurface has its own engine. The method also
     * selects shadows and occlusion, for every geometry. RENDER_TRACE traces rays for them for each
     * sample. The other methods share soft shadows and occlusion among the samples of a pixel
     * [render/light/visibility.h], and compute hard shadows with light views. */
    RenderMethod method;
    RenderKernels kernels;
    int threads;                /* number of threads; 0: one per processor */
    int antialias;              /* 1: one sample, at each pixel's centre. N in
                                 * 2..RENDER_MAX_ANTIALIAS: the centre sample and N x N further
                                 * samples, at the same positions and with the same weights as
                                 * POV-Ray with +A0.0 +AM1 +RN -J */
    double antialias_threshold; /* 0: every pixel gets the N x N further samples, as in POV-Ray. In
                                 * (0, 1]: only pixels that differ from a neighbour by at least this
                                 * much in the square root of a channel; POV-Ray has no such mode */
    bool shadows;
    double shadow_from_mm; /* blockers nearer than this to a shading point cast no shadow on it; 0:
                            * POV-Ray's limit, 0.001 mm */
    int occlusion;         /* 0: no ambient occlusion. N > 0: ambient visibility from N rays per
                            * sample (RENDER_TRACE) or from N occlusion directions per pixel.
                            * POV-Ray has no ambient occlusion */
    /* true: thin vessels are drawn by the area that they cover in each pixel, which POV-Ray cannot
     * do. A vessel is thin if it is narrower than both a pixel and three sample distances: wider
     * vessels are hit by enough samples. false: samples hit or miss thin vessels like other
     * vessels. The planes of depth, normal and id contain the hits of centre samples in both
     * cases. */
    bool cover_thin;
    double min_width_px;                               /* minimum drawn width of vessels, pixels,
                                                        * 0..64; 0: true widths */
    const CellParams *povray_cells;                    /* the cells in which POV-Ray's root finder
                                                        * searches; an isosurface is then drawn
                                                        * where this root finder finds it. NULL: the
                                                        * isosurface is drawn at its proven
                                                        * position */
    bool codes_suffice;                                /* true: the frame may receive 8-bit sRGB
                                                        * codes instead of float colors, if codes
                                                        * are faster. Set it only if no alpha is
                                                        * needed: a transparent view is then drawn
                                                        * on its background color */
    bool want_color, want_depth, want_normal, want_id; /* planes of the frame to draw; depth, normal
                                                        * and id are those of the centre sample */
    bool (*progress)(double fraction, void *context);  /* called by one thread at a time with the
                                                        * finished fraction, 0..1; returns false to
                                                        * stop. NULL: no progress is reported */
    void *progress_context;
} RenderParams;

/* Statistics of a renderer. */
typedef struct RenderStats {
    double prepare_s;    /* wall time for building search structures and preparing views, seconds */
    double trace_s;      /* wall time for drawing pixels, seconds */
    double cpu_s;        /* CPU time of all threads for both, seconds */
    size_t rays;         /* number of primary rays */
    const char *engine;  /* the engine that drew the last rows, such as "field" or "raster" */
    size_t preparations; /* number of times that an engine was prepared for a view: for another
                          * camera, lights, ground plane or antialiasing, or because colors
                          * are wanted after only other planes were drawn */
} RenderStats;

/* Adds the statistics of another renderer, which drew last: `engine` becomes the engine of `more`.
 * `preparations` is not added. */
void renderstats_add(RenderStats *all, const RenderStats *more);

/* The rows [first, first + rows) of an image, counted from the top. The first `above` and the last
 * `below` of these rows are drawn only as neighbours, because adaptive antialiasing compares pixels
 * with their neighbours. They get no further samples and are removed from the result. */
typedef struct Band {
    int first, rows;
    int above, below;
} Band;

/* The input of an engine: a band of an image of one geometry. All pointers are borrowed. */
typedef struct Drawing {
    const Geometry *geometry;
    const View *view;
    const Appearance *appearance;
    const RenderParams *params;
    struct Caster *caster;                    /* traces rays; NULL: the engine traces no rays */
    const TermMean *mean;                     /* interpolates the colors of segments; NULL: colors
                                               * are not interpolated */
    const struct PixelVisibility *visibility; /* visibility that the samples of a pixel share; NULL:
                                               * no visibility is shared */
    const bool *hidden;                       /* per primitive, or per segment of an implicit
                                               * surface: true if it is not visible to the camera
                                               * but casts shadows; NULL: none is hidden */
    const struct ThinLayer *thin;             /* thin vessels that are drawn over each sample; NULL:
                                               * none */
    Band band;
} Drawing;

/* Returns the linear color of a segment at a point of its surface. `segment` is a segment index
 * [scene/geometry.h], `point` is in mm. */
Rgb drawing_color(const Drawing *drawing, uint32_t segment, Vec3 point);

/* Reports the progress of the whole image to params->progress. Does nothing if params->progress is
 * NULL or `worker` is not 0. Errors: STATUS_CANCELLED if the callback returns false.
 *
 * worker   index of the calling thread.
 * further  true: the pass draws the further samples of antialiasing; false: the centre samples.
 * rows     number of rows of the band that this pass has drawn. */
MUST_CHECK Status drawing_progress(const Drawing *drawing, int worker, bool further, size_t rows,
                                   Err *err);

#endif
