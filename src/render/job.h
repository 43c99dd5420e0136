/* The parameters of a renderer, and the drawing that it passes to an engine. */
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
    RENDER_ZBUFFER, /* points on the surfaces of primitives and a depth buffer, as in the paper */
    RENDER_FASTEST  /* RENDER_RASTER where it supports the scene, else rays. Within the bounds of
                     * tier B [verify.h], except for the visibility that samples share */
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

/* The names of RenderKernels, in order; NULL ends the list. */
extern const char *const render_kernel_names[];

enum { RENDER_MAX_ANTIALIAS = 9 };

typedef struct RenderParams {
    /* How primitives and blobs are drawn; an isosurface has an engine of its own. For every
     * geometry, RENDER_TRACE traces the rays of shadows and occlusion for each sample. The other
     * methods share soft shadows and occlusion among the samples of a pixel
     * [render/light/visibility.h], and find hard shadows by light views. */
    RenderMethod method;
    RenderKernels kernels;
    int threads;                /* 0: all processors */
    int antialias;              /* 1: one ray through each pixel's centre. N in
                                 * 2..RENDER_MAX_ANTIALIAS: that ray and N x N more, with the
                                 * positions and weights of POV-Ray's +A0.0 +AM1 +RN -J */
    double antialias_threshold; /* 0: every pixel gets the N x N more rays, as in POV-Ray. In (0,
                                 * 1]: only pixels that differ from a neighbour by this much in the
                                 * square root of a channel; POV-Ray has no such mode */
    bool shadows;
    double shadow_from_mm; /* blockers nearer to a lit point cast no shadow on it; 0: POV-Ray's
                            * limit, 0.001 mm */
    int occlusion; /* 0: ambient light is the same everywhere. N: ambient visibility by N rays, or N
                    * occlusion directions per pixel; POV-Ray has no such mode */
    /* Vessels narrower than a pixel, and than three sample distances, are drawn by the area that
     * they cover; POV-Ray has no such mode. False: samples hit or miss these vessels, too. Planes
     * of geometry have what samples hit in either case. */
    bool cover_thin;
    double
        min_width_px; /* minimum drawn width of such vessels, pixels, 0..64; 0 draws true widths */
    const CellParams *povray_cells; /* an isosurface is drawn where POV-Ray's root finder finds it
                                     * in these cells; NULL: where it is, by proof */
    bool codes_suffice; /* the frame may have 8-bit codes instead of float colors, if that is
                         * faster; a transparent view may have its background and no alpha */
    bool want_color, want_depth, want_normal, want_id; /* geometry planes are of the centre ray */
    bool (*progress)(double fraction, void *context);  /* called by one thread; false: stop; may be
                                                        * NULL */
    void *progress_context;
} RenderParams;

/* What a renderer has done. */
typedef struct RenderStats {
    double prepare_s;    /* wall time for search structures and for what views need */
    double trace_s;      /* wall time for pixels */
    double cpu_s;        /* time of all threads for both */
    size_t rays;         /* number of primary rays */
    const char *engine;  /* the engine that drew the last rows, such as "field" or "raster" */
    size_t preparations; /* how often an engine was prepared for a view: for another camera, lights,
                          * ground plane or antialiasing, or for colors after planes */
} RenderStats;

/* Adds the statistics of another renderer, whose engine drew last. `preparations` is not added. */
void renderstats_add(RenderStats *all, const RenderStats *more);

/* The rows [first, first + rows) of a picture. The first `above` and the last `below` of them are
 * drawn only because adaptive antialiasing compares pixels with their neighbours. They get no
 * further samples and are cut off at the end. */
typedef struct Band {
    int first, rows;
    int above, below;
} Band;

/* A band of a picture of one geometry, for an engine. All pointers are borrowed. */
typedef struct Drawing {
    const Geometry *geometry;
    const View *view;
    const Appearance *appearance;
    const RenderParams *params;
    struct Caster *caster; /* casts the engine's rays; NULL: the engine casts none */
    const TermMean *mean;  /* blends the colors of segments; NULL: colors do not blend */
    const struct PixelVisibility *visibility; /* shared by the samples of a pixel; NULL: none is */
    const bool *hidden; /* per primitive, or per segment of a field: not visible to the camera, but
                         * casts shadows; NULL: none is hidden */
    const struct ThinLayer *thin; /* thin vessels that are drawn over each sample; NULL: none */
    Band band;
} Drawing;

/* Returns the linear color of a segment at a point of its surface. */
Rgb drawing_color(const Drawing *drawing, uint32_t segment, Vec3 point);

/* Reports progress of the whole picture by params->progress, unless it is NULL. Errors:
 * STATUS_CANCELLED if the callback asks to stop.
 *
 * height   of the picture, pixels.
 * further  the pass draws the further samples of antialiasing; else the centre samples.
 * part     finished part of this pass over the band, 0..1. */
MUST_CHECK Status band_progress(const Band *band, const RenderParams *params, int height,
                                bool further, double part, Err *err);

#endif
