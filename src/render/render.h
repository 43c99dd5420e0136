/* The door of the room render: scene -> image, in double precision with float colours, arranged so
 * that it repeats POV-Ray 3.7's arithmetic [docs/POVRAY.md]. */
#ifndef CORCAST_RENDER_RENDER_H
#define CORCAST_RENDER_RENDER_H

#include "base/base.h"
#include "image/image.h"
#include "render/light/shade.h" // IWYU pragma: export
#include "scene/scene.h"
#include "surface/surface.h"

/* How primitives are drawn. */
typedef enum RenderMethod {
    RENDER_TRACE,  /* ray by ray in double precision, as POV-Ray does */
    RENDER_RASTER, /* tile by tile in single precision: the same picture but for rounding */
    RENDER_ZBUFFER /* by points of the surfaces and a depth buffer, as the paper does */
} RenderMethod;

/* The instructions that a tile's samples are drawn with, several at once: those of any processor, AVX2
 * with FMA, AVX-512. Other pictures than RENDER_TRACE's of primitives and blobs may differ in the last
 * digits of single precision from one to the next. */
typedef enum RenderKernels {
    KERNELS_FASTEST, /* of those that this processor has */
    KERNELS_PORTABLE,
    KERNELS_AVX2,
    KERNELS_AVX512
} RenderKernels;

/* Their names, in order; NULL ends them. */
extern const char *const render_kernel_names[];

typedef struct RenderParams {
    /* An implicit model has tiles of its own and takes none of these. What needs rays, soft shadows,
     * occlusion and ground, is traced whatever the method. */
    RenderMethod method;
    RenderKernels kernels;
    int threads;   /* 0: all processors */
    int antialias; /* 1: one ray through each pixel's centre; N > 1: that ray and N x N more, the
                    * places and weights of POV-Ray's +A0.0 +AM1 +RN -J */
    double antialias_threshold; /* 0: every pixel gets the N x N more, as in POV-Ray; else, in
                                 * (0, 1], those only that differ from a neighbour by so much in
                                 * the square root of a channel, which no POV-Ray picture repeats */
    bool shadows;
    double
        shadow_from_mm; /* what is nearer to a lit place is not in its light; 0: POV-Ray's 0.001 mm */
    int occlusion; /* 0: ambient light is the same everywhere; N: the part of it that reaches a point is
                    * found by N rays, which no POV-Ray picture repeats */
    const CellParams *povray_cells; /* of an implicit model: where POV-Ray's root finder sees it in
                                     * these cells; NULL: where it is, by proof */
    bool
        codes_suffice; /* the frame may have 8-bit codes instead of colours, where that is faster */
    bool want_color, want_depth, want_normal, want_id; /* geometry planes are of the centre ray */
    void (*progress)(double fraction, void *context);  /* called by one thread; may be NULL */
    void *progress_context;
} RenderParams;

typedef struct RenderStats {
    double prepare_s; /* building the search structure */
    double trace_s;
    double
        cpu_s; /* of all threads, for both: trace_s when nothing else runs is about cpu_s / threads */
    size_t rays; /* primary */
    size_t
        preparations; /* how often camera, lights or antialiasing were not those of the band before */
} RenderStats;

/* Bands begin at multiples of so many rows. */
enum { RENDER_BAND_STEP = 8 };

/* A scene made ready to be drawn, whole or band by band. */
typedef struct Renderer Renderer;

/* Builds what rays need of the geometry; the scene is borrowed, and `params` as long as this call. Until
 * renderer_free, camera, lights and colours of the scene may change between calls, geometry may
 * not. What tiles need is built with the first rows, and anew only where camera, lights or antialiasing
 * have changed. STATUS_USAGE when this processor cannot run the kernels; STATUS_MEMORY. */
MUST_CHECK Status renderer_new(const Scene *scene, const RenderParams *params, Renderer **out,
                               Err *err);
void renderer_free(Renderer *renderer);

/* Renders the rows first .. first + rows of the picture into *frame (owned), which has as many: the very
 * bytes that those rows have in the whole picture. `first` is a multiple of RENDER_BAND_STEP, and so is
 * `rows` unless they end with the picture. STATUS_MEMORY when the planes do not fit. */
MUST_CHECK Status renderer_rows(Renderer *renderer, int first, int rows, Frame *frame, Err *err);

/* What comes next has `antialias` of RenderParams. */
void renderer_antialias(Renderer *renderer, int antialias);

/* Of all calls so far, renderer_new included. */
RenderStats renderer_stats(const Renderer *renderer);

/* Renders the whole picture into *frame (owned). The same bytes for any number of threads. STATUS_MEMORY when the
 * planes do not fit. `stats` may be NULL. */
MUST_CHECK Status render(const Scene *scene, const RenderParams *params, Frame *frame,
                         RenderStats *stats, Err *err);

/* How many segments of an implicit scene have no surface about them: the potential half way along
 * the segment is below the level. */
MUST_CHECK Status render_count_vanished(const Scene *scene, size_t *count, Err *err);

#endif
