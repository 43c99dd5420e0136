/* Counts differing pixels as the package pixelmatch 7.2.0 [Mapbox, ISC licence] does, whose rule
 * many test suites use: YIQ difference [Kotsarenko and Ramos 2010] with a detector of antialiasing
 * [Vysniauskas 2009]. The order of evaluation is that of its source, so that the same pixels are
 * counted. Two pixels are equal if their codes and their alpha are; where one of two is
 * transparent, both are blended with a checkerboard. */
#include "compare/measures/perception.h"

#include <math.h>

typedef struct Pixel {
    int rgb[3], alpha; /* from 0 to 255 */
} Pixel;

static int code_of_8_bits(const Picture *picture, size_t i)
{
    int code = picture_code(picture, i);
    return picture->bits == 8 ? code : (code + 128) / 257;
}

static Pixel pixel_at(const Picture *picture, int x, int y)
{
    size_t first = ((size_t)y * (size_t)picture->width + (size_t)x) * (size_t)picture->channels;
    Pixel pixel = {.alpha = 255};
    for (int c = 0; c < 3; c++)
        pixel.rgb[c] = code_of_8_bits(picture, first + (picture->channels == 1 ? 0 : (size_t)c));
    if (picture->channels == 4)
        pixel.alpha = code_of_8_bits(picture, first + 3);
    return pixel;
}

static bool are_equal(const Pixel *a, const Pixel *b)
{
    return a->rgb[0] == b->rgb[0] && a->rgb[1] == b->rgb[1] && a->rgb[2] == b->rgb[2] &&
           a->alpha == b->alpha;
}

/* The color a - b, from -255 to 255. Transparent pixels are blended with the square of the
 * checkerboard that pixelmatch has at the pixel (x, y): its squares depend on the byte in an RGBA
 * picture. */
static void subtract(const Picture *picture, int x, int y, const Pixel *a, const Pixel *b,
                     double difference[3])
{
    enum { DARK = 48, STEP = 159 }; /* codes of dark squares; of light squares minus dark ones */
    static const double periods[3] = {1, 1.618033988749895, 2.618033988749895};
    const double byte = 4 * ((double)y * picture->width + x);
    for (int c = 0; c < 3; c++) {
        difference[c] = a->rgb[c] - b->rgb[c];
        if (a->alpha == 255 && b->alpha == 255)
            continue;
        int square = DARK + STEP * (int)((long long)(byte / periods[c]) % 2);
        difference[c] =
            (a->rgb[c] * a->alpha - b->rgb[c] * b->alpha - square * (a->alpha - b->alpha)) / 255.0;
    }
}

/* Returns the channel Y of YIQ, with the weights of pixelmatch. */
static double brightness(const double rgb[3])
{
    return rgb[0] * 0.29889531 + rgb[1] * 0.58662247 + rgb[2] * 0.11448223;
}

static double square_of_yiq(const double rgb[3])
{
    double y = brightness(rgb);
    double i = rgb[0] * 0.59597799 - rgb[1] * 0.27417610 - rgb[2] * 0.32180189;
    double q = rgb[0] * 0.21147017 - rgb[1] * 0.52261711 + rgb[2] * 0.31114694;
    return 0.5053 * y * y + 0.299 * i * i + 0.1957 * q * q;
}

/* Return the coordinates of the neighbours before and after `at`, within the picture. */
static int lower(int at)
{
    return at > 0 ? at - 1 : 0;
}

/* Returns the coordinate of the next pixel, or of the last pixel at the border. */
static int upper(int at, int side)
{
    return at + 1 < side ? at + 1 : side - 1;
}

static bool on_border(const Picture *picture, int x, int y)
{
    return x == 0 || x == picture->width - 1 || y == 0 || y == picture->height - 1;
}

/* Returns true if at least three neighbours have the color of the pixel; the border counts as one.
 */
static bool has_siblings(const Picture *picture, int x, int y)
{
    int equal = on_border(picture, x, y);
    const Pixel center = pixel_at(picture, x, y);
    for (int column = lower(x); column <= upper(x, picture->width); column++)
        for (int row = lower(y); row <= upper(y, picture->height); row++) {
            const Pixel other = pixel_at(picture, column, row);
            equal += (column != x || row != y) && are_equal(&other, &center);
        }
    return equal > 2;
}

/* Returns true if the pixel is on an edge that antialiasing has smoothed: its darkest or its
 * brightest neighbour has siblings in both pictures. */
static bool is_antialiased(const Picture *picture, const Picture *partner, int x, int y)
{
    int equal = on_border(picture, x, y), extreme[2][2] = {{0}};
    const Pixel center = pixel_at(picture, x, y);
    double min = 0, max = 0, difference[3];
    for (int column = lower(x); column <= upper(x, picture->width); column++)
        for (int row = lower(y); row <= upper(y, picture->height); row++) {
            if (column == x && row == y)
                continue;
            const Pixel other = pixel_at(picture, column, row);
            subtract(picture, x, y, &center, &other, difference);
            double delta = brightness(difference);
            if (delta == 0) {
                if (++equal > 2)
                    return false;
            } else if (delta < min) {
                min = delta;
                extreme[0][0] = column;
                extreme[0][1] = row;
            } else if (delta > max) {
                max = delta;
                extreme[1][0] = column;
                extreme[1][1] = row;
            }
        }
    bool smoothed = false;
    for (int i = 0; i < 2 && min != 0 && max != 0; i++)
        smoothed = smoothed || (has_siblings(picture, extreme[i][0], extreme[i][1]) &&
                                has_siblings(partner, extreme[i][0], extreme[i][1]));
    return smoothed;
}

size_t pixelmatch_count(const Picture *a, const Picture *b, double threshold)
{
    const double max_square = 35215; /* the largest square_of_yiq of two colors */
    const double limit = max_square * threshold * threshold;
    size_t count = 0;
    const bool same_form = a->channels == b->channels && a->bits == b->bits;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            if (x == 0 && same_form && picture_rows_equal(a, b, y, 0, a->width))
                break;
            const Pixel in_a = pixel_at(a, x, y), in_b = pixel_at(b, x, y);
            double difference[3];
            if (are_equal(&in_a, &in_b))
                continue;
            subtract(a, x, y, &in_a, &in_b, difference);
            count += square_of_yiq(difference) > limit && !is_antialiased(a, b, x, y) &&
                     !is_antialiased(b, a, x, y);
        }
    return count;
}
