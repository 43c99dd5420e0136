/* The kernels that shade, encode and project the samples of a tile. A kernel processes several
 * samples at once, one per lane of a vector register. Each kernel is compiled once per instruction
 * set. The kernels for one instruction set are called a kind; tilekernels[kernels_kind(...)] are
 * the kernels of the selected kind.
 *
 * A kernel reads and writes whole blocks of as many samples as there are lanes, at most 16. Array
 * elements of samples that hit nothing are undefined and may be overwritten. */
#ifndef CORCAST_RENDER_TILE_TILEKERNELS_H
#define CORCAST_RENDER_TILE_TILEKERNELS_H

#include "image/image.h"
#include "render/job.h"
#include "render/tile/tile.h"
#include "scene/scene.h"

/* A light in the camera's frame. */
typedef struct TileLight {
    float towards[3]; /* parallel light: unit direction to the light; otherwise: position of the
                       * light, mm from the camera */
    float color[3];
    bool parallel;
} TileLight;

/* The properties of a surface for shading: finish, lights, and the color that it fades into. */
typedef struct TileShading {
    Finish finish;
    TileLight lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    float paper[3]; /* background color, into which surfaces fade */
} TileShading;

/* The surface points that the samples of a tile hit, in the camera's frame. */
typedef struct TileSurface {
    const TileHits *hits;
    float direction[3][TILE_SAMPLES];        /* unit direction of the camera ray */
    float point[3][TILE_SAMPLES];            /* mm from the camera; set if a light is not
                                              * parallel */
    float pigment[3][TILE_SAMPLES];          /* linear color of the surface */
    const uint8_t (*shadowed)[TILE_SAMPLES]; /* [light][sample]: 1 if the sample is in the hard
                                              * shadow of the light; NULL: no sample is */
    const float *fade;                       /* per sample: fraction of the background's color;
                                              * NULL: 0 for all */
    const float *ambient;                    /* per sample: ambient visibility, 0 to 1; NULL: 1 for
                                              * all */
    /* Per light: factor of the light, 0 to 1, per sample, for the soft shadows of area lights;
     * NULL: 1 for all. A light that is `shadowed` contributes nothing. */
    const float *light_visibility[VIEW_MAX_LIGHTS];
} TileSurface;

/* The points that the samples of a tile hit, mm in the camera's frame; undefined for samples that
 * hit nothing. */
typedef struct HitPoints {
    double x[TILE_SAMPLES], y[TILE_SAMPLES], z[TILE_SAMPLES];
} HitPoints;

/* The projection from the camera's frame to a light view: converts a point to its tile in the light
 * view, its position in the tile, and its depth. */
typedef struct LightProjection {
    Vec3 axes[3], offset; /* the axes of the light's frame in the camera's frame; the camera's
                           * location in the light's frame */
    bool perspective;
    double left, top, per_x, per_y; /* left and upper edge of the first tile, and number of tiles
                                     * per unit of length, in the light view's plane */
    double columns, rows;           /* number of columns and rows of tiles */
    double slack;                   /* a blocker nearer than this to a point casts no shadow on the
                                     * point, mm */
    double z_middle;                /* subtracted from depths, so that little precision is lost when
                                     * a kernel rounds them to single precision */
} LightProjection;

/* Points of a tile, projected to a light view. */
typedef struct ProjectedPoints {
    float x[TILE_SAMPLES], y[TILE_SAMPLES]; /* position in the light view's plane, relative to the
                                             * middle of the tile */
    double z[TILE_SAMPLES];                 /* depth limit, minus z_middle: a blocker at a smaller
                                             * depth shadows the point */
    int32_t tile[TILE_SAMPLES];             /* index of the light view's tile, row by row */
} ProjectedPoints;

/* The kernels for one instruction set. */
typedef struct TileKernels {
    /* Computes the colors of hits. They differ from the colors of the function shade
     * [light/shade.h] by at most 2e-5 of the light's color. The colors of other samples in the same
     * block become undefined. */
    void (*shade)(const TileShading *look, const TileSurface *surface,
                  float color[3][TILE_SAMPLES]);
    /* Sets the color of the samples whose TileState is TILE_MISS to the background. */
    void (*clear)(const uint8_t *state, const float background[3], float color[3][TILE_SAMPLES]);
    /* Copies the colors of a whole tile to TILE_SIDE rows of interleaved pixels. `stride` is the
     * number of floats from one row to the next. */
    void (*paint)(float color[3][TILE_SAMPLES], float *pixels, size_t stride);
    /* Encodes the colors of a whole tile as 8-bit sRGB codes in TILE_SIDE rows of pixels. `stride`
     * is the number of bytes from one row to the next. Samples whose TileState is TILE_MISS get the
     * background; `state` NULL: no sample gets it. NaN is encoded as 0. */
    void (*encode)(const SrgbCodes *codes, float color[3][TILE_SAMPLES], const uint8_t *state,
                   const uint8_t background[3], uint8_t *pixels, size_t stride);
    /* Returns a bit mask: bit i is set if, at sample i, the visible side of the surface faces the
     * light. Bits of samples that hit nothing are undefined. */
    uint64_t (*facing)(const TracedTile *traced, const HitPoints *points,
                       const float normal[3][TILE_SAMPLES], const TileLight *light);
    /* Projects the points to a light view. *projected receives the projected points. Points outside
     * the light view, and points of samples that hit nothing, get the index of a valid tile,
     * too. */
    void (*project)(const LightProjection *projection, const HitPoints *points,
                    ProjectedPoints *projected);
    /* Returns a bit mask of the samples whose projected point is in the tile `tile` of the light
     * view. */
    uint64_t (*within)(const ProjectedPoints *projected, int32_t tile);
} TileKernels;

/* The kinds of kernels. Kind 0 is portable; each further kind uses a newer instruction set.
 *
 * A table of kernels is a struct of function pointers, such as TileKernels. It exists once per
 * kind, under the names name_portable, name_avx2 and name_avx512, which LANES_NAME [lanes.h] makes.
 * DECLARE_KERNELS declares these variables for a table `name` of the type `type`. EACH_KIND lists
 * their addresses, kind 0 first. */
#ifdef __x86_64__
enum { KINDS_OF_KERNELS = 3 };
#define DECLARE_KERNELS(type, name) extern const type name##_portable, name##_avx2, name##_avx512
#define EACH_KIND(name) &name##_portable, &name##_avx2, &name##_avx512
#else
enum { KINDS_OF_KERNELS = 1 };
#define DECLARE_KERNELS(type, name) extern const type name##_portable
#define EACH_KIND(name) &name##_portable
#endif

DECLARE_KERNELS(TileKernels, tilekernels);
/* One entry per kind. */
extern const TileKernels *const tilekernels[KINDS_OF_KERNELS];

/* Returns the number n of kinds that this processor can run: the kinds 0 to n - 1. Kind n - 1 is
 * the fastest of them. */
int kernels_usable(void);
/* Returns the index of a kind in arrays such as `tilekernels`. This processor must be able to run
 * the kind; it is not checked. For KERNELS_FASTEST, returns the fastest kind that this processor
 * can run. */
int kernels_kind(RenderKernels kernels);

#endif
