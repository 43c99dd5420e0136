/* LDR-FLIP 1.6 with separable filters, all in float as its authors' program, so that their means
 * come out.
 *
 * Both pictures go to the opponent space YCxCz. There they are blurred as the eye blurs at 67
 * pixels per degree (Cz by a sum of two Gaussians, each filtered on its own), and their colour
 * distance is taken in a Hunt-adjusted CIELab. Edges and points, first and second derivatives of a
 * Gaussian applied to Y, amplify it: error = colour^(1 - feature).
 *
 * Work goes by bands of rows. A worker filters the band and its halo horizontally into a workspace
 * of its own, seven planes for each picture, and then each row of the band vertically, so that
 * memory does not grow with the height. A band whose rows and halo are equal in both pictures is
 * zero without computing: the metric is local. */
#include "verify/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ceil(3 sqrt(0.04 / (2 pi^2)) ppd) and ceil(3 * 0.5 * 0.082 ppd) */
enum { CSF_RADIUS = 10, FEATURE_RADIUS = 9, TAPS_MAX = 2 * CSF_RADIUS + 1 };
enum { HALO = CSF_RADIUS, BAND_ROWS = 64, SPAN_ROWS = BAND_ROWS + 2 * HALO };

static const float pixels_per_degree = 67.0206451f; /* a 0.7 m wide 4K screen seen from 0.7 m */

/* The seven one-dimensional filters; each also names the plane that it gives horizontally. */
typedef enum Filter { F_Y, F_CX, F_CZ1, F_CZ2, F_GAUSS, F_EDGE, F_POINT, FILTERS } Filter;
/* The four rows they are applied to. */
typedef enum Input { IN_Y, IN_CX, IN_CZ, IN_LIGHTNESS, INPUTS } Input;

static const Input filter_input[FILTERS] = {IN_Y,         IN_CX,        IN_CZ,       IN_CZ,
                                            IN_LIGHTNESS, IN_LIGHTNESS, IN_LIGHTNESS};

/* What is filtered vertically by what: the colours, then the derivatives along x and along y. */
typedef enum Output { Y, CX, CZ1, CZ2, EDGE_X, POINT_X, EDGE_Y, POINT_Y, OUTPUTS } Output;
static const struct {
    Filter plane, filter;
} outputs[OUTPUTS] = {{F_Y, F_Y},        {F_CX, F_CX},       {F_CZ1, F_CZ1},    {F_CZ2, F_CZ2},
                      {F_EDGE, F_GAUSS}, {F_POINT, F_GAUSS}, {F_GAUSS, F_EDGE}, {F_GAUSS, F_POINT}};

typedef struct Kernel {
    int radius;
    float weights[TAPS_MAX];
} Kernel;

typedef struct Flip {
    const Picture *pictures[2];
    float *linear; /* owned; decoded level of each code */
    Kernel kernels[FILTERS];
    float color_max, color_knee; /* cmax, and pc of it */
    size_t workspace_size;       /* floats for each worker */
    float *workspaces;           /* owned */
    Plane map;                   /* owned */
} Flip;

/* ------------------------------------------------------------------------------------- filters */

/* a sqrt(pi / b) exp(-pi^2 x^2 / b) with x in degrees; of a sum of two such, each is applied along
 * both axes and therefore takes the root of its amplitude. */
static float csf_fill(Kernel *kernel, float a, float b, bool root)
{
    const float pi = 3.14159265358979f;
    float amplitude = a * sqrtf(pi / b), sum = 0;
    if (root)
        amplitude = sqrtf(amplitude);
    kernel->radius = CSF_RADIUS;
    for (int i = -CSF_RADIUS; i <= CSF_RADIUS; i++) {
        float x = (float)i / pixels_per_degree;
        float weight = amplitude * expf(-pi * pi * x * x / b);
        kernel->weights[i + CSF_RADIUS] = weight;
        sum += weight;
    }
    return sum;
}

static void kernel_scale(Kernel *kernel, float factor)
{
    for (int i = 0; i <= 2 * kernel->radius; i++)
        kernel->weights[i] *= factor;
}

static void csf_kernels(Kernel kernels[FILTERS])
{
    kernel_scale(&kernels[F_Y], 1 / csf_fill(&kernels[F_Y], 1, 0.0047f, false));
    kernel_scale(&kernels[F_CX], 1 / csf_fill(&kernels[F_CX], 1, 0.0053f, false));
    float sum1 = csf_fill(&kernels[F_CZ1], 34.1f, 0.04f, true);
    float sum2 = csf_fill(&kernels[F_CZ2], 13.5f, 0.025f, true);
    float joint = 1 / sqrtf(sum1 * sum1 + sum2 * sum2);
    kernel_scale(&kernels[F_CZ1], joint);
    kernel_scale(&kernels[F_CZ2], joint);
}

/* Makes the positive weights sum to 1 and the negative ones, if any, to -1. */
static void kernel_balance(Kernel *kernel)
{
    float positive = 0, negative = 0;
    for (int i = 0; i <= 2 * kernel->radius; i++) {
        float weight = kernel->weights[i];
        if (weight > 0)
            positive += weight;
        else
            negative -= weight;
    }
    for (int i = 0; i <= 2 * kernel->radius; i++)
        kernel->weights[i] /= kernel->weights[i] > 0 ? positive : negative > 0 ? negative : 1;
}

static void feature_kernels(Kernel kernels[FILTERS])
{
    const float sigma = 0.5f * 0.082f * pixels_per_degree;
    for (int i = -FEATURE_RADIUS; i <= FEATURE_RADIUS; i++) {
        float x = (float)i;
        float gauss = expf(-(x * x) / (2 * sigma * sigma));
        kernels[F_GAUSS].weights[i + FEATURE_RADIUS] = gauss;
        kernels[F_EDGE].weights[i + FEATURE_RADIUS] = -x * gauss;
        kernels[F_POINT].weights[i + FEATURE_RADIUS] = (x * x / (sigma * sigma) - 1) * gauss;
    }
    for (Filter filter = F_GAUSS; filter <= F_POINT; filter++) {
        kernels[filter].radius = FEATURE_RADIUS;
        kernel_balance(&kernels[filter]);
    }
}

/* --------------------------------------------------------------------------------------- colour */

typedef struct Triple {
    float x, y, z;
} Triple;

/* Linear RGB to XYZ over the illuminant D65, the matrix of sRGB's primaries. */
static Triple xyz_from_rgb(Triple c)
{
    Triple xyz = {
        10135552.0f / 24577794 * c.x + 8788810.0f / 24577794 * c.y + 4435075.0f / 24577794 * c.z,
        2613072.0f / 12288897 * c.x + 8788810.0f / 12288897 * c.y + 887015.0f / 12288897 * c.z,
        1425312.0f / 73733382.0f * c.x + 8788810.0f / 73733382.0f * c.y +
            70074185.0f / 73733382.0f * c.z};
    return (Triple){xyz.x * (1 / 0.950428545f), xyz.y, xyz.z * (1 / 1.088900371f)};
}

/* Back, and into [0, 1]. */
static Triple rgb_from_ycxcz(float y, float cx, float cz)
{
    float white_y = (y + 16) / 116;
    Triple xyz = {(white_y + cx / 500) * 0.950428545f, white_y,
                  (white_y - cz / 200) * 1.088900371f};
    float r = 3.241003275f * xyz.x - 1.537398934f * xyz.y - 0.498615861f * xyz.z;
    float g = -0.969224334f * xyz.x + 1.875930071f * xyz.y + 0.041554224f * xyz.z;
    float b = 0.055639423f * xyz.x - 0.204011202f * xyz.y + 1.057148933f * xyz.z;
    return (Triple){fminf(fmaxf(r, 0), 1), fminf(fmaxf(g, 0), 1), fminf(fmaxf(b, 0), 1)};
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    return t > delta * delta * delta ? powf(t, 1.0f / 3) : t / (3 * delta * delta) + 4.0f / 29;
}

/* CIELab, its chroma scaled by lightness (Hunt effect). */
static Triple hunt_lab(Triple rgb)
{
    Triple xyz = xyz_from_rgb(rgb);
    float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    float lightness = 116 * y - 16;
    return (Triple){lightness, 0.01f * lightness * (500 * (x - y)),
                    0.01f * lightness * (200 * (y - z))};
}

/* HyAB distance to the power 0.7. */
static float color_distance(Triple a, Triple b)
{
    float da = a.y - b.y, db = a.z - b.z;
    return powf(fabsf(a.x - b.x) + sqrtf(da * da + db * db), 0.7f);
}

/* The vertically filtered rows of one picture. */
typedef struct Rows {
    float *of[OUTPUTS];
} Rows;

static float pixel_error(const Flip *flip, const Rows rows[2], int x)
{
    Triple lab[2];
    float edge[2], point[2];
    for (int i = 0; i < 2; i++) {
        float *const *row = rows[i].of;
        lab[i] = hunt_lab(rgb_from_ycxcz(row[Y][x], row[CX][x], row[CZ1][x] + row[CZ2][x]));
        edge[i] = sqrtf(row[EDGE_X][x] * row[EDGE_X][x] + row[EDGE_Y][x] * row[EDGE_Y][x]);
        point[i] = sqrtf(row[POINT_X][x] * row[POINT_X][x] + row[POINT_Y][x] * row[POINT_Y][x]);
    }
    float color = color_distance(lab[0], lab[1]);
    color = color < flip->color_knee
                ? color * (0.95f / flip->color_knee)
                : 0.95f + (color - flip->color_knee) / (flip->color_max - flip->color_knee) * 0.05f;
    float feature = fmaxf(fabsf(edge[0] - edge[1]), fabsf(point[0] - point[1]));
    return powf(color, 1 - sqrtf(feature / sqrtf(2)));
}

/* ---------------------------------------------------------------------------------------- bands */

static int clamp(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

/* Row `y` of a picture in YCxCz and lightness (Y scaled to [0, 1]), its ends repeated HALO times.
 */
static void row_inputs(const Flip *flip, const Picture *picture, int y, float *const in[INPUTS])
{
    const uint16_t *row =
        picture->codes + (size_t)y * (size_t)picture->width * (size_t)picture->channels;
    for (int x = -HALO; x < picture->width + HALO; x++) {
        const uint16_t *code = row + (size_t)clamp(x, 0, picture->width - 1) * picture->channels;
        bool grey = picture->channels == 1;
        Triple xyz = xyz_from_rgb((Triple){flip->linear[code[0]], flip->linear[code[grey ? 0 : 1]],
                                           flip->linear[code[grey ? 0 : 2]]});
        in[IN_Y][x] = 116 * xyz.y - 16;
        in[IN_CX][x] = 500 * (xyz.x - xyz.y);
        in[IN_CZ][x] = 200 * (xyz.y - xyz.z);
        in[IN_LIGHTNESS][x] = in[IN_Y][x] * (1.0f / 116) + 16.0f / 116;
    }
}

static void add_scaled(float *restrict out, const float *restrict in, float factor, int n)
{
    for (int i = 0; i < n; i++)
        out[i] += factor * in[i];
}

/* Where the parts of a worker's workspace begin. */
static float *span_row(float *workspace, int width, int picture, Filter filter, int row)
{
    return workspace + (((size_t)picture * FILTERS + filter) * SPAN_ROWS + (size_t)row) * width;
}

static void filter_rows(const Flip *flip, float *workspace, int picture, int first, int count)
{
    int width = flip->map.width;
    float *padded = span_row(workspace, width, 2, 0, 0);
    float *in[INPUTS];
    for (int i = 0; i < INPUTS; i++)
        in[i] = padded + (size_t)i * (size_t)(width + 2 * HALO) + HALO;
    for (int row = 0; row < count; row++) {
        row_inputs(flip, flip->pictures[picture], clamp(first + row, 0, flip->map.height - 1), in);
        for (Filter filter = 0; filter < FILTERS; filter++) {
            const Kernel *kernel = &flip->kernels[filter];
            float *out = span_row(workspace, width, picture, filter, row);
            memset(out, 0, (size_t)width * sizeof *out);
            for (int k = -kernel->radius; k <= kernel->radius; k++)
                add_scaled(out, in[filter_input[filter]] + k, kernel->weights[k + kernel->radius],
                           width);
        }
    }
}

/* The map's row that lies `row` rows below the start of the span. */
static void error_row(const Flip *flip, float *workspace, int row, float *out)
{
    int width = flip->map.width;
    float *next = span_row(workspace, width, 2, 0, 0);
    Rows rows[2];
    for (int picture = 0; picture < 2; picture++)
        for (Output output = 0; output < OUTPUTS; output++, next += width) {
            const Kernel *kernel = &flip->kernels[outputs[output].filter];
            rows[picture].of[output] = next;
            memset(next, 0, (size_t)width * sizeof *next);
            for (int k = -kernel->radius; k <= kernel->radius; k++)
                add_scaled(next,
                           span_row(workspace, width, picture, outputs[output].plane, row + k),
                           kernel->weights[k + kernel->radius], width);
        }
    for (int x = 0; x < width; x++)
        out[x] = pixel_error(flip, rows, x);
}

/* Whether both pictures are equal in the rows that lie inside [first, first + count). */
static bool rows_equal(const Flip *flip, int first, int count)
{
    const Picture *a = flip->pictures[0], *b = flip->pictures[1];
    int low = clamp(first, 0, a->height), high = clamp(first + count, 0, a->height);
    size_t row = (size_t)a->width * (size_t)a->channels;
    return memcmp(a->codes + low * row, b->codes + low * row,
                  (size_t)(high - low) * row * sizeof *a->codes) == 0;
}

static void do_band(size_t index, int worker, void *context)
{
    Flip *flip = context;
    int top = (int)index * BAND_ROWS;
    int rows = flip->map.height - top < BAND_ROWS ? flip->map.height - top : BAND_ROWS;
    if (rows_equal(flip, top - HALO, rows + 2 * HALO))
        return;
    float *workspace = flip->workspaces + (size_t)worker * flip->workspace_size;
    for (int picture = 0; picture < 2; picture++)
        filter_rows(flip, workspace, picture, top - HALO, rows + 2 * HALO);
    for (int row = 0; row < rows; row++)
        error_row(flip, workspace, HALO + row,
                  flip->map.values + (size_t)(top + row) * (size_t)flip->map.width);
}

static Status flip_init(Flip *flip, size_t bands, int *threads, Err *err)
{
    const Picture *a = flip->pictures[0];
    TRY(plane_init(&flip->map, a->width, a->height, 1, err));
    size_t levels = (size_t)1 << a->bits;
    TRY(mem_calloc(&flip->linear, levels, sizeof *flip->linear, "decoded levels", err));
    for (size_t i = 0; i < levels; i++)
        flip->linear[i] = srgb_decode((float)i / (float)(levels - 1));
    csf_kernels(flip->kernels);
    feature_kernels(flip->kernels);
    flip->color_max = color_distance(hunt_lab((Triple){0, 1, 0}), hunt_lab((Triple){0, 0, 1}));
    flip->color_knee = 0.4f * flip->color_max;
    *threads = threads_available();
    if ((size_t)*threads > bands)
        *threads = (int)bands;
    size_t rows = 2 * FILTERS * SPAN_ROWS + 2 * OUTPUTS;
    flip->workspace_size = rows * (size_t)a->width + INPUTS * 2 * HALO;
    return mem_calloc(&flip->workspaces, (size_t)*threads * flip->workspace_size,
                      sizeof *flip->workspaces, "values of FLIP's rows", err);
}

Status flip_compute(const Picture *a, const Picture *b, Plane *map, Err *err)
{
    Flip flip = {.pictures = {a, b}};
    size_t bands = ((size_t)a->height + BAND_ROWS - 1) / BAND_ROWS;
    int threads;
    Status status = flip_init(&flip, bands, &threads, err);
    if (status == STATUS_OK) {
        threads_for(bands, threads, do_band, &flip);
        *map = flip.map;
    } else {
        plane_release(&flip.map);
    }
    free(flip.linear);
    free(flip.workspaces);
    return status;
}

double plane_mean(const Plane *plane)
{
    size_t n = (size_t)plane->width * (size_t)plane->height;
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (double)plane->values[i];
    return sum / (double)n;
}
