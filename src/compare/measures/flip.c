/* Computes FLIP 1.6, a perceptual difference of two images, with separable filters. All arithmetic
 * is in float, as in the authors' program, so that the means are equal to theirs.
 *
 * Both images are converted to the opponent space YCxCz and blurred as the eye blurs at 67 pixels
 * per degree; the filter of Cz is a sum of two Gaussians, which are applied separately. The color
 * difference is a distance in Hunt-adjusted CIELab. The feature difference comes from edges and
 * points, the first and second derivatives of a Gaussian applied to Y. It amplifies the color
 * difference: error = color^(1 - feature).
 *
 * Images are processed in tiles so small that all filtered planes of a tile stay in a processor's
 * cache. All rows of the tile and its halo are filtered horizontally, then each row vertically. The
 * metric is local, so a tile that is equal in both images, halo included, has error 0 and is
 * skipped. Sums are stored per tile and added in the order of the tiles, for any number of
 * threads. */
#include "compare/measures/flip.h"

#include "compare/measures/wide.h"
#include "compare/pixels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* HALO: pixels around a tile that its filters reach. TILE: side of a tile in pixels. A Workspace
 * then has 200 kB, which fits into the second-level cache of a core. Larger tiles leave the cache;
 * smaller tiles filter more pixels of halos. SPAN: side of a tile with its halo. */
enum { HALO = FLIP_RADIUS, TILE = 48, SPAN = TILE + 2 * HALO };

/* The planes that the filters are applied to. */
typedef enum Input { IN_Y, IN_CX, IN_CZ, IN_LIGHTNESS, INPUTS } Input;

static const Input filter_input[FLIP_FILTERS] = {IN_Y,         IN_CX,        IN_CZ,       IN_CZ,
                                                 IN_LIGHTNESS, IN_LIGHTNESS, IN_LIGHTNESS};

/* The results of the vertical pass: the blurred colors, then the derivatives along x and y. For
 * each result `outputs` names the plane of the horizontal pass and the vertical filter. */
typedef enum Output { Y, CX, CZ1, CZ2, EDGE_X, POINT_X, EDGE_Y, POINT_Y, OUTPUTS } Output;
static const struct {
    FlipFilter plane, filter;
} outputs[OUTPUTS] = {{F_Y, F_Y},        {F_CX, F_CX},       {F_CZ1, F_CZ1},    {F_CZ2, F_CZ2},
                      {F_EDGE, F_GAUSS}, {F_POINT, F_GAUSS}, {F_GAUSS, F_EDGE}, {F_GAUSS, F_POINT}};

/* One row of a tile of one image after both passes. */
typedef struct Rows {
    float of[OUTPUTS][TILE];
} Rows;

/* The features of one row of one image that are compared. */
typedef struct Features {
    float lightness[TILE], a[TILE], b[TILE], edge[TILE], point[TILE];
} Features;

/* The data of one tile, per thread. */
typedef struct Workspace {
    float colors[3][SPAN];
    float inputs[INPUTS][SPAN];
    float filtered[2][FLIP_FILTERS][SPAN][TILE]; /* per image: results of the horizontal pass */
    Rows rows[2];                                /* per image: results of both passes, one row */
    Features features[2];
    float errors[TILE];        /* of one row */
    float largest[TILE][TILE]; /* per pixel: largest error over all exposures */
} Workspace;

/* Percentiles use errors rounded to 1 / STEPS, so that the counts are exact for any number of
 * threads. */
enum { STEPS = 65536 };

/* Sums over the pixels of a tile. */
typedef struct TileErrors {
    double sum, squares, max;
} TileErrors;

typedef struct Flip {
    const FlipPair *pair;
    FlipKernel kernels[FLIP_FILTERS];
    float color_max, color_knee; /* the paper's c_max, and p_c c_max */
    int tiles_across;
    TileErrors *tiles;     /* per tile; owned */
    uint32_t *counts;      /* STEPS + 1 per thread: number of pixels by rounded error; owned */
    Workspace *workspaces; /* one per thread; owned */
    Plane map;             /* owned; without values if the caller passed no map */
} Flip;

/* --------------------------------------------------------------------------------------- color */

typedef struct Triple {
    float x, y, z;
} Triple;

/* Linear RGB to XYZ over the illuminant D65, the matrix of sRGB's primaries. */
static inline Triple xyz_from_rgb(Triple c)
{
    Triple xyz = {
        10135552.0f / 24577794 * c.x + 8788810.0f / 24577794 * c.y + 4435075.0f / 24577794 * c.z,
        2613072.0f / 12288897 * c.x + 8788810.0f / 12288897 * c.y + 887015.0f / 12288897 * c.z,
        1425312.0f / 73733382.0f * c.x + 8788810.0f / 73733382.0f * c.y +
            70074185.0f / 73733382.0f * c.z};
    return (Triple){xyz.x * (1 / 0.950428545f), xyz.y, xyz.z * (1 / 1.088900371f)};
}

static inline float within_unit(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* Converts YCxCz to linear RGB, clamped to [0, 1]. */
static inline Triple rgb_from_ycxcz(float y, float cx, float cz)
{
    float white_y = (y + 16) / 116;
    Triple xyz = {(white_y + cx / 500) * 0.950428545f, white_y,
                  (white_y - cz / 200) * 1.088900371f};
    float r = 3.241003275f * xyz.x - 1.537398934f * xyz.y - 0.498615861f * xyz.z;
    float g = -0.969224334f * xyz.x + 1.875930071f * xyz.y + 0.041554224f * xyz.z;
    float b = 0.055639423f * xyz.x - 0.204011202f * xyz.y + 1.057148933f * xyz.z;
    return (Triple){within_unit(r), within_unit(g), within_unit(b)};
}

static inline float lab_curve(float t)
{
    const float delta = 6.0f / 29, knee = delta * delta * delta;
    float root = cube_root(t < knee ? knee : t), line = t / (3 * delta * delta) + 4.0f / 29;
    return t > knee ? root : line;
}

/* CIELab, its chroma scaled by lightness (Hunt effect). */
static inline Triple hunt_lab(Triple rgb)
{
    Triple xyz = xyz_from_rgb(rgb);
    float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    float lightness = 116 * y - 16;
    return (Triple){lightness, 0.01f * lightness * (500 * (x - y)),
                    0.01f * lightness * (200 * (y - z))};
}

/* HyAB distance to the power 0.7. */
static inline float color_distance(Triple a, Triple b)
{
    float da = a.y - b.y, db = a.z - b.z;
    return power(magnitude(a.x - b.x) + sqrtf(da * da + db * db), 0.7f);
}

/* Color, edge and point of a row of one image, from its vertically filtered values. */
static void row_features(const Rows *restrict rows, Features *restrict out)
{
    const float(*row)[TILE] = rows->of;
    for (int x = 0; x < TILE; x++) {
        Triple lab = hunt_lab(rgb_from_ycxcz(row[Y][x], row[CX][x], row[CZ1][x] + row[CZ2][x]));
        out->lightness[x] = lab.x;
        out->a[x] = lab.y;
        out->b[x] = lab.z;
        out->edge[x] = sqrtf(row[EDGE_X][x] * row[EDGE_X][x] + row[EDGE_Y][x] * row[EDGE_Y][x]);
        out->point[x] =
            sqrtf(row[POINT_X][x] * row[POINT_X][x] + row[POINT_Y][x] * row[POINT_Y][x]);
    }
}

/* Computes the errors of a row from the features of both images. Color distances up to the knee are
 * mapped to [0, 0.95], larger ones to [0.95, 1], as in the paper. */
static void row_errors(const Flip *flip, const Features *restrict a, const Features *restrict b,
                       float *restrict errors)
{
    const float knee = flip->color_knee, rest = flip->color_max - knee;
    for (int x = 0; x < TILE; x++) {
        float color = color_distance((Triple){a->lightness[x], a->a[x], a->b[x]},
                                     (Triple){b->lightness[x], b->a[x], b->b[x]});
        color = color < knee ? color * (0.95f / knee) : 0.95f + (color - knee) / rest * 0.05f;
        float feature =
            larger(magnitude(a->edge[x] - b->edge[x]), magnitude(a->point[x] - b->point[x]));
        errors[x] = power(color, 1 - sqrtf(feature * 0.707106781f));
    }
}

/* ---------------------------------------------------------------------------------------- tiles */

static int clamp(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

/* Loads SPAN pixels of row `y` from `x` on, in YCxCz and lightness (Y scaled to [0, 1]). Beyond an
 * edge of the image, the pixels at the edge are repeated. */
static void load_inputs(const Flip *flip, int image, int exposure, int x, int y, Workspace *work)
{
    const FlipPair *pair = flip->pair;
    int left = clamp(x, 0, pair->width - 1), right = clamp(x + SPAN, left + 1, pair->width);
    int first = left - x, count = right - left;
    const FlipSpan span = {image, exposure, left, clamp(y, 0, pair->height - 1), count};
    pair->colors(pair, &span, work->colors[0] + first, SPAN);
    for (int i = first; i < first + count; i++) {
        Triple xyz =
            xyz_from_rgb((Triple){work->colors[0][i], work->colors[1][i], work->colors[2][i]});
        work->inputs[IN_Y][i] = 116 * xyz.y - 16;
        work->inputs[IN_CX][i] = 500 * (xyz.x - xyz.y);
        work->inputs[IN_CZ][i] = 200 * (xyz.y - xyz.z);
        work->inputs[IN_LIGHTNESS][i] = work->inputs[IN_Y][i] * (1.0f / 116) + 16.0f / 116;
    }
    for (int k = 0; k < INPUTS; k++) {
        for (int i = 0; i < first; i++)
            work->inputs[k][i] = work->inputs[k][first];
        for (int i = first + count; i < SPAN; i++)
            work->inputs[k][i] = work->inputs[k][first + count - 1];
    }
}

/* Filters TILE values. `in` points to the value that the first weight multiplies for the first
 * result; the values of the next weights are `step` floats apart. Weights farther than `radius`
 * from the middle are left out. `odd` states that the kernel is antisymmetric. */
static inline void convolve(float *restrict out, const float *restrict in, size_t step,
                            const float *weights, int radius, bool odd)
{
    for (int i = 0; i < TILE; i++) {
        float sum = odd ? 0 : weights[FLIP_RADIUS] * in[i + FLIP_RADIUS * step];
        for (size_t k = (size_t)(FLIP_RADIUS - radius); k < FLIP_RADIUS; k++) {
            float before = in[i + k * step], after = in[i + (FLIP_TAPS - 1 - k) * step];
            sum += weights[k] * (odd ? before - after : before + after);
        }
        out[i] = sum;
    }
}

/* Filters by one of the filters. Each case passes constants, so that the compiler makes a separate
 * loop for it. */
static inline void filter(float *out, const float *in, size_t step, const Flip *flip,
                          FlipFilter which)
{
    const float *weights = flip->kernels[which].weights;
    if (which == F_Y || which == F_CX)
        convolve(out, in, step, weights, FLIP_RADIUS_LUMA, false);
    else if (which == F_CZ1 || which == F_CZ2)
        convolve(out, in, step, weights, FLIP_RADIUS, false);
    else if (which == F_EDGE)
        convolve(out, in, step, weights, FLIP_RADIUS_FEATURE, true);
    else
        convolve(out, in, step, weights, FLIP_RADIUS_FEATURE, false);
}

/* Filters a tile and its halo horizontally. */
static void filter_rows(const Flip *flip, int exposure, int left, int top, int rows,
                        Workspace *work)
{
    for (int side = 0; side < 2; side++)
        for (int row = 0; row < rows + 2 * HALO; row++) {
            load_inputs(flip, side, exposure, left - HALO, top - HALO + row, work);
            for (int f = 0; f < FLIP_FILTERS; f++)
                filter(work->filtered[side][f][row], work->inputs[filter_input[f]], 1, flip,
                       (FlipFilter)f);
        }
}

/* Computes the errors of row `row` of the tile. */
static void find_errors(const Flip *flip, int row, Workspace *work)
{
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < OUTPUTS; i++)
            filter(work->rows[side].of[i], work->filtered[side][outputs[i].plane][row], TILE, flip,
                   outputs[i].filter);
    for (int side = 0; side < 2; side++)
        row_features(&work->rows[side], &work->features[side]);
    row_errors(flip, &work->features[0], &work->features[1], work->errors);
}

/* Returns true if both images are equal in a tile and its halo. */
static bool tile_equal(const FlipPair *pair, int left, int top, int columns, int rows)
{
    int x0 = clamp(left - HALO, 0, pair->width), x1 = clamp(left + columns + HALO, 0, pair->width);
    int y0 = clamp(top - HALO, 0, pair->height), y1 = clamp(top + rows + HALO, 0, pair->height);
    for (int y = y0; y < y1; y++)
        if (!pair->equal(pair, x0, y, x1 - x0))
            return false;
    return true;
}

/* Finds the largest error of each pixel of a tile over all exposures. */
static void find_largest(const Flip *flip, int left, int top, int rows, Workspace *work)
{
    memset(work->largest, 0, sizeof work->largest);
    for (int exposure = 0; exposure < flip->pair->exposures; exposure++) {
        filter_rows(flip, exposure, left, top, rows, work);
        for (int row = 0; row < rows; row++) {
            find_errors(flip, row, work);
            for (int x = 0; x < TILE; x++)
                work->largest[row][x] = larger(work->largest[row][x], work->errors[x]);
        }
    }
}

/* Computes the errors of one tile, and adds them to the sums, the counts and the map. */
static void do_tile(size_t index, int worker, void *context)
{
    Flip *flip = context;
    const FlipPair *pair = flip->pair;
    Workspace *work = &flip->workspaces[worker];
    uint32_t *counts = flip->counts + (size_t)worker * (STEPS + 1);
    TileErrors *tile = &flip->tiles[index];
    int left = (int)(index % (size_t)flip->tiles_across) * TILE;
    int top = (int)(index / (size_t)flip->tiles_across) * TILE;
    int columns = pair->width - left < TILE ? pair->width - left : TILE;
    int rows = pair->height - top < TILE ? pair->height - top : TILE;
    if (tile_equal(pair, left, top, columns, rows))
        return;
    find_largest(flip, left, top, rows, work);
    for (int row = 0; row < rows; row++)
        for (int x = 0; x < columns; x++) {
            double error = (double)work->largest[row][x];
            tile->sum += error;
            tile->squares += error * error;
            tile->max = fmax(tile->max, error);
            counts[(int)(error * STEPS + 0.5)]++;
        }
    for (int row = 0; row < rows && flip->map.values; row++)
        memcpy(flip->map.values + (size_t)(top + row) * (size_t)pair->width + (size_t)left,
               work->largest[row], (size_t)columns * sizeof(float));
}

WIDE static void do_tile_wide(size_t index, int worker, void *context)
{
    do_tile(index, worker, context);
}

/* Allocates the workspaces, and sets the constants that scale the difference of colors: the
 * largest difference, between green and blue, and 0.4 of it, the knee of FLIP's curve. */
static Status flip_init(Flip *flip, size_t tiles, int threads, bool with_map, Err *err)
{
    if (with_map)
        TRY(plane_init(&flip->map, flip->pair->width, flip->pair->height, 1, err));
    flip_kernels(flip->kernels);
    flip->color_max = color_distance(hunt_lab((Triple){0, 1, 0}), hunt_lab((Triple){0, 0, 1}));
    flip->color_knee = 0.4f * flip->color_max;
    TRY(mem_calloc(&flip->tiles, tiles, sizeof *flip->tiles, "sums of tiles", err));
    TRY(mem_calloc(&flip->counts, (size_t)threads * (STEPS + 1), sizeof *flip->counts,
                   "counts of errors", err));
    return mem_calloc(&flip->workspaces, (size_t)threads, sizeof *flip->workspaces,
                      "values of FLIP's tiles", err);
}

/* Returns the smallest rounded error up to which at least `fraction` of all weight lies. */
static double percentile_of(const double weights[STEPS + 1], double fraction)
{
    double all = 0, sum = 0;
    for (int i = 0; i <= STEPS; i++)
        all += weights[i];
    for (int i = 0; i <= STEPS; i++) {
        sum += weights[i];
        if (sum >= fraction * all)
            return (double)i / STEPS;
    }
    return 1;
}

/* Sums up all tiles. Pixels of tiles that are equal in both images have no error. */
static Status summarise(const Flip *flip, size_t n_tiles, int threads, FlipSummary *summary,
                        Err *err)
{
    const double pixels = (double)flip->pair->width * flip->pair->height;
    TileErrors all = {0};
    double *counts, *weights, counted = 0;
    TRY(mem_calloc(&counts, 2 * (STEPS + 1), sizeof *counts, "counts of errors", err));
    weights = counts + STEPS + 1;
    for (size_t i = 0; i < n_tiles; i++) {
        all.sum += flip->tiles[i].sum;
        all.squares += flip->tiles[i].squares;
        all.max = fmax(all.max, flip->tiles[i].max);
    }
    for (int i = 0; i <= STEPS; i++) {
        for (int worker = 0; worker < threads; worker++)
            counts[i] += flip->counts[(size_t)worker * (STEPS + 1) + (size_t)i];
        counted += counts[i];
        weights[i] = counts[i] * i;
    }
    counts[0] += pixels - counted;
    *summary = (FlipSummary){.mean = all.sum / pixels,
                             .p95 = percentile_of(counts, 0.95),
                             .max = all.max,
                             .weighted_mean = all.sum > 0 ? all.squares / all.sum : 0,
                             .weighted_median = percentile_of(weights, 0.5),
                             .weighted_p95 = percentile_of(weights, 0.95)};
    free(counts);
    return STATUS_OK;
}

Status flip_run(const FlipPair *pair, Plane *map, FlipSummary *summary, Err *err)
{
    Flip flip = {.pair = pair, .tiles_across = (pair->width + TILE - 1) / TILE};
    size_t tiles = (size_t)flip.tiles_across * (size_t)((pair->height + TILE - 1) / TILE);
    int threads = threads_available();
    Status status = STATUS_OK;
    TRY_GOTO(flip_init(&flip, tiles, threads, map != NULL, err));
    threads_for(tiles, threads, wide_usable() ? do_tile_wide : do_tile, &flip);
    TRY_GOTO(summarise(&flip, tiles, threads, summary, err));
    if (map) {
        *map = flip.map;
        flip.map = (Plane){0};
    }
done:
    plane_release(&flip.map);
    free(flip.tiles);
    free(flip.counts);
    free(flip.workspaces);
    return status;
}

/* ------------------------------------------------------------------------------------- pictures */

typedef struct Pictures {
    const Picture *pictures[2];
    float *linear; /* owned; decoded level of each code */
} Pictures;

static void picture_colors(const FlipPair *pair, const FlipSpan *span, float *out, size_t stride)
{
    const Pictures *self = pair->context;
    const Picture *picture = self->pictures[span->image];
    size_t channels = (size_t)picture->channels;
    size_t first = (size_t)span->y * picture_stride(picture) + (size_t)span->x * channels;
    for (size_t i = 0; i < (size_t)span->n; i++)
        for (size_t c = 0; c < 3; c++)
            out[c * stride + i] =
                self->linear[picture_code(picture, first + i * channels + (channels == 1 ? 0 : c))];
}

static bool pictures_equal(const FlipPair *pair, int x, int y, int n)
{
    const Pictures *self = pair->context;
    return picture_rows_equal(self->pictures[0], self->pictures[1], y, x, n);
}

Status flip_compute(const Picture *a, const Picture *b, Plane *map, FlipSummary *summary, Err *err)
{
    Pictures self = {.pictures = {a, b}};
    TRY(srgb_table(a->bits, &self.linear, err));
    const FlipPair pair = {.width = a->width,
                           .height = a->height,
                           .colors = picture_colors,
                           .equal = pictures_equal,
                           .exposures = 1,
                           .context = &self};
    Status status = flip_run(&pair, map, summary, err);
    free(self.linear);
    return status;
}

Status flip_find(const Picture *a, const Picture *b, double values[MEASURES], Err *err)
{
    FlipSummary summary;
    TRY(flip_compute(a, b, NULL, &summary, err));
    values[MEASURE_FLIP_MEAN] = summary.mean;
    values[MEASURE_FLIP_P95] = summary.p95;
    values[MEASURE_FLIP_MAX] = summary.max;
    values[MEASURE_FLIP_WEIGHTED_MEAN] = summary.weighted_mean;
    values[MEASURE_FLIP_WEIGHTED_MEDIAN] = summary.weighted_median;
    values[MEASURE_FLIP_WEIGHTED_P95] = summary.weighted_p95;
    return STATUS_OK;
}
