/* Finds a change of hue or of saturation: one map of colors changes every pixel of A into the pixel
 * of B. The map does not change greys. Each map has one parameter, which is fitted to the samples.
 * The map is named if it fits the whole picture: for 50 pixels of A and B that differ by more than
 * the rounding of codes, it leaves at most one pixel that differs. A saturation moves a color away
 * from the grey of its pixel. Programs define this grey in different ways, and compute in codes or
 * in light. A level is 1/255 of the range of codes. */
#include "compare/cause/guesses.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The maps: ways to define the grey of a saturation, and ways to turn a hue. */
typedef enum ColorMap {
    TO_LUMA_601, /* saturation; the grey has the luma of the pixel */
    TO_LUMA_709,
    TO_MEAN,
    TO_MAX,    /* as in HSV */
    TO_MIDDLE, /* the middle between the largest and the smallest channel, as in HSL */
    SATURATIONS,
    AROUND_GREY = SATURATIONS, /* hue; a rotation about the axis of greys */
    AT_LUMA,                   /* the matrix of hue-rotate in CSS, which keeps the luma */
    HEXAGON,                   /* the hue of HSV and HSL */
    COLOR_MAPS
} ColorMap;

/* A map with its number. It acts on codes or on linear light. */
typedef struct MapOf {
    ColorMap map;
    bool in_light;
    double number; /* factor of the saturation, or degrees */
} MapOf;

/* Returns the sRGB code, 0 to 255, of a linear level; levels outside 0..1 are clamped. */
static double encode(double level)
{
    return 255 * (double)srgb_encode((float)fmin(fmax(level, 0), 1));
}

/* Returns the chroma of HSV: the largest channel minus the smallest one. */
static double chroma_of(const double c[3])
{
    return fmax(c[0], fmax(c[1], c[2])) - fmin(c[0], fmin(c[1], c[2]));
}

/* Returns the grey from which a saturation moves a color away. */
static double grey_of(ColorMap map, const double c[3])
{
    double high = fmax(c[0], fmax(c[1], c[2])), low = fmin(c[0], fmin(c[1], c[2]));
    switch (map) {
    case TO_LUMA_601:
        return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
    case TO_LUMA_709:
        return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    case TO_MAX:
        return high;
    case TO_MIDDLE:
        return (high + low) / 2;
    default:
        return (c[0] + c[1] + c[2]) / 3;
    }
}

/* Turns the hue of HSV: chroma and lightness stay. `hue` counts sextants: 0 is red, 2 green, 4
 * blue. */
static void turn_hexagon(const double c[3], double degrees, double out[3])
{
    double high = fmax(c[0], fmax(c[1], c[2])), low = fmin(c[0], fmin(c[1], c[2]));
    double chroma = high - low, hue = 0;
    if (chroma > 0)
        hue = high == c[0]   ? (c[1] - c[2]) / chroma
              : high == c[1] ? 2 + (c[2] - c[0]) / chroma
                             : 4 + (c[0] - c[1]) / chroma;
    for (int i = 0; i < 3; i++) {
        double at = fmod(hue + degrees / 60 + (double[]){0, 4, 2}[i] + 12, 6);
        out[i] = low + chroma * fmin(fmax(fabs(at - 3) - 1, 0), 1);
    }
}

/* Turns a color about the grey that has the color's luma, in the plane of colors of equal luma.
 * With the weights (1, 1, 1) / 3 this is a rotation about the axis of greys. If `by_luma` is true,
 * it is the filter hue-rotate of CSS, with the weights and the matrix of that standard. */
static void turn_at_luma(const double c[3], double degrees, bool by_luma, double out[3])
{
    static const double weights[2][3] = {{1 / 3.0, 1 / 3.0, 1 / 3.0}, {0.213, 0.715, 0.072}};
    const double *w = weights[by_luma], cosine = elementary_cos(degrees * DEGREE),
                 sine = elementary_sin(degrees * DEGREE), third = 0.5773502691896258;
    const double luma = w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
    /* What CSS adds for the sine, and the cross product with the axis of greys. */
    static const double css[3][3] = {
        {-0.213, -0.715, 0.928}, {0.143, 0.140, -0.283}, {-0.787, 0.715, 0.072}};
    for (int i = 0; i < 3; i++) {
        double across = third * (c[(i + 2) % 3] - c[(i + 1) % 3]);
        if (by_luma)
            across = css[i][0] * c[0] + css[i][1] * c[1] + css[i][2] * c[2];
        out[i] = luma + cosine * (c[i] - luma) + sine * across;
    }
}

/* Changes a color by the map with its number: saturations mix with grey, hues turn. */
static void apply_map(const MapOf *map, const double c[3], double out[3])
{
    if (map->map < SATURATIONS) {
        double grey = grey_of(map->map, c);
        for (int i = 0; i < 3; i++)
            out[i] = grey + map->number * (c[i] - grey);
    } else if (map->map == HEXAGON) {
        turn_hexagon(c, map->number, out);
    } else {
        turn_at_luma(c, map->number, map->map == AT_LUMA, out);
    }
}

/* ---- fits ------------------------------------------------------------------------------------ */

/* Numbers of pixels: with a difference above slack_of before the map, with one after it, and with a
 * chroma above 16 levels; sum of squared differences after the map, levels^2. */
typedef struct ColorFit {
    size_t beyond, misfits, colored;
    double squares;
} ColorFit;

/* Returns the levels that a map may leave: rounding, and more for programs that round hues of HSV
 * to 8 bits. */
static double slack_of(const MapOf *map)
{
    return map->map == HEXAGON ? 4.01 : 2.01;
}

static void levels_at(const Picture *picture, size_t code, double out[3])
{
    for (size_t c = 0; c < 3; c++)
        out[c] = picture_code(picture, code + c) / (double)largest_code(picture);
}

/* Adds the pixel whose first code has the index `code`. */
static void add_pixel(const MapOf *map, const Picture *a, const Picture *b, size_t code,
                      ColorFit *fit)
{
    double from[3], to[3], mapped[3], worst = 0, off = 0;
    const double slack = slack_of(map);
    levels_at(a, code, from);
    levels_at(b, code, to);
    const double chroma = chroma_of(from);
    double in[3] = {from[0], from[1], from[2]};
    for (int c = 0; map->in_light && c < 3; c++)
        in[c] = (double)srgb_decode((float)from[c]);
    apply_map(map, in, mapped);
    for (int c = 0; c < 3; c++) {
        double is = 255 * to[c], was = 255 * from[c];
        double expected = map->in_light ? encode(mapped[c]) : 255 * fmin(fmax(mapped[c], 0), 1);
        worst = fmax(worst, fabs(expected - is));
        off = fmax(off, fabs(is - was));
        fit->squares += (expected - is) * (expected - is);
    }
    fit->colored += chroma > 16 / 255.0;
    fit->beyond += off > slack;
    fit->misfits += worst > slack;
}

/* Fits a map to the samples, or to all pixels if `samples` is NULL. */
static ColorFit fit_of(const MapOf *map, const Picture *a, const Picture *b, const Samples *samples)
{
    ColorFit fit = {0};
    const size_t n = sampled_pixels(a, samples);
    for (size_t i = 0; i < n; i++)
        add_pixel(map, a, b, sampled_code(a, samples, i), &fit);
    return fit;
}

/* Returns true if `least` pixels differ, as many are colored, and one in 50 differs after the map.
 */
static bool fits(const ColorFit *fit, size_t least)
{
    return fit->beyond >= least && fit->colored >= least && 50 * fit->misfits <= fit->beyond;
}

/* ---- the number of a map --------------------------------------------------------------------- */

/* A map whose number is sought, and the samples that it is fitted to. */
typedef struct NumberSearch {
    MapOf *map;
    const Picture *a, *b;
    const Samples *samples;
} NumberSearch;

/* Returns the sum of squares that the map with this number leaves. */
static double squares_of(void *context, double number)
{
    const NumberSearch *search = context;
    search->map->number = number;
    return fit_of(search->map, search->a, search->b, search->samples).squares;
}

/* Finds the number with the least sum of squares: first on a grid, because there may be several
 * minima, then by golden section, which shrinks the interval of two steps to 0.618^16 = 1/2200 of
 * it. The grid has steps of 6 degrees, or of 0.1 in saturations from 0 to 3. */
static void find_number(MapOf *map, const Picture *a, const Picture *b, const Samples *samples)
{
    enum { STEPS = 16 };
    const bool is_hue = map->map >= SATURATIONS;
    const double from = is_hue ? -180 : 0, step = is_hue ? 6 : 0.1;
    NumberSearch search = {map, a, b, samples};
    double best = from, least = squares_of(&search, from);
    for (int i = 1; i < (is_hue ? 60 : 31); i++) {
        double squares = squares_of(&search, from + i * step);
        if (squares < least) {
            least = squares;
            best = from + i * step;
        }
    }
    map->number = golden_section(squares_of, &search, best - step, best + step, STEPS, &least);
}

static void say(const MapOf *map, Sentence *out)
{
    if (map->map >= SATURATIONS)
        snprintf(out->text, out->size, "B is A with its hues turned by %.0f degrees", map->number);
    else if (map->number < 0.01)
        snprintf(out->text, out->size, "B is A in gray: its saturation is 0");
    else
        snprintf(out->text, out->size, "B is A with its saturation changed by a factor of %.2f%s",
                 map->number, map->in_light ? " in linear light" : "");
}

/* Returns true if more than a tenth of the samples, pixels that differ, are grey in A and differ by
 * more than rounding. No map changes greys, so none fits. */
static bool changes_greys(const Picture *a, const Picture *b, const Samples *samples)
{
    int grey = 0;
    for (int i = 0; i < samples->n; i++) {
        const PixelPlace *at = &samples->at[i];
        double c[3];
        levels_at(a, sampled_code(a, samples, (size_t)i), c);
        grey += chroma_of(c) <= 2 / 255.0 &&
                pixels_apart(a, at->x, at->y, b, at->x, at->y) > 6 * codes_per_level(a);
    }
    return 10 * grey > samples->n;
}

void cause_hue(const Picture *a, const Picture *b, const Samples *samples, Sentence *out)
{
    /* Fewer pixels than ENOUGH fit some map by chance. Of the samples FEW suffice, because most of
     * them may show a nearly grey background. */
    enum { ENOUGH = 16, FEW = 4 };
    if (a->channels != 3 || a->gamma != 0 || changes_greys(a, b, samples))
        return;
    for (ColorMap kind = 0; kind < COLOR_MAPS && !*out->text; kind++)
        for (int in_light = 0; in_light < 2 && !*out->text; in_light++) {
            MapOf map = {.map = kind, .in_light = in_light};
            find_number(&map, a, b, samples);
            ColorFit fit = fit_of(&map, a, b, samples);
            if (!fits(&fit, FEW) || (kind < SATURATIONS && fabs(map.number - 1) < 0.02))
                continue;
            fit = fit_of(&map, a, b, NULL);
            if (fits(&fit, ENOUGH))
                say(&map, out);
        }
}
