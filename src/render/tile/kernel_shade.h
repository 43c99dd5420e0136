/* The functions of TileKernels, whose contracts are in tilekernels.h: shade the samples of a tile
 * by the model of shade.c, store or encode the colors as pixels, and project the hit points into
 * the views of lights. They process LANES samples at once, in single precision.
 *
 * A source that compiles the kernels for one instruction set defines the lanes and includes this
 * file, which therefore has no include guard. LANES_NAME(name) makes the names of the functions.
 * Samples of a tile are in Morton order: each block of 2 x 2 samples is consecutive [tile.h]. */
#include "render/tile/lanes.h"
#include "render/tile/tilekernels.h"
#include <endian.h>

/* Returns x^y for x in (0, 1] and y >= 0; lanes with other x get an undefined finite value. If y is
 * an integer up to 256, which is the usual case, repeated squaring needs at most 8 rounds. Results
 * below 1e-15 may be wrong, because products are kept at 1e-15 or more to avoid subnormal numbers,
 * which are slow. */
LANE_FN Lanes lanes_power(Lanes x, float y)
{
    const Lanes least = lanes_set(1e-15f);
    unsigned whole = y <= 256 ? (unsigned)y : 0;
    if (whole > 0 && (float)whole == y) {
        x = lanes_max(x, least);
        Lanes power = whole & 1 ? x : lanes_set(1);
        while (whole >>= 1) {
            x = lanes_max(x * x, least);
            if (whole & 1)
                power = lanes_max(power * x, least);
        }
        return power;
    }
    return lanes_exp_minus(-y * lanes_log(lanes_max(x, lanes_set(1e-30f))));
}

/* The state of shading the LANES samples from sample `first` on. */
typedef struct Shading {
    const TileShading *look;
    const TileSurface *surface;
    int first;
    Lanes normal[3], direction[3], color[3];
} Shading;

/* Returns the dot product of a and b. */
LANE_FN Lanes dot(const Lanes a[3], const Lanes b[3])
{
    return lanes_fma(a[0], b[0], lanes_fma(a[1], b[1], a[2] * b[2]));
}

/* Returns the Phong highlight for the direction `towards` to a light. */
LANE_FN Lanes phong(const Shading *shading, const Lanes towards[3])
{
    const Finish *finish = &shading->look->finish;
    Lanes twice = -2.0f * dot(shading->direction, shading->normal), mirrored[3];
    for (int c = 0; c < 3; c++)
        mirrored[c] = lanes_fma(shading->normal[c], twice, shading->direction[c]);
    Lanes cosine = dot(mirrored, towards);
    LaneMask towards_light = cosine > 0.0f;
    Lanes power = lanes_power(cosine, finish->phong_size) * finish->phong;
    return lanes_select(towards_light, power, lanes_set(0));
}

/* Returns the Blinn highlight for the direction `towards` to a light. */
LANE_FN Lanes specular(const Shading *shading, const Lanes towards[3])
{
    const Finish *finish = &shading->look->finish;
    Lanes halfway[3];
    for (int c = 0; c < 3; c++)
        halfway[c] = towards[c] - shading->direction[c];
    Lanes length = lanes_sqrt(dot(halfway, halfway));
    Lanes cosine = dot(halfway, shading->normal) / lanes_max(length, lanes_set(1e-30f));
    Lanes power = lanes_power(cosine, 1 / finish->roughness) * finish->specular;
    return lanes_select(cosine > 0.0f, power, lanes_set(0));
}

/* Computes the unit directions to a light. */
LANE_FN void to_light(const Shading *shading, const TileLight *light, Lanes towards[3])
{
    for (int c = 0; c < 3; c++)
        towards[c] = lanes_set(light->towards[c]);
    if (light->parallel)
        return;
    for (int c = 0; c < 3; c++)
        towards[c] -= lanes_load(&shading->surface->point[c][shading->first]);
    Lanes per_length = 1.0f / lanes_sqrt(dot(towards, towards));
    for (int c = 0; c < 3; c++)
        towards[c] *= per_length;
}

/* Adds the diffuse light and the highlights of a light to the colors. 1e-10 is MIN_LIT_COSINE
 * [shade.h]. */
LANE_FN void add_light(Shading *shading, size_t index)
{
    const Finish *finish = &shading->look->finish;
    const TileLight *light = &shading->look->lights[index];
    Lanes towards[3];
    to_light(shading, light, towards);
    Lanes cosine = dot(shading->normal, towards);
    LaneMask lit = cosine >= 1e-10f;
    if (shading->surface->shadowed)
        lit &= ~lanes_of_bytes(&shading->surface->shadowed[index][shading->first]);
    if (!lanes_any(lit))
        return;
    Lanes diffuse = finish->brilliance == 1 ? cosine : lanes_power(cosine, finish->brilliance);
    diffuse *= finish->diffuse;
    Lanes highlight = lanes_set(0);
    if (finish->phong > 0)
        highlight += phong(shading, towards);
    if (finish->specular > 0)
        highlight += specular(shading, towards);
    Lanes visible_part = lanes_set(1); /* fraction of the light that arrives */
    if (shading->surface->light_visibility[index])
        visible_part = lanes_load(&shading->surface->light_visibility[index][shading->first]);
    for (int c = 0; c < 3; c++) {
        Lanes pigment = lanes_load(&shading->surface->pigment[c][shading->first]);
        Lanes sum = lanes_fma(pigment, diffuse, highlight) * (visible_part * light->color[c]);
        shading->color[c] += lanes_select(lit, sum, lanes_set(0));
    }
}

/* Mixes the background's color into the colors, by the fraction TileSurface.fade, so that distant
 * vessels fade. */
LANE_FN void fade(Shading *shading)
{
    const Lanes part = lanes_load(&shading->surface->fade[shading->first]);
    for (int c = 0; c < 3; c++)
        shading->color[c] = lanes_fma(lanes_set(shading->look->paper[c]) - shading->color[c], part,
                                      shading->color[c]);
}

/* TileKernels.shade: computes the colors of hits. Normals are turned to face the viewer. */
LANE_TARGET static void LANES_NAME(shade)(const TileShading *look, const TileSurface *surface,
                                          float color[3][TILE_SAMPLES])
{
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        if (!lanes_any(lanes_of_bytes(&surface->hits->state[first])))
            continue;
        Shading shading;
        shading.look = look;
        shading.surface = surface;
        shading.first = first;
        Lanes ambient = lanes_set(look->finish.ambient);
        if (surface->ambient)
            ambient *= lanes_load(&surface->ambient[first]);
        for (int c = 0; c < 3; c++) {
            shading.normal[c] = lanes_load(&surface->hits->normal[c][first]);
            shading.direction[c] = lanes_load(&surface->direction[c][first]);
            shading.color[c] = lanes_load(&surface->pigment[c][first]) * ambient;
        }
        Lanes along_ray = dot(shading.normal, shading.direction);
        for (int c = 0; c < 3; c++)
            shading.normal[c] =
                lanes_select(along_ray > 0.0f, -shading.normal[c], shading.normal[c]);
        for (size_t i = 0; i < look->n_lights; i++)
            add_light(&shading, i);
        if (surface->fade)
            fade(&shading);
        for (int c = 0; c < 3; c++)
            lanes_store(&color[c][first], shading.color[c]);
    }
}

/* Returns the 8-bit sRGB codes of `linear`, clamped to [0, 1]. The bits of a positive float, read
 * as an integer, grow with its value. The high bits select an entry of the table; the entry plus
 * the low bits, shifted, is the code: a linear interpolation [SrgbCodes]. */
LANE_FN LaneMask srgb_lanes(const SrgbCodes *codes, const float *linear)
{
    Lanes value =
        lanes_min(lanes_max(lanes_load(linear), lanes_set(SRGB_MIN)), lanes_set(SRGB_MAX));
    LaneMask bits = (LaneMask)value - SRGB_CELLS_BEGIN;
    LaneMask cell = lanes_gather(codes->cells, bits >> SRGB_CELL_BITS);
    return (cell + (bits & (SRGB_CELL - 1))) >> SRGB_CELL_BITS;
}

/* Returns two pixels of three bytes each in the low 48 bits of the result. */
LANE_FN uint64_t two_pixels(const uint32_t *pixels)
{
    return pixels[0] | (uint64_t)pixels[1] << 24;
}

/* Stores eight bytes, the lowest first. */
LANE_FN void store_eight_bytes(uint8_t *to, uint64_t bytes)
{
    bytes = htole64(bytes);
    __builtin_memcpy(to, &bytes, sizeof bytes);
}

/* TileKernels.encode: stores the colors of a tile as 8-bit sRGB codes. */
LANE_TARGET static void LANES_NAME(encode)(const SrgbCodes *codes, float color[3][TILE_SAMPLES],
                                           const uint8_t *state, const uint8_t background[3],
                                           uint8_t *to, size_t stride)
{
    uint32_t pixels[TILE_SAMPLES];
    int32_t background_code = background[0] | background[1] << 8 | background[2] << 16;
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        LaneMask pixel = srgb_lanes(codes, &color[0][first]) |
                         srgb_lanes(codes, &color[1][first]) << 8 |
                         srgb_lanes(codes, &color[2][first]) << 16;
        if (state) {
            LaneMask traced = lanes_of_bytes(&state[first]);
            pixel = (pixel & traced) | (background_code & ~traced);
        }
        __builtin_memcpy(&pixels[first], &pixel, sizeof pixel);
    }
    for (int row = 0; row < TILE_SIDE; row++, to += stride) {
        uint64_t left = two_pixels(&pixels[tile_sample_at(0, row)]);
        uint64_t middle = two_pixels(&pixels[tile_sample_at(2, row)]);
        uint64_t right = two_pixels(&pixels[tile_sample_at(4, row)]);
        uint64_t last = two_pixels(&pixels[tile_sample_at(6, row)]);
        store_eight_bytes(to, left | middle << 48);
        store_eight_bytes(to + 8, middle >> 16 | right << 32);
        store_eight_bytes(to + 16, right >> 32 | last << 16);
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* Four floats. */
typedef float Quad __attribute__((vector_size(16)));

/* Stores four pixels: converts red, green and blue of four pixels to r g b r g b ... */
LANE_FN void store_pixels(float *to, Quad r, Quad g, Quad b)
{
    Quad low = __builtin_shufflevector(r, g, 0, 4, 1, 5);
    Quad high = __builtin_shufflevector(r, g, 2, 6, 3, 7);
    Quad middle = __builtin_shufflevector(low, b, 3, 5, 3, 5);
    Quad first = __builtin_shufflevector(low, b, 0, 1, 4, 2);
    Quad second = __builtin_shufflevector(middle, high, 0, 1, 4, 5);
    Quad third = __builtin_shufflevector(b, high, 2, 6, 7, 3);
    __builtin_memcpy(to, &first, sizeof first);
    __builtin_memcpy(to + 4, &second, sizeof second);
    __builtin_memcpy(to + 8, &third, sizeof third);
}

/* TileKernels.paint: stores the colors of a tile as floats. */
LANE_TARGET static void LANES_NAME(paint)(float color[3][TILE_SAMPLES], float *pixels,
                                          size_t stride)
{
    /* Eight consecutive samples are two blocks of 2 x 2, side by side: 4 x 2 pixels. */
    for (int block = 0; block < TILE_SAMPLES / 8; block++) {
        Quad upper[3], lower[3];
        for (int c = 0; c < 3; c++) {
            Quad left, right;
            __builtin_memcpy(&left, &color[c][8 * block], sizeof left);
            __builtin_memcpy(&right, &color[c][8 * block + 4], sizeof right);
            upper[c] = __builtin_shufflevector(left, right, 0, 1, 4, 5);
            lower[c] = __builtin_shufflevector(left, right, 2, 3, 6, 7);
        }
        float *to =
            pixels + (size_t)tile_sample_y(8 * block) * stride + 3 * tile_sample_x(8 * block);
        store_pixels(to, upper[0], upper[1], upper[2]);
        store_pixels(to + stride, lower[0], lower[1], lower[2]);
    }
}

/* TileKernels.clear: gives samples without a hit the background's color. */
LANE_TARGET static void LANES_NAME(clear)(const uint8_t *state, const float background[3],
                                          float color[3][TILE_SAMPLES])
{
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        LaneMask traced = lanes_of_bytes(&state[first]);
        for (int c = 0; c < 3; c++)
            lanes_store(&color[c][first], lanes_select(traced, lanes_load(&color[c][first]),
                                                       lanes_set(background[c])));
    }
}

/* ---- lights ---------------------------------------------------------------------------------- */

/* Returns a mask with bit i set if sample i faces the light. A surface faces the light if the light
 * and the camera are on the same side of it.
 *
 * point_light   true: the light has a position; false: it is parallel.
 * perspective   true: camera rays have the direction (x, y, 1) of their sample in the view's plane;
 *               false: (0, 0, 1). */
LANE_FN uint64_t facing_samples(const TracedTile *traced, const HitPoints *points,
                                const float normal[3][TILE_SAMPLES], const TileLight *light,
                                bool point_light, bool perspective)
{
    uint64_t facing = 0;
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        Lanes nx = lanes_load(&normal[0][first]), ny = lanes_load(&normal[1][first]);
        Lanes nz = lanes_load(&normal[2][first]), along_ray = nz, x = lanes_set(light->towards[0]);
        Lanes y = lanes_set(light->towards[1]), z = lanes_set(light->towards[2]);
        if (point_light) {
            x -= lanes_from_doubles_plus(&points->x[first], 0);
            y -= lanes_from_doubles_plus(&points->y[first], 0);
            z -= lanes_from_doubles_plus(&points->z[first], 0);
        }
        if (perspective)
            along_ray += nx * (lanes_load(&traced->x[first]) + (float)traced->middle_x) +
                         ny * (lanes_load(&traced->y[first]) + (float)traced->middle_y);
        Lanes along_light = nx * x + ny * y + nz * z;
        LaneMask faces = lanes_select(along_ray > 0.0f, -along_light, along_light) > 0.0f;
        facing |= (uint64_t)lanes_bits(faces) << first;
    }
    return facing;
}

/* TileKernels.facing. The constants in the first call let the compiler leave out unused branches of
 * the usual case. */
LANE_TARGET static uint64_t LANES_NAME(facing)(const TracedTile *traced, const HitPoints *points,
                                               const float normal[3][TILE_SAMPLES],
                                               const TileLight *light)
{
    if (light->parallel && !traced->perspective)
        return facing_samples(traced, points, normal, light, false, false);
    return facing_samples(traced, points, normal, light, !light->parallel, traced->perspective);
}

/* Returns the index of the tile that contains a position along one axis, clamped to [0, count). The
 * position is in tiles. */
LANE_FN int32_t tile_at(double position, double count)
{
    position = position > 0 ? position : 0;
    return (int32_t)(position < count ? position : count - 1);
}

/* TileKernels.project: projects the points to a light view. `slack` moves a point towards the light
 * by this length, so that its own surface does not shade it: in a parallel view along z, in
 * perspective along the line to the light, which changes z by slack times the line's z. */
LANE_TARGET static void LANES_NAME(project)(const LightProjection *aim, const HitPoints *points,
                                            ProjectedPoints *restrict aimed)
{
    const LightProjection a = *aim;
    const double width = 1 / a.per_x, height = 1 / a.per_y;
    double seen_x[TILE_SAMPLES], seen_y[TILE_SAMPLES]; /* in the view's plane */
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        double px = points->x[sample], py = points->y[sample], pz = points->z[sample];
        double x = px * a.axes[0].x + py * a.axes[0].y + pz * a.axes[0].z + a.offset.x;
        double y = px * a.axes[1].x + py * a.axes[1].y + pz * a.axes[1].z + a.offset.y;
        double z = px * a.axes[2].x + py * a.axes[2].y + pz * a.axes[2].z + a.offset.z;
        seen_x[sample] = x;
        seen_y[sample] = y;
        aimed->z[sample] = z - a.slack - a.z_middle;
    }
    for (int sample = 0; a.perspective && sample < TILE_SAMPLES; sample++) {
        double z = aimed->z[sample] + a.slack + a.z_middle, scale = 1 / z;
        double x = seen_x[sample] * scale, y = seen_y[sample] * scale;
        seen_x[sample] = x;
        seen_y[sample] = y;
        aimed->z[sample] = z - a.slack / sqrt(1 + x * x + y * y) - a.z_middle;
    }
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        double x = (seen_x[sample] - a.left) * a.per_x, y = (seen_y[sample] - a.top) * a.per_y;
        int32_t row = tile_at(y, a.rows), column = tile_at(x, a.columns);
        aimed->x[sample] = (float)((x - column - 0.5) * width);
        aimed->y[sample] = (float)((y - row - 0.5) * height);
        aimed->tile[sample] = row * (int32_t)a.columns + column;
    }
}

/* TileKernels.within: returns the samples whose projected point is in the tile. */
LANE_TARGET static uint64_t LANES_NAME(within)(const ProjectedPoints *aimed, int32_t tile)
{
    uint64_t bits = 0;
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        LaneMask tiles;
        __builtin_memcpy(&tiles, &aimed->tile[first], sizeof tiles);
        bits |= (uint64_t)lanes_bits(tiles == tile) << first;
    }
    return bits;
}

const TileKernels LANES_NAME(tilekernels) = {.shade = LANES_NAME(shade),
                                             .clear = LANES_NAME(clear),
                                             .paint = LANES_NAME(paint),
                                             .encode = LANES_NAME(encode),
                                             .facing = LANES_NAME(facing),
                                             .project = LANES_NAME(project),
                                             .within = LANES_NAME(within)};
