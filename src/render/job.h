/* What is asked of a renderer, and which rows of the picture it draws at a time. */
#ifndef CORCAST_RENDER_JOB_H
#define CORCAST_RENDER_JOB_H

#include "base/base.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

/* How primitives and blobs are drawn. */
typedef enum RenderMethod {
    RENDER_TRACE,   /* ray by ray in double precision, as POV-Ray does */
    RENDER_RASTER,  /* tile by tile in single precision: the same picture but for rounding */
    RENDER_ZBUFFER, /* by points of the surfaces of primitives and a depth buffer, as the paper does
                     */
    RENDER_FASTEST  /* the fastest within the bounds of tier B [verify.h], but for what samples
                     * share: RENDER_RASTER of what it takes, rays of the rest */
} RenderMethod;

/* The instructions that a tile's samples are drawn with, several at once: those of any processor,
 * AVX2 with FMA, AVX-512. Other pictures than RENDER_TRACE's of primitives and blobs may differ in
 * the last digits of single precision from one to the next. */
typedef enum RenderKernels {
    KERNELS_FASTEST, /* of those that this processor has */
    KERNELS_PORTABLE,
    KERNELS_AVX2,
    KERNELS_AVX512
} RenderKernels;

/* Their names, in order; NULL ends them. */
extern const char *const render_kernel_names[];

enum { RENDER_MOST_ANTIALIAS = 9 };

typedef struct RenderParams {
    /* Of primitives and blobs; an isosurface has an engine of its own. For all of them RENDER_TRACE
     * says that shadows and occlusion are found for every sample, by rays; else soft shadows and
     * occlusion are shared by the samples of a pixel [render/light/visibility.h], and hard shadows
     * are those of the lights' views. */
    RenderMethod method;
    RenderKernels kernels;
    int threads;                /* 0: all processors */
    int antialias;              /* 1: one ray through each pixel's centre; N > 1, at most
                                 * RENDER_MOST_ANTIALIAS: that ray and N x N more, the
                                 * places and weights of POV-Ray's +A0.0 +AM1 +RN -J */
    double antialias_threshold; /* 0: every pixel gets the N x N more, as in POV-Ray; else, in
                                 * (0, 1], those only that differ from a neighbour by so much in
                                 * the square root of a channel, which no POV-Ray picture repeats */
    bool shadows;
    double shadow_from_mm; /* what is nearer to a lit place casts no shadow on it; 0: POV-Ray's
                            * limit, 0.001 mm */
    int occlusion;   /* 0: ambient light is the same everywhere; N: the part of it that reaches a
                      * point is found by N rays, or N beams a pixel, which no POV-Ray picture
                      * repeats */
    bool cover_thin; /* vessels narrower than a pixel, and than three sample distances, are drawn by
                      * the area that they cover of it, which no POV-Ray picture repeats; else
                      * samples hit or miss them. Planes of geometry have what samples hit in any
                      * case */
    double least_px; /* minimum width that such vessels are drawn with, pixels, from 0 to 64; what
                      * is narrower is drawn by area; 0 draws true widths */
    const CellParams *povray_cells; /* an isosurface is drawn where POV-Ray's root finder sees it in
                                     * these cells; NULL: where it is, by proof */
    bool codes_suffice; /* the frame may have 8-bit codes instead of colours, where that is faster,
                         * and of transparent views the background */
    bool want_color, want_depth, want_normal, want_id; /* geometry planes are of the centre ray */
    void (*progress)(double fraction, void *context);  /* called by one thread; may be NULL */
    void *progress_context;
} RenderParams;

typedef struct RenderStats {
    double prepare_s;   /* search structures: of the geometry, and what views need besides */
    double trace_s;     /* pixels */
    double cpu_s;       /* of all threads, for both: trace_s when nothing else runs is about cpu_s /
                           threads */
    size_t rays;        /* primary */
    const char *engine; /* that drew the last rows: "field", "raster", "zbuffer" or "trace" */
    size_t preparations; /* how often something was prepared anew for a view: for another camera,
                            lights, ground plane or antialiasing, or for colours after planes */
} RenderStats;

/* Adds what another renderer has done, whose engine drew last; preparations stay those of *all. */
void renderstats_add(RenderStats *all, const RenderStats *more);

/* Rows first .. first + rows of the picture. The first `above` and the last `below` of them are
 * drawn only because adaptive antialiasing compares pixels with their neighbours: they get no
 * further samples and are cut off at the end. */
typedef struct Band {
    int first, rows;
    int above, below;
} Band;

/* What an engine draws: a band of a picture of one geometry. */
typedef struct Drawing {
    const Geometry *geometry;
    const View *view;
    const Appearance *appearance;
    const RenderParams *params;
    struct Caster *caster; /* for the rays that the engine asks for; NULL where it asks for none */
    const TermMean *mean;  /* of colours that blend; else NULL */
    const struct PixelVisibility *visibility; /* what samples of a pixel share; NULL: nothing */
    const bool *hidden; /* per primitive, or per segment of a field: the camera does not see it,
                         * lights do; NULL: none is hidden */
    const struct ThinLayer *thin; /* thin vessels that are drawn over each sample; NULL: none */
    Band band;
} Drawing;

/* The linear colour of the segment of this number at a point of its surface. */
Rgb drawing_color(const Drawing *drawing, uint32_t segment, Vec3 point);

/* Reports progress of the whole picture by params->progress, if there is one. `part`, from 0 to 1,
 * is of the present pass over the band: that of the centre samples, or, if `further`, of the
 * further samples of antialiasing. */
void band_progress(const Band *band, const RenderParams *params, int height, bool further,
                   double part);

#endif
