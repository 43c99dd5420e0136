/* The count of pixelmatch 7.2.0 [Mapbox, ISC licence], a rule that many test suites use: YIQ
 * difference [Kotsarenko and Ramos 2010] with a detector of antialiasing [Vysniauskas 2009]. Order
 * of evaluation is that of its source, so that the same pixels come out. */
#include "verify/verify.h"

#include <math.h>

static void read_pixel(const Picture *picture, int x, int y, int rgb[3])
{
    size_t first = ((size_t)y * (size_t)picture->width + (size_t)x) * (size_t)picture->channels;
    for (int c = 0; c < 3; c++) {
        int code = picture_code(picture, first + (picture->channels == 1 ? 0 : (size_t)c));
        rgb[c] = picture->bits == 8 ? code : (code + 128) / 257;
    }
}

static bool same_pixel(const Picture *picture, int x, int y, const int rgb[3])
{
    int other[3];
    read_pixel(picture, x, y, other);
    return other[0] == rgb[0] && other[1] == rgb[1] && other[2] == rgb[2];
}

static double difference(const int a[3], const int b[3])
{
    double r = a[0] - b[0], g = a[1] - b[1], u = a[2] - b[2];
    double y = r * 0.29889531 + g * 0.58662247 + u * 0.11448223;
    double i = r * 0.59597799 - g * 0.27417610 - u * 0.32180189;
    double q = r * 0.21147017 - g * 0.52261711 + u * 0.31114694;
    return 0.5053 * y * y + 0.299 * i * i + 0.1957 * q * q;
}

static int lower(int at)
{
    return at > 0 ? at - 1 : 0;
}

static int upper(int at, int side)
{
    return at + 1 < side ? at + 1 : side - 1;
}

static bool on_border(const Picture *picture, int x, int y)
{
    return x == 0 || x == picture->width - 1 || y == 0 || y == picture->height - 1;
}

/* Whether at least three of the neighbours have the pixel's colour; the border counts as one. */
static bool has_siblings(const Picture *picture, int x, int y)
{
    int equal = on_border(picture, x, y), center[3];
    read_pixel(picture, x, y, center);
    for (int column = lower(x); column <= upper(x, picture->width); column++)
        for (int row = lower(y); row <= upper(y, picture->height); row++)
            equal += (column != x || row != y) && same_pixel(picture, column, row, center);
    return equal > 2;
}

/* Whether the pixel of `picture` lies on an edge that antialiasing has smoothed: its darkest or its
 * brightest neighbour has siblings in both pictures. */
static bool is_antialiased(const Picture *picture, const Picture *partner, int x, int y)
{
    int equal = on_border(picture, x, y), center[3], extreme[2][2] = {{0}};
    double min = 0, max = 0;
    read_pixel(picture, x, y, center);
    for (int column = lower(x); column <= upper(x, picture->width); column++)
        for (int row = lower(y); row <= upper(y, picture->height); row++) {
            if (column == x && row == y)
                continue;
            int other[3];
            read_pixel(picture, column, row, other);
            double delta = (center[0] - other[0]) * 0.29889531 +
                           (center[1] - other[1]) * 0.58662247 +
                           (center[2] - other[2]) * 0.11448223;
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
    const double limit = 35215 * threshold * threshold;
    size_t count = 0;
    for (int y = 0; y < a->height; y++) {
        if (picture_rows_equal(a, b, y, 0, a->width))
            continue;
        for (int x = 0; x < a->width; x++) {
            int in_a[3], in_b[3];
            read_pixel(a, x, y, in_a);
            read_pixel(b, x, y, in_b);
            if (difference(in_a, in_b) > limit && !is_antialiased(a, b, x, y) &&
                !is_antialiased(b, a, x, y))
                count++;
        }
    }
    return count;
}
